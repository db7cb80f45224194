#include "report/trade_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "design/illustration.h"
#include "report/figures.h"
#include "report/page_parts.h"
#include "report/result_json.h"
#include "report/run_figures.h"
#include "report/run_folder.h"

namespace catoptric::report {
namespace {

using Json = nlohmann::ordered_json;

std::string bandwidth_word(const design::TradeSetting& setting) {
  if (setting.accuracy_rel) return "accuracy key";
  if (setting.model.estimate.neighbours) return "neighbours";
  return *setting.model.estimate.kernel_radius_mm > 0 ? "kernel radius" : "pointwise";
}

std::string sampler_word(const design::TradeSetting& setting) {
  if (setting.rung == sim::Rung::tubes) return "none";
  return setting.model.photons.sampler == sim::Sampler::sobol ? "sobol" : "random";
}

/// What one colour and shape stands for in the plot.
std::string group_of(const design::TradeSetting& setting) {
  std::string group(name(setting.rung));
  if (setting.accuracy_rel) return group + ", accuracy key";
  if (setting.model.engine != design::Engine::meridian)
    return fmt::format("{}, engine {}", group, name(setting.model.engine));
  if (setting.rung != sim::Rung::tubes) group += ", " + sampler_word(setting);
  if (setting.rung == sim::Rung::photons) group += ", " + bandwidth_word(setting);
  return group;
}

std::vector<const design::TradeRow*> front_of(const design::Tradeoff& trade) {
  std::vector<const design::TradeRow*> front;
  for (const design::TradeRow& row : trade.rows)
    if (row.on_front) front.push_back(&row);
  std::sort(front.begin(), front.end(), [](const auto* a, const auto* b) { return a->seconds < b->seconds; });
  return front;
}

Json setting_json(const design::Scene& scene, const design::TradeRow& row) {
  const design::TradeSetting& setting = row.setting;
  Json json = {{"words", design::words(scene, setting)}, {"rung", std::string(name(setting.rung))}};
  if (setting.accuracy_rel) json["accuracy"] = *setting.accuracy_rel;
  json["engine"] = std::string(name(setting.model.engine));
  if (setting.model.engine == design::Engine::mesh) {
    json["chord_error"] = setting.model.mesh.chord_error;
    json["newton_tolerance"] = setting.model.mesh.newton_tolerance;
  }
  json["sampler"] = sampler_word(setting);
  json["photons"] = row.photons;
  if (!setting.accuracy_rel) {
    const auto& estimate = setting.model.estimate;
    json["kernel"] = std::string(sim::name(estimate.kernel));
    if (estimate.neighbours) json["neighbours"] = *estimate.neighbours;
    if (estimate.kernel_radius_mm) json["kernel_radius"] = scene.to_scene_unit(*estimate.kernel_radius_mm);
  }
  json["threads"] = setting.threads;
  json["seconds"] = row.seconds;
  json["seconds_least"] = row.least_seconds;
  json["error"] = row.error_rel;
  json["error_greatest"] = row.greatest_error_rel;
  json["seeds"] = row.seeds;
  json["on_front"] = row.on_front;
  return json;
}

Json trade_json(const design::Scene& scene, const design::Tradeoff& trade) {
  Json settings = Json::array(), front = Json::array(), choices = Json::array();
  for (const design::TradeRow& row : trade.rows) settings.push_back(setting_json(scene, row));
  for (const design::TradeRow* row : front_of(trade)) front.push_back(setting_json(scene, *row));
  for (const design::TradeChoice& choice : trade.choices) {
    Json entry = {{"accuracy", choice.accuracy_rel}, {"setting", nullptr}};
    if (choice.row) entry["setting"] = setting_json(scene, trade.rows[*choice.row]);
    choices.push_back(std::move(entry));
  }
  return {{"title", scene.title},
          {"command", "tradeoff"},
          {"sentence", trade.sentence},
          {"unit", std::string(symbol(scene.unit))},
          {"reference", {{"kind", trade.reference}, {"error", trade.reference_error_rel}}},
          {"field_rms", {{"value", trade.rms_w_per_m2}, {"unit", irradiance_unit(scene.source.quantity)}}},
          {"choices", choices},
          {"pareto", front},
          {"settings", settings},
          {"left_out", trade.left_out},
          {"machine", trade.machine},
          {"seconds", trade.seconds},
          {"seed", scene.seed},
          {"version", version()}};
}

TradeFigure trade_figure(const design::Tradeoff& trade) {
  TradeFigure figure{"Time against error of one evaluation", "time of one evaluation (s)",
                     "relative RMSE of the irradiance",      {},
                     {"not beaten by any other", {}, {}},    {0.1, 0.01, 0.001}};
  // What is nearer the truth than double precision is drawn at the foot of the axis.
  const auto shown = [](double error) { return std::max(error, 1e-12); };
  std::map<std::string, Curve> groups;
  for (const design::TradeRow& row : trade.rows) {
    Curve& group = groups[group_of(row.setting)];
    group.x.push_back(row.seconds);
    group.y.push_back(shown(row.error_rel));
  }
  for (auto& [label, group] : groups) {
    group.label = label;
    figure.groups.push_back(std::move(group));
  }
  for (const design::TradeRow* row : front_of(trade)) {
    figure.front.x.push_back(row->seconds);
    figure.front.y.push_back(shown(row->error_rel));
  }
  return figure;
}

/// With the digits that a measured time or error has.
Table shown_trade_table(const design::Scene& scene, const design::Tradeoff& trade) {
  Table table = trade_table(scene, trade);
  for (Column& column : table.columns)
    if (column.name.starts_with("seconds") || column.name.starts_with("error")) column.digits = 3;
  return table;
}

}  // namespace

Table trade_table(const design::Scene& scene, const design::Tradeoff& trade) {
  const std::string length(symbol(scene.unit));
  Table table{{{"rung", ""},
               {"engine", ""},
               {"sampler", ""},
               {"photons", ""},
               {"bandwidth", ""},
               {"kernel", ""},
               {"kernel_radius", length},
               {"neighbours", ""},
               {"chord_error", ""},
               {"newton_tolerance", ""},
               {"threads", ""},
               {"seconds", "s"},
               {"seconds_least", "s"},
               {"error", ""},
               {"error_greatest", ""},
               {"seeds", ""},
               {"on_front", ""}},
              {}};
  for (const design::TradeRow& row : trade.rows) {
    const design::TradeSetting& setting = row.setting;
    const auto& estimate = setting.model.estimate;
    const bool radius = !setting.accuracy_rel && estimate.kernel_radius_mm;
    const bool mesh = setting.model.engine == design::Engine::mesh;
    const bool neighbours = !setting.accuracy_rel && estimate.neighbours;
    table.rows.push_back(
        {std::string(name(setting.rung)), std::string(name(setting.model.engine)), sampler_word(setting),
         static_cast<long long>(row.photons),
         setting.accuracy_rel ? fmt::format("accuracy {:g}", *setting.accuracy_rel) : bandwidth_word(setting),
         std::string(sim::name(estimate.kernel)),
         radius ? Cell{scene.to_scene_unit(*estimate.kernel_radius_mm)} : Cell{},
         neighbours ? Cell{static_cast<long long>(*estimate.neighbours)} : Cell{},
         mesh ? Cell{setting.model.mesh.chord_error} : Cell{},
         mesh ? Cell{setting.model.mesh.newton_tolerance} : Cell{}, static_cast<long long>(setting.threads),
         row.seconds, row.least_seconds, row.error_rel, row.greatest_error_rel,
         static_cast<long long>(row.seeds), static_cast<long long>(row.on_front)});
  }
  return table;
}

Table front_table(const design::Scene& scene, const design::Tradeoff& trade) {
  Table table{{{"setting", ""},
               {"time", "ms", 3},
               {"relative error", "", 3},
               {"greatest of the seeds", "", 3},
               {"error", std::string(irradiance_unit(scene.source.quantity)), 3}},
              {}};
  for (const design::TradeRow* row : front_of(trade))
    table.rows.push_back({design::words(scene, row->setting), 1e3 * row->seconds, row->error_rel,
                          row->greatest_error_rel, row->error_rel * trade.rms_w_per_m2});
  return table;
}

WrittenFiles write_tradeoff(const design::Scene& scene, const design::Tradeoff& trade,
                            const std::filesystem::path& path) {
  RunFolder folder(path);
  folder.text("scene.toml", design::scene_text(scene));
  folder.text("tradeoff.json", json_text(trade_json(scene, trade)));
  folder.table("tradeoff.csv", trade_table(scene, trade));
  const design::Candidate mirror = design::start_candidate(scene);
  const auto figures = folder.draw_all(
      {{"tradeoff", "Time of one evaluation against its error; the line is what no other setting beats.",
        trade_script(trade_figure(trade))},
       mirror_picture(scene, mirror.profile, mirror.source)});
  Page page = page_of(scene, "tradeoff");
  page.subtitle = trade.sentence;
  page.facts = {
      {"Truth", fmt::format("{} (relative error {:.2g})", trade.reference, trade.reference_error_rel)},
      {"Root mean square of the field",
       fmt::format("{:.5g} {}", trade.rms_w_per_m2, printed(irradiance_unit(scene.source.quantity)))},
      {"Machine", trade.machine},
      {"Settings", fmt::format("{} measured, {} left out", trade.rows.size(), trade.left_out.size())},
      {"Time", fmt::format("{:.1f} s", trade.seconds)}};
  const std::size_t settings = trade.rows.size();
  Table left_out{{{"setting", ""}}, {}};
  for (const std::string& sentence : trade.left_out) left_out.rows.push_back({sentence});
  page.sections = {
      {"Time against error", {}, {}, {}, picked(figures, {"tradeoff"})},
      {"Settings that no other beats",
       {"An error is the root mean square over the samples against the truth, relative to the field's root "
        "mean "
        "square; of several seeds their root mean square."},
       {},
       {{"", front_table(scene, trade)}},
       {}},
      {"All settings",
       {},
       {},
       {{"", shown_trade_table(scene, trade), fmt::format("All {} settings measured", settings)},
        {"", std::move(left_out), fmt::format("{} settings left out, and why", trade.left_out.size())}},
       {}},
      mirror_section(scene, mirror.profile, mirror.source, design::shown_paths(scene), figures),
      again_section(scene, "tradeoff")};
  folder.text("report.html", html_page(page));
  return folder.take();
}

}  // namespace catoptric::report
