#include "photometry/photometric_types.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "base/units.h"

using namespace catoptric;
using namespace catoptric::photometry;

namespace {

constexpr double degree = pi / 180;

std::vector<double> even(double first, double last, double step) {
  std::vector<double> angles;
  for (double angle = first; angle <= last; angle += step) angles.push_back(angle);
  return angles;
}

struct Direction {
  double x, y, z;
};

/// A file of type A or B that measured an intensity given by direction.
Lm63File measured(PhotometricType type, double first_h, double first_v,
                  const std::function<double(Direction)>& intensity) {
  Lm63File file;
  file.type = type;
  file.horizontal_deg = even(first_h, 90, 3);
  file.vertical_deg = even(first_v, 90, 3);
  for (const double h : file.horizontal_deg)
    for (const double v : file.vertical_deg) {
      const double sh = std::sin(h * degree), ch = std::cos(h * degree);
      const double sv = std::sin(v * degree), cv = std::cos(v * degree);
      file.candela.push_back(intensity(type == PhotometricType::a ? Direction{cv * sh, sv, cv * ch}
                                                                  : Direction{sh, ch * sv, ch * cv}));
    }
  return file;
}

}  // namespace

TEST_CASE("types A and B keep what is where, to the error of interpolation") {
  const auto lobe = [](Direction d) { return std::max(0.0, 100 * d.z + 40 * d.x * d.z - 30 * d.y * d.z); };
  for (const auto type : {PhotometricType::a, PhotometricType::b}) {
    const IntensityTable table = intensity_of(measured(type, -90, -90, lobe));
    double worst = 0;
    for (double gamma = 0; gamma <= 90; gamma += 1.7)
      for (double c = 0; c < 360; c += 7.3) {
        const double s = std::sin(gamma * degree);
        const double exact =
            lobe({s * std::cos(c * degree), s * std::sin(c * degree), std::cos(gamma * degree)});
        worst = std::max(worst, std::abs(table.at(gamma, c) - exact));
      }
    // Bilinear twice over, by 3 degrees each: 2 (h^2/8) (|I_hh| + |I_vv|), second derivatives below 300 each.
    const double h = 3 * degree;
    CHECK(worst < 2 * h * h / 8 * 600);
    CHECK(table.at(120, 0) == 0);
  }
}

TEST_CASE("a half that is not measured is the mirror image of the other") {
  const auto even_lobe = [](Direction d) { return 100 * d.z * (1 + d.x * d.x + std::abs(d.y)); };
  for (const auto type : {PhotometricType::a, PhotometricType::b}) {
    const IntensityTable whole = intensity_of(measured(type, -90, -90, even_lobe));
    const IntensityTable quarter = intensity_of(measured(type, 0, 0, even_lobe));
    REQUIRE(whole.values().size() == quarter.values().size());
    for (std::size_t i = 0; i < whole.values().size(); ++i)
      CHECK(std::abs(whole.values()[i] - quarter.values()[i]) < 1e-9 * 300);
  }
}

TEST_CASE("resampled types keep the flux of a cosine") {
  for (const auto type : {PhotometricType::a, PhotometricType::b}) {
    const IntensityTable table =
        intensity_of(measured(type, -90, -90, [](Direction d) { return 100 * std::max(0.0, d.z); }));
    const double h = 3 * degree;
    CHECK(table.flux() == Approx(100 * pi).margin(2 * h * h / 8 * 200 * 2 * pi));
  }
}
