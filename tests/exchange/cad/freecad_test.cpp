#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>

#include "base/units.h"
#include "cad/export.h"
#include "cad/opening.h"
#include "support/cad/lamp_mirror.h"
#include "support/cad/sample_profiles.h"
#include "support/temporary_folder.h"

// Files opened by another program: FreeCAD without a window. It shares OCCT with us, so this is a test of
// being accepted; that the numbers are exact is tested on the text of the files.

using namespace catoptric;
using test::TemporaryFolder;

namespace {

/// What a script for FreeCAD says, by key; empty when it said nothing. It says by `say(key, value)`.
std::map<std::string, std::string> freecad_says(const TemporaryFolder& folder, const std::string& text) {
  const auto script = folder / "ask.py";
  test::write_whole(script, "def say(key, value):\n    print('\\nSAYS', key, value)\n" + text);
  const std::string command = "HOME='" + folder.path().string() +
                              "' QT_QPA_PLATFORM=offscreen LC_ALL=C timeout 120 freecadcmd '" +
                              script.string() + "' 2>&1 < /dev/null";
  std::map<std::string, std::string> says;
  std::FILE* pipe = ::popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) {
    std::istringstream line(buffer.data());
    std::string mark, key, value;
    line >> mark >> key >> std::ws;
    std::getline(line, value);
    if (mark == "SAYS") says[key] = value;
  }
  ::pclose(pipe);
  return says;
}

/// What FreeCAD says of one file.
std::map<std::string, std::string> freecad_says_of(const TemporaryFolder& folder,
                                                   const std::filesystem::path& file) {
  return freecad_says(folder, R"(import Part
s = Part.read(')" + file.string() +
                                  R"(')
b = s.BoundBox
say('type', s.ShapeType)
say('valid', s.isValid())
say('area', repr(s.Area))
say('volume', repr(s.Volume))
say('box', ' '.join(repr(v) for v in (b.XMin, b.XMax, b.YMin, b.YMax, b.ZMin, b.ZMax)))
say('faces', len(s.Faces))
say('revolutions', sum(f.Surface.TypeId == 'Part::GeomSurfaceOfRevolution' for f in s.Faces))
for f in s.Faces:
    if f.Surface.TypeId == 'Part::GeomSurfaceOfRevolution' and len(s.Faces) == 1:
        c = f.Surface.BasisCurve
        say('poles', ' '.join(repr(v) for p in c.getPoles() for v in (p.x, p.y, p.z)))
        say('weights', ' '.join(repr(v) for v in c.getWeights()))
        say('degree', c.Degree)
)");
}

bool has_freecad() {
  const bool has = std::system("command -v freecadcmd > /dev/null 2>&1") == 0;
  if (!has) {
    WARN("skipped: freecadcmd is not installed (Debian: apt-get install freecad-python3)");
    SUCCEED();
  }
  return has;
}

std::vector<double> numbers(const std::string& text) {
  std::istringstream in(text);
  std::vector<double> values;
  for (double value; in >> value;) values.push_back(value);
  return values;
}

// (8 pi / 3) f^2 ((1 + R^2 / (4 f^2))^(3/2) - 1) with f = 50 mm, R = 100 mm.
constexpr double paraboloid_area_mm2 = 38294.488151512927;

void check_box(const std::string& text, const std::array<double, 6>& expected) {
  const auto box = numbers(text);
  REQUIRE(box.size() == 6);
  for (std::size_t i = 0; i < 6; ++i)
    CHECK(std::abs(box[i] - expected[i]) < 1e-7);  // what OCCT takes for one point
}

}  // namespace

TEST_CASE("FreeCAD opens the paraboloid: one surface of revolution, its area, its box in mm") {
  if (!has_freecad()) return;
  const TemporaryFolder folder;
  for (const char* name : {"mirror.step", "mirror.igs"})
    for (const auto unit : {LengthUnit::millimetre, LengthUnit::centimetre, LengthUnit::inch}) {
      cad::ExportOptions options;
      options.unit = unit;
      cad::export_reflector(test::paraboloid(), folder / name, options);
      auto says = freecad_says_of(folder, folder / name);
      CAPTURE(name, std::string(symbol(unit)));
      CHECK(says["valid"] == "True");
      CHECK(says["faces"] == "1");
      CHECK(says["revolutions"] == "1");
      CHECK(std::atof(says["area"].c_str()) == Approx(paraboloid_area_mm2).epsilon(1e-6));
      check_box(says["box"], {-100, 100, -100, 100, 50, 100});
      CHECK(says["degree"] == "2");
      const std::array<double, 9> poles{0, 0, 100, 50, 0, 100, 100, 0, 50};
      const auto found = numbers(says["poles"]);
      REQUIRE(found.size() == poles.size());
      for (std::size_t i = 0; i < poles.size(); ++i) CHECK(std::abs(found[i] - poles[i]) <= 2e-14);
    }
}

TEST_CASE("FreeCAD has the weights of a rational mirror") {
  if (!has_freecad()) return;
  const TemporaryFolder folder;
  const Profile profile = test::wavy_profile(3, true);
  cad::export_reflector(profile, folder / "mirror.step");
  auto says = freecad_says_of(folder, folder / "mirror.step");
  const auto weights = numbers(says["weights"]);
  REQUIRE(weights.size() == profile.points().size());
  for (std::size_t i = 0; i < weights.size(); ++i) CHECK(weights[i] == profile.points()[i].weight);
}

TEST_CASE("FreeCAD opens the walled mirror as a solid of the right volume") {
  if (!has_freecad()) return;
  const TemporaryFolder folder;
  cad::ExportOptions options;
  options.wall = cad::Wall{2};
  options.iges_mode = cad::IgesMode::brep;
  for (const char* name : {"mirror.step", "mirror.igs"}) {
    cad::export_reflector(test::hemisphere(50), folder / name, options);
    auto says = freecad_says_of(folder, folder / name);
    CAPTURE(name);
    CHECK(says["type"] == "Solid");
    CHECK(says["valid"] == "True");
    CHECK(says["faces"] == "3");
    // FreeCAD integrates without an error bound; on this solid it is good to 1e-6.
    CHECK(std::atof(says["volume"].c_str()) ==
          Approx(2 * pi / 3 * (52. * 52 * 52 - 50. * 50 * 50)).epsilon(1e-6));
    check_box(says["box"], {-52, 52, -52, 52, 0, 52});
  }
}

TEST_CASE(
    "FreeCAD has the lamp mirror by its name, as a solid of the right volume, and its section from DXF") {
  if (!has_freecad()) return;
  const TemporaryFolder folder;
  const test::LampMirror mirror;
  cad::ExportOptions options;
  options.schema = cad::StepSchema::ap242;
  options.wall = mirror.wall();
  options.product = "Lamp mirror";
  const Profile profile = cad::with_opening(test::paraboloid(), mirror.opening_mm);
  cad::export_reflector(profile, folder / "mirror.step", options);
  cad::export_reflector(profile, folder / "mirror.dxf", options);
  options.wall = {};
  options.dxf_curves = cad::DxfCurves::splines;
  cad::export_reflector(test::hemisphere(50), folder / "rational.dxf", options);
  auto says = freecad_says(folder, "folder = '" + folder.path().string() + R"(/'
import FreeCAD, Part, Import
document = FreeCAD.newDocument()
Import.insert(folder + 'mirror.step', document.Name)
for o in document.Objects:
    say('label', o.Label)
    say('type', o.Shape.ShapeType)
    say('valid', o.Shape.isValid())
    say('volume', repr(o.Shape.Volume))
    say('area', repr(o.Shape.Area))
    b = o.Shape.BoundBox
    say('box', ' '.join(repr(v) for v in (b.XMin, b.XMax, b.YMin, b.YMax, b.ZMin, b.ZMax)))
for name in ('mirror', 'rational'):
    document = FreeCAD.newDocument()
    Import.readDXF(folder + name + '.dxf', document.Name)
    curves = [e.Curve for o in document.Objects for e in o.Shape.Edges]
    splines = [c for c in curves if c.TypeId == 'Part::GeomBSplineCurve']
    say(name + '_splines', len(splines))
    say(name + '_poles', ' '.join(repr(v) for p in splines[0].getPoles() for v in (p.x, p.y, p.z)))
    say(name + '_weights', ' '.join(repr(v) for v in splines[0].getWeights()))
)");
  CHECK(says["label"] == "Lamp mirror");
  CHECK(says["type"] == "Solid");
  CHECK(says["valid"] == "True");
  // FreeCAD integrates without an error bound; on this solid it is good to 1e-8.
  CHECK(std::atof(says["volume"].c_str()) == Approx(mirror.volume_mm3()).epsilon(1e-7));
  CHECK(std::atof(says["area"].c_str()) == Approx(mirror.area_mm2()).epsilon(1e-7));
  check_box(says["box"], {-108, 108, -108, 108, 50, mirror.back_z(10)});
  CHECK(says["mirror_splines"] == "1");  // the optical surface; the back is a polyline
  const auto poles = numbers(says["mirror_poles"]);
  REQUIRE(poles.size() == 9);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(poles[3 * i] == profile.points()[i].r_mm);
    CHECK(poles[3 * i + 1] == profile.points()[i].z_mm);
  }
  CHECK(numbers(says["rational_weights"]) == std::vector<double>{1, std::sqrt(0.5), 1});
}
