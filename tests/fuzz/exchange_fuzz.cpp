// Hostile IGES and STEP files for the reader of profiles, made by changing valid ones where a reader must
// think. Every one must end as a profile or as a CadError with its parts; see README.md.

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <optional>

#include "cad/detail/curve_source.h"
#include "cad/detail/import_here.h"
#include "cad/export.h"
#include "cad/profile_import.h"
#include "fuzz/support/free_curves_step.h"
#include "fuzz/support/iges_mutator.h"
#include "fuzz/support/input_batch.h"
#include "fuzz/support/step_mutator.h"
#include "support/cad/sample_profiles.h"
#include "support/temporary_folder.h"

namespace {

using namespace catoptric;
using Clock = std::chrono::steady_clock;

constexpr std::array<const char*, 7> endings{"profile",
                                             "refused",
                                             "refused: the child crashed",
                                             "refused: the child ran out of time",
                                             "refused: out of memory",
                                             "refused: the child ended early",
                                             "NOT AS IT MUST"};

/// How reading a file ended.
struct Ended {
  unsigned which;          ///< of endings
  std::string fault = {};  ///< when it must not end so
};

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

bool is_finite(const Profile& profile) {
  for (const ControlPoint& point : profile.points())
    if (!std::isfinite(point.r_mm) || !std::isfinite(point.z_mm) || !std::isfinite(point.weight))
      return false;
  return std::isfinite(profile.diagonal_mm());
}

Ended refusal(const CadError& error) {
  const ErrorParts& parts = error.parts();
  if (parts.what.empty() || parts.hint.empty()) return {6, "a message without its parts"};
  if (std::string(error.what()).size() > 100000) return {6, "a message without end"};
  if (contains(parts.why, "crashes on it")) return {2};
  if (contains(parts.why, "come to an end")) return {3};
  if (contains(parts.why, "not enough memory")) return {4};
  if (contains(parts.why, "without a result")) return {5};
  return {1};
}

/// @in read: the reader, on the file
template <typename Read>
Ended ended(Read&& read) {
  try {
    return is_finite(read().profile) ? Ended{0} : Ended{6, "a profile that is not finite"};
  } catch (const CadError& error) {
    return refusal(error);
  } catch (const std::exception& error) {
    return {6, std::string("an exception of the wrong kind: ") + error.what()};
  }
}

std::size_t open_files() {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator("/proc/self/fd"),
                                                std::filesystem::directory_iterator()));
}

double peak_mib() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Valid files that mutations begin with.
std::vector<std::string> seeds(const std::string& format, const test::TemporaryFolder& folder) {
  std::vector<std::string> texts;
  const auto exported = [&](const Profile& profile, const cad::ExportOptions& options) {
    const auto file = folder / ("seed." + format);
    cad::export_reflector(profile, file, options);
    texts.push_back(test::read_whole(file));
    std::filesystem::remove(file);
  };
  cad::ExportOptions options;
  exported(test::paraboloid(), options);
  exported(test::hemisphere(10), options);
  options.wall = cad::Wall{2, cad::WallSide::outside};
  options.iges_mode = cad::IgesMode::brep;
  options.schema = cad::StepSchema::ap203;
  exported(test::paraboloid(), options);
  // Small files are read faster, and more of their changes matter: they come more often.
  std::vector<std::string> small;
  if (format == "step") small.assign(3, fuzz::free_curves_step());
  if (format == "iges")
    for (const auto& entry : std::filesystem::directory_iterator(CATOPTRIC_DATA "/profiles"))
      if (entry.path().extension() == ".igs") small.push_back(test::read_whole(entry.path()));
  std::sort(small.begin(), small.end());  // folders have no order
  for (int i = 0; i < 3; ++i) texts.insert(texts.end(), small.begin(), small.end());
  return texts;
}

struct Arguments {
  std::string format;
  std::uint64_t runs = 1000000, seed = 1, first = 0;
  double seconds = HUGE_VAL;  ///< the campaign ends after so many
  std::uint64_t batch = 200;  ///< inputs per child; 0: every input by import_profile() itself
  std::chrono::milliseconds limit{300};
  std::filesystem::path keep;  ///< folder for files worth keeping
};

Arguments arguments(int count, char** values) {
  Arguments result;
  for (int i = 1; i < count; ++i) {
    const std::string text = values[i];
    const auto value = [&](const char* name) -> std::optional<std::string> {
      const std::string start = std::string("-") + name + "=";
      if (text.rfind(start, 0) != 0) return std::nullopt;
      return text.substr(start.size());
    };
    if (const auto runs = value("runs")) result.runs = std::stoull(*runs);
    if (const auto seconds = value("seconds")) result.seconds = std::stod(*seconds);
    if (const auto seed = value("seed")) result.seed = std::stoull(*seed);
    if (const auto first = value("first")) result.first = std::stoull(*first);
    if (const auto batch = value("batch")) result.batch = std::stoull(*batch);
    if (const auto limit = value("limit")) result.limit = std::chrono::milliseconds(std::stol(*limit));
    if (const auto keep = value("keep")) result.keep = *keep;
    if (text[0] != '-') result.format = text;
  }
  return result;
}

class Campaign {
 public:
  explicit Campaign(Arguments asked)
      : asked_(std::move(asked)), file_(folder_ / ("hostile." + asked_.format)) {
    for (const std::string& text : seeds(asked_.format, folder_))
      if (asked_.format == "step")
        step_.emplace_back(text);
      else
        iges_.emplace_back(text);
    warm_up();
  }

  /// @out number of findings
  int run() {
    const std::size_t files_before = open_files();
    begin_ = Clock::now();
    while (done_ < asked_.runs && seconds() < asked_.seconds) {
      const std::uint64_t before = done_;
      if (asked_.batch > 0) try_batch(std::min(asked_.batch, asked_.runs - done_));
      if (asked_.batch == 0) try_alone();
      if (done_ / 10000 != before / 10000) report();
    }
    report();
    if (open_files() != files_before) complain(fmt::format("{} files are open", open_files()));
    if (::waitpid(-1, nullptr, WNOHANG) != -1 || errno != ECHILD) complain("a child is left");
    std::filesystem::remove(file_);
    if (!folder_.is_empty()) complain("files are left in the folder");
    return findings_;
  }

 private:
  /// Reads what is trusted in this process, so that no child has to load OCCT's tables again.
  void warm_up() const {
    for (const std::string& text : seeds(asked_.format, folder_)) {
      test::write_whole(file_, text);
      static_cast<void>(asked_.format == "step" ? cad::detail::read_step_curves(file_)
                                                : cad::detail::read_iges_curves(file_));
    }
  }

  void write_input(std::uint64_t number) const {
    fuzz::Chance chance(asked_.seed * 0x9E3779B97F4A7C15 + number);
    test::write_whole(
        file_, asked_.format == "step" ? chance.of(step_).mutated(chance) : chance.of(iges_).mutated(chance));
  }

  /// Many inputs in one child; the one that ends it is tried again by the program's own sandbox.
  void try_batch(std::uint64_t count) {
    const fuzz::BatchProgress progress = fuzz::run_batch(
        count, asked_.limit,
        [&](std::uint64_t i, unsigned& which) {
          write_input(asked_.first + done_ + i);
          const Ended end =
              ended([&] { return cad::detail::import_here(file_, cad::detail::kind_of_file(file_), {}); });
          which = end.which;
          return end.fault;
        },
        counts_);
    done_ += progress.done;
    if (!progress.finding.empty()) {
      complain(fmt::format("input {}: {}", asked_.first + done_ - 1, progress.finding));
      keep(asked_.first + done_ - 1, "finding");
    }
    if (progress.died) try_alone();
  }

  /// The next input by import_profile().
  void try_alone() {
    const std::uint64_t number = asked_.first + done_++;
    write_input(number);
    const auto begin = Clock::now();
    const Ended end = ended([&] {
      cad::ImportOptions options;
      options.time_limit = asked_.limit;
      return cad::import_profile(file_, options);
    });
    const std::chrono::duration<double> took = Clock::now() - begin;
    slowest_ = std::max(slowest_, took.count());
    ++alone_;
    if (++counts_[end.which] <= 5) keep(number, endings[end.which]);
    if (!end.fault.empty()) complain(fmt::format("input {}: {}", number, end.fault));
    constexpr std::chrono::seconds patience{10};  // a loaded machine may keep us waiting
    if (took > asked_.limit + patience) complain(fmt::format("input {} hung", number));
  }

  void keep(std::uint64_t number, const std::string& word) const {
    if (asked_.keep.empty()) return;
    std::string name;
    for (const char c : word) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    std::filesystem::create_directories(asked_.keep);
    write_input(number);
    std::filesystem::copy_file(file_, asked_.keep / fmt::format("{}_{}.{}", name, number, asked_.format),
                               std::filesystem::copy_options::overwrite_existing);
  }

  void complain(const std::string& what) {
    ++findings_;
    fmt::print("FINDING: {}\n", what);
  }

  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  void report() const {
    fmt::print(
        "{} {} inputs, {} of them alone, {:.0f} s, {:.0f} a second, slowest {:.1f} s, {} files open, {:.0f} "
        "MiB\n",
        asked_.format, done_, alone_, seconds(), static_cast<double>(done_) / seconds(), slowest_,
        open_files(), peak_mib());
    for (std::size_t i = 0; i < endings.size(); ++i)
      if (counts_[i] > 0) fmt::print("    {:9} {}\n", counts_[i], endings[i]);
    std::fflush(stdout);
  }

  Arguments asked_;
  test::TemporaryFolder folder_;
  std::filesystem::path file_;
  std::vector<fuzz::StepMutator> step_;
  std::vector<fuzz::IgesMutator> iges_;
  std::uint64_t counts_[16] = {};
  std::uint64_t done_ = 0, alone_ = 0;
  Clock::time_point begin_;
  double slowest_ = 0;
  int findings_ = 0;
};

}  // namespace

int main(int count, char** values) {
  const Arguments asked = arguments(count, values);
  if (asked.format != "step" && asked.format != "iges") {
    fmt::print(
        "usage: fuzz_exchange step|iges [-runs=N] [-seed=N] [-first=N] [-seconds=S] [-batch=N] "
        "[-limit=MILLISECONDS] "
        "[-keep=FOLDER]\n");
    return 2;
  }
  return Campaign(asked).run() == 0 ? 0 : 1;
}
