#include <catch2/catch.hpp>
#include <cmath>

#include "base/random_stream.h"
#include "base/units.h"
#include "sim/intensity_source.h"
#include "sim/projection_map.h"
#include "sim/simulation.h"
#include "support/flat_mirror.h"
#include "support/statistics.h"

/// Points with a table of intensities: what they emit, where they are not asked to, and their direct light.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr double degree = pi / 180;

/// Uneven steps, a dark ring, other light in every plane.
IntensityTable uneven_table() {
  const std::vector<double> gamma{0, 7, 20, 45, 46, 80, 90, 130, 180}, c{0, 30, 100, 250};
  std::vector<double> values;
  for (std::size_t plane = 0; plane < c.size(); ++plane)
    for (std::size_t i = 0; i < gamma.size(); ++i)
      values.push_back(i == 5 ? 0 : 1 + static_cast<double>((3 * plane + 5 * i) % 7));
  return {LightQuantity::luminous, gamma, c, values};
}

IntensityTable power_of_cosine(double exponent) {
  std::vector<double> gamma, values;
  for (int i = 0; i <= 360; ++i) {
    gamma.push_back(0.25 * i);
    values.push_back(std::pow(std::max(0.0, std::cos(gamma.back() * degree)), exponent));
  }
  return {LightQuantity::radiant, gamma, {0}, values};
}

const Vector3 place(3, -4, 50), axis = Vector3(0.3, -0.2, 1).normalized(), along(1, 0.4, 0);

/// Directions in the frame of the table.
Eigen::Matrix3d table_frame() {
  Eigen::Matrix3d frame;
  frame.col(2) = axis;
  frame.col(0) = (along - along.dot(axis) * axis).normalized();
  frame.col(1) = axis.cross(frame.col(0));
  return frame;
}

/// p-value of an emission over a grid of 36 x 24 directions against the integral of the table over each.
/// @in map: only directions of cells that lie wholly in it are counted, null for all
double fit(const Emission& emission, const IntensityTable& table) {
  constexpr int rows = 36, columns = 24, draws = 200'000, fine = 12;
  const Eigen::Matrix3d frame = table_frame();
  std::vector<double> want(rows * columns, 0), counts(rows * columns, 0);
  double all = 0;
  for (int i = 0; i < rows * fine; ++i)
    for (int k = 0; k < columns * fine; ++k) {
      const double gamma = 180 * (i + 0.5) / (rows * fine), c = 360 * (k + 0.5) / (columns * fine);
      const double light = table.at(gamma, c) * std::sin(gamma * degree);
      want[static_cast<std::size_t>(i / fine * columns + k / fine)] += light;
      all += light;
    }
  for (int i = 0; i < draws; ++i) {
    RandomStream stream(11, Purpose::test, static_cast<std::uint64_t>(i));
    const double first = stream.uniform(), second = stream.uniform();
    const Vector3 local = frame.transpose() * emission.emit({first, second, 0, 0}).direction;
    const double gamma = std::acos(std::clamp(local.z(), -1.0, 1.0)) / pi;
    const double turn = std::atan2(local.y(), local.x()) / (2 * pi);
    const int row = std::min(rows - 1, static_cast<int>(gamma * rows));
    const int column = std::min(columns - 1, static_cast<int>((turn < 0 ? turn + 1 : turn) * columns));
    counts[static_cast<std::size_t>(row * columns + column)] += 1;
  }
  std::vector<double> got{0}, expected{0};
  for (std::size_t i = 0; i < want.size(); ++i) {
    const double mean = want[i] / all * draws;
    if (mean < 20) {  // together
      got[0] += counts[i];
      expected[0] += mean;
    } else {
      got.push_back(counts[i]);
      expected.push_back(mean);
    }
  }
  if (expected[0] < 20) {
    got[1] += got[0];
    expected[1] += expected[0];
    got.erase(got.begin());
    expected.erase(expected.begin());
  }
  return test::chi_square_p(got, expected);
}

}  // namespace

TEST_CASE("a table's emission follows its intensities between the angles as well") {
  const auto table = std::make_shared<const IntensityTable>(uneven_table());
  const IntensitySource source(place, 2, table, axis, along);
  CHECK(source.emission()->power_w() == Approx(2).epsilon(1e-14));
  CHECK(test::plausible(fit(*source.emission(), *table)));
  std::vector<double> values = table->values();
  for (std::size_t i = 0; i < values.size(); ++i) values[i] *= 1 + 0.1 * static_cast<double>(i % 3);
  const IntensityTable twin(table->quantity(), table->gamma_deg(), table->c_deg(), values);
  CHECK(test::rejected(fit(*source.emission(), twin)));
}

TEST_CASE("a table of a cosine's power is a point source by that law") {
  for (const double exponent : {1.0, 8.0}) {
    const auto table = std::make_shared<const IntensityTable>(power_of_cosine(exponent));
    const IntensitySource measured(place, 2, table, axis);
    const PointSource law(place, 2, exponent, axis);
    CHECK(measured.is_round());
    CHECK(measured.tilt_rad() == law.tilt_rad());
    for (const Vector3& point : {Vector3(0, 0, 90), Vector3(40, 10, 70), Vector3(-60, 5, 55)}) {
      const Vector3 normal = Vector3(0.1, 0, -1).normalized();
      CHECK(measured.unhindered_w_per_mm2(point, normal) ==
            Approx(law.unhindered_w_per_mm2(point, normal)).epsilon(2e-4).margin(1e-9));
    }
  }
}

TEST_CASE("a table's photons go nowhere but to the mirror, and none is kept from it", "[long]") {
  const auto profile = Profile::bezier({{5, 100, 1}, {50, 100, 1.4}, {100, 50, 1}});
  const auto table = std::make_shared<const IntensityTable>(uneven_table());
  for (const Vector3& at : {Vector3(0, 0, 50), Vector3(20, 10, 60), Vector3(-150, 0, 70)}) {
    const IntensitySource source(at, 2, table, axis, along);
    const ProjectionMap map = ProjectionMap::towards(profile, at);
    const auto emission = source.emission_to(profile), everywhere = source.emission();
    std::size_t inside = 0, drawn_inside = 0;
    constexpr int draws = 100'000;
    for (std::uint64_t i = 0; i < draws; ++i) {
      RandomStream stream(5, Purpose::test, i);
      const std::array<double, 4> numbers{stream.uniform(), stream.uniform(), 0, 0};
      const Vector3 direction = emission->emit(numbers).direction;
      CHECK(map.touches(direction, 5 * degree));
      inside += map.contains(everywhere->emit(numbers).direction);
      drawn_inside += map.contains(direction);
    }
    // The same light reaches the map by either: shares of unlike powers.
    const double by_all = 2.0 * static_cast<double>(inside) / draws;
    const double by_some = emission->power_w() * static_cast<double>(drawn_inside) / draws;
    const double noise = std::hypot(2 * std::sqrt(static_cast<double>(inside)),
                                    emission->power_w() * std::sqrt(static_cast<double>(drawn_inside))) /
                         draws;
    CAPTURE(at.transpose(), by_all, by_some);
    CHECK(test::plausible(test::normal_p((by_all - by_some) / noise)));
    CHECK(emission->power_w() <= 2 * (1 + 1e-12));
  }
}

TEST_CASE("a flat mirror shows a table's image") {
  const test::FlatMirror mirror(80, 60);
  const NearField field = NearField::disc({0, 0, 0}, {0, 0, 1}, 20);
  const auto table = std::make_shared<const IntensityTable>(power_of_cosine(2));
  const IntensitySource source({1, 2, 60}, 2, table, {0, 0, 1}), image({1, 2, 100}, 2, table, {0, 0, -1});
  const auto samples = field.samples(30);
  const FieldEstimate got = simulate({source, mirror, {}, field}, samples, {1 << 18, Sampler::sobol, 5},
                                     {Kernel::silverman, std::nullopt, 4.0});
  for (std::size_t i = 0; i < samples.size(); ++i)
    CHECK(got.reflected[i] ==
          Approx(image.unhindered_w_per_mm2(samples[i].point_mm, samples[i].normal)).epsilon(0.03));
}
