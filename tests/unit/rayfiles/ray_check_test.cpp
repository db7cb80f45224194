#include "rayfiles/ray_check.h"

#include <catch2/catch.hpp>
#include <limits>

#include "rayfiles/ray_file.h"
#include "support/ray_bytes.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::rayfiles;
using namespace catoptric::test;

TEST_CASE("what rays are together is found, dark ones left out") {
  const TemporaryFolder folder;
  write_whole(folder / "rays", tm25_file(3, three_rays()));
  const RayCheck check = check_rays(*RayFile::open(folder / "rays"));
  CHECK(check.sound());
  CHECK_NOTHROW(require_sound(check));
  CHECK(check.notes.empty());
  const RayStatistics& all = check.statistics;
  CHECK(all.lit == 2);
  CHECK(all.total_flux == 3);
  CHECK(all.least_flux == 0);
  CHECK(all.greatest_flux == 2);
  CHECK(!all.equal_flux);
  CHECK(all.lowest_mm == Vector3(1, 2, 3));
  CHECK(all.highest_mm == Vector3(4, 5, 6));
  CHECK((all.sphere.centre_mm - Vector3(2.5, 3.5, 4.5)).norm() < 0.01);
  CHECK(all.sphere.radius_mm == Approx(std::sqrt(6.75)).epsilon(0.005));
  CHECK((all.mean_direction - Vector3(1.2, 0, 1 - 1.6) / 3).norm() < 1e-7);
  CHECK(*all.total_deviation_rel == 0);
}

TEST_CASE("each fault of a ray is found with its file, number, byte, field and rule") {
  const TemporaryFolder folder;
  const std::string sound = tm25_file(3, three_rays());
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                  infinity = std::numeric_limits<float>::infinity();
  const auto found = [&](std::size_t number, float value, const char* what, const char* field) {
    const std::size_t at = 36288 + 28 + 4 * number;  // the second ray's
    INFO(what);
    write_whole(folder / "rays", with_f32(sound, at, value));
    const RayCheck check = check_rays(*RayFile::open(folder / "rays"));
    REQUIRE(check.findings.size() == 1);
    CHECK(check.findings[0].count == 1);
    CHECK_THROWS_WITH(require_sound(check), Catch::Contains(what) &&
                                                Catch::Contains("ray 1 (the first is 0), byte ") &&
                                                Catch::Contains(field));
    CHECK(check.statistics.total_flux == 1);  // the rays without fault
  };
  found(0, nan, "start point is not finite", "byte 36316, x to z");
  found(2, infinity, "start point is not finite", "x to z");
  found(3, nan, "direction is not finite", "byte 36328, kx to kz");
  found(5, -infinity, "direction is not finite", "kx to kz");
  found(5, -0.7f, "far from unit length", "kx to kz");
  found(6, nan, "flux is not finite", "byte 36340, phi");
  found(6, -1e-30f, "flux is negative", "phi");
}

TEST_CASE("a direction of no length is found, and comes as it is") {
  const ListedRays rays({{Vector3::Zero(), Vector3::Zero(), 1}, {Vector3::Zero(), Vector3::UnitX(), 1}});
  CHECK(check_rays(rays).findings.at(0).parts.what == "a direction has no length");
  CHECK(rays.ray(0).direction == Vector3::Zero());
}

TEST_CASE("directions with few decimals pass, and the rule has its edge where it says") {
  const auto passes = [](double length) {
    return check_rays(ListedRays({{Vector3::Zero(), {0, 0, length}, 1}})).sound();
  };
  CHECK(passes(0.9951));
  CHECK(passes(1.0049));
  CHECK(!passes(0.9949));
  CHECK(!passes(1.0051));
}

TEST_CASE("rays that break the same rule are counted, the first is shown") {
  std::vector<SourceRay> list(10, {Vector3::Zero(), Vector3::UnitZ(), 1});
  list[4].flux = list[7].flux = -1;
  list[5].direction.setZero();
  const RayCheck check = check_rays(ListedRays(list));
  REQUIRE(check.findings.size() == 2);
  CHECK(check.findings[0].count == 2);
  CHECK(check.findings[0].parts.where == "list, ray 4");
  CHECK(check.findings[1].parts.where == "list, ray 5");
  CHECK_THROWS_WITH(require_sound(check), Catch::Contains("2 rays break this"));
  CHECK(!check.statistics.equal_flux);
}

TEST_CASE("a header's total that is not the rays' is a note") {
  ListedRays rays({{Vector3::Zero(), Vector3::UnitZ(), 2}});
  const auto notes = [&](double total) {
    rays.header_.total_flux = total;
    return check_rays(rays).notes.size();
  };
  CHECK(notes(2.0019) == 0);
  CHECK(notes(2.0021) == 1);
  CHECK(notes(1.9979) == 1);
  CHECK(notes(0) == 1);
  CHECK(check_rays(rays).notes[0] == "the rays' fluxes add up to 2 W, the header says 0 W");
}

TEST_CASE("rays without any flux are a finding") {
  const RayCheck check = check_rays(ListedRays({{Vector3::Zero(), Vector3::UnitZ(), 0}}));
  CHECK_THROWS_WITH(require_sound(check), Catch::Contains("no ray carries flux"));
  CHECK(check.statistics.lit == 0);
}

TEST_CASE("rays of one flux are known as such") {
  const SourceRay ray{Vector3(1, 2, 3), Vector3::UnitZ(), 0.25};
  const RayStatistics all = check_rays(ListedRays(std::vector<SourceRay>(100, ray))).statistics;
  CHECK(all.equal_flux);
  CHECK(all.sphere.radius_mm == 0);
  CHECK(all.sphere.centre_mm == ray.position_mm);
}
