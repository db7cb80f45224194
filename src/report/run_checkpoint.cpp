#include "report/run_checkpoint.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "report/result_json.h"
#include "report/text.h"

namespace catoptric::report {
namespace {

using nlohmann::ordered_json;

/// What the answers depend on.
std::string searched(design::Scene scene) {
  for (const char* key : {"title", "threads", "search.most_evaluations", "search.most_iterations"})
    scene.settings.remove(key);
  return design::scene_text(scene);
}

ordered_json as_json(const optim::Answer& answer) {
  ordered_json row = answer.x;
  row.push_back(std::isfinite(answer.value) ? ordered_json(answer.value) : ordered_json(nullptr));
  return row;
}

optim::Answer answer_of(const ordered_json& row) {
  if (!row.is_array() || row.size() < 2) throw std::runtime_error("an answer is no list");
  optim::Answer answer{{}, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i + 1 < row.size(); ++i) answer.x.push_back(row[i].get<double>());
  if (!row.back().is_null()) answer.value = row.back().get<double>();
  return answer;
}

}  // namespace

Checkpoint::Checkpoint(const design::Scene& scene, const std::filesystem::path& folder,
                       std::function<Clock::time_point()> now)
    : now_(std::move(now)), path_(folder / "checkpoint.json"), scene_(searched(scene)) {}

bool Checkpoint::exists() const { return std::filesystem::exists(path_); }

std::vector<optim::Answer> Checkpoint::read() const {
  const auto refuse = [&](std::string what, std::string why) {
    throw InputError({std::move(what), path_.string(), std::move(why),
                      "start anew without --resume, which writes a new checkpoint"});
  };
  std::vector<optim::Answer> answers;
  std::string saved_version, saved_scene;
  try {
    std::ifstream file(path_, std::ios::binary);
    const ordered_json saved = ordered_json::parse(file);
    saved_version = saved.at("version").get<std::string>();
    saved_scene = saved.at("scene").get<std::string>();
    for (const ordered_json& row : saved.at("answers")) answers.push_back(answer_of(row));
  } catch (const std::exception& error) {
    refuse("the checkpoint cannot be read", clean_line(error.what()));
  }
  if (saved_version != version())
    refuse("the checkpoint is of another version",
           "it was written by " + clean_line(saved_version) + ", this is " + version() +
               ", and only the same version goes on to the same bits");
  if (saved_scene != scene_)
    refuse("the checkpoint is of another scene",
           "only threads, title and the search's budgets may differ when a search is resumed");
  return answers;
}

bool Checkpoint::keep(const optim::SearchTape& tape) {
  constexpr int dearest_share = 20;
  if (now_() - written_ < dearest_share * cost_) return false;
  write(tape);
  return true;
}

void Checkpoint::write(const optim::SearchTape& tape) {
  const auto begin = now_();
  ordered_json saved = {{"about", "a search on its way: design --resume goes on from here"},
                        {"version", version()},
                        {"scene", scene_},
                        {"evaluations", tape.answers().size()}};
  if (const optim::Answer* best = tape.best())
    saved["best"] = {{"variables", best->x}, {"search_value", best->value}};
  ordered_json& rows = saved["answers"] = ordered_json::array();
  for (const optim::Answer& answer : tape.answers()) rows.push_back(as_json(answer));
  write_file_whole(path_, saved.dump() + "\n");
  written_ = now_();
  cost_ = written_ - begin;
}

void Checkpoint::remove() const {
  std::error_code ignored;  // a file that stays does no harm
  std::filesystem::remove(path_, ignored);
}

}  // namespace catoptric::report
