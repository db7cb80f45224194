#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/surface_shape.h"
#include "sim/glass.h"
#include "sim/material.h"
#include "sim/near_field.h"

namespace catoptric::sim {

/// A thing that light meets besides the mirror: a sheet with a material, or a body of glass bounded by
/// polished faces, fronts outside. What of the body's border is no face is its edge, black: light that gets
/// there is absorbed.
struct Object {
  std::string name;
  std::vector<std::shared_ptr<const SurfaceShape>> faces;
  Material material{0, 0};     ///< of a sheet
  std::optional<Glass> glass;  ///< of a body
  bool of_luminaire =
      true;  ///< false: it belongs to the room, and is left out where the luminaire stands alone
};

/// A surface besides the near field where irradiance is asked for.
struct MoreField {
  std::string name;
  NearField field;
  double kernel_scale = 1;  ///< its kernel's radius over the near field's
};

/// All that stands about mirror and near field. Few things: each is asked in turn.
class Surroundings {
 public:
  /// One face of one object.
  struct Face {
    std::size_t object, face;
    bool operator==(const Face&) const = default;
  };
  struct Stop {
    Face face;
    Meeting meeting;
  };

  Surroundings() = default;
  /// @fails InputError for a bad material or glass, a sheet or a body without faces
  Surroundings(std::vector<Object> objects, std::vector<MoreField> fields);

  const std::vector<Object>& objects() const { return objects_; }
  const std::vector<MoreField>& fields() const { return fields_; }
  /// Whether there is nothing at all.
  bool is_empty() const { return objects_.empty() && fields_.empty(); }

  /// The first face ahead, no farther than `reach_mm`. Light inside a body meets that body's faces alone.
  /// @in    on: the face on which the ray starts; inside: the body of glass that it goes through
  std::optional<Stop> first(const Ray& ray, std::optional<Face> on, std::optional<std::size_t> inside,
                            double reach_mm) const;

  /// How far the first opaque thing is, fields included, no farther than `reach_mm`; bodies of glass do not
  /// count.
  std::optional<double> first_opaque(const Ray& ray, double reach_mm) const;

  /// Why it is not round about the axis, seen from one near field: a thing that is not, or a further field.
  std::optional<std::string> asymmetry() const;

  /// Whether light may go on from a thing here, so that it may reach the mirror or a field from anywhere.
  bool sends_light_on() const { return sends_light_on_; }
  /// Whether light may go through a thing here, so that what comes straight from the source has no closed
  /// form.
  bool lets_light_through() const { return lets_light_through_; }
  /// Whether something may stand between the source and a field.
  bool may_shade() const { return may_shade_; }

  /// The body of glass that holds the point, if any.
  std::optional<std::size_t> body_around(const Vector3& point_mm) const;

  /// The same without what belongs to the room, fields included: the luminaire alone.
  Surroundings luminaire() const;

 private:
  std::vector<Object> objects_;
  std::vector<MoreField> fields_;
  bool sends_light_on_ = false, lets_light_through_ = false, may_shade_ = false;
};

}  // namespace catoptric::sim
