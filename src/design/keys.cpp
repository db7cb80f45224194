#include "design/keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/tolerance.h"

namespace catoptric::design {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// Lengths a scene may name, in its own unit; wide enough for 1 um parts in metres and 100 km fields in mm.
constexpr double far = 1e12;

const std::vector<Key>& scene_table() {
  using enum KeyType;
  using Q = Quantity;
  static const std::vector<Key> table{
      {.path = "title", .type = text, .standard = "\"\"", .meaning = "what the scene is, shown in reports"},
      {.path = "unit",
       .type = choice,
       .choices = {"mm", "cm", "m", "in"},
       .standard = "\"mm\"",
       .meaning = "unit of every length in the scene and in what is written for it"},
      {.path = "seed",
       .type = integer,
       .least = 0,
       .greatest = 9e15,
       .standard = "1",
       .meaning = "key of all random numbers"},
      {.path = "threads",
       .type = integer,
       .least = 0,
       .greatest = 1024,
       .standard = "0",
       .meaning = "threads to use; 0: one per core. Results do not depend on it"},

      {.path = "source.kind",
       .type = choice,
       .choices = {"point"},
       .standard = "\"point\"",
       .meaning = "a point that radiates alike in all directions"},
      {.path = "source.position",
       .type = numbers,
       .quantity = Q::length,
       .least = -far,
       .greatest = far,
       .count = 3,
       .standard = "[0.0, 0.0, 0.0]",
       .meaning = "x, y, z of the source"},
      {.path = "source.power",
       .type = number,
       .quantity = Q::power_w,
       .least = 0,
       .greatest = 1e12,
       .least_excluded = true,
       .meaning = "radiant power of the source, W"},

      {.path = "reflector.name",
       .type = text,
       .standard = "\"reflector\"",
       .meaning = "name of the part in exchange files"},
      {.path = "reflector.degree",
       .type = integer,
       .least = 1,
       .greatest = 9,
       .meaning = "degree of the generatrix"},
      {.path = "reflector.points",
       .type = points,
       .quantity = Q::length,
       .least = -far,
       .greatest = far,
       .meaning = "control points [r, z] from the apex to the rim"},
      {.path = "reflector.weights",
       .type = numbers,
       .least = least_weight,
       .greatest = greatest_weight,
       .meaning = "weights of the control points; all 1 when left out"},
      {.path = "reflector.knots",
       .type = numbers,
       .meaning = "knots, each repeated by its multiplicity; equal clamped spans when left out"},
      {.path = "reflector.profile",
       .type = text,
       .meaning = "IGES or STEP file to take the generatrix from, instead of points"},
      {.path = "reflector.profile_index",
       .type = integer,
       .least = 0,
       .greatest = 1e6,
       .meaning = "which of the file's curves, as `catoptric profile` numbers them"},
      {.path = "reflector.profile_axis",
       .type = numbers,
       .count = 6,
       .meaning = "axis of revolution in the file: a point in mm and a direction"},
      {.path = "reflector.profile_apex",
       .type = number,
       .quantity = Q::length,
       .least = -far,
       .greatest = far,
       .meaning = "z that the file's generatrix begins at; as it lies in the file when left out"},
      {.path = "reflector.profile_upside_down",
       .type = boolean,
       .meaning = "true turns the file's generatrix over, when its axis points the other way"},
      {.path = "reflector.reflectance",
       .type = number,
       .least = 0,
       .greatest = 1,
       .standard = "1.0",
       .meaning = "share of the light that the mirror reflects, specularly"},
      {.path = "reflector.transmittance",
       .type = number,
       .least = 0,
       .greatest = 1,
       .standard = "0.0",
       .meaning = "share of the light that passes straight through; the rest is absorbed"},
      {.path = "reflector.wall",
       .type = number,
       .quantity = Q::length,
       .least = 0,
       .greatest = far,
       .least_excluded = true,
       .meaning = "wall thickness of the exported solid; left out: the open optical surface"},
      {.path = "reflector.wall_side",
       .type = choice,
       .choices = {"outside", "inside"},
       .meaning = "side of the optical surface on which the wall stands"},

      {.path = "near_field.shape",
       .type = choice,
       .choices = {"disc", "rectangle"},
       .standard = "\"disc\"",
       .meaning = "shape of the surface that is to be lit"},
      {.path = "near_field.center",
       .type = numbers,
       .quantity = Q::length,
       .least = -far,
       .greatest = far,
       .count = 3,
       .standard = "[0.0, 0.0, 0.0]",
       .meaning = "its centre"},
      {.path = "near_field.normal",
       .type = numbers,
       .least = -far,
       .greatest = far,
       .count = 3,
       .standard = "[0.0, 0.0, 1.0]",
       .meaning = "direction of the side that is to be lit"},
      {.path = "near_field.along",
       .type = numbers,
       .least = -far,
       .greatest = far,
       .count = 3,
       .meaning = "direction of a rectangle's width"},
      {.path = "near_field.radius",
       .type = number,
       .quantity = Q::length,
       .least = 0,
       .greatest = far,
       .least_excluded = true,
       .meaning = "radius of a disc"},
      {.path = "near_field.width",
       .type = number,
       .quantity = Q::length,
       .least = 0,
       .greatest = far,
       .least_excluded = true,
       .meaning = "width of a rectangle"},
      {.path = "near_field.height",
       .type = number,
       .quantity = Q::length,
       .least = 0,
       .greatest = far,
       .least_excluded = true,
       .meaning = "height of a rectangle"},
      {.path = "near_field.samples",
       .type = integer,
       .least = 1,
       .greatest = 1e6,
       .standard = "512",
       .meaning = "points where the irradiance is asked for, uniform by area"},
      {.path = "near_field.real",
       .type = boolean,
       .standard = "false",
       .meaning = "true: an object that stops light; false: an invisible register"},
      {.path = "near_field.reflectance",
       .type = number,
       .least = 0,
       .greatest = 1,
       .meaning = "share of the light that a real near field reflects, diffusely"},
      {.path = "near_field.transmittance",
       .type = number,
       .least = 0,
       .greatest = 1,
       .meaning = "share of the light that passes straight through a real near field"},

      {.path = "target.kind",
       .type = choice,
       .choices = {"none", "paraboloid", "reflector", "csv"},
       .standard = "\"none\"",
       .meaning = "where the desired irradiance comes from: eq. 12 and 13 of the paper, the light of a "
                  "reference reflector, or a table"},
      {.path = "target.focal_length",
       .type = number,
       .quantity = Q::length,
       .least = 0,
       .greatest = far,
       .least_excluded = true,
       .meaning = "paraboloid: distance a from vertex to focus; the focus is the source"},
      {.path = "target.rim_radius",
       .type = number,
       .quantity = Q::length,
       .least = 0,
       .greatest = far,
       .least_excluded = true,
       .meaning = "paraboloid: radius of its rim, beyond which eq. 12 gives no light; 2 a when left out"},
      {.path = "target.degree",
       .type = integer,
       .least = 1,
       .greatest = 9,
       .meaning = "reference reflector: degree"},
      {.path = "target.points",
       .type = points,
       .quantity = Q::length,
       .least = -far,
       .greatest = far,
       .meaning = "reference reflector: control points"},
      {.path = "target.weights",
       .type = numbers,
       .least = least_weight,
       .greatest = greatest_weight,
       .meaning = "reference reflector: weights"},
      {.path = "target.knots", .type = numbers, .meaning = "reference reflector: knots"},
      {.path = "target.file",
       .type = text,
       .meaning = "csv: table with columns x, y, z in the scene's unit and the irradiance in W/m^2; its "
                  "points replace the near field's samples"},
      {.path = "target.column", .type = text, .meaning = "csv: name of the column that holds the irradiance"},

      {.path = "model.rung",
       .type = choice,
       .choices = {"auto", "photons"},
       .standard = "\"auto\"",
       .meaning = "how the light is computed"},
      {.path = "model.engine",
       .type = choice,
       .choices = {"auto", "meridian", "occt"},
       .standard = "\"auto\"",
       .meaning = "how rays meet the mirror; occt is the slow reference"},
      {.path = "model.photons",
       .type = integer,
       .least = 0,
       .greatest = 1e10,
       .standard = "100000",
       .meaning = "photons emitted for one evaluation"},
      {.path = "model.neighbours",
       .type = integer,
       .least = 1,
       .greatest = 1e9,
       .meaning = "photons in one estimate (the paper's N); not together with kernel_radius"},
      {.path = "model.kernel_radius",
       .type = number,
       .quantity = Q::length,
       .least = 0,
       .greatest = far,
       .least_excluded = true,
       .meaning =
           "fixed radius of the kernel; a tenth of the near field's half-width when both are left out"},
      {.path = "model.kernel",
       .type = choice,
       .choices = {"silverman", "epanechnikov", "cone", "gaussian", "constant"},
       .standard = "\"silverman\"",
       .meaning = "weight of a photon by its distance"},
      {.path = "model.sampler",
       .type = choice,
       .choices = {"random", "sobol"},
       .standard = "\"sobol\"",
       .meaning = "independent random photons, or Owen-scrambled Sobol points"},
      {.path = "model.replicates",
       .type = integer,
       .least = 2,
       .greatest = 1000,
       .standard = "8",
       .meaning = "independent repetitions behind every reported figure, which give its noise"},
      {.path = "model.interactions",
       .type = integer,
       .least = 1,
       .greatest = 1e6,
       .standard = "1000",
       .meaning = "a photon is stopped after so many meetings with surfaces"},

      {.path = "search.method",
       .type = choice,
       .choices = {"hooke-jeeves"},
       .standard = "\"hooke-jeeves\"",
       .meaning = "how better mirrors are looked for"},
      {.path = "search.metric",
       .type = choice,
       .choices = {"rmse", "relative-rmse"},
       .standard = "\"rmse\"",
       .meaning = "what is made small: eq. 7 in W/m^2, or the same divided by the target's root mean square"},
      {.path = "search.acceleration",
       .type = number,
       .least = 0,
       .greatest = 1000,
       .standard = "1.0",
       .meaning = "factor alpha of the pattern step"},
      {.path = "search.reduction",
       .type = number,
       .least = 0,
       .greatest = 0.99,
       .least_excluded = true,
       .standard = "0.5",
       .meaning = "the step is multiplied by it after a failed iteration"},
      {.path = "search.smallest_step",
       .type = number,
       .least = 0,
       .greatest = 1,
       .least_excluded = true,
       .standard = "0.001",
       .meaning = "the search ends when the step is below this share of the first"},
      {.path = "search.most_evaluations",
       .type = integer,
       .least = 1,
       .greatest = 1e9,
       .standard = "2000",
       .meaning = "the search ends after so many evaluations"},
      {.path = "search.most_iterations",
       .type = integer,
       .least = 1,
       .greatest = 1e9,
       .standard = "1000",
       .meaning = "the search ends after so many iterations"},

      {.path = "variables.*.start",
       .type = number,
       .least = -far,
       .greatest = far,
       .meaning = "first value; the reflector's own when left out"},
      {.path = "variables.*.step",
       .type = number,
       .least = 0,
       .greatest = far,
       .least_excluded = true,
       .meaning = "first step"},
      {.path = "variables.*.lower",
       .type = number,
       .least = -far,
       .greatest = far,
       .meaning = "least value allowed"},
      {.path = "variables.*.upper",
       .type = number,
       .least = -far,
       .greatest = far,
       .meaning = "greatest value allowed"},

      {.path = "landscape.variables",
       .type = texts,
       .meaning = "one or two variables over which the objective is drawn"},
      {.path = "landscape.lower", .type = numbers, .meaning = "least value of each"},
      {.path = "landscape.upper", .type = numbers, .meaning = "greatest value of each"},
      {.path = "landscape.steps",
       .type = numbers,
       .least = 2,
       .greatest = 10000,
       .meaning = "how many values of each"},
      {.path = "landscape.greatest",
       .type = number,
       .least = 0,
       .least_excluded = true,
       .meaning = "objective above which the drawn surface is cut off; the table keeps all"},

      {.path = "export.unit",
       .type = choice,
       .choices = {"mm", "cm", "m", "in"},
       .standard = "\"mm\"",
       .meaning = "unit of length inside exchange files"},
      {.path = "export.step_schema",
       .type = choice,
       .choices = {"ap203", "ap214", "ap242"},
       .standard = "\"ap214\"",
       .meaning = "STEP application protocol"},
      {.path = "export.iges_mode",
       .type = choice,
       .choices = {"faces", "brep"},
       .standard = "\"faces\"",
       .meaning = "IGES entities: trimmed surfaces (144) or boundary representation (186)"},
  };
  return table;
}

const std::vector<Key>& study_table() {
  using enum KeyType;
  static const std::vector<Key> table{
      {.path = "title", .type = text, .meaning = "what the study shows"},
      {.path = "command",
       .type = choice,
       .choices = {"design", "simulate"},
       .meaning = "what is done with each run's scene"},
      {.path = "scene", .type = text, .meaning = "the scene that runs vary, relative to the study's folder"},
      {.path = "runs.name", .type = text, .meaning = "the run's name; also its folder"},
      {.path = "runs.scene", .type = text, .meaning = "a scene of the run's own"},
      {.path = "runs.set",
       .type = text,
       .meaning = "table of scene keys and the values they take in this run"},
      {.path = "runs.reference",
       .type = text,
       .meaning = "table of figures from elsewhere, printed beside ours under the same names"},
  };
  return table;
}

bool fits(std::string_view pattern, std::string_view path) {
  while (true) {
    const auto pattern_dot = pattern.find('.'), path_dot = path.find('.');
    const auto part = pattern.substr(0, pattern_dot);
    if (part != "*" && part != path.substr(0, path_dot)) return false;
    if ((pattern_dot == std::string_view::npos) != (path_dot == std::string_view::npos)) return false;
    if (pattern_dot == std::string_view::npos) return true;
    pattern.remove_prefix(pattern_dot + 1);
    path.remove_prefix(path_dot + 1);
  }
}

}  // namespace

std::span<const Key> scene_keys() { return scene_table(); }
std::span<const Key> study_keys() { return study_table(); }

const Key* find_key(std::span<const Key> keys, std::string_view path) {
  const auto found =
      std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return fits(key.path, path); });
  return found == keys.end() ? nullptr : &*found;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = a[i - 1] == b[j - 1];
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, cost[i - 1][j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  return cost[a.size()][b.size()];
}

std::string nearest_path(std::span<const Key> keys, std::string_view path) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, path.size() / 3) + 1;
  const auto last_name = [](std::string_view whole) { return whole.substr(whole.rfind('.') + 1); };
  for (const Key& key : keys) {
    std::size_t distance = edit_distance(key.path, path);
    if (last_name(key.path) == last_name(path)) distance = std::min<std::size_t>(distance, 2);  // wrong table
    if (distance < least) {
      least = distance;
      best = std::string(key.path);
    }
  }
  return best;
}

std::string reference(std::span<const Key> keys) {
  std::string text;
  for (const Key& key : keys) {
    text += fmt::format("{}\n    {}\n    {}", key.path, key.meaning, rule(key));
    if (!key.standard.empty()) text += fmt::format("; {} when left out", key.standard);
    text += "\n";
  }
  return text;
}

std::string rule(const Key& key) {
  std::string text;
  switch (key.type) {
    case KeyType::text:
      return "a text in quotes";
    case KeyType::choice:
      return fmt::format("one of \"{}\"", fmt::join(key.choices, "\", \""));
    case KeyType::boolean:
      return "true or false";
    case KeyType::texts:
      return "a list of texts";
    case KeyType::integer:
      text = "a whole number";
      break;
    case KeyType::number:
      text = "a number";
      break;
    case KeyType::numbers:
      text = key.count ? fmt::format("a list of {} numbers", key.count) : "a list of numbers";
      break;
    case KeyType::points:
      text = "a list of points [r, z]";
      break;
  }
  if (key.least != -unbounded && std::abs(key.least) != far)
    text += fmt::format(" {} {}", key.least_excluded ? ">" : ">=", key.least);
  if (key.greatest != unbounded && key.greatest != far) text += fmt::format(" and <= {}", key.greatest);
  if (key.quantity == Quantity::length) text += ", in the scene's unit of length";
  if (key.quantity == Quantity::power_w) text += ", in W";
  return text;
}

}  // namespace catoptric::design
