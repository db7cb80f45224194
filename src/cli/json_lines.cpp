#include "cli/json_lines.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <variant>

#include "base/whole_file.h"

namespace catoptric::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Bytes that are no UTF-8 (of a file's name, say) are replaced: a line is always valid.
void tell(const Json& event) {
  fmt::print("{}\n", event.dump(-1, ' ', false, Json::error_handler_t::replace));
  std::fflush(stdout);
}

Json known(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

void json_begin(const std::string& title, const std::filesystem::path& folder) {
  tell({{"event", "begin"}, {"title", title}, {"folder", folder.string()}});
}

void json_progress(const std::string& phase, const design::Progress& progress, const Pace& pace,
                   const std::string& unit) {
  Json event{
      {"event", "progress"}, {"phase", phase}, {"share", progress.share}, {"best", known(progress.best)}};
  event["unit"] = unit;
  event["iterations"] = progress.iterations;
  event["evaluations"] = progress.evaluations;
  event["evaluations_per_second"] = pace.evaluations_per_s > 0 ? Json(pace.evaluations_per_s) : Json(nullptr);
  event["seconds_left"] = pace.seconds_left >= 0 ? Json(pace.seconds_left) : Json(nullptr);
  if (!progress.note.empty()) event["note"] = progress.note;
  tell(event);
}

void json_written(const report::WrittenFiles& files, const std::filesystem::path& folder) {
  Json event{
      {"event", "written"}, {"folder", folder.string()}, {"files", files.names}, {"notes", files.notes}};
  for (const std::string& name : files.names)
    if (name.ends_with(".json")) {
      const auto text = read_whole_file(folder / name);
      if (const auto* whole = std::get_if<std::string>(&text))
        event["result"] = Json::parse(*whole, nullptr, false);
      break;
    }
  tell(event);
}

void json_plan(const std::string& purpose, const sim::Plan& plan) {
  Json findings = Json::array();
  for (const sim::Finding& each : plan.findings)
    findings.push_back({{"feature", each.feature}, {"found", each.found}, {"consequence", each.consequence}});
  tell({{"event", "plan"},
        {"purpose", purpose},
        {"rung", std::string(name(plan.rung))},
        {"findings", findings}});
}

void json_error(const ErrorParts& parts, ExitCode code) {
  tell({{"event", "error"},
        {"what", parts.what},
        {"where", parts.where},
        {"why", parts.why},
        {"hint", parts.hint},
        {"exit_code", static_cast<int>(code)}});
}

void json_end(ExitCode code) { tell({{"event", "end"}, {"exit_code", static_cast<int>(code)}}); }

}  // namespace catoptric::cli
