#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/radius_bins.h"
#include "sim/tube_map.h"

namespace catoptric::sim {

/// The light of tubes as rings on the plane, ready to be seen from any radius.
///
/// Tubes are cut where their radius turns or passes the axis, and into panels of at most half a kernel radius
/// on which eight Gauss nodes integrate sin(theta) times the ring kernel. From one radius, panels inside the
/// kernel are summed node by node; where the kernel begins or ends in a panel, like distance^(5/2), the panel
/// is cut there and gets nodes anew.
class TubeRings {
 public:
  /// @in    radii ascending; only light that one of them, or one between neighbours less than two kernel
  ///        radii apart, can see is kept
  /// @error error_w_per_mm2, by the rule's known error on distance^(5/2): a small share of the tolerance
  /// @cost  some 0.2 us a panel
  TubeRings(std::span<const Tube> tubes, const AxialLight& light, double kernel_radius_mm,
            std::span<const double> radii_mm, double tolerance_w_per_mm2);

  /// The field smoothed by the Silverman kernel at some radii, W/mm^2.
  /// @out   values[i] depends on at_mm[i] alone
  /// @cost  some 0.3 us a radius and branch
  void smoothed(std::span<const double> at_mm, std::span<double> values) const;

  /// How the field at a radius answers to changes of the tubes: moments[tube][k] times what is added to the
  /// tube's rho[k], summed, is added to the irradiance.
  /// @in    moments: as many as tubes; overwritten
  void moments(double at_mm, std::span<std::array<double, 6>> moments) const;

  double error_w_per_mm2() const { return bins_.worst(); }

  /// Where the smoothed field is less smooth: radii at which the kernel passes the end of a branch or a fold.
  /// Ascending.
  const std::vector<double>& breaks_mm() const { return breaks_mm_; }

  static constexpr std::size_t lanes = 8;
  /// Nodes of one panel or a part of it.
  struct Block {
    std::array<double, lanes> ring;   ///< radius, in kernel radii
    std::array<double, lanes> power;  ///< times the kernel's peak, W/mm^2
  };
  /// A part of a tube on which the ring's radius only rises or only falls, with its own x from -1 to 1.
  struct Panel {
    std::array<double, 6> ring;  ///< coefficients, in kernel radii
    double sine, cosine;         ///< of the emission angle at x = 0
    double half_rad;
    double power;         ///< per unit of x and sine, times the kernel's peak
    std::size_t tube;     ///< index of the tube
    double centre, half;  ///< x of the tube is centre + half x
    double sign;          ///< of the tube's radius
    AxialLight light;
    WeightCourse course;  ///< factor on the power
    Block nodes;
    double at(double x) const {
      return ring[0] + x * (ring[1] + x * (ring[2] + x * (ring[3] + x * (ring[4] + x * ring[5]))));
    }
    double slope(double x) const {
      return ring[1] + x * (2 * ring[2] + x * (3 * ring[3] + x * (4 * ring[4] + x * 5 * ring[5])));
    }
  };
  struct Reach {
    double least, most;  ///< of the rings of a panel, in kernel radii
  };

 private:
  void add(const Tube& tube, std::size_t index);
  void divide(const Panel& whole, double middle_rad, double low, double high, int depth);
  bool is_rough(const Panel& panel, double centre_rad) const;
  double edge_error_of(const Panel& panel, const Reach& reach) const;
  bool is_seen(const Reach& reach) const;
  void book(const Reach& reach, double error);

  AxialLight light_;
  double h_, allowed_;
  RadiusBins bins_;
  std::vector<Reach> windows_;  ///< rings that any radius asked for can see
  std::vector<Panel> panels_;
  std::vector<Reach> reaches_;
  std::vector<double> breaks_mm_;
};

}  // namespace catoptric::sim
