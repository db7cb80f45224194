#include <dxflib/dl_creationadapter.h>
#include <dxflib/dl_dxf.h>
#include <fmt/format.h>

#include <array>
#include <fstream>
#include <locale>
#include <memory>

#include "base/errors.h"
#include "cad/detail/section_drawing.h"

// Written and read with dxflib, which is not OCCT's. Numbers go in as texts of our own: dxflib's have 16
// decimals at most, which is not every digit of a small one.

namespace catoptric::cad::detail {
namespace {

struct Layer {
  const char* name;
  int color;  // AutoCAD's index
  const char* line_type;
};
constexpr std::array layers{Layer{"0", 7, "CONTINUOUS"},      Layer{"OPTICAL", 5, "CONTINUOUS"},
                            Layer{"BACK", 8, "CONTINUOUS"},   Layer{"EDGE", 8, "CONTINUOUS"},
                            Layer{"FLANGE", 8, "CONTINUOUS"}, Layer{"AXIS", 1, "CENTER"}};

constexpr int planar_spline = 8, rational_spline = 4;

/// $INSUNITS of the DXF reference.
int unit_code(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::inch:
      return 1;
    case LengthUnit::millimetre:
      return 4;
    case LengthUnit::centimetre:
      return 5;
    case LengthUnit::metre:
      return 6;
  }
  return 0;
}

/// Every digit of it, with a point, so that no reader takes it for an integer.
void real(const DL_WriterA& file, int code, double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  file.dxfString(code, text);
}

void point(const DL_WriterA& file, const Vector2& at, int code = 10) {
  real(file, code, at.x());
  real(file, code + 10, at.y());
  real(file, code + 20, 0);
}

/// The header with tables and blocks that readers of release 2000 want to find.
void begin(DL_Dxf& dxf, DL_WriterA& file, const Drawing& drawing, const std::string& title) {
  dxf.writeHeader(file);
  file.dxfString(9, "$INSUNITS");
  file.dxfInt(70, unit_code(drawing.unit));
  file.dxfString(9, "$MEASUREMENT");
  file.dxfInt(70, drawing.unit == LengthUnit::inch ? 0 : 1);
  file.sectionEnd();
  file.comment(
      fmt::format("{}: half section of a mirror of revolution, x = radius, y = along the axis", title)
          .c_str());
  file.comment(drawing.chord_mm > 0
                   ? fmt::format("polylines are within {:.3g} mm of the curves", drawing.chord_mm).c_str()
                   : "OPTICAL is the mirror's exact curve");
  file.sectionTables();
  dxf.writeVPort(file);
  file.tableLinetypes(4);
  for (const char* name : {"BYBLOCK", "BYLAYER", "CONTINUOUS"})
    dxf.writeLinetype(file, DL_LinetypeData(name, name, 0, 0, 0.0));
  std::array<double, 4> dashes{12.5, -2.5, 2.5, -2.5};
  dxf.writeLinetype(file, DL_LinetypeData("CENTER", "Center", 0, 4, 20.0, dashes.data()));
  file.tableEnd();
  file.tableLayers(static_cast<int>(layers.size()));
  for (const Layer& layer : layers)
    dxf.writeLayer(file, DL_LayerData(layer.name, 0),
                   DL_Attributes("", layer.color, -1, layer.line_type, 1.0));
  file.tableEnd();
  file.tableStyle(1);
  dxf.writeStyle(file, DL_StyleData("Standard", 0, 0.0, 1.0, 0.0, 0, 2.5, "txt", ""));
  file.tableEnd();
  dxf.writeView(file);
  dxf.writeUcs(file);
  file.tableAppid(1);
  dxf.writeAppid(file, "ACAD");
  file.tableEnd();
  dxf.writeDimStyle(file, 1, 1, 1, 1, 1);
  dxf.writeBlockRecord(file);
  file.tableEnd();
  file.sectionEnd();
  file.sectionBlocks();
  for (const char* name : {"*Model_Space", "*Paper_Space", "*Paper_Space0"}) {
    dxf.writeBlock(file, DL_BlockData(name, 0, 0, 0, 0));
    dxf.writeEndBlock(file, name);
  }
  file.sectionEnd();
  file.sectionEntities();
}

void entity(const DL_WriterA& file, const char* kind, const char* subclass, const std::string& layer) {
  file.entity(kind);
  file.dxfString(100, "AcDbEntity");
  file.dxfString(8, layer);
  file.dxfString(100, subclass);
}

void spline(const DL_WriterA& file, const DrawnCurve& curve) {
  entity(file, "SPLINE", "AcDbSpline", curve.layer);
  file.dxfInt(70, planar_spline + (curve.weights.empty() ? 0 : rational_spline));
  file.dxfInt(71, curve.degree);
  file.dxfInt(72, static_cast<int>(curve.knots.size()));
  file.dxfInt(73, static_cast<int>(curve.points.size()));
  file.dxfInt(74, 0);
  for (const double knot : curve.knots) real(file, 40, knot);
  for (const double weight : curve.weights) real(file, 41, weight);
  for (const Vector2& each : curve.points) point(file, each);
}

void polyline(const DL_WriterA& file, const DrawnCurve& curve) {
  entity(file, "LWPOLYLINE", "AcDbPolyline", curve.layer);
  file.dxfInt(90, static_cast<int>(curve.points.size()));
  file.dxfInt(70, 0);
  for (const Vector2& each : curve.points) {
    real(file, 10, each.x());
    real(file, 20, each.y());
  }
}

void arc(const DL_WriterA& file, const DrawnCurve& curve) {
  entity(file, "ARC", "AcDbCircle", curve.layer);
  point(file, curve.points.front());
  real(file, 40, curve.radius);
  file.dxfString(100, "AcDbArc");
  real(file, 50, curve.first_deg);
  real(file, 51, curve.last_deg);
}

void line(const DL_WriterA& file, const DrawnCurve& curve) {
  entity(file, "LINE", "AcDbLine", curve.layer);
  point(file, curve.points[0], 10);
  point(file, curve.points[1], 11);
}

void draw(const DL_WriterA& file, const DrawnCurve& curve) {
  switch (curve.kind) {
    case DrawnCurve::Kind::line:
      return line(file, curve);
    case DrawnCurve::Kind::arc:
      return arc(file, curve);
    case DrawnCurve::Kind::spline:
      return spline(file, curve);
    case DrawnCurve::Kind::polyline:
      return polyline(file, curve);
  }
}

/// Collects what dxflib finds in a file.
class Collector : public DL_CreationAdapter {
 public:
  Drawing take() { return std::move(drawing_); }
  bool has_unit() const { return has_unit_; }

  void setVariableInt(const std::string& key, int value, int) override {
    if (key != "$INSUNITS") return;
    for (const LengthUnit unit :
         {LengthUnit::millimetre, LengthUnit::centimetre, LengthUnit::metre, LengthUnit::inch})
      if (unit_code(unit) == value) {
        drawing_.unit = unit;
        has_unit_ = true;
      }
  }
  void addLine(const DL_LineData& data) override {
    add(DrawnCurve::Kind::line).points = {{data.x1, data.y1}, {data.x2, data.y2}};
  }
  void addArc(const DL_ArcData& data) override {
    DrawnCurve& curve = add(DrawnCurve::Kind::arc);
    curve.points = {{data.cx, data.cy}};
    curve.radius = data.radius;
    curve.first_deg = data.angle1;
    curve.last_deg = data.angle2;
  }
  void addPolyline(const DL_PolylineData&) override { add(DrawnCurve::Kind::polyline); }
  void addVertex(const DL_VertexData& data) override {
    drawing_.curves.back().points.emplace_back(data.x, data.y);
  }
  void addSpline(const DL_SplineData& data) override {
    add(DrawnCurve::Kind::spline).degree = static_cast<int>(data.degree);
    rational_ = (data.flags & rational_spline) != 0;
  }
  void addKnot(const DL_KnotData& data) override { drawing_.curves.back().knots.push_back(data.k); }
  void addControlPoint(const DL_ControlPointData& data) override {
    drawing_.curves.back().points.emplace_back(data.x, data.y);
    if (rational_) drawing_.curves.back().weights.push_back(data.w);
  }

 private:
  DrawnCurve& add(DrawnCurve::Kind kind) {
    rational_ = false;
    return drawing_.curves.emplace_back(DrawnCurve{kind, getAttributes().getLayer(), {}});
  }

  Drawing drawing_;
  bool rational_ = false, has_unit_ = false;
};

}  // namespace

void write_dxf(const Drawing& drawing, const std::filesystem::path& path, const std::string& title) {
  DL_Dxf dxf;
  const std::unique_ptr<DL_WriterA> file(dxf.out(path.c_str(), DL_Codes::AC1015));
  const auto require = [&](bool written) {
    if (!written) throw IoError({"cannot write the DXF file", path.string(), "", "check the free space"});
  };
  require(file != nullptr && !file->openFailed());
  begin(dxf, *file, drawing, title);
  for (const DrawnCurve& curve : drawing.curves) draw(*file, curve);
  file->sectionEnd();
  dxf.writeObjects(*file);
  dxf.writeObjectsEnd(*file);
  file->dxfEOF();
  file->close();
}

Drawing read_dxf(const std::filesystem::path& path) {
  Collector collector;
  DL_Dxf dxf;
  std::ifstream file(path, std::ios::binary);
  if (!file || !dxf.in(file, &collector) || !collector.has_unit())
    throw CadError({"this is no DXF file with a unit of length", path.string(), "", "check the file"});
  return collector.take();
}

}  // namespace catoptric::cad::detail
