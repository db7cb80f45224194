#include <catch2/catch.hpp>

#include "base/tolerance.h"
#include "cad/export.h"
#include "cad/profile_import.h"
#include "support/cad/sample_profiles.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using test::TemporaryFolder;

TEST_CASE("Mirrors from 1 um to 100 m go through every exact format and unit") {
  const TemporaryFolder folder;
  // Extent is 2.9 times the rim radius: rims of 0.5 um to 100 m.
  for (const double rim_mm : {5e-4, 1e-2, 1.0, 1e3, 1e5})
    for (const char* name : {"mirror.step", "mirror.igs", "mirror.brep"})
      for (const auto unit : {LengthUnit::millimetre, LengthUnit::metre}) {
        const Profile profile = test::paraboloid(rim_mm / 100);
        cad::ExportOptions options;
        options.unit = unit;
        const auto report = cad::export_reflector(profile, folder / name, options);
        CAPTURE(rim_mm, name);
        CHECK(report.largest_deviation_mm <= Tolerance::for_scale(profile.diagonal_mm()).exchange_mm);
        if (std::string(name) == "mirror.brep") continue;
        const Profile back = cad::import_profile(folder / name).profile;
        for (std::size_t i = 0; i < 3; ++i)
          CHECK(std::abs(back.points()[i].z_mm - profile.points()[i].z_mm) <= 1e-15 * rim_mm * 2);
      }
}

TEST_CASE("Walled mirrors of all sizes go through STEP") {
  const TemporaryFolder folder;
  for (const double scale : {1e-4, 1e-2, 1.0, 1e2, 1e3}) {
    cad::ExportOptions options;
    options.wall = cad::Wall{2 * scale};
    CAPTURE(scale);
    CHECK(
        cad::export_reflector(test::paraboloid(scale), folder / "mirror.step", options).figures.face_count ==
        3);
  }
}

TEST_CASE("Beyond these sizes nothing is written") {
  const TemporaryFolder folder;
  for (const double scale : {1e-9, 3e-6, 1e4, 1e12})
    for (const char* name : {"mirror.step", "mirror.igs", "mirror.brep", "mirror.stl", "mirror.glb"})
      CHECK_THROWS_AS(cad::export_reflector(test::paraboloid(scale), folder / name), CadError);
  CHECK(folder.is_empty());
}
