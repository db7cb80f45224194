#pragma once

#include <memory>
#include <variant>
#include <vector>

namespace catoptric::sim {

/// How a mirror's reflectance goes with the angle of incidence, as a share of its greatest. Immutable, so
/// that materials and threads share it.
class AngularReflectance {
 public:
  /// @in    angles of incidence, rad, rising within [0, pi/2], as many as shares in [0, 1]; the reflectance
  /// is
  ///        linear in the angle between them and level before the first and after the last. Shares are taken
  ///        over the greatest of them, which is positive
  /// @fails InputError where they are not so
  static std::shared_ptr<const AngularReflectance> table(std::vector<double> angles_rad,
                                                         std::vector<double> reflectances);
  /// Of a bare metal in air, unpolarised light: Fresnel's, 1 at grazing incidence.
  /// @in    index n > 0, extinction k >= 0
  /// @fails InputError where they are not so
  static std::shared_ptr<const AngularReflectance> metal(double index, double extinction);

  /// The share of the greatest reflectance at an incidence, in [0, 1].
  /// @in    cosine of the angle of incidence, in [0, 1]
  /// @error roundings; head-on a cosine tells the angle to 2e-8 rad, by which a table may slope
  double relative(double cosine) const;

  bool operator==(const AngularReflectance&) const = default;

 private:
  struct Table {
    std::vector<double> angles_rad, relative;
    bool operator==(const Table&) const = default;
  };
  struct Metal {
    double index, extinction;
    bool operator==(const Metal&) const = default;
  };
  explicit AngularReflectance(std::variant<Table, Metal> law) : law_(std::move(law)) {}
  std::variant<Table, Metal> law_;
};

}  // namespace catoptric::sim
