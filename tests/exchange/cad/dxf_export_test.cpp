#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "cad/detail/section_drawing.h"
#include "cad/export.h"
#include "cad/opening.h"
#include "support/cad/lamp_mirror.h"
#include "support/cad/sample_profiles.h"
#include "support/temporary_folder.h"

// The half section as DXF: by the text of the file, group by group, without the library that wrote it.

using namespace catoptric;
using test::TemporaryFolder;

namespace {

struct Entity {
  std::string kind;
  std::multimap<int, std::string> groups;
  std::string layer() const { return groups.find(8)->second; }
  std::vector<double> reals(int code) const {
    std::vector<double> values;
    for (auto [at, end] = groups.equal_range(code); at != end; ++at)
      values.push_back(std::strtod(at->second.c_str(), nullptr));
    return values;
  }
  int integer(int code) const { return std::atoi(groups.find(code)->second.c_str()); }
};

struct DxfText {
  std::vector<Entity> entities;
  std::map<std::string, std::string> variables;  ///< of the header, with their first value
  std::vector<std::string> layers;

  std::vector<Entity> on(const std::string& layer) const {
    std::vector<Entity> found;
    for (const Entity& each : entities)
      if (each.layer() == layer) found.push_back(each);
    return found;
  }
};

/// Pairs of lines: a group's code and its value.
DxfText parsed(const std::string& file) {
  DxfText result;
  std::istringstream in(file);
  std::string code_line, value, section, table_entry, variable;
  while (std::getline(in, code_line) && std::getline(in, value)) {
    const int code = std::atoi(code_line.c_str());
    if (code == 0) table_entry = value;
    if (code == 2 && table_entry == "SECTION") section = value;
    if (code == 2 && table_entry == "LAYER" && section == "TABLES") result.layers.push_back(value);
    if (section == "HEADER" && code == 9) variable = value;
    if (section == "HEADER" && code != 9) result.variables.emplace(variable, value);
    if (section != "ENTITIES") continue;
    if (code == 0 && value != "SECTION") result.entities.push_back({value, {}});
    if (code != 0 && !result.entities.empty()) result.entities.back().groups.emplace(code, value);
  }
  if (!result.entities.empty() && result.entities.back().kind == "EOF") result.entities.pop_back();
  while (!result.entities.empty() && result.entities.back().groups.count(8) == 0) result.entities.pop_back();
  return result;
}

DxfText written(const Profile& profile, const cad::ExportOptions& options) {
  const TemporaryFolder folder;
  cad::export_reflector(profile, folder / "mirror.dxf", options);
  return parsed(test::read_whole(folder / "mirror.dxf"));
}

}  // namespace

TEST_CASE("DXF: the section of the paraboloid bit for bit on its layers") {
  cad::ExportOptions options;
  options.wall = test::LampMirror{}.wall();
  const Profile cut = cad::with_opening(test::paraboloid(), 10);
  const DxfText file = written(cut, options);
  CHECK(file.variables.at("$INSUNITS") == "4");
  for (const char* layer : {"OPTICAL", "BACK", "EDGE", "FLANGE", "AXIS"})
    CHECK(std::find(file.layers.begin(), file.layers.end(), layer) != file.layers.end());
  const auto optical = file.on("OPTICAL");
  REQUIRE(optical.size() == 1);
  CHECK(optical[0].kind == "SPLINE");
  CHECK(optical[0].integer(71) == 2);
  CHECK((optical[0].integer(70) & 4) == 0);  // not rational
  CHECK(optical[0].reals(40) == cut.knots());
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(optical[0].reals(10)[i] == cut.points()[i].r_mm);
    CHECK(optical[0].reals(20)[i] == cut.points()[i].z_mm);
  }
  REQUIRE(file.on("BACK").size() == 1);
  CHECK(file.on("BACK")[0].kind == "LWPOLYLINE");  // of degree 8 it would be, which not all read
  CHECK(file.on("EDGE").size() == 1);              // of the opening: the rim has its flange
  CHECK(file.on("FLANGE").size() == 3);
  REQUIRE(file.on("AXIS").size() == 1);
  CHECK(file.on("AXIS")[0].reals(10) == std::vector<double>{0});
  CHECK(file.on("AXIS")[0].reals(11) == std::vector<double>{0});
}

TEST_CASE("DXF: the outline closes, the back lies a wall away, the flange is where it was asked for") {
  const test::LampMirror mirror;
  cad::ExportOptions options;
  options.wall = mirror.wall();
  const DxfText file = written(cad::with_opening(test::paraboloid(), 10), options);
  const Entity back = file.on("BACK")[0];
  const std::vector<double> r = back.reals(10), z = back.reals(20);
  for (std::size_t i = 0; i < r.size(); ++i) {
    // The foot on the parabola by Newton: the wall is as thick everywhere.
    double foot = r[i];
    for (int step = 0; step < 30; ++step) {
      const double drop = mirror.height(foot) - z[i];
      foot -= (foot - r[i] - drop * foot / 100) / (1 + foot * foot / 1e4 - drop / 100);
    }
    CHECK(std::hypot(foot - r[i], mirror.height(foot) - z[i]) ==
          Approx(1).margin(3e-7));  // the back's own error
  }
  CHECK(r.front() == Approx(mirror.back_r(10)).margin(1e-12));
  CHECK(z.front() == Approx(mirror.back_z(10)).margin(1e-12));
  CHECK(z.back() == Approx(52).margin(1e-12));
  CHECK(r.back() == Approx(mirror.back_r(mirror.flange_meets())).margin(1e-7));  // the back's own tolerance
  double r_max = 0;
  for (const Entity& line : file.on("FLANGE"))
    for (const int code : {10, 11}) r_max = std::max(r_max, line.reals(code)[0]);
  CHECK(r_max == 108);
  CHECK(file.on("FLANGE")[0].reals(10)[0] == r.back());
  CHECK(file.on("FLANGE")[2].reals(11)[0] == 100);
}

TEST_CASE("DXF: units") {
  cad::ExportOptions options;
  for (const auto& [unit, code, rim] : {std::tuple{LengthUnit::centimetre, "5", 10.0},
                                        {LengthUnit::metre, "6", 0.1},
                                        {LengthUnit::inch, "1", 100 / 25.4}}) {
    options.unit = unit;
    const DxfText file = written(test::paraboloid(), options);
    CHECK(file.variables.at("$INSUNITS") == code);
    CHECK(file.on("OPTICAL")[0].reals(10).back() == rim);
  }
}

TEST_CASE(
    "DXF: a curve with weights is a polyline within its stated chord, or a spline with them if asked for") {
  const Profile profile = test::hemisphere(50);
  const TemporaryFolder folder;
  cad::ExportOptions options;
  options.wall = cad::Wall{2};
  const auto report = cad::export_reflector(profile, folder / "mirror.dxf", options);
  const std::string text = test::read_whole(folder / "mirror.dxf");
  const DxfText file = parsed(text);
  const Entity line = file.on("OPTICAL")[0];
  CHECK(line.kind == "LWPOLYLINE");
  const std::vector<double> r = line.reals(10), z = line.reals(20);
  REQUIRE(line.integer(90) == static_cast<int>(r.size()));
  double farthest = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    CHECK(std::hypot(r[i], z[i]) == Approx(50).margin(1e-12));
    if (i > 0) farthest = std::max(farthest, 50 - std::hypot(r[i] + r[i - 1], z[i] + z[i - 1]) / 2);
  }
  CHECK(report.chord_mm == 1e-6 * profile.diagonal_mm());
  CHECK(farthest <= report.chord_mm);
  CHECK(farthest > 0.01 * report.chord_mm);  // and no finer than it must be
  CHECK(text.find("polylines are within") != std::string::npos);

  options.dxf_curves = cad::DxfCurves::splines;
  CHECK(cad::export_reflector(profile, folder / "mirror.dxf", options).chord_mm == 0);
  const Entity spline = parsed(test::read_whole(folder / "mirror.dxf")).on("OPTICAL")[0];
  CHECK(spline.kind == "SPLINE");
  CHECK((spline.integer(70) & 4) != 0);
  CHECK(spline.reals(41) == std::vector<double>{1, std::sqrt(0.5), 1});
  options.dxf_curves = cad::DxfCurves::polylines;
  options.wall = {};
  CHECK(written(test::paraboloid(), options).on("OPTICAL")[0].kind == "LWPOLYLINE");
}

TEST_CASE("DXF: arcs at kinks, straight facets exactly, the same bytes each time") {
  const Profile facets(1, {0, 0, 0.5, 1, 1}, {{0, 100, 1}, {60, 80, 1}, {90, 20, 1}});
  cad::ExportOptions options;
  options.wall = cad::Wall{2};
  const DxfText file = written(facets, options);
  CHECK(file.on("OPTICAL")[0].kind == "LWPOLYLINE");
  CHECK(file.on("OPTICAL")[0].reals(10) == std::vector<double>{0, 60, 90});
  int arcs = 0;
  for (const Entity& each : file.on("BACK"))
    if (each.kind == "ARC") {
      ++arcs;
      CHECK(each.reals(40)[0] == Approx(2).margin(1e-13));
      const double turn = std::fmod(each.reals(51)[0] - each.reals(50)[0] + 360, 360);
      CHECK(turn < 90);  // the short way, counter-clockwise
    }
  CHECK(arcs == 2);  // at the kink and at the pointed vertex
  const TemporaryFolder folder;
  cad::export_reflector(facets, folder / "mirror.dxf", options);
  const std::string first = test::read_whole(folder / "mirror.dxf");
  cad::export_reflector(facets, folder / "mirror.dxf", options);
  CHECK(first == test::read_whole(folder / "mirror.dxf"));
}

TEST_CASE("DXF: a drawing that differs in one bit does not pass") {
  using namespace catoptric::cad::detail;
  const TemporaryFolder folder;
  const Drawing drawing =
      section_drawing(test::wavy_profile(3, true), cad::Wall{1}, LengthUnit::inch, cad::DxfCurves::splines);
  write_dxf(drawing, folder / "a.dxf", "mirror");
  CHECK(!difference(drawing, read_dxf(folder / "a.dxf")));
  Drawing other = drawing;
  other.curves[0].points[2].x() = std::nextafter(other.curves[0].points[2].x(), 1000);
  CHECK(difference(other, read_dxf(folder / "a.dxf")));
  other = drawing;
  other.curves[0].weights[1] = std::nextafter(other.curves[0].weights[1], 1000);
  CHECK(difference(other, read_dxf(folder / "a.dxf")));
  other = drawing;
  other.unit = LengthUnit::metre;
  CHECK(difference(other, read_dxf(folder / "a.dxf")));
  other = drawing;
  other.curves[1].layer = "OPTICAL";
  CHECK(difference(other, read_dxf(folder / "a.dxf")));
}
