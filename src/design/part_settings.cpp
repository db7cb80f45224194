#include "design/part_settings.h"

#include <fmt/format.h>

#include <string>

#include "base/units.h"
#include "cad/opening.h"
#include "cad/shape.h"

namespace catoptric::design {
namespace {

/// A key that only adds to another one.
void require_beside(const Settings& settings, const char* key, const char* needed, const char* why,
                    const char* hint) {
  if (settings.has(key) && !settings.has(needed)) throw settings.error(key, "stands alone", why, hint);
}

void check_opening(const Settings& settings) {
  if (!settings.has("reflector.opening")) return;
  const char* what = "cannot be cut from a mirror that is still to be found so";
  if (settings.text("start") == "tailored")
    throw settings.error(
        "reflector.opening", what,
        "tailoring takes all of the mirror's light, the part that falls into the opening too",
        "tailor without it, then simulate and export designed.toml with it");
  if (settings.text("search.method") == "levenberg-marquardt")
    throw settings.error("reflector.opening", what,
                         "Levenberg-Marquardt's derivatives are by the control points of the whole mirror",
                         "search.method = \"hooke-jeeves\"");
}

std::optional<cad::Flange> flange(const Settings& settings, double unit_mm) {
  const auto width = settings.number("reflector.flange");
  if (!width) return std::nullopt;
  return cad::Flange{*width * unit_mm, *settings.number("reflector.flange_thickness") * unit_mm};
}

}  // namespace

void complete_part(Settings& settings) {
  require_beside(settings, "reflector.wall_side", "reflector.wall", "there is no wall",
                 "reflector.wall = 1.0");
  require_beside(settings, "reflector.flange", "reflector.wall", "a flange is a part of a wall",
                 "reflector.wall = 1.0");
  require_beside(settings, "reflector.flange_thickness", "reflector.flange", "there is no flange",
                 "reflector.flange = 5.0");
  require_beside(settings, "reflector.material", "reflector.wall", "a surface has no mass, a wall has",
                 "reflector.wall = 1.0");
  if (settings.has("reflector.wall")) settings.fill("reflector.wall_side", "\"outside\"");
  if (settings.has("reflector.flange")) {
    if (settings.text("reflector.wall_side") == "inside")
      throw settings.error("reflector.flange", "has no place", "the wall stands inside, a flange outside",
                           "reflector.wall_side = \"outside\"");
    settings.fill("reflector.flange_thickness", fmt::format("{}", *settings.number("reflector.wall")));
  }
  check_opening(settings);
}

std::optional<double> opening_mm(const Settings& settings, double unit_mm, const Profile& profile) {
  const auto radius = settings.number("reflector.opening");
  if (!radius) return std::nullopt;
  try {
    cad::with_opening(profile, *radius * unit_mm);
  } catch (const Error& error) {
    throw settings.error("reflector.opening", error.parts().what, error.parts().why, error.parts().hint);
  }
  return *radius * unit_mm;
}

cad::ExportOptions export_options(const Settings& settings, double unit_mm) {
  cad::ExportOptions options;
  options.unit = *parse_length_unit(*settings.text("export.unit"));
  const std::string schema = *settings.text("export.step_schema");
  options.schema = schema == "ap203"   ? cad::StepSchema::ap203
                   : schema == "ap242" ? cad::StepSchema::ap242
                                       : cad::StepSchema::ap214;
  options.iges_mode =
      settings.text("export.iges_mode") == "brep" ? cad::IgesMode::brep : cad::IgesMode::faces;
  const std::string curves = *settings.text("export.dxf_curves");
  options.dxf_curves = curves == "splines"     ? cad::DxfCurves::splines
                       : curves == "polylines" ? cad::DxfCurves::polylines
                                               : cad::DxfCurves::automatic;
  options.product = *settings.text("reflector.name");
  options.material.name = settings.text("reflector.material").value_or("");
  if (!options.material.name.empty())
    options.material.density_kg_per_m3 = settings.number("reflector.density");
  if (const auto wall = settings.number("reflector.wall")) {
    const bool inside = settings.text("reflector.wall_side") == "inside";
    options.wall = cad::Wall{*wall * unit_mm, inside ? cad::WallSide::inside : cad::WallSide::outside,
                             flange(settings, unit_mm)};
  }
  return options;
}

void check_flange(const Settings& settings, const cad::ExportOptions& options, const Profile& profile) {
  if (!options.wall || !options.wall->flange) return;
  cad::Wall bare = *options.wall;
  bare.flange.reset();
  try {
    cad::require_wall(profile, bare);
  } catch (const CadError&) {
    return;  // the wall's own trouble, of which files tell when they are written
  }
  try {
    cad::require_wall(profile, *options.wall);
  } catch (const CadError& error) {
    throw settings.error("reflector.flange", error.parts().what, error.parts().why, error.parts().hint);
  }
}

}  // namespace catoptric::design
