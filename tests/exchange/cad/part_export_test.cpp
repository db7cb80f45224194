#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>
#include <vector>

#include "cad/detail/comparison.h"
#include "cad/detail/exchange_file.h"
#include "cad/detail/shape.h"
#include "cad/export.h"
#include "cad/opening.h"
#include "support/cad/lamp_mirror.h"
#include "support/cad/sample_profiles.h"
#include "support/step_text.h"
#include "support/temporary_folder.h"

// STEP of AP242 with names, colours and material: by the text of the file, without a CAD kernel.

using namespace catoptric;
using test::StepText;
using test::TemporaryFolder;

namespace {

cad::ExportOptions part_options() {
  cad::ExportOptions options;
  options.schema = cad::StepSchema::ap242;
  options.wall = test::LampMirror{}.wall();
  options.product = "Lamp mirror A";
  options.material = {"Aluminium EN AW-1050A", 2705};
  return options;
}

std::string written(const cad::ExportOptions& options) {
  const TemporaryFolder folder;
  cad::export_reflector(cad::with_opening(test::paraboloid(), 10), folder / "mirror.step", options);
  return test::read_whole(folder / "mirror.step");
}

std::string unquoted(const std::string& text) { return text.substr(1, text.size() - 2); }

/// The faces' names with the generatrices' control points, of those on surfaces of revolution.
struct NamedFace {
  std::string name;
  int surface;
};
std::vector<NamedFace> faces(const StepText& file) {
  std::vector<NamedFace> list;
  for (const int face : file.all("ADVANCED_FACE")) {
    const auto parts = file.arguments(face, "ADVANCED_FACE");
    list.push_back({unquoted(parts[0]), StepText::reference(parts[2])});
  }
  return list;
}

}  // namespace

TEST_CASE("STEP of AP242 names the part and its faces, the optical surface being the profile's") {
  const StepText file(written(part_options()));
  CHECK(file.dangling().empty());
  const auto products = file.all("PRODUCT");
  REQUIRE(products.size() == 1);
  CHECK(file.arguments(products[0], "PRODUCT")[1] == "'Lamp mirror A'");
  CHECK(file.all("MANIFOLD_SOLID_BREP").size() == 1);
  int optical = 0;
  for (const NamedFace& face : faces(file)) {
    if (face.name != "optical surface") {
      CHECK(face.name == "body");
      continue;
    }
    ++optical;
    const int curve = StepText::reference(file.arguments(face.surface, "SURFACE_OF_REVOLUTION")[1]);
    const auto poles = StepText::list(file.arguments(curve, "B_SPLINE_CURVE_WITH_KNOTS")[2]);
    REQUIRE(poles.size() == 3);
    // Exactly the cut parabola: (10, 99.5), (55, 95), (100, 50).
    const Profile cut = cad::with_opening(test::paraboloid(), 10);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(file.triple(StepText::reference(poles[i])) ==
            std::vector<double>{cut.points()[i].r_mm, 0, cut.points()[i].z_mm});
  }
  CHECK(optical == 1);
  CHECK(faces(file).size() == 6);
}

TEST_CASE("STEP of AP242 colours the optical surface otherwise than the body") {
  const StepText file(written(part_options()));
  // From a styled item's style to its colour.
  const auto color = [&](const std::string& styles) -> std::vector<double> {
    int at = StepText::reference(StepText::list(styles)[0]);
    at = StepText::reference(StepText::list(file.arguments(at, "PRESENTATION_STYLE_ASSIGNMENT")[0])[0]);
    at = StepText::reference(file.arguments(at, "SURFACE_STYLE_USAGE")[1]);
    at = StepText::reference(StepText::list(file.arguments(at, "SURFACE_SIDE_STYLE")[1])[0]);
    at = StepText::reference(file.arguments(at, "SURFACE_STYLE_FILL_AREA")[0]);
    at = StepText::reference(StepText::list(file.arguments(at, "FILL_AREA_STYLE")[1])[0]);
    at = StepText::reference(file.arguments(at, "FILL_AREA_STYLE_COLOUR")[1]);
    const auto rgb = file.arguments(at, "COLOUR_RGB");
    return {std::atof(rgb[1].c_str()), std::atof(rgb[2].c_str()), std::atof(rgb[3].c_str())};
  };
  const auto whole = file.all("STYLED_ITEM"), own = file.all("OVER_RIDING_STYLED_ITEM");
  REQUIRE(whole.size() == 1);
  REQUIRE(own.size() == 1);
  const auto body = file.arguments(whole[0], "STYLED_ITEM");
  const auto optical = file.arguments(own[0], "OVER_RIDING_STYLED_ITEM");
  CHECK(file.arguments(StepText::reference(body[2]), "MANIFOLD_SOLID_BREP").size() == 2);
  CHECK(file.arguments(StepText::reference(optical[2]), "ADVANCED_FACE")[0] == "'optical surface'");
  CHECK(color(body[1])[2] == Approx(0.57).margin(0.002));     // grey; sRGB, as the file has it
  CHECK(color(optical[1])[2] == Approx(0.94).margin(0.002));  // light blue
}

TEST_CASE("STEP of AP242 holds the material and its density, and without one says nothing of it") {
  const StepText file(written(part_options()));
  bool named = false;
  for (const int item : file.all("DESCRIPTIVE_REPRESENTATION_ITEM"))
    named = named || file.arguments(item, "DESCRIPTIVE_REPRESENTATION_ITEM")[0] == "'Aluminium EN AW-1050A'";
  CHECK(named);
  const auto measures = file.all("MEASURE_REPRESENTATION_ITEM");
  REQUIRE(measures.size() == 1);
  const auto density = file.arguments(measures[0], "MEASURE_REPRESENTATION_ITEM");
  CHECK(density[1].substr(0, 25) == "POSITIVE_RATIO_MEASURE(2.");
  CHECK(std::atof(density[1].c_str() + 23) == 2.705);
  // Of g and cm^3: mass over a length to the third.
  const auto unit = file.arguments(StepText::reference(density[2]), "DERIVED_UNIT");
  std::vector<double> powers;
  std::vector<std::string> units;
  for (const std::string& each : StepText::list(unit[0])) {
    const auto element = file.arguments(StepText::reference(each), "DERIVED_UNIT_ELEMENT");
    powers.push_back(std::atof(element[1].c_str()));
    const auto si = file.arguments(StepText::reference(element[0]), "SI_UNIT");
    units.push_back(si[0] + si[1]);
  }
  CHECK(powers == std::vector<double>{1, -3});
  CHECK(units == std::vector<std::string>{"$.GRAM.", ".CENTI..METRE."});
  cad::ExportOptions options = part_options();
  options.material.density_kg_per_m3 = {};
  CHECK(written(options).find("density") == std::string::npos);
  options.material = {};
  CHECK(written(options).find("material") == std::string::npos);
}

TEST_CASE("STEP of AP242 of the open surface is coloured and named too") {
  cad::ExportOptions options = part_options();
  options.wall = {};
  CHECK_THROWS_WITH(written(options), Catch::Contains("open surface"));  // which has no mass
  options.material = {};
  const StepText file(written(options));
  REQUIRE(faces(file).size() == 1);
  CHECK(faces(file)[0].name == "optical surface");
  CHECK(file.all("COLOUR_RGB").size() == 1);
}

TEST_CASE("STEP of AP242 is the same bytes each time, and so is plain STEP before and after it") {
  const std::string plain = written({});
  const bool same = written(part_options()) == written(part_options());
  CHECK(same);
  const bool plain_stays = written({}) == plain;
  CHECK(plain_stays);
}

TEST_CASE("A part whose name, colour or material was lost does not pass") {
  using namespace catoptric::cad::detail;
  const TemporaryFolder folder;
  const Profile profile = test::paraboloid();
  const TopoDS_Shape shape = walled_solid(profile, {1});
  const FileLabels labels{"mirror.step", "Lamp mirror A", "", "", "1970-01-01T00:00:00", {"Steel", 7850}};
  write_step_part(shape, profile, folder / "part.step", labels, LengthUnit::centimetre);
  CHECK(!part_loss(folder / "part.step", shape, profile, labels));
  FileLabels other = labels;
  other.product = "Lamp mirror B";
  CHECK(part_loss(folder / "part.step", shape, profile, other));
  other = labels;
  other.material.name = "Brass";
  CHECK(part_loss(folder / "part.step", shape, profile, other));
  other = labels;
  other.material.density_kg_per_m3 = 7850.001;
  CHECK(part_loss(folder / "part.step", shape, profile, other));
  write_step(shape, folder / "plain.step", labels, LengthUnit::millimetre, cad::StepSchema::ap242);
  const auto loss = part_loss(folder / "plain.step", shape, profile, labels);
  REQUIRE(loss);
}
