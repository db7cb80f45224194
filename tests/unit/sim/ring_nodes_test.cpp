#include "sim/ring_nodes.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/ring_counts.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr std::size_t bins = 128, sets = 6;  // two groups of lanes, the second not full
constexpr double bin_width = 0.5;

/// Of a set, at a place in bins; every set has its own, so that none can stand for another.
double line(std::size_t set, double place) { return 3 + static_cast<double>(set) + 0.1 * place; }
double cubic(std::size_t set, double place) {
  const double x = place / bins;
  return line(set, place) + static_cast<double>(set + 1) * x * x * (2 - 3 * x);
}

/// Counts that are the density in the middle of each bin, to the last digit.
RingBins photons_of(double (*density)(std::size_t, double)) {
  RingBins photons{bin_width, bins, RingBins::row_of(sets), {}};
  photons.counts = std::make_unique<double[]>(bins * photons.row);
  for (std::size_t bin = 0; bin < bins; ++bin)
    for (std::size_t set = 0; set < sets; ++set)
      photons.counts[bin * photons.row + set] = bin_width * density(set, static_cast<double>(bin) + 0.5);
  return photons;
}

RingDensity density_at(RingNodes& nodes, const RingNodes::Reading& reading) {
  nodes.want(reading);
  nodes.estimate();
  RingDensity got;
  nodes.read(reading, got);
  return got;
}

/// Ends, between the nodes nearest to them, where a window first sees no end, amid, on a node.
const std::vector<double> places{0, 0.3, 1.5, 2.9, 11.9, 12.1, 37.2, 64, 115.7, 116.4, 125.2, 127.6, 128};

}  // namespace

TEST_CASE("ring nodes see straight lines and cubics exactly, on nodes and between, at the ends and amid") {
  for (RingKernel kernel : {RingKernel::epanechnikov, RingKernel::biweight})
    for (double reach : {12.3, 64.0})
      for (double place : places) {
        RingNodes straight(photons_of(line), kernel, reach * bin_width);
        RingNodes bent(photons_of(cubic), kernel, reach * bin_width);
        const RingDensity a = density_at(straight, straight.between(place));
        const RingDensity b = density_at(bent, bent.between(place));
        CAPTURE(place, reach);
        for (std::size_t set = 0; set < sets; ++set) {
          CHECK(a.second_order[set] == Approx(line(set, place)).epsilon(1e-11));
          CHECK(b.fourth_order[set] == Approx(cubic(set, place)).epsilon(1e-9));
        }
        CHECK_FALSE(b.second_order[0] == Approx(cubic(0, place)).epsilon(1e-9));  // wrong twin: order two
      }
}

TEST_CASE("ring nodes: Poisson's squares are those of the weights, nearest readings those of one node") {
  // One photon in one bin: the density is its weight, the square of it the sum of squares.
  for (double place : {0.0, 5.0, 40.0, 64.0, 123.0, 128.0}) {
    RingBins photons = photons_of(line);
    std::fill_n(photons.counts.get(), bins * photons.row, 0.0);
    const std::size_t bin = std::min<std::size_t>(bins - 1, static_cast<std::size_t>(place) + 3);
    photons.counts[bin * photons.row + 5] = 1;
    RingNodes nodes(std::move(photons), RingKernel::biweight, 20 * bin_width);
    const RingDensity got = density_at(nodes, nodes.nearest(place));
    CHECK(got.second_order[5] > 0);
    CHECK(got.second_square == Approx(got.second_order[5] * got.second_order[5]).epsilon(1e-13));
    CHECK(got.fourth_square == Approx(got.fourth_order[5] * got.fourth_order[5]).epsilon(1e-13));
    for (double off : {-0.49, 0.49}) {
      if (place + off < 0) continue;
      RingDensity near;
      nodes.read(nodes.nearest(place + off), near);
      CHECK(near.second_order == got.second_order);
    }
  }
}

TEST_CASE("counted rings: a place reads the same alone, among others and in any order") {
  CountedRings rings({0, 40, 100}, 3, 4096);
  std::vector<double> squares;
  for (int i = 0; i < 5000; ++i) squares.push_back(100 * std::pow((i + 0.5) / 5000, 1.5));
  for (std::size_t set = 0; set < 3; ++set) rings.add(set, 0, std::span(squares).subspan(set * 7));
  rings.close();
  const std::vector<double> all{99.9, 0, 17.3, 40, 39.99, 80, 2.5, 17.31};
  const auto seen = [&](const std::vector<double>& at) {
    std::vector<std::vector<double>> numbers(at.size());
    rings.estimate(at, RingKernel::biweight, 5, [&](std::size_t i, const RingDensity& density) {
      numbers[i] = density.second_order;
      numbers[i].insert(numbers[i].end(), density.fourth_order.begin(), density.fourth_order.end());
      numbers[i].insert(numbers[i].end(), {density.second_square, density.fourth_square});
    });
    return numbers;
  };
  const auto together = seen(all);
  for (std::size_t i = 0; i < all.size(); ++i) CHECK(seen({all[i]})[0] == together[i]);
  CHECK(together[2] != together[7]);
}
