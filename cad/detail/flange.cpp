#include "cad/detail/flange.h"

#include <fmt/format.h>
#include <Geom_BSplineCurve.hxx>
#include <Precision.hxx>
#include <cmath>
#include <gp_Pnt.hxx>
#include <optional>

namespace catoptric::cad::detail {
namespace {

/// Parameter nearest to the piece's end at which it reaches `height_mm` over the rim, `up` being +1 or -1.
std::optional<double> reaches(const SectionPiece& piece, double rim_z_mm, double up, double height_mm) {
  constexpr int steps = 64;
  const double rounding_mm = 1e-3 * Precision::Confusion();  // a flat mirror's flange is flush with its back
  const auto above = [&](double u) {
    return up * (piece.curve->Value(u).Z() - rim_z_mm) - height_mm + rounding_mm;
  };
  double below = piece.last;
  for (int i = steps - 1; i >= 0; --i) {
    double reached = piece.first + (piece.last - piece.first) * i / steps;
    if (above(reached) < 0) {
      below = reached;
      continue;
    }
    while (true) {  // halve until no double lies between
      const double middle = 0.5 * (reached + below);
      if (middle == reached || middle == below) return reached;
      (above(middle) >= 0 ? reached : below) = middle;
    }
  }
  return std::nullopt;
}

/// The piece up to `end`, whose parameter is `u`.
void end_at(SectionPiece& piece, double u, const Vector2& end) {
  piece.last = u;
  if (piece.kind != SectionPiece::Kind::spline) return;
  const Handle(Geom_BSplineCurve) curve = Handle(Geom_BSplineCurve)::DownCast(piece.curve->Copy());
  curve->Segment(piece.first, u);
  curve->SetPole(curve->NbPoles(), gp_Pnt(end.x(), 0., end.y()));
  piece.curve = curve;
  piece.first = curve->FirstParameter();
  piece.last = curve->LastParameter();
}

[[noreturn]] void refuse_flange(std::string what, std::string why, std::string hint) {
  throw CadError({std::move(what), "", std::move(why), std::move(hint)});
}

}  // namespace

void add_flange(std::vector<SectionPiece>& pieces, const Rim& rim, double width_mm, double thickness_mm) {
  const double least_mm = 10 * Precision::Confusion();  // as of a wall
  if (!(std::isfinite(width_mm) && width_mm > least_mm && std::isfinite(thickness_mm) &&
        thickness_mm > least_mm))
    refuse_flange(fmt::format("a flange {} mm wide and {} mm thick cannot be built", width_mm, thickness_mm),
                  "both are finite and above 1e-6 mm", "make it larger, or leave it out");
  // 1e-9: a mirror that ends along the axis, up to its rounding; its flange lies towards its body.
  const double up = std::copysign(1, std::abs(rim.outward.y()) > 1e-9 ? rim.outward.y() : -rim.tangent.y());
  std::optional<double> met;
  while (!pieces.empty() && !(met = reaches(pieces.back(), rim.point.y(), up, thickness_mm)))
    pieces.pop_back();
  if (!met)
    refuse_flange(fmt::format("a flange {} mm thick does not fit", thickness_mm),
                  "it is thicker than the wall's outer side is high there", "make the flange thinner");
  SectionPiece& last = pieces.back();
  const double top_mm = rim.point.y() + up * thickness_mm, edge_mm = rim.point.x() + width_mm;
  const Vector2 corner(last.curve->Value(*met).X(), top_mm);
  if (corner.x() >= edge_mm - least_mm)
    refuse_flange(
        fmt::format("a flange {} mm wide ends within the wall", width_mm),
        fmt::format("the wall's outer side is {:.6g} mm from the rim there", corner.x() - rim.point.x()),
        "make the flange wider");
  const gp_Pnt start = last.curve->Value(last.first);
  if (start.Distance(gp_Pnt(corner.x(), 0., corner.y())) <= Precision::Confusion())
    pieces.pop_back();
  else
    end_at(last, *met, corner);
  using Part = SectionPiece::Part;
  pieces.push_back(straight_piece(Part::flange, corner, {edge_mm, top_mm}));
  pieces.push_back(straight_piece(Part::flange, {edge_mm, top_mm}, {edge_mm, rim.point.y()}));
  pieces.push_back(straight_piece(Part::flange, {edge_mm, rim.point.y()}, rim.point));
}

}  // namespace catoptric::cad::detail
