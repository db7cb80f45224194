#include "design/tradeoff.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "base/byte_record.h"
#include "design/evaluator.h"
#include "design/judge.h"
#include "design/memory_need.h"
#include "design/sampling.h"
#include "design/shared_work.h"
#include "design/stage.h"
#include "design/thread_limit.h"
#include "sim/closed_forms.h"
#include "sim/tubes.h"

namespace catoptric::design {
namespace {

/// Streams that neither searches nor verdicts nor references use.
constexpr std::uint64_t trade_stream = std::uint64_t{1} << 33;
constexpr std::uint64_t truth_stream = std::uint64_t{1} << 34;

using Clock = std::chrono::steady_clock;
double elapsed_s(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// As rank 0's memory has room.
std::uint64_t fitting_for_all(Ranks& ranks) {
  const Bytes bytes = ranks.from_first([] { return ByteWriter().put(photons_that_fit()).take(); });
  return ByteReader(bytes).get<std::uint64_t>();
}

struct Truth {
  std::string name;
  double error_rel = 0;
  std::vector<double> total;  ///< W/mm^2
};

Truth find_truth(const Scene& scene, const Profile& profile, std::span<const sim::FieldSample> samples,
                 const RunControl& control) {
  const Stage stage(scene, profile);
  if (auto form = sim::closed_form(stage.scene, samples))
    return {"closed form: " + form->name, 1e-12,
            sum(sim::direct_field(stage.scene, samples), form->reflected)};
  sim::AccuracyRequest request;
  request.relative = scene.tradeoff.reference_accuracy_rel;
  request.photons = scene.model.photons;
  request.photons.sampler = sim::Sampler::sobol;
  request.photons.stream = truth_stream;
  request.photons.ranks = control.ranks;
  request.most_photons = std::min(50 * scene.tradeoff.most_photons, fitting_for_all(ranks_of(control)));
  const sim::AccurateField field = sim::reach_accuracy(stage.scene, samples, request);
  return {field.rung == sim::Rung::tubes
              ? fmt::format("ray tubes, {} rays", field.rays)
              : fmt::format("rung {}, {} photons", name(field.rung), field.sets * field.photons),
          field.error95_rel, sum(field.direct, field.reflected)};
}

/// One setting applied to a scene.
Scene with_setting(const Scene& scene, const TradeSetting& setting) {
  Scene changed = scene;
  changed.model = setting.model;
  changed.accuracy_rel = setting.accuracy_rel;
  return changed;
}

struct Field {
  std::vector<double> total;
  std::uint64_t photons = 0;
};

Field compute(const Scene& scene, const TradeSetting& setting, const Profile& profile,
              std::span<const sim::FieldSample> samples, std::uint64_t stream) {
  if (!setting.accuracy_rel)
    return {total_by_rung(scene, setting.rung, profile, samples, stream),
            setting.rung == sim::Rung::tubes ? 0 : setting.model.photons.photons};
  const Judgement judgement =
      judge_to_accuracy(scene, {{samples.begin(), samples.end()}, {}}, profile, stream, false, {});
  return {sum(judgement.direct, judgement.reflected), judgement.accuracy->spent_photons};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Runs one setting with every seed and then as often as a steady time takes.
TradeRow measure(const Scene& scene, const TradeSetting& setting, const Profile& profile,
                 std::span<const sim::FieldSample> samples, const Truth& truth) {
  constexpr std::size_t fewest_times = 3, most_times = 15;
  constexpr double enough_seconds = 0.05;  // of short evaluations several are needed for a median
  const Scene changed = with_setting(scene, setting);
  const ThreadLimit limit(setting.threads > 0 ? setting.threads : scene.threads);
  const double rms = root_mean_square(truth.total);
  TradeRow row{.setting = setting, .seeds = setting.rung == sim::Rung::tubes ? 1 : scene.tradeoff.seeds};
  std::vector<double> times;
  double square = 0, spent = 0;
  int judged_seeds = 0;
  constexpr double patience = 10;  // in longest evaluations: an accuracy may turn out to be out of reach
  const std::size_t most = std::max(most_times, static_cast<std::size_t>(row.seeds));
  for (std::size_t run = 0; run < most; ++run) {
    const bool judged = static_cast<int>(run) < row.seeds;
    if (!judged && run >= fewest_times && spent > enough_seconds) break;
    if (spent > (judged ? patience : 1) * scene.tradeoff.seconds) break;
    const auto begin = Clock::now();
    // Sets of photons of an accuracy take consecutive streams: seeds stand far apart.
    const Field field =
        compute(changed, setting, profile, samples, trade_stream + (static_cast<std::uint64_t>(run) << 20));
    times.push_back(elapsed_s(begin));
    spent += times.back();
    row.photons = std::max(row.photons, field.photons);
    if (!judged) continue;
    const double error = root_mean_square_error(field.total, truth.total) / rms;
    square += error * error;
    ++judged_seeds;
    row.greatest_error_rel = std::max(row.greatest_error_rel, error);
  }
  row.seeds = judged_seeds;
  row.error_rel = std::sqrt(square / judged_seeds);
  row.seconds = median(times);
  row.least_seconds = *std::min_element(times.begin(), times.end());
  return row;
}

/// Whether two settings differ in the number of photons alone.
bool same_family(const TradeSetting& a, const TradeSetting& b) {
  const auto &x = a.model.estimate, &y = b.model.estimate;
  return a.rung == b.rung && a.model.engine == b.model.engine && a.threads == b.threads &&
         a.model.photons.sampler == b.model.photons.sampler && x.kernel == y.kernel &&
         x.neighbours == y.neighbours && x.kernel_radius_mm == y.kernel_radius_mm &&
         a.model.mesh.chord_error == b.model.mesh.chord_error &&
         a.model.mesh.newton_tolerance == b.model.mesh.newton_tolerance &&
         a.accuracy_rel.has_value() == b.accuracy_rel.has_value();
}

/// Time to be expected from the nearest measured relative, by photons; 0 when nothing is known.
double expected_seconds(const std::vector<TradeRow>& rows, const TradeSetting& setting) {
  double expected = 0;
  for (const TradeRow& row : rows)
    if (same_family(row.setting, setting) && row.setting.model.photons.photons > 0)
      expected = row.seconds * static_cast<double>(setting.model.photons.photons) /
                 static_cast<double>(row.setting.model.photons.photons);
  return expected;
}

std::string machine() {
  std::ifstream file("/proc/cpuinfo");
  std::string line, model = "unknown processor";
  while (std::getline(file, line))
    if (line.rfind("model name", 0) == 0 && line.find(':') != std::string::npos) {
      model = line.substr(line.find(':') + 2);
      break;
    }
  return fmt::format("{}, {} cores", model, std::thread::hardware_concurrency());
}

std::string sentence_of(const Scene& scene, const Tradeoff& trade) {
  std::string text;
  for (const TradeChoice& choice : trade.choices) {
    text += fmt::format("{}for {:g} % ", text.empty() ? "Take " : "; ", 100 * choice.accuracy_rel);
    if (!choice.row) {
      text += "nothing that was tried suffices";
      continue;
    }
    const TradeRow& row = trade.rows[*choice.row];
    text += fmt::format("{} ({:.2g} ms)", words(scene, row.setting), 1e3 * row.seconds);
  }
  return text + ".";
}

}  // namespace

void mark_front(std::vector<TradeRow>& rows) {
  for (TradeRow& row : rows)
    row.on_front = std::none_of(rows.begin(), rows.end(), [&](const TradeRow& other) {
      return other.seconds <= row.seconds && other.greatest_error_rel <= row.greatest_error_rel &&
             (other.seconds < row.seconds || other.greatest_error_rel < row.greatest_error_rel);
    });
}

std::vector<TradeChoice> choose(const std::vector<TradeRow>& rows, double reference_error_rel,
                                const std::vector<double>& accuracies_rel) {
  std::vector<TradeChoice> choices;
  for (const double accuracy : accuracies_rel) {
    TradeChoice choice{accuracy, {}};
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (rows[i].greatest_error_rel + reference_error_rel <= accuracy &&
          (!choice.row || rows[i].seconds < rows[*choice.row].seconds))
        choice.row = i;
    choices.push_back(choice);
  }
  return choices;
}

Tradeoff run_tradeoff(const Scene& written, const RunControl& control) {
  const auto begin = Clock::now();
  const Candidate start = start_candidate(written);
  const Profile& profile = start.profile;
  Scene scene = written;
  scene.source = start.source;
  scene.mirror = start.mirror;
  const std::vector<sim::FieldSample> samples = field_samples(scene);
  control.tell({"reference", 0.0, std::numeric_limits<double>::quiet_NaN(), 0});
  const Truth truth = find_truth(scene, profile, samples, control);
  Tradeoff trade;
  trade.reference = truth.name;
  trade.reference_error_rel = truth.error_rel;
  trade.rms_w_per_m2 = to_w_per_m2(root_mean_square(truth.total));
  if (!(trade.rms_w_per_m2 > 0))
    throw InputError({"the near field is dark", scene.settings.file(),
                      "errors are relative to its irradiance", "aim the mirror at the near field"});
  if (!ranks_of(control).leads()) return trade;  // times are measured where nobody else works
  const std::vector<TradeSetting> settings = trade_settings(scene, profile);
  for (std::size_t i = 0; i < settings.size() && !control.stopped(); ++i) {
    if (!fits_memory(with_setting(scene, settings[i]))) {
      trade.left_out.push_back(words(scene, settings[i]) + ": would not fit into memory");
      continue;
    }
    const double expected = expected_seconds(trade.rows, settings[i]);
    if (expected > scene.tradeoff.seconds) {
      trade.left_out.push_back(fmt::format("{}: about {:.2g} s an evaluation, tradeoff.seconds is {:g}",
                                           words(scene, settings[i]), expected, scene.tradeoff.seconds));
      continue;
    }
    trade.rows.push_back(measure(scene, settings[i], profile, samples, truth));
    control.tell({"measure", static_cast<double>(i + 1) / static_cast<double>(settings.size()),
                  std::numeric_limits<double>::quiet_NaN(), static_cast<long>(i + 1)});
  }
  mark_front(trade.rows);
  trade.choices = choose(trade.rows, truth.error_rel, {0.1, 0.01, 0.001});
  trade.sentence = sentence_of(scene, trade);
  trade.machine = machine();
  trade.seconds = elapsed_s(begin);
  return trade;
}

}  // namespace catoptric::design
