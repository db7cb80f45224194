#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "base/ray.h"
#include "sim/cosine_law.h"

namespace catoptric {
class Profile;
}

namespace catoptric::sim {

class ProjectionMap;
struct Emitter;

/// Photons of a source on their way to what they are sent to. All of them carry the same power, so that a
/// photon map needs no power per photon: where a source is brighter, more photons come from.
class Emission {
 public:
  virtual ~Emission() = default;

  /// The part of the source's power that goes there. Photons share it equally.
  /// @from  Jensen & Christensen 1995; paper section 4.4
  virtual double power_w() const = 0;

  /// How many numbers `emit` uses: the first so many of four.
  virtual std::size_t numbers() const { return 4; }

  /// One photon's path.
  /// @in    numbers: uniform in [0, 1); stream: of the set of photons, of meaning to a source that has but so
  ///        many rays
  /// @out   a continuous function of the numbers as far as the source allows, so that low-discrepancy points
  ///        keep their quality
  virtual Ray emit(const std::array<double, 4>& numbers, std::uint64_t stream = 0) const = 0;

  /// Of a point source that follows a law of the cosine: its directions, which are all there is to tell.
  virtual const ProjectionMap* directions() const { return nullptr; }
};

/// A light source.
class Source {
 public:
  virtual ~Source() = default;
  virtual double power_w() const = 0;
  virtual Vector3 position_mm() const = 0;

  /// Radius of a ball about the position that holds the source; 0 for a point.
  virtual double extent_mm() const { return 0; }

  /// Angle between the z axis and the axis about which the source and its light are symmetric; 0 also where
  /// every axis will do. On the z axis with no tilt, the light is the same all round it.
  virtual double tilt_rad() const { return 0; }

  /// Whether the source and its light are symmetric about that axis.
  virtual bool is_round() const { return true; }

  /// Whether it is known by rays alone: direct light cannot be computed, so that photons bring it, and those
  /// that never meet the mirror are recorded as well.
  virtual bool is_sampled() const { return false; }

  /// Power per solid angle in a direction, W/sr, as seen from so far that the source is a point.
  /// @in    direction: a unit vector
  /// @out   0 of a source that is sampled
  virtual double intensity_w_per_sr(const Vector3& direction) const = 0;

  /// What it is, in words: "a point", "a disc ..."; and what of its nature the model leaves out.
  virtual std::string words() const = 0;
  virtual std::string left_out() const = 0;

  /// Photons to where a mirror may be met, or to all that the source lights. The source must outlive them.
  virtual std::unique_ptr<Emission> emission_to(const Profile& mirror) const = 0;
  virtual std::unique_ptr<Emission> emission() const = 0;

  /// Irradiance straight from the source on a surface element with nothing in the way, W/mm^2; 0 behind the
  /// element and in its own plane, and of a source that is sampled.
  virtual double unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const = 0;

  /// The same with occlusion by the mirror.
  virtual double direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                                  double lift_mm) const = 0;
};

/// Direct light of a source that is seen as a point: intensity times cosine over the square of the distance.
/// @from  paper eq. 13, for any distance and tilt
double point_irradiance_w_per_mm2(const Source& point, const Vector3& place_mm, const Vector3& normal);
/// The same with occlusion by the mirror.
double point_direct_w_per_mm2(const Source& point, const Vector3& place_mm, const Vector3& normal,
                              Probe& mirror, double lift_mm);

/// A source whose every place shines by one law of the cosine to one axis, so that directions can be drawn
/// before places.
class MappedSource : public Source {
 public:
  std::unique_ptr<Emission> emission_to(const Profile& mirror) const final;
  std::unique_ptr<Emission> emission() const final;

  /// Where it is, and by which law all of its places shine.
  virtual Emitter emitter() const = 0;

  /// The directions photons are sent to: those in which a mirror may be met, or all that the source lights.
  virtual ProjectionMap directions_to(const Profile& mirror) const;
  ProjectionMap all_directions() const;

  /// The part of the power that goes into the directions of `map`.
  /// @in    a map of this source
  double power_into_w(const ProjectionMap& map) const;

  virtual std::size_t emission_numbers() const { return 4; }

  /// One photon's path into the directions of `map`: two numbers for the direction, two for the place.
  virtual Ray emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const = 0;
};

/// Above it a beam is narrower than 2 degrees and its cosine's power leaves the range of numbers.
inline constexpr double greatest_exponent = 1000;

/// A point that radiates the same in all directions, or with the intensity I0 cos^n about an axis and nothing
/// behind, where I0 = power (n + 1) / (2 pi).
class PointSource final : public MappedSource {
 public:
  /// @in    exponent 0: the same in all directions, without an axis
  /// @fails InputError for a position that is not finite, a power that is negative or not finite, an exponent
  ///        below 0 or above greatest_exponent, an axis without direction
  PointSource(const Vector3& position_mm, double power_w, double exponent = 0,
              const Vector3& axis = Vector3::UnitZ());
  double power_w() const override { return power_w_; }
  Vector3 position_mm() const override { return position_mm_; }
  double tilt_rad() const override;
  double intensity_w_per_sr(const Vector3& direction) const override;
  std::string words() const override;
  std::string left_out() const override { return "a point has none"; }
  Emitter emitter() const override;
  std::size_t emission_numbers() const override { return 2; }
  Ray emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const override;
  double unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const override {
    return point_irradiance_w_per_mm2(*this, point_mm, normal);
  }
  double direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                          double lift_mm) const override {
    return point_direct_w_per_mm2(*this, point_mm, normal, mirror, lift_mm);
  }

  const CosineLaw& law() const { return law_; }
  const Vector3& axis() const { return axis_; }

 private:
  Vector3 position_mm_;
  double power_w_;
  CosineLaw law_;
  Vector3 axis_;
};

/// What keeps a place, a power and an axis from being a source's.
/// @fails InputError naming it
void check_source(const Vector3& position_mm, double power_w, const Vector3& axis);

/// The axis as a unit vector, exactly itself where it is one of the coordinate axes.
Vector3 unit_axis(const Vector3& axis);

/// Angle between an axis of either sense and z, exactly 0 where they are parallel.
double tilt_of(const Vector3& axis);

}  // namespace catoptric::sim
