#include "cad/profile_import.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "cad/export.h"
#include "support/cad/profile_files.h"
#include "support/cad/sample_profiles.h"
#include "support/iges_text.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using cad::ImportedProfile;
using cad::ImportOptions;
using test::IgesText;
using test::TemporaryFolder;

namespace {

ImportedProfile imported(const std::string& text, const ImportOptions& options = {},
                         const std::string& name = "profile.igs") {
  const TemporaryFolder folder;
  test::write_whole(folder / name, text);
  return cad::import_profile(folder / name, options);
}

/// What the refusal says, all of it.
std::string refusal(const std::string& text, const ImportOptions& options = {},
                    const std::string& name = "profile.igs") {
  try {
    imported(text, options, name);
  } catch (const CadError& error) {
    CHECK(!error.parts().hint.empty());
    return error.what();
  }
  return "";
}

bool mentions(const std::vector<std::string>& notes, const std::string& what) {
  for (const std::string& note : notes)
    if (note.find(what) != std::string::npos) return true;
  return false;
}

void check_points(const Profile& profile, const std::vector<ControlPoint>& expected, double margin_mm) {
  REQUIRE(profile.points().size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CAPTURE(i, profile.points()[i].r_mm, profile.points()[i].z_mm, profile.points()[i].weight);
    CHECK(std::abs(profile.points()[i].r_mm - expected[i].r_mm) <= margin_mm);
    CHECK(std::abs(profile.points()[i].z_mm - expected[i].z_mm) <= margin_mm);
    CHECK(std::abs(profile.points()[i].weight - expected[i].weight) <= 1e-15 * expected[i].weight);
  }
}

/// Largest distance of the profile's points from a meridian given as a function that is 0 on it, in mm.
template <typename Function>
double off(const Profile& profile, const Function& distance) {
  double greatest = 0;
  for (int i = 0; i <= 200; ++i) {
    const double u =
        profile.first_parameter() + (profile.last_parameter() - profile.first_parameter()) * i / 200;
    const MeridianPoint p = profile.at(u);
    greatest = std::max(greatest, std::abs(distance(p.r_mm, p.z_mm)));
  }
  return greatest;
}

constexpr double roundings = 1e-12;  // of numbers near 100 mm: some ten of them

}  // namespace

TEST_CASE("IGES 126: control points, weights and knots as they are, in mm") {
  const ImportedProfile found = imported(test::start_a_text());
  check_points(found.profile, {{0, 100, 1}, {50, 100, 1.6}, {90, 50, 1}}, 0);
  CHECK(found.profile.knots() == std::vector<double>{0, 0, 0, 1, 1, 1});
  CHECK(mentions(found.notes, "CM"));
  CHECK(mentions(found.notes, "IGES 126"));
  CHECK(mentions(found.notes, "z axis"));
  CHECK(found.candidates.size() == 1);
}

TEST_CASE("A profile in any plane about any axis: the same (r, z)") {
  const ImportedProfile found = imported(test::start_a_tilted_text());
  // z = 0 where the file's origin falls on the axis: (1, 2, 3) cm lies 26/7 cm farther along (2, 3, 6)/7.
  check_points(found.profile,
               {{0, 1000. / 10 + 260. / 7, 1}, {50, 100 + 260. / 7, 1.6}, {90, 50 + 260. / 7, 1}}, roundings);
  CHECK(mentions(found.notes, "axis from the line"));
  SECTION("with the axis said, z runs from its origin") {
    ImportOptions options;
    options.axis = cad::Axis{{10, 20, 30}, {4, 6, 12}};
    check_points(imported(test::start_a_tilted_text(), options).profile,
                 {{0, 100, 1}, {50, 100, 1.6}, {90, 50, 1}}, roundings);
  }
  SECTION("an axis said the other way round turns z round") {
    ImportOptions options;
    options.axis = cad::Axis{{10, 20, 30}, {-4, -6, -12}};
    check_points(imported(test::start_a_tilted_text(), options).profile,
                 {{0, -100, 1}, {50, -100, 1.6}, {90, -50, 1}}, roundings);
  }
}

TEST_CASE("Any of 24 turned positions gives the same profile") {
  for (int turn = 0; turn < 24; ++turn) {
    const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(0.1 + turn, Vector3(1, 2, 3).normalized()) *
                                      Eigen::AngleAxisd(turn % 4, Vector3::UnitZ()))
                                         .toRotationMatrix();
    const Vector3 shift(3 * turn, -40, 7);
    const auto place = [&](double r, double z) {
      const Vector3 p = rotation * Vector3(r, 0, z) + shift;
      return IgesText::Point{p.x(), p.y(), p.z()};
    };
    IgesText file;
    file.line(place(0, -10), place(0, 200));
    file.spline(2, {0, 0, 0, 1, 1, 1}, {1, 0.5, 1}, {place(80, 40), place(45, 90), place(5, 100)});
    const double zero = -(rotation * Vector3::UnitZ()).dot(-shift);
    check_points(imported(file.text()).profile,
                 {{5, 100 + zero, 1}, {45, 90 + zero, 0.5}, {80, 40 + zero, 1}}, roundings);
  }
}

TEST_CASE("IGES units") {
  struct Case {
    int flag;
    const char* name;
    double mm;
  };
  for (const auto& [flag, name, mm] :
       {Case{1, "INCH", 25.4}, Case{2, "MM", 1}, Case{6, "M", 1000}, Case{10, "CM", 10}}) {
    IgesText file(flag, name);
    file.spline(2, {0, 0, 0, 1, 1, 1}, {1, 1, 1}, {{0, 0, 10}, {5, 0, 10}, {9, 0, 5}});
    CAPTURE(name);
    check_points(imported(file.text()).profile, {{0, 10 * mm, 1}, {5 * mm, 10 * mm, 1}, {9 * mm, 5 * mm, 1}},
                 1e-15 * 10 * mm);
  }
}

TEST_CASE("IGES 100 and 110 in a 102: the arc is exact, the pieces are joined") {
  const ImportedProfile found = imported(test::cap_and_skirt_text());
  CHECK(found.profile.degree() == 2);
  CHECK(mentions(found.notes, "joined 2 pieces: 1 arc, 1 line"));
  CHECK(off(found.profile, [](double r, double z) {
          return r <= 30 ? std::hypot(r, z - 50) - 50 : (z - (90 - (r - 30) * 4 / 3)) * 0.6;
        }) < roundings);
  CHECK(found.profile.points().front().r_mm == 0);
  CHECK(found.profile.points().back().r_mm == 60);
}

TEST_CASE("IGES 106: a polyline of degree 1") {
  const Profile profile = imported(test::facets_text()).profile;
  CHECK(profile.degree() == 1);
  check_points(profile, {{0, 100, 1}, {40, 95, 1}, {80, 60, 1}, {85, 10, 1}}, 0);
}

TEST_CASE("IGES 104: conics by their equations, which OCCT itself reads wrong") {
  const auto conic = [](int form, std::array<double, 6> c, std::array<double, 2> from,
                        std::array<double, 2> to) {
    IgesText file;
    const int plane = file.matrix(test::upright(100));
    file.conic(form, c, from, to, plane);
    return imported(file.text()).profile;
  };
  SECTION("parabola") {
    check_points(imported(test::parabola_text()).profile, {{0, 100, 1}, {50, 100, 1}, {100, 50, 1}},
                 roundings);
  }
  SECTION("ellipse, major axis along the mirror's axis") {
    const Profile profile = conic(1, {1. / 1600, 0, 1. / 3600, 0, 0, -1}, {40, 0}, {0, 60});
    CHECK(off(profile, [](double r, double z) { return std::hypot(r / 40, (z - 100) / 60) * 40 - 40; }) <
          roundings);
    CHECK(profile.points().front().z_mm == 160);
  }
  SECTION("ellipse, major axis across") {
    const Profile profile = conic(1, {1. / 3600, 0, 1. / 1600, 0, 0, -1}, {60, 0}, {0, 40});
    CHECK(off(profile, [](double r, double z) { return std::hypot(r / 60, (z - 100) / 40) * 40 - 40; }) <
          roundings);
  }
  SECTION("hyperbola") {
    const Profile profile = conic(2, {-1. / 3600, 0, 1. / 1600, 0, 0, -1}, {0, 40}, {60, 40 * std::sqrt(2.)});
    CHECK(off(profile, [](double r, double z) { return z - 100 - 40 * std::hypot(1, r / 60); }) < roundings);
  }
  SECTION("within a composite") {
    IgesText file;
    const int plane = file.matrix(test::upright(100));
    const int parabola =
        file.conic(3, {0.005, 0, 0, 0, 1, 0}, {0, 0}, {100, -50}, plane, IgesText::Role::dependent);
    const int line = file.line({100, 0, 50}, {110, 0, 20}, IgesText::Role::dependent);
    file.composite({parabola, line});
    const Profile profile = imported(file.text()).profile;
    CHECK(off(profile, [](double r, double z) {
            return r <= 100 ? z - 100 + r * r / 200 : z - 50 + 3 * (r - 100);
          }) < roundings);
  }
  SECTION("a surface of revolution on a conic is refused rather than read wrong") {
    IgesText file;
    const int plane = file.matrix(test::upright(100));
    const int parabola =
        file.conic(3, {0.005, 0, 0, 0, 1, 0}, {0, 0}, {100, -50}, plane, IgesText::Role::dependent);
    const int axis = file.line({0, 0, 0}, {0, 0, 1}, IgesText::Role::dependent);
    file.add({120, 0, std::to_string(axis) + "," + std::to_string(parabola) + ",0.,6.283185307179586"});
    CHECK(refusal(file.text()).find("IGES 104") != std::string::npos);
  }
}

TEST_CASE("IGES 112 and 130") {
  SECTION("parametric spline, power basis: x = 100 t, z = 100 - 50 t^2") {
    IgesText file;
    file.add({112, 0,
              "3,1,3,1,0.,1.,0.,100.,0.,0.,0.,0.,0.,0.,100.,0.,-50.,0.,100.,100.,0.,0.,0.,0.,0.,0.,50.,-100.,"
              "-50.,0."});
    CHECK(off(imported(file.text()).profile, [](double r, double z) { return z - 100 + r * r / 200; }) <
          roundings);
  }
  SECTION("offset of an arc by 1 mm, approximated within 1e-6 and said so") {
    IgesText file;
    const int plane = file.matrix(test::upright(100));
    const int arc = file.arc(0, {0, -50}, {30, -10}, {0, 0}, plane, IgesText::Role::dependent);
    file.add({130, 0, std::to_string(arc) + ",1,0,0,0,1.,0.,0.,0.,0.,-1.,0.,0.,1."});
    const ImportedProfile found = imported(file.text());
    const double size_mm = std::hypot(30, 10);
    const double inner = off(found.profile, [](double r, double z) { return std::hypot(r, z - 50) - 49; });
    const double outer = off(found.profile, [](double r, double z) { return std::hypot(r, z - 50) - 51; });
    CHECK(std::min(inner, outer) < 1e-6 * size_mm);
    CHECK(mentions(found.notes, "largest deviation"));
  }
}

TEST_CASE("The committed profiles are what the generator writes, and all can be imported") {
  for (const auto& [name, text] : test::profile_files()) {
    CAPTURE(name);
    CHECK(test::read_whole(std::string(CATOPTRIC_DATA "/profiles/") + name) == text);
    CHECK_NOTHROW(cad::import_profile(std::string(CATOPTRIC_DATA "/profiles/") + name));
  }
}

TEST_CASE("What we export comes back as it was, from STEP and IGES, every degree") {
  const TemporaryFolder folder;
  for (int degree = 1; degree <= 9; ++degree)
    for (const char* name : {"mirror.step", "mirror.igs"}) {
      const Profile profile = test::wavy_profile(degree, true);
      cad::export_reflector(profile, folder / name);
      const ImportedProfile found = cad::import_profile(folder / name);
      CAPTURE(degree, name);
      CHECK(found.profile == profile);
      CHECK(mentions(found.notes, "meridian of a surface of revolution"));
    }
}

TEST_CASE("A walled mirror offers its faces and asks which") {
  const TemporaryFolder folder;
  cad::ExportOptions walled;
  walled.wall = cad::Wall{2};
  cad::export_reflector(test::paraboloid(), folder / "mirror.step", walled);
  CHECK_THROWS_WITH(cad::import_profile(folder / "mirror.step"),
                    Catch::Contains("several curves") && Catch::Contains("cone"));
  int found = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    ImportOptions options;
    options.candidate = i;
    found += cad::import_profile(folder / "mirror.step", options).profile == test::paraboloid();
  }
  CHECK(found == 1);
  ImportOptions beyond;
  beyond.candidate = 3;
  CHECK_THROWS_WITH(cad::import_profile(folder / "mirror.step", beyond), Catch::Contains("no curve 3"));
}

TEST_CASE("Two curves: listed, and chosen by number") {
  IgesText file;
  file.spline(2, {0, 0, 0, 1, 1, 1}, {1, 1, 1}, {{0, 0, 100}, {50, 0, 100}, {90, 0, 50}});
  file.polyline({{0, 0, 90}, {40, 0, 80}});
  const std::string message = refusal(file.text());
  CHECK(message.find("[0] rational B-spline (IGES 126") != std::string::npos);
  CHECK(message.find("[1] polyline (IGES 106") != std::string::npos);
  ImportOptions second;
  second.candidate = 1;
  CHECK(imported(file.text(), second).profile.degree() == 1);
}

TEST_CASE("Axes: which one is taken and which is told") {
  const auto along = [](IgesText::Point a, IgesText::Point b) {
    IgesText file;
    file.polyline({a, {(a[0] + b[0]) / 2 + 1, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2 + 1}, b});
    return imported(file.text());
  };
  SECTION("y, when the profile is drawn in the xy plane") {
    IgesText file;
    file.spline(2, {0, 0, 0, 1, 1, 1}, {1, 1, 1}, {{0, 100, 0}, {50, 100, 0}, {100, 50, 0}});
    check_points(imported(file.text()).profile, {{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}, 0);
  }
  SECTION("ends on two axes: z, and x is mentioned") {
    const ImportedProfile found = along({0, 0, 100}, {100, 0, 0});
    CHECK(mentions(found.notes, "z axis"));
    CHECK(mentions(found.notes, "(x would do too"));
  }
  SECTION("a curve from rim to vertex is turned round") {
    const ImportedProfile found = along({90, 0, 20}, {0, 0, 100});
    CHECK(found.profile.points().front().r_mm == 0);
    CHECK(mentions(found.notes, "turned round"));
  }
}

TEST_CASE("Refusals name the trouble and a remedy") {
  SECTION("a gap") {
    IgesText file;
    const int a = file.line({0, 0, 100}, {30, 0, 90}, IgesText::Role::dependent);
    const int b = file.line({30, 0, 89.9}, {60, 0, 50}, IgesText::Role::dependent);
    file.composite({a, b});
    CHECK_THAT(refusal(file.text()), Catch::Contains("gap") && Catch::Contains("0.1 mm"));
  }
  SECTION("a curve out of every plane with an axis") {
    IgesText file;
    file.spline(3, {0, 0, 0, 0, 1, 1, 1, 1}, {1, 1, 1, 1}, {{0, 0, 10}, {5, 1, 10}, {9, 2, 5}, {10, -1, 0}});
    CHECK_THAT(refusal(file.text()), Catch::Contains("no axis"));
  }
  SECTION("a planar curve whose plane misses the axis that was said") {
    ImportOptions options;
    options.axis = cad::Axis{{0, 5, 0}, {0, 0, 1}};
    CHECK_THAT(refusal(test::start_a_text(), options), Catch::Contains("leaves the plane"));
  }
  SECTION("across the axis") {
    IgesText file;
    file.spline(2, {0, 0, 0, 1, 1, 1}, {1, 1, 1}, {{-5, 0, 10}, {5, 0, 10}, {9, 0, 5}});
    CHECK_THAT(refusal(file.text()), Catch::Contains("crosses the axis by 5 mm"));
  }
  SECTION("an axis that is none") {
    for (const Vector3& direction : {Vector3(0, 0, 0), Vector3(0, 0, std::nan(""))}) {
      ImportOptions options;
      options.axis = cad::Axis{{0, 0, 0}, direction};
      CHECK_THAT(refusal(test::start_a_text(), options), Catch::Contains("axis"));
    }
  }
  SECTION("a curve on the axis") {
    IgesText file;
    file.polyline({{0, 0, 0}, {0, 0, 10}});
    CHECK(!refusal(file.text()).empty());
  }
  SECTION("a file without a curve") {
    IgesText file;
    file.add({116, 0, "1.,2.,3.,0"});
    CHECK_THAT(refusal(file.text()), Catch::Contains("no free curve"));
  }
}
