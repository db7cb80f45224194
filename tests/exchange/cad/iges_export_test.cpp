#include <catch2/catch.hpp>
#include <cmath>

#include "cad/export.h"
#include "support/cad/sample_profiles.h"
#include "support/iges_parts.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using cad::ExportOptions;
using test::IgesSpline;
using test::TemporaryFolder;

namespace {

std::string exported(const Profile& profile, const ExportOptions& options = {}) {
  const TemporaryFolder folder;
  cad::export_reflector(profile, folder / "mirror.igs", options);
  return test::read_whole(folder / "mirror.igs");
}

/// Whether the file holds the generatrix, poles within `margin` file units.
bool holds(const std::string& file, const Profile& profile, double unit_mm, double margin) {
  for (const IgesSpline& spline : test::iges_splines(file)) {
    if (spline.degree != profile.degree() || spline.points.size() != profile.points().size() ||
        spline.knots != profile.knots())
      continue;
    bool same = true;
    for (std::size_t i = 0; i < spline.points.size(); ++i) {
      const ControlPoint& point = profile.points()[i];
      const double weight = profile.is_rational() ? point.weight : 1;
      same = same && std::abs(spline.points[i][0] - point.r_mm / unit_mm) <= margin &&
             spline.points[i][1] == 0 && std::abs(spline.points[i][2] - point.z_mm / unit_mm) <= margin &&
             spline.weights[i] == weight;
    }
    if (same) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("IGES text holds the generatrix bit for bit, every degree, both modes") {
  for (int degree = 1; degree <= 9; ++degree)
    for (const auto mode : {cad::IgesMode::faces, cad::IgesMode::brep}) {
      ExportOptions options;
      options.iges_mode = mode;
      const Profile profile = test::wavy_profile(degree, degree % 2 == 0);
      const std::string file = exported(profile, options);
      CAPTURE(degree);
      CHECK(holds(file, profile, 1, 0));
      CHECK(test::iges_entities(file, 120).size() == 1);
      CHECK(test::iges_entities(file, mode == cad::IgesMode::faces ? 144 : 510).size() == 1);
    }
}

TEST_CASE("IGES keeps wild weights and multiple knots") {
  for (const Profile& profile : {test::wild_weights_profile(), test::multiple_knots_profile()})
    CHECK(holds(exported(profile), profile, 1, 0));
}

TEST_CASE("IGES units: flag, name and numbers agree") {
  struct Case {
    LengthUnit unit;
    const char* global;
  };
  for (const auto& [unit, global] :
       {Case{LengthUnit::millimetre, ",1.,2,2HMM,"}, Case{LengthUnit::centimetre, ",1.,10,2HCM,"},
        Case{LengthUnit::metre, ",1.,6,1HM,"}, Case{LengthUnit::inch, ",1.,1,4HINCH,"}}) {
    ExportOptions options;
    options.unit = unit;
    const std::string file = exported(test::paraboloid(), options);
    const double unit_mm = millimetres_per(unit);
    CAPTURE(std::string(symbol(unit)));
    CHECK(file.find(global) != std::string::npos);
    CHECK(holds(file, test::paraboloid(), unit_mm, 1e-15 * 100 / unit_mm));
  }
}

TEST_CASE("IGES lines have 80 columns and the same mirror the same bytes") {
  const std::string first = exported(test::wavy_profile(3, true));
  exported(test::paraboloid());
  CHECK(first == exported(test::wavy_profile(3, true)));
  for (std::size_t start = 0; start < first.size();) {
    const std::size_t end = first.find('\n', start);
    REQUIRE(end - start == 80);
    start = end + 1;
  }
}

TEST_CASE("IGES labels: nobody's login name, and a hollerith comma does no harm") {
  ExportOptions options;
  options.author = "Doe, J.; for a customer";
  const std::string file = exported(test::paraboloid(), options);
  CHECK(file.find("Doe, J.; for a customer") != std::string::npos);
  if (const char* user = std::getenv("USER"))
    CHECK(exported(test::paraboloid()).find(user) == std::string::npos);
}

TEST_CASE("A walled mirror goes into IGES as faces and as a solid") {
  for (const auto mode : {cad::IgesMode::faces, cad::IgesMode::brep}) {
    ExportOptions options;
    options.iges_mode = mode;
    options.wall = cad::Wall{2};
    const std::string file = exported(test::paraboloid(), options);
    CHECK(holds(file, test::paraboloid(), 1, 0));
    CHECK(test::iges_entities(file, 186).size() == (mode == cad::IgesMode::brep ? 1u : 0u));
  }
}
