#include "report/figures.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/errors.h"
#include "report/gnuplot.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::report;
namespace fs = std::filesystem;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

std::string drawn(const std::string& script) {
  const test::TemporaryFolder folder;
  const Drawing drawing = draw(script, folder.path(), "figure");
  INFO(drawing.sentence);
  INFO(script.substr(0, 2000));
  CHECK(drawing.sentence.empty());
  REQUIRE(drawing.drawn());
  CHECK(fs::exists(folder.path() / "figure.gp"));
  CHECK(fs::file_size(folder.path() / "figure.svg") == drawing.svg_text.size());
  CHECK(drawing.svg_text.find("<svg") != std::string::npos);
  CHECK(drawing.svg_text.find("</svg>") != std::string::npos);
  return drawing.svg_text;
}

GeneratrixFigure generatrix() {
  return {"Generatrix",
          "cm",
          {{"wanted", CurveRole::target, {0, 5, 10}, {10, 8.75, 5}, {0, 5, 10}, {10, 10, 5}},
           {"found", CurveRole::obtained, {0, 5, 9.5}, {10, 8.75, 5.5}, {}, {}}},
          PlanePoint{0, 5},
          {{0, 0}, {20, 0}}};
}

LandscapeFigure landscape() {
  LandscapeFigure figure{"Landscape", "w1", "r2 [cm]", "RMSE [W/m²]", {}, {}, {}, {}, AxisScale::linear};
  for (int i = 0; i <= 10; ++i) {
    figure.objective.x.push_back(0.1 * i);
    figure.objective.y.push_back(i);
  }
  for (double y : figure.objective.y)
    for (double x : figure.objective.x) figure.objective.value.push_back(std::hypot(x - 0.5, y / 10 - 0.5));
  figure.paths = {{"run 1", {0.1, 0.3, 0.5}, {1, 4, 5}}, {"run 2", {0.9, 0.6}, {9, 6}}};
  figure.marks = {{"A", 0.1, 1, MarkKind::start}, {"P", 0.5, 5, MarkKind::minimum}};
  return figure;
}

IrradianceFigure irradiance() {
  return {"Irradiance", "mm", "irradiance", "W/m²", {{-1, 0, 1}, {-1, 0, 1}, {0, 1, 0, 1, 2, 1, 0, 1, 0}}, {},
          {},           {}};
}

}  // namespace

TEST_CASE("a generatrix figure holds its data and draws every curve") {
  const std::string script = generatrix_script(generatrix());
  for (const char* line : {"\n5 8.75\n", "\n9.5 5.5\n", "\n20 0\n", "\n0 5\n", "size ratio -1"})
    CHECK(script.find(line) != std::string::npos);
  const std::string svg = drawn(script);
  for (const char* text :
       {">Generatrix<", ">wanted<", ">found<", ">source<", ">near field<", ">r [cm]<", ">z [cm]<"})
    CHECK(count(svg, text) == 1);
  CHECK(count(svg, "id=\"gnuplot_plot_") == 5);  // two curves, one control polygon, field, source
}

TEST_CASE("an irradiance map has a colour bar in its unit and keeps the scale it was given") {
  IrradianceFigure figure = irradiance();
  CHECK(irradiance_map_script(figure).find("cbrange [0:2]") != std::string::npos);
  figure.greatest = 7.5;
  figure.disc_radius = 1;
  const std::string script = irradiance_map_script(figure);
  CHECK(script.find("cbrange [0:7.5]") != std::string::npos);
  const std::string svg = drawn(script);
  for (const char* text : {">x [mm]<", ">y [mm]<", ">irradiance [W/m²]<"}) CHECK(count(svg, text) == 1);
}

TEST_CASE("an irradiance surface draws its polygons") {
  const std::string svg = drawn(irradiance_surface_script(irradiance()));
  CHECK(count(svg, ">irradiance [W/m²]<") == 1);
  CHECK(count(svg, "<polygon") >= 4);
}

TEST_CASE("a dark field still has a colour scale") {
  IrradianceFigure figure = irradiance();
  figure.field.value.assign(9, 0.0);
  drawn(irradiance_map_script(figure));
  drawn(irradiance_surface_script(figure));
  figure.field.value.assign(9, nan_value);
  CHECK(irradiance_map_script(figure).find("cbrange [0:1]") != std::string::npos);
}

TEST_CASE("a radial cut draws bands where there is noise") {
  RadialCutFigure figure{"Cut", "cm", "illuminance", "lx", {}};
  figure.curves = {{"target", {0, 1, 2}, {2, 1, 0.5}, {}, CurveRole::target},
                   {"total", {0, 1, 2}, {2.1, 1.1, 0.4}, {0.1, 0.1, 0.1}, CurveRole::obtained}};
  const std::string svg = drawn(radial_cut_script(figure));
  CHECK(count(svg, ">target<") == 1);
  CHECK(count(svg, ">total<") == 1);
  CHECK(count(svg, "illuminance [lx]") == 1);
  CHECK(count(svg, "id=\"gnuplot_plot_") == 3);
  CHECK(count(svg, "fill-opacity") >= 1);
}

TEST_CASE("a band lies where the curve would without its bias, and is named where it has a name") {
  RadialCutFigure figure{"Cut", "cm", "illuminance", "lx", {}};
  figure.curves = {{"total", {0, 1}, {2, 1}, {0.1, 0.2}, CurveRole::obtained, {-0.5, 0.25}, "95 % interval"}};
  const std::string script = radial_cut_script(figure);
  CHECK(script.find("0 2 0.1 -0.5\n1 1 0.2 0.25\n") != std::string::npos);
  CHECK(count(drawn(script), ">95 % interval<") == 1);
  figure.curves[0].band_shift.pop_back();
  CHECK_THROWS_AS(radial_cut_script(figure), InputError);
}

TEST_CASE("a polar diagram has both sides of the axis, circles over the greatest value and its unit") {
  PolarFigure figure{"Intensity", "intensity (cd)", {}};
  figure.curves = {{"C0, C180", {-90, 0, 90}, {10, 40, 20}}, {"C90, C270", {-90, 0, 90}, {nan_value, 40, 0}}};
  const std::string script = polar_script(figure);
  CHECK(script.find("rrange [0:40]") != std::string::npos);
  CHECK(script.find("-90 10\n0 40\n90 20\n") != std::string::npos);
  const std::string svg = drawn(script);
  for (const char* text : {">intensity (cd)<", ">C0, C180<", ">0°<", ">180°<", ">30<", ">40<"})
    CHECK(count(svg, text) == 1);
  CHECK(count(svg, ">90°<") == 2);
  figure.curves = {{"dark", {0, 180}, {0, 0}}};
  drawn(polar_script(figure));
}

TEST_CASE("a trade is drawn with its settings, its front and the accuracies asked for") {
  TradeFigure figure{"Trade", "time (s)", "relative error", {}, {}, {0.1, 0.01}};
  figure.groups = {{"photons", {0.01, 0.1}, {0.2, 0.02}}, {"tubes", {0.001}, {1e-6}}};
  figure.front = {"front", {0.001}, {1e-6}};
  const std::string svg = drawn(trade_script(figure));
  for (const char* text : {">photons<", ">tubes<", ">front<", ">10 %<", ">1 %<", ">time (s)<"})
    CHECK(count(svg, text) == 1);
}

TEST_CASE("curves that are alike are told apart by dashes or shapes, not by colour alone") {
  ConvergenceFigure figure{"Convergence", "RMSE", {{"a", {1}, {1}}, {"b", {1}, {2}}}};
  const std::string script = convergence_script(figure);
  CHECK(script.find("pt 7 ") != std::string::npos);
  CHECK(script.find("pt 5 ") != std::string::npos);
  CHECK(script.find("dt 1 ") != std::string::npos);
  CHECK(script.find("dt (12,6) ") != std::string::npos);
}

TEST_CASE("convergence is drawn on a logarithmic axis, zeros and infinities left out") {
  ConvergenceFigure figure{"Convergence", "RMSE [W/m²]", {}};
  const double infinity = std::numeric_limits<double>::infinity();
  figure.curves = {{"run", {1, 5, 9, 12}, {infinity, 1, 0.01, 0}}};
  const std::string script = convergence_script(figure);
  CHECK(script.find("logscale y") != std::string::npos);
  CHECK(script.find("1 NaN\n5 1\n9 0.01\n12 NaN\n") != std::string::npos);
  const std::string svg = drawn(script);
  CHECK(count(svg, ">evaluations<") == 1);
  CHECK(count(svg, ">0.1<") == 1);
}

TEST_CASE("a landscape shows contours with values, paths and marks") {
  const std::string script = landscape_contour_script(landscape());
  const std::string svg = drawn(script);
  for (const char* text : {">run 1<", ">run 2<", ">w1<", ">r2 [cm]<", ">RMSE [W/m²]<", ">start<"})
    CHECK(count(svg, text) == 1);
  CHECK(count(svg, ">end<") == 0);  // no such mark
  CHECK(count(svg, ">A<") == 10);   // once in black, nine times in the white rim
  CHECK(script.find("levels discrete 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7\n") != std::string::npos);
  CHECK(count(svg, ">0.3<") >= 2);  // at the colour bar and on the line
}

TEST_CASE("a landscape with holes, without range or on a logarithmic scale is drawn") {
  LandscapeFigure figure = landscape();
  figure.scale = AxisScale::logarithmic;
  drawn(landscape_contour_script(figure));
  drawn(landscape_surface_script(figure));
  figure.greatest = 0.2;
  for (int i = 0; i < 30; ++i) figure.objective.value[i] = std::numeric_limits<double>::infinity();
  drawn(landscape_contour_script(figure));
  drawn(landscape_surface_script(figure));
  figure.scale = AxisScale::linear;
  figure.objective.value.assign(figure.objective.value.size(), 3.0);
  figure.greatest.reset();
  drawn(landscape_contour_script(figure));
  drawn(landscape_surface_script(figure));
}

TEST_CASE("a landscape of one variable is a line with marks") {
  LineFigure figure{"Line", "w1", "RMSE", {{"r2 = 10", {0.5, 1, 2}, {0.2, 0, 0.3}}}, {{"start", 2, 0.3}}};
  const std::string svg = drawn(line_script(figure));
  CHECK(count(svg, ">r2 = 10<") == 1);
  figure.y_scale = AxisScale::logarithmic;
  drawn(line_script(figure));
}

TEST_CASE("the same numbers give the same script") {
  CHECK(landscape_contour_script(landscape()) == landscape_contour_script(landscape()));
}

TEST_CASE("lists that do not match are refused") {
  GeneratrixFigure figure = generatrix();
  figure.curves[0].z.pop_back();
  CHECK_THROWS_AS(generatrix_script(figure), InputError);
  LandscapeFigure hills = landscape();
  hills.objective.value.pop_back();
  CHECK_THROWS_AS(landscape_contour_script(hills), InputError);
  hills = landscape();
  std::swap(hills.objective.x[0], hills.objective.x[1]);
  CHECK_THROWS_AS(landscape_surface_script(hills), InputError);
}

TEST_CASE("text from a user is drawn as it stands and never interpreted") {
  const test::TemporaryFolder folder;
  const std::string witness = (folder.path() / "witness").string();
  const std::vector<std::string> hostile = {
      "it's \"quoted\"",
      "back\\slash \\n \\",
      "line one\nset output '" + witness + "'\nprint 1 #",
      "'; system('touch " + witness + "'); '",
      "`touch " + witness + "`",
      "''; system('touch " + witness + "') #",
      "'''; system('touch " + witness + "') #",
      "'.system(\"touch " + witness + "\").'",
      "@macro @@ $0 ${x}",
      "{/Bold x}_2^3 a_b ~a{.8-}",
      "100 % %d %s %n",
      "<b>&amp;</b> ]]> <script>",
      "EOD\nEOD",
      "broken \xff\xfe bytes",
      "W/m² € 𝛼",
      std::string(5000, 'x'),
      "",
  };
  for (const std::string& text : hostile) {
    CAPTURE(text.substr(0, 80));
    GeneratrixFigure figure = generatrix();
    figure.title = figure.length_unit = figure.curves[0].label = text;
    drawn(generatrix_script(figure));
    LandscapeFigure hills = landscape();
    hills.title = hills.x_label = hills.value_label = hills.paths[0].label = hills.marks[0].label = text;
    drawn(landscape_contour_script(hills));
    CHECK_FALSE(fs::exists(witness));
  }
  GeneratrixFigure figure = generatrix();
  figure.title = "a'b \"c\" {d}_e @f `g` \\n %h <i>&";
  CHECK(count(drawn(generatrix_script(figure)), ">a’b \"c\" {d}_e @f `g` \\n %h &lt;i>&amp;<") == 1);
}

TEST_CASE("a long title is broken at blanks, none of it lost") {
  GeneratrixFigure figure = generatrix();
  figure.title = "The irradiance of the design at full power over the floor, " + std::string(30, 'y') +
                 " and the walls of the room";
  const std::string svg = drawn(generatrix_script(figure));
  CHECK(count(svg, ">The irradiance of the design at full power over the floor,<") == 1);
  CHECK(count(svg, ">" + std::string(30, 'y') + " and the walls of the room<") == 1);
}
