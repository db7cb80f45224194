#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "cad/export.h"
#include "support/cad/sample_profiles.h"
#include "support/step_text.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using cad::ExportOptions;
using test::StepGeneratrix;
using test::StepText;
using test::TemporaryFolder;

namespace {

/// The one generatrix of the file that an export of the open surface leaves, read as text.
StepGeneratrix written_generatrix(const Profile& profile, const ExportOptions& options = {}) {
  const TemporaryFolder folder;
  cad::export_reflector(profile, folder / "mirror.step", options);
  const StepText file(test::read_whole(folder / "mirror.step"));
  CHECK(file.dangling().empty());
  const auto found = test::generatrices(file);
  REQUIRE(found.size() == 1);
  return found.front();
}

/// Largest difference between a pole in the file and the profile's, in file units.
double pole_difference(const StepGeneratrix& file, const Profile& profile, double unit_mm) {
  double greatest = 0;
  for (std::size_t i = 0; i < profile.points().size(); ++i) {
    const ControlPoint& point = profile.points()[i];
    greatest = std::max({greatest, std::abs(file.poles[i][0] - point.r_mm / unit_mm),
                         std::abs(file.poles[i][1]), std::abs(file.poles[i][2] - point.z_mm / unit_mm)});
  }
  return greatest;
}

/// The text without the line breaks of its layout.
std::string unwrapped(const std::string& content) {
  std::string text;
  bool at_start = false;
  for (const char c : content) {
    if (c == '\n') at_start = true;
    if (c == '\n' || (at_start && c == ' ')) continue;
    at_start = false;
    text += c;
  }
  return text;
}

}  // namespace

TEST_CASE("STEP text holds the generatrix bit for bit, every degree") {
  for (int degree = 1; degree <= 9; ++degree)
    for (const bool rational : {false, true}) {
      const Profile profile = test::wavy_profile(degree, rational);
      const StepGeneratrix file = written_generatrix(profile);
      CAPTURE(degree, rational);
      CHECK(file.degree == degree);
      REQUIRE(file.poles.size() == profile.points().size());
      CHECK(pole_difference(file, profile, 1) == 0);
      CHECK(file.flat_knots == profile.knots());
      REQUIRE(file.weights.size() == (rational ? profile.points().size() : 0));
      for (std::size_t i = 0; i < file.weights.size(); ++i)
        CHECK(file.weights[i] == profile.points()[i].weight);
      CHECK(file.axis_point == std::vector<double>{0, 0, 0});
      CHECK(file.axis_direction == std::vector<double>{0, 0, 1});
    }
}

TEST_CASE("STEP keeps weights from 1e-8 to 1e8, multiple knots and repeated poles") {
  SECTION("weights") {
    const Profile profile = test::wild_weights_profile();
    const StepGeneratrix file = written_generatrix(profile);
    for (std::size_t i = 0; i < profile.points().size(); ++i)
      CHECK(file.weights[i] == profile.points()[i].weight);
  }
  SECTION("knots of every multiplicity up to the degree") {
    const Profile profile = test::multiple_knots_profile();
    const StepGeneratrix file = written_generatrix(profile);
    CHECK(file.flat_knots == profile.knots());
    CHECK(pole_difference(file, profile, 1) == 0);
  }
  SECTION("a repeated pole at the vertex") {
    const Profile profile = Profile::bezier({{0, 100, 1}, {0, 100, 1}, {50, 100, 2}, {100, 50, 1}});
    CHECK(pole_difference(written_generatrix(profile), profile, 1) == 0);
  }
  SECTION("numbers too small for the printer's 23 characters") {
    const Profile profile = Profile::bezier({{0, 1e-120, 1}, {50, -1e-300, 2}, {100, 50, 1}});
    CHECK(pole_difference(written_generatrix(profile), profile, 1) <
          1e-119);  // they are written with 15 digits
  }
}

TEST_CASE("Equal weights are the same curve without weights") {
  const Profile profile = Profile::bezier({{0, 100, 2}, {50, 100, 2}, {100, 50, 2}});
  CHECK(written_generatrix(profile).weights.empty());
}

TEST_CASE("An unclamped knot vector is written clamped, the same curve") {
  const Profile profile(2, {0, 1, 2, 3, 4, 5, 6}, {{10, 100, 1}, {40, 100, 2}, {60, 90, 1}, {80, 60, 1}});
  const StepGeneratrix file = written_generatrix(profile);
  CHECK(file.flat_knots == std::vector<double>{2, 2, 2, 3, 4, 4, 4});
  const MeridianPoint start = profile.at(2), end = profile.at(4);
  CHECK(std::abs(file.poles.front()[0] - start.r_mm) < 1e-13);  // two knot insertions of numbers near 100
  CHECK(std::abs(file.poles.back()[2] - end.z_mm) < 1e-13);
}

TEST_CASE("File units: the numbers change, the mirror does not") {
  const Profile profile = test::paraboloid();
  struct Case {
    LengthUnit unit;
    const char* text;
  };
  for (const auto& [unit, text] : {Case{LengthUnit::millimetre, "SI_UNIT(.MILLI.,.METRE.)"},
                                   Case{LengthUnit::centimetre, "SI_UNIT(.CENTI.,.METRE.)"},
                                   Case{LengthUnit::metre, "SI_UNIT($,.METRE.)"},
                                   Case{LengthUnit::inch, "CONVERSION_BASED_UNIT('INCH'"}}) {
    const TemporaryFolder folder;
    ExportOptions options;
    options.unit = unit;
    const auto report = cad::export_reflector(profile, folder / "mirror.stp", options);
    std::string content = test::read_whole(folder / "mirror.stp");
    const auto generatrix = test::generatrices(StepText(content)).front();
    CAPTURE(std::string(symbol(unit)));
    CHECK(content.find(text) != std::string::npos);
    const double unit_mm = millimetres_per(unit);
    CHECK(pole_difference(generatrix, profile, unit_mm) <= 1e-15 * 100 / unit_mm);  // a few roundings
    CHECK(report.largest_deviation_mm <= 1e-13);
  }
}

TEST_CASE("All three schemas hold the same generatrix") {
  struct Case {
    cad::StepSchema schema;
    const char* name;
  };
  for (const auto& [schema, name] :
       {Case{cad::StepSchema::ap203, "CONFIG_CONTROL_DESIGN"},
        Case{cad::StepSchema::ap214, "AUTOMOTIVE_DESIGN"},
        Case{cad::StepSchema::ap242, "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING"}}) {
    const TemporaryFolder folder;
    ExportOptions options;
    options.schema = schema;
    options.wall = cad::Wall{2};
    cad::export_reflector(test::paraboloid(), folder / "mirror.step", options);
    const std::string content = test::read_whole(folder / "mirror.step");
    CAPTURE(name);
    CHECK(content.find(name) != std::string::npos);
    const StepText file(content);
    CHECK(file.all("MANIFOLD_SOLID_BREP").size() == 1);
    bool found = false;
    for (const auto& each : test::generatrices(file))
      found = found || (each.poles.size() == 3 && pole_difference(each, test::paraboloid(), 1) == 0);
    CHECK(found);
  }
}

TEST_CASE("The same mirror gives the same bytes, again and again in one process") {
  const TemporaryFolder folder;
  for (const auto schema : {cad::StepSchema::ap203, cad::StepSchema::ap214}) {
    ExportOptions options;
    options.schema = schema;
    options.wall = cad::Wall{1};
    cad::export_reflector(test::paraboloid(), folder / "mirror.step", options);
    const std::string first = test::read_whole(folder / "mirror.step");
    cad::export_reflector(test::wavy_profile(3, true), folder / "other.step", options);
    cad::export_reflector(test::paraboloid(), folder / "mirror.step", options);
    CHECK(first == test::read_whole(folder / "mirror.step"));
  }
}

TEST_CASE("Labels are those that were asked for, and nobody else's name") {
  const TemporaryFolder folder;
  ExportOptions options;
  options.schema = cad::StepSchema::ap203;  // the one that asks for persons and dates
  options.product = "downlight 'A'";
  options.author = "a lighting engineer";
  options.organization = "a firm";
  options.time_stamp = "2026-01-31T12:34:56";
  cad::export_reflector(test::paraboloid(), folder / "mirror.step", options);
  const std::string content = unwrapped(test::read_whole(folder / "mirror.step"));
  CHECK(content.find("PRODUCT('downlight ''A''','downlight ''A'''") != std::string::npos);
  CHECK(content.find("FILE_NAME('mirror.step','2026-01-31T12:34:56',('a lighting engineer'),('a firm')") !=
        std::string::npos);
  CHECK(content.find("CALENDAR_DATE(2026,31,1)") != std::string::npos);
  if (const char* user = std::getenv("USER"))
    CHECK(content.find("'" + std::string(user) + "'") == std::string::npos);
}

TEST_CASE("The time stamp is 1970 unless the environment says another") {
  const TemporaryFolder folder;
  ::unsetenv("SOURCE_DATE_EPOCH");
  cad::export_reflector(test::paraboloid(), folder / "a.step");
  CHECK(test::read_whole(folder / "a.step").find("'1970-01-01T00:00:00'") != std::string::npos);
  ::setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  cad::export_reflector(test::paraboloid(), folder / "a.step");
  CHECK(test::read_whole(folder / "a.step").find("'2023-11-14T22:13:20'") != std::string::npos);
  ::setenv("SOURCE_DATE_EPOCH", "yesterday", 1);
  CHECK_THROWS_AS(cad::export_reflector(test::paraboloid(), folder / "b.step"), InputError);
  ::unsetenv("SOURCE_DATE_EPOCH");
}

TEST_CASE("Options that make no file make no file") {
  const TemporaryFolder folder;
  ExportOptions options;
  SECTION("labels beyond ASCII") {
    options.product =
        "r\xc3\xa9"
        "flecteur";
    CHECK_THROWS_AS(cad::export_reflector(test::paraboloid(), folder / "a.step", options), InputError);
  }
  SECTION("a line break in a label") {
    options.author = "a\nb";
    CHECK_THROWS_AS(cad::export_reflector(test::paraboloid(), folder / "a.igs", options), InputError);
  }
  SECTION("a time stamp of another form") {
    for (const char* stamp :
         {"today", "2026-13-01T00:00:00", "2026-01-01 00:00:00", "2026-01-01T00:00:00Z"}) {
      options.time_stamp = stamp;
      CHECK_THROWS_AS(cad::export_reflector(test::paraboloid(), folder / "a.step", options), InputError);
    }
  }
  SECTION("an unknown extension") {
    for (const char* name : {"a.obj", "a", "a.gltf", "a.step.txt"})
      CHECK_THROWS_AS(cad::export_reflector(test::paraboloid(), folder / name, options), CadError);
  }
  SECTION("a folder that is not there") {
    CHECK_THROWS_AS(cad::export_reflector(test::paraboloid(), folder / "no/a.step", options), IoError);
  }
  SECTION("a wall that cannot be") {
    options.wall = cad::Wall{-1};
    CHECK_THROWS_AS(cad::export_reflector(test::paraboloid(), folder / "a.step", options), CadError);
  }
  CHECK(folder.is_empty());
}
