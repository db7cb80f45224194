#include "report/gnuplot.h"

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "report/child_process.h"
#include "report/text.h"

namespace catoptric::report {
namespace {

/// Why there is no picture, or nothing.
std::string defect(const ChildResult& result, const GnuplotOptions& options) {
  switch (result.end) {
    case ChildResult::End::not_found:
      return fmt::format("{} is not installed (Debian: apt install gnuplot-nox)", options.program);
    case ChildResult::End::timed_out:
      return fmt::format("{} took longer than {} s", options.program,
                         static_cast<double>(options.time_limit.count()) / 1000);
    case ChildResult::End::failed:
      return fmt::format("{} could not be run: {}", options.program, result.errors);
    case ChildResult::End::finished:
      break;
  }
  if (result.exit_code != 0)
    return fmt::format("{} ended with code {}: {}", options.program, result.exit_code,
                       clean_line(result.errors));
  // an interrupted gnuplot leaves an open document
  if (result.output.find("</svg>") == std::string::npos)
    return fmt::format("{} gave no picture: {}", options.program, clean_line(result.errors));
  return {};
}

}  // namespace

Drawing draw(const std::string& script, const std::filesystem::path& folder, const std::string& name,
             const GnuplotOptions& options) {
  Drawing drawing;
  drawing.script = folder / (name + ".gp");
  drawing.svg = folder / (name + ".svg");
  // a picture of an earlier run must not stand beside this run's data
  std::error_code not_there;
  std::filesystem::remove(drawing.svg, not_there);
  write_file_whole(drawing.script, script);
  // -d: no settings of the user's own; an absolute path, so that no name reads as an option
  const ChildResult result = run_child(
      {options.program, "-d", std::filesystem::absolute(drawing.script).string()}, options.time_limit);
  const std::string why = defect(result, options);
  if (!why.empty()) {
    drawing.sentence =
        fmt::format("{}; the figure's data and script are in {}", why, drawing.script.string());
    return drawing;
  }
  write_file_whole(drawing.svg, result.output);
  drawing.svg_text = result.output;
  return drawing;
}

}  // namespace catoptric::report
