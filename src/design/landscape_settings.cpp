#include "design/landscape_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::design {
namespace {

void forbid_alone(const Settings& settings) {
  for (const char* key : {"landscape.lower", "landscape.upper", "landscape.steps", "landscape.greatest"})
    if (settings.has(key))
      throw settings.error(key, "stands alone", "a landscape needs its variables",
                           "landscape.variables = [\"w1\", \"r2\"]");
  if (*settings.boolean("landscape.paths"))
    throw settings.error("landscape.paths", "stands alone", "a landscape needs its variables",
                         "landscape.variables = [\"w1\", \"r2\"]");
}

const optim::Variable& searched_variable(const Settings& settings, const std::string& name,
                                         const std::vector<optim::Variable>& searched) {
  std::string list;
  for (const optim::Variable& each : searched) {
    if (each.name == name) return each;
    list += (list.empty() ? "" : ", ") + each.name;
  }
  throw settings.error("landscape.paths", name + " is not searched",
                       "a path is that of the search in the landscape's variables; searched is " +
                           (list.empty() ? "nothing" : list),
                       "[variables." + name + "] with step, lower and upper, or paths = false");
}

/// A search from `start` is allowed by its bounds.
void check_start(const Settings& settings, const Numbers& start,
                 const std::vector<optim::Variable>& searched) {
  for (std::size_t i = 0; i < start.size(); ++i)
    if (!(start[i] >= searched[i].lower && start[i] <= searched[i].upper))
      throw settings.error("landscape.starts",
                           fmt::format("{} = {} lies outside its bounds", searched[i].name, start[i]),
                           fmt::format("it is searched from {} to {}", searched[i].lower, searched[i].upper),
                           "move the start or widen the bounds");
}

/// Which searches' paths are shown.
void set_paths(const Settings& settings, const std::vector<optim::Variable>& searched, LandscapeSpec& spec) {
  spec.paths = *settings.boolean("landscape.paths");
  spec.starts = *settings.points("landscape.starts");
  if (!spec.starts.empty() && !spec.paths)
    throw settings.error("landscape.starts", "no paths are drawn", "starts are those of searches",
                         "landscape.paths = true");
  if (!spec.paths || settings.text("start") == "tailored")
    return;  // what is searched is known after tailoring
  std::vector<optim::Variable> moved;
  for (const std::string& name : spec.variables) moved.push_back(searched_variable(settings, name, searched));
  if (!settings.texts("search.refine")->empty())
    throw settings.error("landscape.paths", "the search changes its variables on the way",
                         "a refined mirror has others than the landscape", "no search.refine");
  if (!spec.starts.empty() && moved.size() != 2)
    throw settings.error("landscape.starts", "starts are pairs", "this landscape has one variable",
                         "variables.<name>.start, whose search is shown in any case");
  for (const Numbers& start : spec.starts) check_start(settings, start, moved);
}

}  // namespace

std::optional<LandscapeSpec> landscape_settings(const Settings& settings, const Candidate& base,
                                                const std::vector<optim::Variable>& searched) {
  const auto names = settings.texts("landscape.variables");
  if (!names) {
    forbid_alone(settings);
    return std::nullopt;
  }
  if (names->empty() || names->size() > 2 || (names->size() == 2 && names->front() == names->back()))
    throw settings.error("landscape.variables", fmt::format("{} names", names->size()),
                         "a landscape has one or two different variables", "[\"w1\", \"r2\"]");
  LandscapeSpec spec{*names, {}, {}, {}, settings.number("landscape.greatest")};
  for (const std::string& name : *names)
    if (!is_variable(name, base))
      throw settings.error("landscape.variables", name + " is no variable of this reflector",
                           variables_rule(base), "");
  for (const char* key : {"landscape.lower", "landscape.upper", "landscape.steps"})
    if (!settings.has(key) || settings.numbers(key)->size() != names->size())
      throw settings.error(key, "does not fit the variables",
                           fmt::format("{} numbers are needed", names->size()), "");
  spec.lower = *settings.numbers("landscape.lower");
  spec.upper = *settings.numbers("landscape.upper");
  const Numbers counts = *settings.numbers("landscape.steps");
  for (const double count : counts) {
    if (count != std::floor(count)) throw settings.error("landscape.steps", "is no whole number", "", "41");
    spec.steps.push_back(static_cast<int>(count));
  }
  for (std::size_t i = 0; i < names->size(); ++i)
    if (!(spec.lower[i] < spec.upper[i]))
      throw settings.error("landscape.upper", "the bounds leave no room", "lower must be less than upper",
                           "swap them");
  set_paths(settings, searched, spec);
  return spec;
}

}  // namespace catoptric::design
