#include "rayfiles/ray_file.h"

#include <catch2/catch.hpp>

#include "base/random_stream.h"
#include "rayfiles/ray_check.h"
#include "rayfiles/ray_file_writer.h"
#include "support/ray_bytes.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::rayfiles;
using namespace catoptric::test;

namespace {

Vector3 random_direction(RandomStream& random) {
  const double z = 2 * random.uniform() - 1;
  const double azimuth = 2 * 3.14159265358979 * random.uniform();
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

std::vector<float> random_ray(RandomStream& random, std::size_t columns) {
  std::vector<float> ray(columns);
  for (float& number : ray) number = static_cast<float>(random.uniform());
  const Vector3 direction = random_direction(random);
  for (int axis = 0; axis < 3; ++axis)
    ray[3 + static_cast<std::size_t>(axis)] = static_cast<float>(direction[axis]);
  return ray;
}

}  // namespace

TEST_CASE("random rays come back to the bit from both formats, twice the same file") {
  const TemporaryFolder folder;
  Tm25Header all;
  all.has_wavelength = all.has_luminous_flux = all.has_stokes = all.has_tristimulus = true;
  all.additional_columns = {"a", "b"};
  all.spectra = {{{400.0f, 1.0f}, {500.0f, 2.0f}}};
  all.additional_text = "some text";
  ZemaxHeader spectral;
  spectral.rays = ZemaxRays::spectral_color;
  for (const RayFileHeader& header : {RayFileHeader(Tm25Header{}), RayFileHeader(all),
                                      RayFileHeader(ZemaxHeader{}), RayFileHeader(spectral)}) {
    std::vector<std::vector<float>> rays;
    for (const char* name : {"once", "again"}) {
      RandomStream random(1, Purpose::test, 0);
      rays.clear();
      RayFileWriter writer(folder / name, header);
      for (int i = 0; i < 1000; ++i) {
        rays.push_back(random_ray(random, writer.columns().size()));
        writer.add(rays.back());
      }
      writer.commit();
    }
    CHECK(read_whole(folder / "once") == read_whole(folder / "again"));
    const auto file = RayFile::open(folder / "once");
    REQUIRE(file->count() == rays.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      for (std::size_t k = 0; k < rays[i].size(); ++k)
        if (std::bit_cast<std::uint32_t>(file->stored(i, k)) != std::bit_cast<std::uint32_t>(rays[i][k]))
          ++wrong;
    CHECK(wrong == 0);
    const RayCheck check = check_rays(*file);
    CHECK(check.sound());
    CHECK(check.notes.size() == file->header().notes.size());  // the writer's total is the rays'
  }
}

TEST_CASE("the box and the sphere hold all start points, and the sphere is hardly larger than need be") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed, Purpose::test, 0);
    const Vector3 centre = 100 * Vector3(random.uniform(), random.uniform(), random.uniform());
    std::vector<SourceRay> list;
    for (int i = 0; i < 2000; ++i)  // on a sphere of 10 mm, the smallest around them to a few per mille
      list.push_back({centre + 10 * random_direction(random), Vector3::UnitZ(), 1});
    const RayStatistics all = check_rays(ListedRays(list)).statistics;
    bool inside = true;
    for (const SourceRay& ray : list)
      inside = inside && (ray.position_mm - all.sphere.centre_mm).norm() <= all.sphere.radius_mm &&
               (ray.position_mm - all.lowest_mm).minCoeff() >= 0 &&
               (all.highest_mm - ray.position_mm).minCoeff() >= 0;
    INFO(seed << " " << all.sphere.radius_mm);
    CHECK(inside);
    CHECK(all.sphere.radius_mm >= 9.9);
    CHECK(all.sphere.radius_mm <= 10.5);
    CHECK(all.mean_direction == Vector3(0, 0, 1));
  }
}

TEST_CASE("the sphere around a cube, a needle and a plate is theirs to five percent") {
  const auto radius = [](const Vector3& size) {
    RandomStream random(9, Purpose::test, 3);
    std::vector<SourceRay> list;
    for (int i = 0; i < 5000; ++i) {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      list.push_back({size.cwiseProduct(Vector3(x, y, z)), Vector3::UnitZ(), 1});
    }
    for (int corner = 0; corner < 8; ++corner)
      list.push_back(
          {size.cwiseProduct(Vector3(corner & 1, corner >> 1 & 1, corner >> 2)), Vector3::UnitZ(), 1});
    return check_rays(ListedRays(list)).statistics.sphere.radius_mm / (size.norm() / 2);
  };
  for (const Vector3& size : {Vector3(1, 1, 1), Vector3(100, 1, 1), Vector3(10, 10, 0.1), Vector3(3, 2, 1)}) {
    CHECK(radius(size) >= 1);
    CHECK(radius(size) <= 1.05);
  }
}
