#include "design/image_blur.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

constexpr int places = 96;
constexpr double reach = 100, image = 20;

std::vector<double> radii() {
  std::vector<double> list;
  for (int i = 0; i < places; ++i) list.push_back(reach * std::sqrt((i + 0.5) / places));
  return list;
}

Eigen::VectorXd sampled(const std::function<double(double)>& light) {
  Eigen::VectorXd values(places);
  const auto at = radii();
  for (int i = 0; i < places; ++i) values[i] = light(at[static_cast<std::size_t>(i)]);
  return values;
}

}  // namespace

TEST_CASE("one image on the axis is an even disc, and images keep their power wherever they are put") {
  const ImageBlur blur(radii(), image);
  const auto rings = static_cast<Eigen::Index>(blur.ring_radii_mm().size());
  const Eigen::VectorXd centre = blur.light(Eigen::VectorXd::Unit(rings, 0));
  const double even = 1 / (pi * image * image);
  const auto at = radii();
  for (int i = 0; i < places; ++i) {
    const double radius = at[static_cast<std::size_t>(i)];
    if (std::abs(radius - image) > 1)
      CHECK(centre[i] == Approx(radius < image ? even : 0).epsilon(1e-9).margin(1e-12));
  }
  // Places are even in area, so that the mean over them is the power over the field's area; some ten of them
  // lie on an image's border.
  for (const Eigen::Index ring : {Eigen::Index{20}, Eigen::Index{60}, Eigen::Index{110}}) {
    const double mean = blur.light(Eigen::VectorXd::Unit(rings, ring)).mean();
    CHECK(mean * pi * reach * reach == Approx(1).epsilon(0.03));
  }
}

TEST_CASE("light that images can make has no limit, and sharpening finds the way there") {
  const ImageBlur blur(radii(), image);
  const auto rings = static_cast<Eigen::Index>(blur.ring_radii_mm().size());
  Eigen::VectorXd powers(rings);
  for (Eigen::Index j = 0; j < rings; ++j)
    powers[j] =
        blur.ring_radii_mm()[static_cast<std::size_t>(j)] * (1.2 + std::sin(0.05 * static_cast<double>(j)));
  const Eigen::VectorXd wanted = blur.light(powers);
  CHECK(blur.limit(wanted) < 2e-3 * wanted.mean());
  double last = HUGE_VAL;
  for (const int rounds : {0, 1, 10, 100, 1000}) {
    const double now = (blur.light(blur.improved(wanted, blur.even_powers(wanted), rounds)) - wanted).norm();
    CHECK(now < last);
    last = now;
  }
  CHECK((blur.factors(wanted, wanted).array() - 1).abs().maxCoeff() < 1e-12);
}

TEST_CASE("what is finer than an image leaves its limit") {
  const ImageBlur blur(radii(), image);
  const Eigen::VectorXd spot = sampled([](double radius) { return radius < 0.5 * image ? 1.0 : 0.0; });
  // An even disc of one image about the spot: its best height is a quarter, which leaves the root of 3/4.
  // Images about the axis, whose light peaks there, serve the spot a little better.
  const double by_hand = spot.norm() / std::sqrt(places) * std::sqrt(0.75);
  CHECK(blur.limit(spot) < by_hand);
  CHECK(blur.limit(spot) > 0.75 * by_hand);
  CHECK(blur.limit(spot) > 20 * blur.limit(sampled([](double) { return 1.0; })));
}
