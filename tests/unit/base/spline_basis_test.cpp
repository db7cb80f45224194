#include "base/spline_basis.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/profile.h"

using namespace catoptric;

namespace {

/// Where the basis functions put a curve of weight 1, and how fast it moves.
struct Moving {
  double r = 0, z = 0, dr = 0, dz = 0;
};

Moving through_basis(const Profile& profile, double u) {
  const SplineBasis basis = spline_basis(profile.degree(), profile.knots(), u);
  Moving at;
  for (std::size_t i = 0; i < basis.value.size(); ++i) {
    const ControlPoint& point = profile.points()[basis.first + i];
    at.r += basis.value[i] * point.r_mm;
    at.z += basis.value[i] * point.z_mm;
    at.dr += basis.slope[i] * point.r_mm;
    at.dz += basis.slope[i] * point.z_mm;
  }
  return at;
}

Profile wavy(int degree, std::vector<double> knots) {
  std::vector<ControlPoint> points;
  for (std::size_t i = 0; i + static_cast<std::size_t>(degree) + 1 < knots.size(); ++i)
    points.push_back({static_cast<double>(i), 3 + std::sin(1.7 * static_cast<double>(i)), 1});
  return Profile(degree, std::move(knots), std::move(points));
}

}  // namespace

TEST_CASE("basis functions put a curve where its own spans put it") {
  const Profile profile =
      GENERATE(wavy(1, {0, 0, 0.3, 1, 1}), wavy(2, {0, 0, 0, 0.2, 0.2, 0.7, 1, 1, 1}),
               wavy(3, {-1, -1, -1, -1, 0, 0.5, 0.5, 2, 2, 2, 2}), wavy(3, {0, 1, 2, 3, 4, 5, 6, 7, 8}),
               wavy(9, Profile::uniform_knots(9, 13)));
  for (int i = 0; i <= 40; ++i) {
    const double u = profile.first_parameter() +
                     (profile.last_parameter() - profile.first_parameter()) * static_cast<double>(i) / 40;
    const MeridianPoint exact = profile.at(u);
    const Moving at = through_basis(profile, u);
    CHECK(at.r == Approx(exact.r_mm).margin(1e-12));
    CHECK(at.z == Approx(exact.z_mm).margin(1e-12));
    if (profile.degree() == 1 || u == 0.5 || u == 0.2) continue;  // a corner has two slopes
    CHECK(at.dr == Approx(exact.dr).margin(1e-11));
    CHECK(at.dz == Approx(exact.dz).margin(1e-11));
  }
}
