#include <fmt/format.h>
#include <BRepTools_WireExplorer.hxx>
#include <BRep_Tool.hxx>
#include <GeomAPI_ProjectPointOnCurve.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <GeomConvert.hxx>
#include <GeomConvert_ApproxCurve.hxx>
#include <GeomConvert_CompCurveToBSplineCurve.hxx>
#include <Geom_OffsetCurve.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "cad/detail/curve_source.h"

namespace catoptric::cad::detail {
namespace {

constexpr int greatest_degree = 9;  // of a Profile

std::string kind_of(const Handle(Geom_Curve) & curve) {
  switch (GeomAdaptor_Curve(curve).GetType()) {
    case GeomAbs_Line:
      return "line";
    case GeomAbs_Circle:
      return "arc";
    case GeomAbs_Ellipse:
      return "ellipse";
    case GeomAbs_Hyperbola:
      return "hyperbola";
    case GeomAbs_Parabola:
      return "parabola";
    case GeomAbs_BezierCurve:
    case GeomAbs_BSplineCurve:
      return "B-spline";
    case GeomAbs_OffsetCurve:
      return "offset curve";
    default:
      return "curve";
  }
}

double size_of(const Handle(Geom_Curve) & curve) {
  double size = 0;
  const gp_Pnt start = curve->Value(curve->FirstParameter());
  for (int i = 1; i <= 32; ++i)
    size = std::max(
        size, start.Distance(curve->Value(curve->FirstParameter() +
                                          (curve->LastParameter() - curve->FirstParameter()) * i / 32)));
  return size;
}

/// Greatest distance of points of `made` from `given`.
double deviation_mm(const Handle(Geom_Curve) & made, const Handle(Geom_Curve) & given) {
  double greatest = 0;
  for (int i = 0; i <= 64; ++i) {
    const gp_Pnt point =
        made->Value(made->FirstParameter() + (made->LastParameter() - made->FirstParameter()) * i / 64);
    double nearest = std::min(point.Distance(given->Value(given->FirstParameter())),
                              point.Distance(given->Value(given->LastParameter())));
    const GeomAPI_ProjectPointOnCurve projection(point, given);
    if (projection.NbPoints() > 0) nearest = std::min(nearest, projection.LowerDistance());
    greatest = std::max(greatest, nearest);
  }
  return greatest;
}

Handle(Geom_BSplineCurve) approximated(const Handle(Geom_Curve) & curve) {
  const double tolerance_mm = import_rel * size_of(curve);
  const GeomConvert_ApproxCurve approximation(curve, tolerance_mm, GeomAbs_C2, 200, greatest_degree);
  if (!approximation.HasResult() || approximation.MaxError() > tolerance_mm)
    throw CadError({"a curve cannot be made a B-spline", "",
                    fmt::format("degree {} and 200 pieces do not reach {} mm", greatest_degree, tolerance_mm),
                    "export it from the CAD program as a B-spline (IGES 126)"});
  return approximation.Curve();
}

CurvePiece piece_of(const TopoDS_Edge& edge) {
  double first = 0, last = 0;
  const Handle(Geom_Curve) whole = BRep_Tool::Curve(edge, first, last);
  if (whole.IsNull()) throw CadError({"an edge has no curve in space", "", "", "export the curve itself"});
  const Handle(Geom_TrimmedCurve) curve = new Geom_TrimmedCurve(whole, first, last);
  const std::string kind = kind_of(whole);
  CurvePiece piece{nullptr, kind, 0};
  if (kind == "offset curve") {
    piece.spline = approximated(curve);
  } else {
    piece.spline = GeomConvert::CurveToBSplineCurve(curve, Convert_TgtThetaOver2);
    if (piece.spline->Degree() > greatest_degree) piece.spline = approximated(piece.spline);
  }
  const bool is_same_curve = kind == "B-spline" && piece.spline->Degree() <= greatest_degree &&
                             GeomAdaptor_Curve(whole).Degree() <= greatest_degree;
  if (!is_same_curve) piece.deviation_mm = deviation_mm(piece.spline, curve);
  if (edge.Orientation() == TopAbs_REVERSED) piece.spline->Reverse();
  return piece;
}

std::vector<TopoDS_Edge> edges_in_order(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Edge> edges;
  if (shape.ShapeType() == TopAbs_WIRE)
    for (BRepTools_WireExplorer i(TopoDS::Wire(shape)); i.More(); i.Next()) edges.push_back(i.Current());
  std::size_t all = 0;
  for (TopExp_Explorer i(shape, TopAbs_EDGE); i.More(); i.Next()) ++all;
  if (edges.size() == all) return edges;
  edges.clear();  // the wire explorer stops at a gap; joining says where it is
  for (TopExp_Explorer i(shape, TopAbs_EDGE); i.More(); i.Next()) edges.push_back(TopoDS::Edge(i.Current()));
  return edges;
}

Handle(Geom_BSplineCurve) join(const std::vector<CurvePiece>& pieces) {
  double size = 0;
  for (const CurvePiece& piece : pieces) size = std::max(size, size_of(piece.spline));
  const gp_Pnt start = pieces.front().spline->StartPoint();
  for (const CurvePiece& piece : pieces) size = std::max(size, start.Distance(piece.spline->EndPoint()));
  GeomConvert_CompCurveToBSplineCurve whole(pieces.front().spline);
  for (std::size_t i = 1; i < pieces.size(); ++i)
    // Least multiplicity as high as it goes: the join stays a kink and moves nothing.
    if (!whole.Add(pieces[i].spline, import_rel * size, true, true, greatest_degree)) {
      const gp_Pnt end = whole.BSplineCurve()->EndPoint(), begin = whole.BSplineCurve()->StartPoint();
      double gap_mm = HUGE_VAL;
      for (const gp_Pnt& here : {begin, end})
        for (const gp_Pnt& there : {pieces[i].spline->StartPoint(), pieces[i].spline->EndPoint()})
          gap_mm = std::min(gap_mm, here.Distance(there));
      throw CadError({"a composite curve has a gap", "",
                      fmt::format("{:.6g} mm between its pieces {} and {}", gap_mm, i, i + 1),
                      "close it in the CAD program"});
    }
  return whole.BSplineCurve();
}

/// "2 lines, 1 arc" in order of first appearance.
std::string listing(const std::vector<CurvePiece>& pieces) {
  if (pieces.size() == 1) return pieces.front().kind;
  std::vector<std::pair<std::string, int>> counts;
  for (const CurvePiece& piece : pieces) {
    const auto known = std::find_if(counts.begin(), counts.end(),
                                    [&](const auto& each) { return each.first == piece.kind; });
    if (known == counts.end())
      counts.emplace_back(piece.kind, 1);
    else
      ++known->second;
  }
  std::string text;
  for (const auto& [kind, count] : counts)
    text += fmt::format("{}{} {}{}", text.empty() ? "" : ", ", count, kind, count == 1 ? "" : "s");
  return text;
}

}  // namespace

std::vector<CurvePiece> pieces_of(const TopoDS_Shape& edges) {
  std::vector<CurvePiece> pieces;
  for (const TopoDS_Edge& edge : edges_in_order(edges))
    if (!BRep_Tool::Degenerated(edge)) pieces.push_back(piece_of(edge));
  return pieces;
}

std::vector<std::vector<CurvePiece>> chains_of(std::vector<CurvePiece> pieces) {
  std::vector<gp_Pnt> ends;  // 2 i and 2 i + 1 belong to piece i
  std::vector<double> sizes;
  for (const CurvePiece& piece : pieces) {
    ends.push_back(piece.spline->StartPoint());
    ends.push_back(piece.spline->EndPoint());
    sizes.push_back(size_of(piece.spline));
  }
  constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> partner(ends.size(), none);
  for (std::size_t a = 0; a < partner.size(); ++a) {
    std::vector<std::size_t> here;
    for (std::size_t b = 0; b < partner.size(); ++b) {
      const double size = std::max(sizes[a / 2], sizes[b / 2]);
      if (a != b && ends[a].Distance(ends[b]) <= import_rel * size) here.push_back(b);
    }
    if (here.size() == 1 && here.front() / 2 != a / 2) partner[a] = here.front();
  }
  for (std::size_t a = 0; a < partner.size(); ++a)  // where three meet, nearness may be one-sided
    if (partner[a] != none && partner[partner[a]] != a) partner[a] = none;
  std::vector<std::vector<CurvePiece>> chains;
  std::vector<bool> used(pieces.size(), false);
  const auto follow = [&](std::size_t entry) {  // from the end at which the chain starts
    chains.emplace_back();
    while (entry != none && !used[entry / 2]) {
      used[entry / 2] = true;
      chains.back().push_back(pieces[entry / 2]);
      entry = partner[entry ^ 1];
    }
  };
  for (std::size_t end = 0; end < partner.size(); ++end)
    if (partner[end] == none && !used[end / 2]) follow(end);
  for (std::size_t piece = 0; piece < pieces.size(); ++piece)
    if (!used[piece]) follow(2 * piece);  // closed chains have no loose end
  return chains;
}

SourceCurve joined_curve(const std::vector<CurvePiece>& pieces) {
  if (pieces.empty()) throw CadError({"a curve has no length", "", "", "check the file"});
  SourceCurve result;
  result.curve = pieces.size() == 1 ? pieces.front().spline : join(pieces);
  result.is_line = pieces.size() == 1 && pieces.front().kind == "line";
  result.description = fmt::format("{}, degree {}, {} control points", listing(pieces),
                                   result.curve->Degree(), result.curve->NbPoles());
  double deviation = 0;
  for (const CurvePiece& piece : pieces) deviation = std::max(deviation, piece.deviation_mm);
  if (pieces.size() > 1)
    result.notes.push_back(fmt::format("joined {} pieces: {}", pieces.size(), listing(pieces)));
  if (pieces.size() > 1 || pieces.front().kind != "B-spline" || deviation > 0)
    result.notes.push_back(fmt::format(
        "converted to a {} B-spline of degree {} with {} control points, largest deviation {:.2g} mm",
        result.curve->IsRational() ? "rational" : "polynomial", result.curve->Degree(),
        result.curve->NbPoles(), deviation));
  return result;
}

}  // namespace catoptric::cad::detail
