#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <string_view>

#include "base/errors.h"
#include "base/float_traps.h"
#include "cli/commands.h"
#include "cli/json_lines.h"
#include "cli/parser.h"
#include "cli/terminal.h"

namespace {

using namespace catoptric;
using namespace catoptric::cli;

ExitCode run(const CommandLine& line) {
  const CommonOptions& common = line.common;
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

/// The same in words for people and, where a program listens, for it.
ExitCode failed(const ErrorParts& parts, const char* words, ExitCode code, bool json) {
  if (json) json_error(parts, code);
  fmt::print(stderr, "{} {}\n", inked("catoptric:", Ink::error, stderr), words);
  return code;
}

ExitCode run_guarded(int argc, char** argv) {
  const bool json = std::any_of(argv, argv + argc, [](std::string_view word) { return word == "--json"; });
  const ExitCode code = [&] {
    try {
      const auto parsed = parse(argc, argv);
      if (const auto* ended = std::get_if<ExitCode>(&parsed)) return *ended;
      return run(std::get<CommandLine>(parsed));
    } catch (const Error& error) {
      return failed(error.parts(), error.what(), error.exit_code(), json);
    } catch (const std::exception& error) {
      const std::string words = fmt::format("a mistake of this program, please report it: {}", error.what());
      return failed({words, "", "", ""}, words.c_str(), ExitCode::our_bug, json);
    }
  }();
  if (json) json_end(code);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is then an error of the write, and ends with 6
  trap_float_errors();
  return static_cast<int>(run_guarded(argc, argv));
}
