#include <fmt/format.h>

#include "base/units.h"
#include "cad/profile_import.h"
#include "cli/commands.h"

namespace catoptric::cli {
namespace {

void print_list(const char* key, const std::vector<std::string>& values) {
  fmt::print("{} = [", key);
  for (std::size_t i = 0; i < values.size(); ++i) fmt::print("{}{}", i ? ", " : "", values[i]);
  fmt::print("]\n");
}

}  // namespace

ExitCode profile_command(const CommonOptions& options, const ProfileOptions& more) {
  cad::ImportOptions import;
  import.candidate = more.index;
  if (!more.axis.empty())
    import.axis = cad::Axis{{more.axis[0], more.axis[1], more.axis[2]},
                            { more.axis[3],
                              more.axis[4],
                              more.axis[5] }};
  const cad::ImportedProfile found = cad::import_profile(options.input, import);
  const double unit_mm = millimetres_per(*parse_length_unit(more.unit));

  fmt::print("# {}\n", options.input.string());
  for (const std::string& note : found.notes) fmt::print("# {}\n", note);
  if (found.candidates.size() > 1) {
    fmt::print("# curves in the file, for --index and reflector.profile_index:\n");
    for (std::size_t i = 0; i < found.candidates.size(); ++i)
      fmt::print("#   {}: {}\n", i, found.candidates[i]);
  }
  std::vector<std::string> points, weights, knots;
  for (const ControlPoint& point : found.profile.points()) {
    points.push_back(fmt::format("[{}, {}]", point.r_mm / unit_mm, point.z_mm / unit_mm));
    weights.push_back(fmt::format("{}", point.weight));
  }
  for (double knot : found.profile.knots()) knots.push_back(fmt::format("{}", knot));
  fmt::print("unit = \"{}\"\n\n[reflector]\ndegree = {}\n", more.unit, found.profile.degree());
  print_list("points", points);
  print_list("weights", weights);
  print_list("knots", knots);
  return ExitCode::done;
}

}  // namespace catoptric::cli
