#include <catch2/catch.hpp>
#include <cmath>

#include "base/errors.h"
#include "base/units.h"
#include "photometry/direct_ratio.h"
#include "photometry/eulumdat.h"

using namespace catoptric;
using namespace catoptric::photometry;

namespace {

IntensityTable cosine() {
  std::vector<double> gamma, values;
  for (int i = 0; i <= 90; ++i) {
    gamma.push_back(i);
    values.push_back(i == 90 ? 0 : 100 * std::cos(i * pi / 180));
  }
  return {LightQuantity::luminous, gamma, {0}, values};
}

}  // namespace

TEST_CASE("direct ratios of a cosine are the view factors of parallel squares") {
  // Howell, A Catalog of Radiation Heat Transfer Configuration Factors, for equal squares of side x h
  for (const double index : room_indices) {
    const double x = 2 * index, root = std::sqrt(1 + x * x);
    const double factor = 2 / (pi * x * x) *
                          (std::log((1 + x * x) / std::sqrt(1 + 2 * x * x)) +
                           2 * x * root * std::atan(x / root) - 2 * x * std::atan(x));
    CHECK(direct_ratio(cosine(), index) ==
          Approx(factor).margin(2e-4));  // 1e-4 of the rule, as much of chords
  }
  CHECK(direct_ratio({LightQuantity::luminous, {90, 180}, {0}, {1, 1}}, 1) == 0);
}

TEST_CASE("absolute photometry is lamps of the luminaire's flux, their count negative") {
  Luminaire luminaire;
  luminaire.lamp_count = 3;
  const EulumdatFile file = eulumdat_of(cosine(), luminaire);
  REQUIRE(file.lamps.size() == 1);
  CHECK(file.lamps[0].count == -3);
  CHECK(file.lamps[0].flux_lm == cosine().flux());
  CHECK(file.output_ratio_percent == 100);
  CHECK(file.downward_percent == 100);
  luminaire.lamp_flux_lm = 2 * cosine().flux();
  CHECK(eulumdat_of(cosine(), luminaire).lamps[0].count == 3);
  CHECK(eulumdat_of(cosine(), luminaire).output_ratio_percent == 50);
}

TEST_CASE("a EULUMDAT file has the symmetry of its table, to the bit") {
  const auto stored = [](std::vector<double> c, std::vector<double> at_90) {
    std::vector<double> values;
    for (const double value : at_90) values.insert(values.end(), {1, value});
    const EulumdatFile file = eulumdat_of({LightQuantity::luminous, {0, 90}, c, values}, {});
    return std::pair(file.symmetry, file.intensity_cd.size() / 2);
  };
  using enum EulumdatSymmetry;
  const std::vector<double> four{0, 90, 180, 270};
  CHECK(eulumdat_of(cosine(), {}).symmetry == rotational);
  CHECK(stored(four, {1, 2, 1, 2}) == std::pair(both, std::size_t{2}));
  CHECK(stored(four, {1, 2, 3, 2}) == std::pair(about_c0, std::size_t{3}));
  CHECK(stored(four, {1, 2, 1, 4}) == std::pair(about_c90, std::size_t{3}));
  CHECK(stored(four, {1, 2, std::nextafter(1, 2), 4}) == std::pair(none, std::size_t{4}));
  CHECK(stored({0, 80, 180, 270}, {1, 2, 3, 2}) == std::pair(none, std::size_t{4}));
  CHECK(stored({0, 120, 240}, {1, 2, 2}) == std::pair(none, std::size_t{3}));
}

TEST_CASE("texts are cut to the format's lengths and take one line each") {
  Luminaire luminaire;
  luminaire.manufacturer = "two\nlines" + std::string(100, 'x');
  luminaire.opening = {50, 50, 5, true};
  const EulumdatReading reading = parse_eulumdat(eulumdat_text(eulumdat_of(cosine(), luminaire)), "a.ldt");
  CHECK(reading.notes.empty());
  CHECK(reading.file.company == "two lines" + std::string(69, 'x'));
  CHECK(reading.file.type == 1);
  CHECK(opening_of(reading.file) == luminaire.opening);
}

TEST_CASE("what EULUMDAT cannot hold is refused") {
  CHECK_THROWS_WITH(eulumdat_of({LightQuantity::radiant, {0, 90}, {0}, {1, 1}}, {}), Catch::Contains("W/sr"));
  CHECK_THROWS_WITH(eulumdat_of({LightQuantity::luminous, {0, 90}, {0}, {0, 0}}, {}),
                    Catch::Contains("dark"));
  std::vector<double> gamma;
  for (int i = 0; i <= 400; ++i) gamma.push_back(i * 0.225);
  const IntensityTable fine(LightQuantity::luminous, gamma, {0}, std::vector<double>(gamma.size(), 1));
  CHECK_THROWS_WITH(eulumdat_of(fine, {}), Catch::Contains("721 planes of 361"));
}
