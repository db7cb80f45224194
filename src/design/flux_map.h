#pragma once

#include <functional>
#include <vector>

namespace catoptric::design {

/// Light from a source on the axis by polar angle, measured from the direction to the mirror's apex.
struct PolarFlux {
  std::function<double(double angle_rad)> within_w;     ///< power within that angle
  std::function<double(double angle_rad)> per_angle_w;  ///< its derivative, W/rad
};

/// @in exponent of the cosine: 0 is alike in all directions; otherwise the light goes into one half space,
///     about the direction to the apex (towards_apex) or away from it
PolarFlux polar_flux(double power_w, double exponent, bool towards_apex);

/// Irradiance wanted from the mirror by distance from the axis.
struct WantedLight {
  std::function<double(double radius_mm)> w_per_mm2;
  std::vector<double> breaks_mm;  ///< where it jumps or bends, rising; none at 0 or the end
  double end_mm;                  ///< beyond it there is to be none
};

/// Where on the near field a ray must land, by the angle it leaves the source at.
struct Landing {
  double radius_mm;
  double per_angle_mm;  ///< its derivative, mm/rad; 0 once all light is placed
};

/// Flux balance: what the source sends within an angle, less what the mirror absorbs, fills the near field
/// from its centre outwards.
/// @from  conservation of flux, as in Elmer 1980, "The Optical Design of Reflectors"
class FluxMap {
 public:
  /// @in    reflectance in (0, 1]; wanted light finite, negative values count as none
  /// @error radii relative 1e-9 where the wanted light is smooth between its breaks
  /// @cost  some 3,000 values of the wanted light
  FluxMap(PolarFlux source, double reflectance, const WantedLight& wanted);

  double wanted_w() const { return placed_.back().flux_w; }
  /// Power that the mirror can reflect when it takes all angles up to this one.
  double available_w(double angle_rad) const { return reflectance_ * source_.within_w(angle_rad); }
  /// The angle by which all wanted light is placed; pi where even the whole sphere holds too little.
  double last_angle_rad() const { return last_angle_rad_; }
  /// The angles at which the wanted light breaks, rising.
  std::vector<double> break_angles_rad() const;

  Landing at(double angle_rad) const;

 private:
  struct Node {
    double flux_w, square_mm2;       ///< light within a circle, its radius squared
    double rise_before, rise_after;  ///< d square / d flux on either side
  };
  double angle_of(double flux_w) const;

  PolarFlux source_;
  double reflectance_;
  std::vector<Node> placed_;
  std::vector<double> break_flux_w_;
  double last_angle_rad_ = 0;
};

}  // namespace catoptric::design
