#include "cad/surface_import.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/errors.h"
#include "base/profile.h"
#include "cad/engines.h"
#include "cad/export.h"
#include "support/temporary_folder.h"

/// Faces of files as light meets them.

using namespace catoptric;
using catoptric::test::TemporaryFolder;

namespace {

const Profile paraboloid = Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}});

/// Rays from the focus to all sides of the mirror.
std::vector<Ray> rays() {
  std::vector<Ray> list;
  for (int i = 0; i < 400; ++i) {
    const double cosine = 1 - 0.99 * (i + 0.5) / 400, azimuth = 2.399963 * i,
                 sine = std::sqrt(1 - cosine * cosine);
    list.push_back({{0, 0, 50}, {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine}});
  }
  return list;
}

}  // namespace

TEST_CASE("Faces of a file are met where the mirror is that they were written from, in any unit of length") {
  const TemporaryFolder folder;
  const auto mirror = cad::make_meridian_reflector(paraboloid);
  const auto probe = mirror->probe();
  for (const char* name : {"mirror.step", "mirror.igs"})
    for (const auto unit : {LengthUnit::millimetre, LengthUnit::inch})
      for (const double chord : {1e-2, 1e-4}) {
        cad::ExportOptions options;
        options.unit = unit;
        cad::export_reflector(paraboloid, folder / name, options);
        const cad::ImportedSurface found = cad::import_surface(folder / name, {chord});
        CAPTURE(name, chord, found.facets->corners.size());
        CHECK(found.faces == 1);
        CHECK(found.greatest_mm.z() == Approx(100).epsilon(1e-6));
        const double size_mm = (found.greatest_mm - found.least_mm).norm();
        double worst_mm = 0;
        int odd = 0;  // slivers about the apex, where the mesher's corners crowd
        for (const Ray& ray : rays()) {
          const auto wanted = probe->first_hit(ray, 0);
          const auto met = found.shape->meet(ray, false, 1e9);
          REQUIRE(wanted.has_value() == met.has_value());
          if (!wanted) continue;
          worst_mm = std::max(worst_mm, std::abs(wanted->distance_mm - met->distance_mm));
          // From there it goes out through the mouth, and the facet it starts on is not in its way.
          const Vector3 there = ray.origin_mm + met->distance_mm * ray.direction;
          if (std::abs(met->normal.dot(wanted->normal)) < 1 - 20 * chord ||
              found.shape->meet({there, Vector3(0, 0, -1)}, true, 1e9))
            ++odd;
          CHECK_FALSE(found.shape->meet(ray, false, 0.9 * met->distance_mm));
        }
        CHECK(odd <= 3);
        CHECK(worst_mm < 3 * chord * size_mm);
        CHECK(worst_mm > 1e-4 * chord * size_mm);  // facets they are
      }
}

TEST_CASE("Files that hold no faces, or are none, are refused by their names") {
  const TemporaryFolder folder;
  test::write_whole(folder / "broken.step", "ISO-10303-21;\nHEADER;\n");
  CHECK_THROWS_WITH(cad::import_surface(folder / "broken.step"), Catch::Contains("broken.step"));
  CHECK_THROWS_WITH(cad::import_surface(folder / "nothing.step"), Catch::Contains("nothing.step"));
  CHECK_THROWS_WITH(cad::import_surface(std::string(CATOPTRIC_DATA) + "/profiles/start_a.igs"),
                    Catch::Contains("start_a.igs") && Catch::Contains("holds no"));
  CHECK_THROWS_WITH(cad::import_surface(std::string(CATOPTRIC_DATA) + "/profiles/start_a.igs", {1e-9}),
                    Catch::Contains("out of range"));
}
