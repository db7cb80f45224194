#include "sim/probes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <set>

#include "base/random_stream.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

const NearField field = NearField::rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 40, 20);
const std::vector<double> dark(FieldCells::count, 0.0);

std::vector<std::uint32_t> cells_of(const std::vector<FieldSample>& samples) {
  const FieldCells cells = FieldCells::squares(field);
  std::vector<std::uint32_t> list;
  for (const FieldSample& sample : samples) list.push_back(cells.at(field.to_plane(sample.point_mm)));
  return list;
}

/// A spot of that half width about (12.3, -4.1) of the field.
double spot(const FieldSample& sample, double width_mm) {
  const Vector2 at = field.to_plane(sample.point_mm) - Vector2(12.3, -4.1);
  return std::exp(-at.squaredNorm() / (width_mm * width_mm));
}

double weighted(const Probes& probes, const std::vector<FieldSample>& samples, double width_mm) {
  double sum = 0;
  for (std::size_t i = 0; i < probes.picks.size(); ++i)
    sum += probes.shares[i] * spot(samples[probes.picks[i]], width_mm);
  return sum;
}

}  // namespace

TEST_CASE("cells cover the field, and cells of neighbouring numbers lie side by side") {
  const FieldCells cells = FieldCells::squares(field);
  std::vector<Vector2> middles(FieldCells::count);
  std::set<std::uint32_t> met;
  for (int i = 0; i < 32; ++i)
    for (int j = 0; j < 32; ++j) {
      const Vector2 middle((i + 0.5) / 16 * 20 - 20, (j + 0.5) / 16 * 10 - 10);
      met.insert(cells.at(middle));
      middles[cells.at(middle)] = middle;
    }
  CHECK(met.size() == FieldCells::count);
  // Four in a row make a square of two by two cells.
  for (std::size_t cell = 0; cell < FieldCells::count; cell += 4)
    for (std::size_t other = cell; other < cell + 4; ++other) {
      CHECK(std::abs(middles[cell].x() - middles[other].x()) < 1.5 * 40 / 32.0);
      CHECK(std::abs(middles[cell].y() - middles[other].y()) < 1.5 * 20 / 32.0);
    }
  CHECK(cells.at(Vector2(-1e9, -1e9)) == cells.at(Vector2(-20, -10)));
  CHECK(cells.at(Vector2(1e9, 1e9)) == FieldCells::count - 1);
}

TEST_CASE("ring cells have equal areas") {
  const FieldCells cells = FieldCells::rings(30);
  CHECK(cells.at(0.0) == 0);
  CHECK(cells.at(30.0) == FieldCells::count - 1);
  CHECK(cells.at(30 * std::sqrt(0.5 - 1e-9)) == FieldCells::count / 2 - 1);
  CHECK(cells.at(30 * std::sqrt(0.5 + 1e-9)) == FieldCells::count / 2);
}

TEST_CASE("probes stand for all samples") {
  const auto samples = field.samples(5000);
  const ProbePicker picker(cells_of(samples));
  for (const std::size_t wanted : {1u, 64u, 128u, 4000u}) {
    INFO(wanted);
    const Probes probes = picker.pick(dark, wanted);
    CHECK(std::abs(static_cast<double>(probes.picks.size()) - static_cast<double>(wanted)) <= 1);
    CHECK(std::accumulate(probes.shares.begin(), probes.shares.end(), 0.0) == Approx(1).epsilon(1e-12));
    CHECK(std::set(probes.picks.begin(), probes.picks.end()).size() == probes.picks.size());
  }
  // More than there are: all, alike.
  const Probes all = picker.pick(dark, 100'000);
  REQUIRE(all.picks.size() == samples.size());
  for (const double share : all.shares) CHECK(share == Approx(1.0 / static_cast<double>(samples.size())));
  // Evenly spread: a smooth mean is met well within the noise that picks at random would have.
  double mean = 0, square = 0;
  for (const FieldSample& sample : samples) {
    mean += spot(sample, 8) / static_cast<double>(samples.size());
    square += spot(sample, 8) * spot(sample, 8) / static_cast<double>(samples.size());
  }
  const double noise = std::sqrt((square - mean * mean) / 128);
  CHECK(std::abs(weighted(picker.pick(dark, 128), samples, 8) - mean) < 0.5 * noise);
}

TEST_CASE("probes find the spot that holds all the light, and still stand for all") {
  const auto samples = field.samples(50'000);
  const auto cells = cells_of(samples);
  const ProbePicker picker(cells);
  constexpr double width_mm = 0.3;  // a spot on 1/2800 of the field, between most of 128 even picks
  double mean = 0;
  std::vector<double> light = dark;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    mean += spot(samples[i], width_mm) / static_cast<double>(samples.size());
    light[cells[i]] += spot(samples[i], width_mm);
  }
  const Probes probes = picker.pick(light, 128);
  CHECK(std::abs(static_cast<double>(probes.picks.size()) - 128) <= 1);
  // 64 picks on a few cells, of which the spot is a fifth and half shade: 20 % is three standard deviations.
  CHECK(weighted(probes, samples, width_mm) == Approx(mean).epsilon(0.2));
  // As many as half of the probes stand for the dark, which is nearly all of the field.
  double dark_share = 0;
  for (std::size_t i = 0; i < probes.picks.size(); ++i)
    if (spot(samples[probes.picks[i]], width_mm) < 1e-6) dark_share += probes.shares[i];
  CHECK(dark_share > 0.95);
  // The wrong twin: even picks show next to nothing of it, or far too much.
  CHECK(std::abs(weighted(picker.pick(dark, 128), samples, width_mm) / mean - 1) > 0.5);
}

TEST_CASE("light where no sample lies is nobody's") {
  const std::vector<std::uint32_t> two_cells{0, 0, 5, 5};
  std::vector<double> light = dark;
  light[700] = 1e6;
  const Probes probes = ProbePicker(two_cells).pick(light, 2);
  CHECK(probes.picks.size() == 2);
}
