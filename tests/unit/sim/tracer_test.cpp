#include "sim/tracer.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/units.h"
#include "cad/engines.h"
#include "support/analytic_reflectors.h"
#include "support/crossings.h"
#include "support/flat_mirror.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

PhotonOptions photons(std::uint64_t count) {
  PhotonOptions options;
  options.photons = count;
  return options;
}

void check_sum(const EnergyLedger& energy) {
  const double sum =
      energy.missed_w + energy.absorbed_w + energy.received_w + energy.escaped_w + energy.cut_off_w;
  CHECK(std::abs(sum - energy.emitted_w) <= 1e-12 * energy.emitted_w);
}

}  // namespace

TEST_CASE("the near field registers only what has touched the mirror, and on the side it came from") {
  const test::FlatMirror mirror(100, 50);
  const PointSource source({0, 0, 0}, 1);
  // the plane at 60 lies between source and mirror: every photon crosses it twice, once untouched
  const auto between = NearField::disc({0, 0, 60}, {0, 0, 1}, 1000);
  const auto traced = test::fly({source, mirror, {}, between}, photons(5000), 0);
  CHECK(traced.counts.stored == 5000);
  for (const Crossing& crossing : traced.crossings) CHECK(crossing.from_front());
  CHECK(traced.energy.received_w == Approx(traced.energy.emitted_w).epsilon(1e-14));
  check_sum(traced.energy);

  const auto turned = NearField::disc({0, 0, 60}, {0, 0, -1}, 1000);
  const auto behind = test::fly({source, mirror, {}, turned}, photons(5000), 0);
  CHECK(behind.counts.stored == 5000);
  for (const Crossing& crossing : behind.crossings) CHECK_FALSE(crossing.from_front());
  CHECK(behind.energy.escaped_w == Approx(behind.energy.emitted_w).epsilon(1e-14));
  check_sum(behind.energy);
}

TEST_CASE("a photon is registered where its straight path meets the plane") {
  const test::FlatMirror mirror(100, 50);
  const PointSource source({3, -4, 20}, 1);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 400);
  const auto traced = test::fly({source, mirror, {}, field}, photons(5000), 100);
  CHECK(traced.counts.stored == traced.counts.met_mirror);
  // image at (3, -4, 180): the mirror's edge throws a shadow line at 50 / 80 of the slope
  for (const Crossing& crossing : traced.crossings) {
    const Vector2 on_mirror = Vector2(3, -4) + (crossing.plane_mm() - Vector2(3, -4)) * 80 / 180;
    CHECK(on_mirror.norm() <= 50 * (1 + 1e-12));
  }
}

TEST_CASE("records come in the order of the photons and only from the recorded area") {
  const auto mirror = test::paraboloid();
  const PointSource source({0, 0, 50}, 1);
  const auto field = NearField::rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 60, 30);
  const auto traced = test::fly({source, mirror, {}, field}, photons(10000), 10);
  CHECK(traced.counts.stored > 100);
  for (std::size_t i = 0; i < traced.crossings.size(); ++i) {
    const Crossing& crossing = traced.crossings[i];
    CHECK(std::abs(crossing.x_mm) <= 40);
    CHECK(std::abs(crossing.y_mm) <= 25);
    if (i > 0) CHECK(crossing.photon() > traced.crossings[i - 1].photon());
  }
}

TEST_CASE("no photons, one photon") {
  const auto mirror = test::paraboloid();
  const PointSource source({0, 0, 50}, 1);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 200);
  const auto none = test::fly({source, mirror, {}, field}, photons(0), 0);
  CHECK(none.crossings.empty());
  CHECK(none.photon_power_w == 0);
  CHECK(none.energy.emitted_w == 0);
  const auto one = test::fly({source, mirror, {}, field}, photons(1), 0);
  CHECK(one.counts.stored == 1);
  CHECK(one.photon_power_w == Approx(0.5));
  check_sum(one.energy);
}

TEST_CASE("a mirror of reflectance 0 absorbs all, one that transmits all lets all through") {
  const auto mirror = test::paraboloid();
  const PointSource source({0, 0, 50}, 1);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 200);
  const auto black = test::fly({source, mirror, {0, 0}, field}, photons(2000), 0);
  CHECK(black.counts.stored == 0);
  CHECK(black.energy.absorbed_w == Approx(black.energy.emitted_w));
  check_sum(black.energy);
  const auto glass = test::fly({source, mirror, {0, 1}, field}, photons(2000), 0);
  CHECK(glass.counts.stored == 0);
  CHECK(glass.energy.escaped_w == Approx(glass.energy.emitted_w));
  check_sum(glass.energy);
  const auto above = NearField::disc({0, 0, 200}, {0, 0, -1}, 1e6);
  const auto through = test::fly({source, mirror, {0, 1}, above}, photons(2000), 0);
  CHECK(through.energy.received_w == Approx(through.energy.emitted_w).epsilon(0.01));
  CHECK(through.counts.stored > 1900);
}

TEST_CASE("a real near field that only transmits registers what an invisible one does") {
  const auto mirror = test::paraboloid();
  const PointSource source({0, 0, 50}, 1);
  const auto invisible = NearField::disc({0, 0, 0}, {0, 0, 1}, 70);
  const auto clear = NearField::disc({0, 0, 0}, {0, 0, 1}, 70, Material::matt(0, 1));
  const auto a = test::fly({source, mirror, {}, invisible}, photons(5000), 0);
  const auto b = test::fly({source, mirror, {}, clear}, photons(5000), 0);
  CHECK(a.crossings == b.crossings);
  check_sum(b.energy);
}

TEST_CASE("a real near field stops what it absorbs and shades the mirror from behind") {
  const test::FlatMirror mirror(100, 50);
  const PointSource source({0, 0, 0}, 1);
  const auto screen = NearField::disc({0, 0, 60}, {0, 0, 1}, 1000, Material::matt(0));
  const auto dark = test::fly({source, mirror, {}, screen}, photons(1000), 0);
  CHECK(dark.counts.met_mirror == 0);
  CHECK(dark.energy.missed_w == Approx(dark.energy.emitted_w));
  check_sum(dark.energy);
  const auto below = NearField::disc({0, 0, -10}, {0, 0, 1}, 1000, Material::matt(0));
  const auto lit = test::fly({source, mirror, {}, below}, photons(1000), 0);
  CHECK(lit.energy.received_w == Approx(lit.energy.emitted_w));
  CHECK(lit.counts.stored == 1000);
  check_sum(lit.energy);
}

TEST_CASE("a photon that leaves a real near field does not meet it again before the mirror") {
  // a tilted plane: the point where a photon lands lies on either side of it by rounding
  const Vector3 up = Vector3(0.1, 0.2, 1).normalized();
  const auto black = test::sphere(0, 50, -50);
  const PointSource source(30 * up, 1);
  const auto floor = NearField::disc(1 * up, up, 60, Material::matt(1));
  constexpr double count = 20'000;
  const auto traced = test::fly({source, black, {0, 0}, floor}, photons(20'000), 0);
  CHECK(traced.counts.met_mirror == 20'000);
  const double falls = 0.5 * (1 - 29 / std::hypot(29, std::sqrt(2499)));
  const double met_floor = static_cast<double>(traced.counts.interactions) - count;
  CHECK(std::abs(met_floor - count * falls) < 6 * std::sqrt(count * falls * (1 - falls)));
}

TEST_CASE("a photon meets a real near field again after the mirror") {
  // closed by dome and floor; only the floor absorbs, so everything ends there
  const auto dome = test::half_ellipsoid(0, 50, 50);
  const PointSource source({0, 0, 30}, 1);
  const auto floor = NearField::disc({0, 0, 0}, {0, 0, 1}, 50 * (1 + 1e-12), Material::matt(0.5));
  const auto traced = test::fly({source, dome, {1, 0}, floor}, photons(5000), 0);
  CHECK(traced.energy.received_w + traced.energy.missed_w == Approx(traced.energy.emitted_w).epsilon(1e-12));
  CHECK(traced.counts.stored > traced.counts.met_mirror);  // many land more than once
}

TEST_CASE("a photon shut in is cut off, not followed for ever") {
  const auto mirror = test::sphere(0, 50, -50);
  const PointSource source({0, 0, 10}, 1);
  const auto field = NearField::disc({0, 0, -100}, {0, 0, 1}, 10);
  auto options = photons(200);
  options.most_interactions = 100;
  const auto traced = test::fly({source, mirror, {}, field}, options, 0);
  CHECK(traced.energy.cut_off_w == Approx(traced.energy.emitted_w));
  CHECK(traced.counts.interactions == 200 * 100);
  CHECK(traced.counts.met_mirror == 200);
  CHECK(traced.counts.stored == 0);  // the field's plane lies on every path, but behind the mirror
  check_sum(traced.energy);
}

TEST_CASE("impossible options are refused") {
  const auto mirror = test::paraboloid();
  const PointSource source({0, 0, 50}, 1);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 200);
  CHECK_THROWS_AS(trace_photons({source, mirror, {}, field}, photons(most_photons + 1), 0), InputError);
  CHECK_THROWS_AS(test::fly({source, mirror, {0.9, 0.2}, field}, photons(1), 0), InputError);
  auto options = photons(1);
  options.most_interactions = 0;
  CHECK_THROWS_AS(test::fly({source, mirror, {}, field}, options, 0), InputError);
  CHECK_THROWS_AS(PointSource({0, 0, NAN}, 1), InputError);
  CHECK_THROWS_AS(PointSource({0, 0, 0}, -1), InputError);
  CHECK_THROWS_AS(PointSource({0, 0, 0}, HUGE_VAL), InputError);
}

TEST_CASE("photons traced in their planes have the fates and crossings of those traced in space", "[long]") {
  const PointSource source({0, 0, 50}, 1), low({0, 0, -30}, 1);
  const Profile bowl = Profile::bezier({{0, 100, 1}, {50, 100, 1.6}, {90, 50, 1}});
  const Profile pot = Profile::bezier({{0, 110, 1}, {70, 110, 1}, {70, 60, 3}, {25, 20, 1}});
  const Profile shell = Profile::bezier({{30, 90, 1}, {70, 80, 1}, {60, 10, 1}});
  const std::vector<NearField> fields{NearField::disc({0, 0, 0}, {0, 0, 1}, 60),
                                      NearField::disc({10, -20, 5}, {0.3, -0.2, 1}, 80),
                                      NearField::rectangle({30, 0, 70}, {-1, 0.2, 0.1}, {0, 1, 0}, 100, 60),
                                      NearField::disc({0, 5, 20}, {0.1, 0, -1}, 30, Material::matt(0, 0.5))};
  for (const Profile& profile : {bowl, pot, shell})
    for (const NearField& field : fields)
      for (const Material& material : {Material{1, 0}, Material{0.7, 0.2}})
        for (const PointSource* from : {&source, &low}) {
          const auto mirror = cad::make_meridian_reflector(profile);
          const Scene scene{*from, *mirror, material, field};
          // In a pot every bounce magnifies a difference; some bounces are enough to compare.
          const PhotonOptions options{5000, Sampler::random, 3, 1, 6};
          const auto plane = test::fly(scene, options, 20);
          const auto space = test::fly(scene, options, 20, FlightSpace::always_space);
          const double few = 2;  // a photon on a rim or a border may go either way
          CHECK(std::abs(double(plane.counts.met_mirror) - double(space.counts.met_mirror)) <= few);
          CHECK(std::abs(double(plane.counts.stored) - double(space.counts.stored)) <= few);
          CHECK(std::abs(plane.energy.received_w - space.energy.received_w) <= few * plane.photon_power_w);
          CHECK(std::abs(plane.energy.absorbed_w - space.energy.absorbed_w) <= few * plane.photon_power_w);
          CHECK(std::abs(plane.energy.cut_off_w - space.energy.cut_off_w) <= few * plane.photon_power_w);
          std::size_t apart = 0, alike = 0;
          for (std::size_t i = 0, j = 0; i < plane.crossings.size() && j < space.crossings.size();) {
            const Crossing &a = plane.crossings[i], &b = space.crossings[j];
            if (a.photon() != b.photon()) {
              ++(a.photon() < b.photon() ? i : j);
              continue;
            }
            // some 1e-12 of the part at every hit; a grazing bounce magnifies that
            ++((a.plane_mm() - b.plane_mm()).norm() <= 1e-8 && a.from_front() == b.from_front() ? alike
                                                                                                : apart);
            ++i, ++j;
          }
          CAPTURE(apart, alike, few);
          CHECK(apart <= alike / 500);
          CHECK(alike + 20 > space.crossings.size() * 99 / 100);
        }
}
