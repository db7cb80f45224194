#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string_view>

#include "base/errors.h"
#include "base/float_traps.h"
#include "cli/commands.h"
#include "cli/json_lines.h"
#include "cli/parser.h"
#include "cli/terminal.h"
#include "cluster/open_ranks.h"

namespace {

using namespace catoptric;
using namespace catoptric::cli;

/// Commands that share their work; any other is rank 0's alone.
const std::set<std::string_view> shared_commands{"design", "simulate",    "landscape",
                                                 "study",  "sensitivity", "tradeoff"};

ExitCode run(const CommandLine& line, Ranks& ranks) {
  CommonOptions common = line.common;
  common.ranks = &ranks;
  if (!ranks.leads() && !shared_commands.contains(line.command)) return ExitCode::done;
  const std::map<std::string, std::function<ExitCode()>> commands{
      {"design", [&] { return design_command(common, line.design); }},
      {"simulate", [&] { return simulate_command(common); }},
      {"explain", [&] { return explain_command(common); }},
      {"landscape", [&] { return landscape_command(common, line.landscape); }},
      {"tradeoff", [&] { return tradeoff_command(common); }},
      {"sensitivity", [&] { return sensitivity_command(common); }},
      {"intensity", [&] { return intensity_command(common); }},
      {"rays", [&] { return rays_command(common); }},
      {"profile", [&] { return profile_command(common, line.profile); }},
      {"export", [&] { return export_command(common, line.shape); }},
      {"study", [&] { return study_command(common); }},
      {"completion", [&] { return completion_command(line.completion); }},
      {"manual", [&] { return manual_command(line.manual); }}};
  return commands.at(line.command)();
}

/// How a command ended, and the words of the error that ended it.
struct Ended {
  ExitCode code = ExitCode::done;
  std::string words = {};
};

/// The same in words for people and, where a program listens, for it; by rank 0 alone.
Ended failed(const ErrorParts& parts, const char* words, ExitCode code, bool json, bool leads) {
  if (leads && json) json_error(parts, code);
  if (leads) fmt::print(stderr, "{} {}\n", inked("catoptric:", Ink::error, stderr), words);
  return {code, words};
}

/// What `run` did, with what it threw as words and exit code.
Ended guarded(const std::function<ExitCode()>& run, bool json, bool leads) {
  try {
    return {run()};
  } catch (const Error& error) {
    return failed(error.parts(), error.what(), error.exit_code(), json, leads);
  } catch (const std::exception& error) {
    const std::string words = fmt::format("a mistake of this program, please report it: {}", error.what());
    return failed({words, "", "", ""}, words.c_str(), ExitCode::our_bug, json, leads);
  }
}

int run_guarded(int argc, char** argv) {
  const bool json = std::any_of(argv, argv + argc, [](std::string_view word) { return word == "--json"; });
  std::unique_ptr<cluster::SharedRanks> ranks;
  Ended ended = guarded([&] { return ranks = cluster::open_ranks(), ExitCode::done; }, json, true);
  const bool leads = !ranks || ranks->leads();
  // Whatever a library may print is rank 0's to print.
  if (!leads) [[maybe_unused]]
    const auto* silent = std::freopen("/dev/null", "w", stdout);
  if (ranks)
    ended = guarded(
        [&] {
          const auto parsed = parse(argc, argv);
          if (const auto* code = std::get_if<ExitCode>(&parsed)) return *code;
          return run(std::get<CommandLine>(parsed), *ranks);
        },
        json, leads);
  if (json && leads) json_end(ended.code);
  std::fflush(stdout);
  const int code = static_cast<int>(ended.code);
  return ranks ? ranks->leave(code, ended.words) : code;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is then an error of the write, and ends with 6
  trap_float_errors();
  return run_guarded(argc, argv);
}
