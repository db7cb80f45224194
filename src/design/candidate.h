#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/intensity_table.h"
#include "base/profile.h"
#include "base/units.h"
#include "design/curvature_profile.h"
#include "design/free_profile.h"
#include "design/variables.h"
#include "sim/material.h"
#include "sim/ray_source.h"

namespace catoptric::design {

enum class SourceKind { point, disc, rectangle, sphere, cylinder, intensity, rays, several };

struct SourceSpec {
  Vector3 position_mm;
  double power_w;  ///< of a luminous source lm: all that is named by W is lm then, and W/mm^2 is lm/mm^2
  SourceKind kind = SourceKind::point;
  double exponent = 0;                 ///< of a point
  Vector3 axis = Vector3::UnitZ();     ///< of a point's intensity, of a cylinder; normal of what is flat
  double radius_mm = 0;                ///< of disc, sphere and cylinder
  double length_mm = 0;                ///< of a cylinder
  double width_mm = 0, height_mm = 0;  ///< of a rectangle
  Vector3 along = Vector3::UnitX();    ///< direction of its width; of C = 0
  std::shared_ptr<const IntensityTable> table = nullptr;  ///< of a point with measured intensity
  std::shared_ptr<const sim::RayBundle> rays = nullptr;   ///< of a ray file
  LightQuantity quantity = LightQuantity::radiant;
  std::vector<SourceSpec> parts =
      {};  ///< of several: their places from `position_mm`, their shares of the power
};

/// The source as the light room has it.
std::unique_ptr<sim::Source> make_source(const SourceSpec& spec);

/// The exponent of its intensity's cosine from afar: what is flat is Lambert's, 0 is alike in all directions;
/// nothing for a cylinder, which follows a sine, tables, rays and several
/// sources.
std::optional<double> far_exponent(const SourceSpec& spec);

/// What a design vector decides: the mirror's shape, and the source and the mirror's surface it is judged
/// with.
struct Candidate {
  Profile profile;
  SourceSpec source;
  sim::Material mirror;
};

/// A variable beside the shape.
enum class SceneVariable {
  source_x,
  source_y,
  source_z,
  source_power,
  source_flux,
  source_exponent,
  reflectance
};

/// "source.z" -> source_z; nothing for other names.
std::optional<SceneVariable> parse_scene_variable(std::string_view name);

/// All names, for messages.
std::string scene_variable_names();

/// Whether it is a length, in the scene's unit.
bool is_length(SceneVariable variable);

/// Whether it names a component of the profile or a scene variable; variables_rule() says which there are.
bool is_variable(const std::string& name, const Candidate& base);
std::string variables_rule(const Candidate& base);

/// The unit a variable of any kind is written in; empty for plain numbers.
std::string unit_of_variable(std::string_view name, LengthUnit unit);

/// Its value in a candidate: lengths in `unit`, power in W.
double scene_value(const Candidate& candidate, SceneVariable variable, LengthUnit unit);

/// What keeps a value from being this variable's, in words, or nothing.
std::optional<std::string> value_defect(const Candidate& base, SceneVariable variable, double value);

/// What moves the shape alone.
using ShapeFamily = std::variant<ProfileFamily, FreeProfile, CurvatureProfile>;

/// Moves named variables of a fixed candidate, shape and all; the rest stays.
class SceneFamily {
 public:
  /// @in names of components of the profile or of scene variables, in any order
  /// @in opening_mm  radius of the opening that is cut from every mirror; nothing: none
  SceneFamily(Candidate base, const std::vector<std::string>& names, LengthUnit unit,
              std::optional<double> opening_mm = {});
  /// @in shape  whose variables are the names that are no scene variables, in their order
  SceneFamily(Candidate base, ShapeFamily shape, const std::vector<std::string>& names, LengthUnit unit,
              std::optional<double> opening_mm = {});

  /// The candidate with the variables set, or nothing where these values make none (the generatrix crosses
  /// the axis, no power, ...).
  /// @cost  a profile's; no light
  std::optional<Candidate> at(std::span<const double> values) const;

  /// The same before its opening is cut: what the variables are components of.
  std::optional<Candidate> whole_at(std::span<const double> values) const;

  const Candidate& base() const { return base_; }
  /// Places in the vector of the variables beside the shape.
  const std::vector<std::size_t>& scene_places() const { return scene_places_; }

 private:
  Candidate base_;
  ShapeFamily shape_;
  std::vector<std::size_t> shape_places_, scene_places_;
  std::vector<SceneVariable> scene_variables_;
  double unit_mm_;
  std::optional<double> opening_mm_;
};

}  // namespace catoptric::design
