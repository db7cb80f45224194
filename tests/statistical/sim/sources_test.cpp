#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/random_stream.h"
#include "base/units.h"
#include "cad/engines.h"
#include "sim/disc_source.h"
#include "sim/frame.h"
#include "sim/projection_map.h"
#include "sim/rings.h"
#include "sim/simulation.h"
#include "sim/tubes.h"
#include "support/analytic_reflectors.h"
#include "support/statistics.h"

/// Sources with an axis: what they emit, and that all rungs see the same light of them.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr double power = pi / 100;

std::size_t bin(double share, std::size_t bins) {
  return std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, share) * static_cast<double>(bins)));
}

/// Cells of equal light about an axis: 20 in the cosine's power that is even, 16 in azimuth.
class LightCells {
 public:
  LightCells(const Vector3& axis, double exponent) : frame_(frame_about(axis)), power_(exponent + 1) {}
  static constexpr std::size_t count = 20 * 16;

  std::size_t of(const Vector3& direction) const {
    const Vector3 local = frame_.transpose() * direction;
    const double azimuth = std::atan2(local.y(), local.x()) / (2 * pi) + 0.5;
    return 16 * bin(std::pow(std::max(0.0, local.z()), power_), 20) + bin(azimuth, 16);
  }
  Vector3 direction(double light, double turns) const {
    const double cosine = std::pow(light, 1 / power_), sine = std::sqrt(1 - cosine * cosine);
    return frame_ * Vector3(sine * std::cos(2 * pi * turns), sine * std::sin(2 * pi * turns), cosine);
  }

 private:
  Eigen::Matrix3d frame_;
  double power_;
};

/// Share of each cell that belongs to the map, by evenly spread directions.
std::vector<double> shares(const ProjectionMap& map, const LightCells& cells) {
  constexpr int finest = 640;
  std::vector<double> share(LightCells::count, 0);
  for (int i = 0; i < finest; ++i)
    for (int j = 0; j < finest; ++j) {
      const Vector3 direction = cells.direction((i + 0.5) / finest, (j + 0.5) / finest);
      if (map.contains(direction)) share[cells.of(direction)] += LightCells::count / (1.0 * finest * finest);
    }
  return share;
}

double fit(const MappedSource& source, const ProjectionMap& map, const LightCells& cells,
           const std::vector<double>& share) {
  constexpr int draws = 100'000;
  double inside = 0;
  for (const double each : share) inside += each;
  std::vector<double> got{0}, want{0}, counts(LightCells::count, 0);
  for (int i = 0; i < draws; ++i) {
    RandomStream stream(7, Purpose::test, static_cast<std::uint64_t>(i));
    std::array<double, 4> numbers;
    for (double& number : numbers) number = stream.uniform();
    counts[cells.of(source.emit(map, numbers).direction)] += 1;
  }
  for (std::size_t i = 0; i < LightCells::count; ++i) {
    const bool whole = share[i] > 0.999;  // the counting blurs the border of the others
    if (whole) got.push_back(0), want.push_back(0);
    (whole ? got.back() : got[0]) += counts[i];
    (whole ? want.back() : want[0]) += draws * share[i] / inside;
  }
  if (want[0] < 5) {  // too few for the normal law, or none
    got.erase(got.begin());
    want.erase(want.begin());
  }
  return test::chi_square_p(got, want);
}

const Vector3 places[] = {{0, 0, 50}, {0, 0, 20}, {30, 0, 60}, {-200, 40, 75}};
const Vector3 axes[] = {{0, 0, 1}, {0.5, 0.2, 1}, {1, 0, -0.1}};

}  // namespace

TEST_CASE("a point's emission follows its power of the cosine, wherever and however it stands", "[long]") {
  const auto profile = test::paraboloid().profile();
  for (const double exponent : {0.5, 1.0, 3.0, 50.0})
    for (const Vector3& place : places)
      for (const Vector3& axis : axes) {
        CAPTURE(exponent, place.transpose(), axis.transpose());
        const PointSource source(place, power, exponent, axis);
        const LightCells cells(axis, exponent);
        const ProjectionMap map = source.directions_to(profile);
        const std::vector<double> share = shares(map, cells);
        double inside = 0;
        for (const double each : share) inside += each / LightCells::count;
        // the counted light is that of the map, to the cells on its border
        CHECK(source.power_into_w(map) == Approx(inside * power).epsilon(0.01).margin(1e-4 * power));
        if (inside < 0.02) continue;  // hardly a whole cell
        CHECK(test::plausible(fit(source, map, cells, share)));
      }
}

TEST_CASE("another exponent's emission is told apart") {
  const auto profile = test::paraboloid().profile();
  for (const double exponent : {0.5, 1.0, 3.0, 50.0}) {
    const PointSource source({0, 0, 20}, power, exponent, {0.5, 0.2, 1}),
        twin({0, 0, 20}, power, 1.3 * exponent, {0.5, 0.2, 1});
    const LightCells cells({0.5, 0.2, 1}, exponent);
    const ProjectionMap map = source.directions_to(profile);
    CAPTURE(exponent);
    CHECK(test::rejected(fit(twin, twin.directions_to(profile), cells, shares(map, cells))));
  }
}

TEST_CASE("a disc emits evenly from its area and by Lambert's law into its own side") {
  const Vector3 normal = Vector3(0.3, -0.2, 1).normalized(), center(4, 5, 30);
  const LambertianDisc disc(center, 5, normal, power);
  const ProjectionMap all = disc.all_directions();
  CHECK(disc.power_into_w(all) == Approx(power).epsilon(1e-14));
  const Eigen::Matrix3d frame = frame_about(normal);
  const auto places_of = [&](const auto& share_of_radius) {
    std::vector<double> counts(12 * 10, 0);
    for (int i = 0; i < 100'000; ++i) {
      RandomStream stream(9, Purpose::test, static_cast<std::uint64_t>(i));
      std::array<double, 4> numbers;
      for (double& number : numbers) number = stream.uniform();
      const Vector3 local = frame.transpose() * (disc.emit(all, numbers).origin_mm - center);
      REQUIRE(std::abs(local.z()) < 1e-12);
      const double azimuth = std::atan2(local.y(), local.x()) / (2 * pi) + 0.5;
      counts[10 * bin(share_of_radius(local.head<2>().norm() / 5), 12) + bin(azimuth, 10)] += 1;
    }
    return test::chi_square_even_p(counts);
  };
  CHECK(test::plausible(places_of([](double r) { return r * r; })));
  CHECK(test::rejected(places_of([](double r) { return r; })));
  const LightCells cells(normal, 1), even(normal, 0);
  const std::vector<double> whole(LightCells::count, 1.0);
  CHECK(test::plausible(fit(disc, all, cells, whole)));
  CHECK(test::rejected(fit(disc, all, even, whole)));
}

namespace {

/// A disc that sends its photons everywhere it shines.
class Careless final : public MappedSource {
 public:
  explicit Careless(const LambertianDisc& disc) : disc_(disc) {}
  double power_w() const override { return disc_.power_w(); }
  Vector3 position_mm() const override { return disc_.position_mm(); }
  double extent_mm() const override { return disc_.extent_mm(); }
  double tilt_rad() const override { return disc_.tilt_rad(); }
  double intensity_w_per_sr(const Vector3& way) const override { return disc_.intensity_w_per_sr(way); }
  std::string words() const override { return disc_.words(); }
  std::string left_out() const override { return disc_.left_out(); }
  ProjectionMap directions_to(const Profile&) const override { return disc_.all_directions(); }
  Emitter emitter() const override { return disc_.emitter(); }
  Ray emit(const ProjectionMap& map, const std::array<double, 4>& numbers) const override {
    return disc_.emit(map, numbers);
  }
  double unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const override {
    return disc_.unhindered_w_per_mm2(point_mm, normal);
  }
  double direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                          double lift_mm) const override {
    return disc_.direct_w_per_mm2(point_mm, normal, mirror, lift_mm);
  }

 private:
  const LambertianDisc& disc_;
};

}  // namespace

TEST_CASE("photons sent towards the mirror alone carry as much light there as those sent everywhere",
          "[long]") {
  const auto profile = Profile::bezier({{20, 100, 1}, {50, 95, 1}, {100, 60, 1}});
  const auto mirror = cad::make_meridian_reflector(profile);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  for (const auto& [center, normal] : {std::pair<Vector3, Vector3>{{0, 0, 30}, {0, 0, 1}},
                                       {{20, 5, 30}, {-0.3, 0, 1}},
                                       {{0, 0, 30}, {0.4, 0, 1}}}) {
    const LambertianDisc disc(center, 8, normal, power);
    const Careless everywhere(disc);
    const auto met_w = [&](const Source& source) {
      const PhotonFlights flights(Scene{source, *mirror, {}, field}, RecordedArea::about(field, 0));
      const FlightTotals totals = flights.fly({400'000, Sampler::random, 3, 1, 1000}, [](auto, auto&&) {});
      return std::pair(totals.energy.emitted_w - totals.energy.missed_w, totals.counts);
    };
    const auto [aimed_w, aimed] = met_w(disc);
    const auto [all_w, all] = met_w(everywhere);
    CHECK(aimed.met_mirror > all.met_mirror);  // which is what aiming is for
    const double share = all_w / power, noise = std::sqrt(share * (1 - share) / 400'000);
    CHECK(aimed_w / power == Approx(share).margin(6 * noise));
  }
}

namespace {

struct Compared {
  double worst_z = 0;
  void add(const std::vector<std::vector<double>>& replicates, const std::vector<double>& wanted,
           double one_photon) {
    const double count = static_cast<double>(replicates.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      double mean = 0, square = 0;
      for (const auto& one : replicates) mean += one[i] / count;
      for (const auto& one : replicates) square += (one[i] - mean) * (one[i] - mean) / (count - 1);
      worst_z =
          std::max(worst_z, std::abs(mean - wanted[i]) / (std::sqrt(square / count) + one_photon / count));
    }
  }
};

std::vector<FieldSample> along_radius(int count) {
  std::vector<FieldSample> samples;
  for (int i = 0; i < count; ++i)
    samples.push_back(
        {{90.0 * (i + 0.5) / count * std::cos(i), 90.0 * (i + 0.5) / count * std::sin(i), 0}, {0, 0, 1}});
  return samples;
}

constexpr double kernel_mm = 6;
constexpr std::uint64_t photons = 1 << 15, streams = 8;
/// Student's t with 7 degrees of freedom for some 300 comparisons: below 1e-6 for all of them together.
constexpr double most_z = 18;

std::vector<std::vector<double>> by_photons(const Scene& scene, const std::vector<FieldSample>& samples) {
  std::vector<std::vector<double>> replicates;
  for (std::uint64_t stream = 0; stream < streams; ++stream)
    replicates.push_back(simulate(scene, samples, {photons, Sampler::sobol, 3, stream, 1000},
                                  {Kernel::silverman, {}, kernel_mm})
                             .reflected);
  return replicates;
}

std::vector<std::vector<double>> by_rings(const Scene& scene, const std::vector<FieldSample>& samples) {
  std::vector<std::vector<double>> replicates;
  for (std::uint64_t stream = 0; stream < streams; ++stream) {
    RingsOptions options;
    options.photons = {photons, Sampler::sobol, 3, 100 + stream, 1000};
    options.replicates = 1;
    options.widest_kernel_radius_mm = kernel_mm;
    replicates.push_back(
        RingPhotons(scene, options).smoothed(ring_radii_mm(scene.near_field, samples), kernel_mm));
  }
  return replicates;
}

}  // namespace

TEST_CASE("tubes, rings and photons see the same light of a point with an exponent", "[long]") {
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  const auto samples = along_radius(12);
  for (const double w1 : {1.0, 2.5}) {
    const auto mirror =
        cad::make_meridian_reflector(Profile::bezier({{0, 100, 1}, {50, 100, w1}, {100, 50, 1}}));
    for (const double exponent : {0.5, 1.0, 3.0, 50.0}) {
      CAPTURE(w1, exponent);
      const PointSource source({0, 0, 50}, power, exponent);
      const Scene scene{source, *mirror, {0.9, 0}, field};
      TubesOptions options;
      options.kernel_radius_mm = kernel_mm;
      options.tolerance_w_per_mm2 = from_w_per_m2(1e-5);
      options.most_rays = 20'000;
      const TubesField tubes = tubes_field(scene, samples, options);
      CHECK(tubes.error_w_per_mm2 <= options.tolerance_w_per_mm2);
      const double one_photon = power / photons * 3 / (pi * kernel_mm * kernel_mm);
      Compared compared;
      compared.add(by_photons(scene, samples), tubes.irradiance, one_photon);
      compared.add(by_rings(scene, samples), tubes.irradiance, one_photon);
      CHECK(compared.worst_z < most_z);
      // wrong twin: half as much again in the exponent
      const PointSource near({0, 0, 50}, power, 1.5 * exponent);
      Compared twin;
      twin.add(by_photons(Scene{near, *mirror, {0.9, 0}, field}, samples), tubes.irradiance, one_photon);
      CHECK(twin.worst_z > most_z);
    }
  }
}

TEST_CASE("rings and photons see the same light of a disc, and a tiny disc is Lambert's point", "[long]") {
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 100);
  const auto samples = along_radius(12);
  const auto mirror =
      cad::make_meridian_reflector(Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}));
  const double one_photon = power / photons * 3 / (pi * kernel_mm * kernel_mm);
  const auto mean_of = [](const std::vector<std::vector<double>>& replicates) {
    std::vector<double> mean(replicates[0].size(), 0);
    for (const auto& one : replicates)
      for (std::size_t i = 0; i < mean.size(); ++i)
        mean[i] += one[i] / static_cast<double>(replicates.size());
    return mean;
  };
  const LambertianDisc wide({0, 0, 50}, 10, {0, 0, 1}, power), tiny({0, 0, 50}, 1e-4, {0, 0, 1}, power);
  const Scene wide_scene{wide, *mirror, {}, field}, tiny_scene{tiny, *mirror, {}, field};
  const auto wide_rings = by_rings(wide_scene, samples), wide_photons = by_photons(wide_scene, samples);
  Compared rings;
  rings.add(wide_photons, mean_of(wide_rings), one_photon);
  CHECK(rings.worst_z < most_z);
  const PointSource point({0, 0, 50}, power, 1);
  TubesOptions options;
  options.kernel_radius_mm = kernel_mm;
  const std::vector<double> tubes =
      tubes_field(Scene{point, *mirror, {}, field}, samples, options).irradiance;
  Compared limit, twin;
  limit.add(by_photons(tiny_scene, samples), tubes, one_photon);
  CHECK(limit.worst_z < most_z);
  const LambertianDisc wider({0, 0, 50}, 25, {0, 0, 1}, power);
  twin.add(by_photons(Scene{wider, *mirror, {}, field}, samples), tubes, one_photon);
  CHECK(twin.worst_z > most_z);  // a size is seen
}
