#include "design/source_settings.h"

namespace catoptric::design {
namespace {

void refuse(const Settings& settings, const char* path, const char* why) {
  if (settings.has(path)) throw settings.error(path, "does not belong to this source", why, "remove it");
}

}  // namespace

void complete_source(Settings& settings) {
  if (!settings.has("source.power"))
    throw settings.error("source.power", "is missing", "a source needs its power in W", "source.power = 1.0");
  const bool disc = settings.text("source.kind") == "disc";
  if (disc) {
    refuse(settings, "source.exponent", "a disc radiates by Lambert's law");
    if (!settings.has("source.radius"))
      throw settings.error("source.radius", "is missing", "a disc needs it", "source.radius = 5");
  } else {
    refuse(settings, "source.radius", "a point has no size");
    if (!settings.has("source.exponent")) settings.set({"source.exponent", "0.0", "default"});
  }
  const bool has_axis =
      disc || *settings.number("source.exponent") > 0 || settings.has("variables.source.exponent.step");
  if (!has_axis) refuse(settings, "source.axis", "with exponent 0 light is the same in all directions");
  if (has_axis && !settings.has("source.axis")) settings.set({"source.axis", "[0.0, 0.0, 1.0]", "default"});
}

SourceSpec source_spec(const Settings& settings, double unit_mm) {
  const auto vector = [&](const char* path) {
    const Numbers v = *settings.numbers(path);
    return Vector3(v[0], v[1], v[2]);
  };
  SourceSpec spec{unit_mm * vector("source.position"), *settings.number("source.power")};
  if (settings.text("source.kind") == "disc") {
    spec.kind = SourceKind::disc;
    spec.radius_mm = *settings.number("source.radius") * unit_mm;
  } else {
    spec.exponent = *settings.number("source.exponent");
  }
  if (settings.has("source.axis")) {
    spec.axis = vector("source.axis");
    require_direction(settings, "source.axis", spec.axis);
  }
  return spec;
}

void require_direction(const Settings& settings, const char* path, const Vector3& vector) {
  constexpr double least_length = 1e-100;  // the squares of shorter ones lose digits
  if (!(vector.norm() >= least_length))
    throw settings.error(path, "has no direction", "its length is zero, or nearly", "[0, 0, 1]");
}

}  // namespace catoptric::design
