#pragma once

#include <Eigen/Core>
#include <vector>

namespace catoptric::design {

/// Light about the axis that is made of even discs of one radius: what a mirror makes of a source that is no
/// point, with the source's images taken for alike. Powers belong to rings of disc centres, which reach one
/// image beyond the outermost place of comparison.
class ImageBlur {
 public:
  /// @in radii_mm: places of comparison, rising, even in area; image_mm > 0: radius of the discs
  ImageBlur(const std::vector<double>& radii_mm, double image_mm);

  const std::vector<double>& ring_radii_mm() const { return rings_mm_; }
  /// Power of a ring over its area.
  std::vector<double> densities(const Eigen::VectorXd& powers) const;

  Eigen::VectorXd light(const Eigen::VectorXd& powers) const { return light_ * powers; }

  /// Powers for even light as strong as what is wanted on the whole.
  Eigen::VectorXd even_powers(const Eigen::VectorXd& wanted) const;

  /// By how much each ring's power is to be multiplied, where what is made differs from what is wanted.
  /// @from  image space reconstruction algorithm, Daube-Witherspoon & Muehllehner 1986: repeated, it leads to
  ///        the least squares of all powers that are not negative
  Eigen::VectorXd factors(const Eigen::VectorXd& wanted, const Eigen::VectorXd& made) const;

  /// Powers after so many multiplications; few give a smooth light, many come nearer to what is wanted.
  Eigen::VectorXd improved(const Eigen::VectorXd& wanted, Eigen::VectorXd powers, int rounds) const;

  /// Least root mean square difference from what is wanted that any powers leave.
  /// @error 1 % of itself: a thousandth is what a hundred further rounds would change
  /// @cost  some 50 ms
  double limit(const Eigen::VectorXd& wanted) const;

 private:
  std::vector<double> rings_mm_;
  double width_mm_;        ///< of a ring
  Eigen::MatrixXd light_;  ///< at a place (row), from a ring with power 1
};

}  // namespace catoptric::design
