#include "cad/detail/generatrix_facets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/units.h"

namespace catoptric::cad::detail {
namespace {

using meridian::Piece;
using meridian::SpanTable;

/// Some 600 MB of facets and tree.
constexpr std::size_t most_triangles = 4'000'000;

/// A ring this near the axis, in mesh units, is a point of it: floats would make its triangles degenerate.
constexpr double axis_radius = 1e-7;

/// A piece of the generatrix as a straight line.
struct Chord {
  Vector2 start, end;  ///< (r, z), mm
  FacetStrip strip;
};

Vector2 pole(const Piece<double>& piece, std::size_t i) {
  const auto& c = piece.curve;
  return {std::max(0.0, c.rw[i] / c.w[i]), c.zw[i] / c.w[i]};
}

double distance_to_segment(const Vector2& point, const Vector2& start, const Vector2& end) {
  const Vector2 along = end - start;
  const double length_squared = along.squaredNorm();
  const double share =
      length_squared > 0 ? std::clamp((point - start).dot(along) / length_squared, 0.0, 1.0) : 0;
  return (point - start - share * along).norm();
}

/// Cuts spans into chords.
class Flattener {
 public:
  Flattener(int degree, double chord_mm, std::vector<Chord>& chords)
      : degree_(degree), chord_mm_(chord_mm), chords_(chords) {}

  void run(const Piece<double>& piece, int depth) {
    Piece<double> left, right;
    meridian::halve(piece, degree_, left, right);
    constexpr int deepest = 48;  // halvings of a span whose ends are still exact doubles
    if (depth == deepest || (depth > 0 && is_flat(piece, left, right))) {
      const std::size_t last = static_cast<std::size_t>(degree_);
      const Vector2 start = pole(piece, 0), end = pole(piece, last);
      if (start != end)
        chords_.push_back(
            {start, end, {piece.span, piece.lo, piece.lo + piece.width, (end - start).norm(), false, false}});
      return;
    }
    if (chords_.size() > most_triangles)
      throw InputError(
          {"the chord error asks for too many facets", "model.chord_error", "", "take a larger one"});
    run(left, depth + 1);
    run(right, depth + 1);
  }

 private:
  /// Whether each point of the piece is near the chord's point at the same share of the parameter (at its
  /// quarters), and no pole far: between the quarters no spike hides.
  bool is_flat(const Piece<double>& piece, const Piece<double>& left, const Piece<double>& right) const {
    const std::size_t last = static_cast<std::size_t>(degree_);
    const Vector2 start = pole(piece, 0), end = pole(piece, last);
    for (std::size_t i = 1; i < last; ++i)
      if (distance_to_segment(pole(piece, i), start, end) > 4 * chord_mm_) return false;
    const auto off = [&](const Piece<double>& half, double share) {
      Piece<double> low, high;
      meridian::halve(half, degree_, low, high);
      return (pole(high, 0) - ((1 - share) * start + share * end)).norm();
    };
    return (pole(right, 0) - 0.5 * (start + end)).norm() <= chord_mm_ && off(left, 0.25) <= chord_mm_ &&
           off(right, 0.75) <= chord_mm_;
  }

  int degree_;
  double chord_mm_;
  std::vector<Chord>& chords_;
};

/// Draws the generatrix on past its free ends, along its last chord.
void extend(std::vector<Chord>& chords, double length_mm) {
  const auto past = [length_mm](const Vector2& from, const Vector2& to) {
    Vector2 end = to + length_mm * (to - from).normalized();
    end.x() = std::max(0.0, end.x());
    return end;
  };
  const Chord first = chords.front(), last = chords.back();
  if (first.start.x() > 0)
    chords.insert(chords.begin(),
                  {past(first.end, first.start),
                   first.start,
                   {first.strip.span, first.strip.s0, first.strip.s0, length_mm, true, false}});
  if (last.end.x() > 0)
    chords.push_back({last.end,
                      past(last.start, last.end),
                      {last.strip.span, last.strip.s1, last.strip.s1, length_mm, true, false}});
}

/// Least distance of two segments that do not cross lies at an end of one.
bool near(const Chord& a, const Chord& b, double distance_mm) {
  const auto side = [](const Chord& chord, const Vector2& p) {
    const Vector2 along = chord.end - chord.start, to = p - chord.start;
    return along.x() * to.y() - along.y() * to.x() > 0;
  };
  if (side(a, b.start) != side(a, b.end) && side(b, a.start) != side(b, a.end)) return true;
  return distance_to_segment(a.start, b.start, b.end) < distance_mm ||
         distance_to_segment(a.end, b.start, b.end) < distance_mm ||
         distance_to_segment(b.start, a.start, a.end) < distance_mm ||
         distance_to_segment(b.end, a.start, a.end) < distance_mm;
}

/// Marks chords that others come near to, their neighbours not counted.
/// @cost  O(n^2) for n chords, a few hundred
void mark_crowded(std::vector<Chord>& chords, double distance_mm, bool closed) {
  for (std::size_t i = 0; i < chords.size(); ++i)
    for (std::size_t j = i + 2; j < chords.size(); ++j) {
      if (closed && i == 0 && j + 1 == chords.size()) continue;
      if (near(chords[i], chords[j], distance_mm)) chords[i].strip.crowded = chords[j].strip.crowded = true;
    }
}

/// Sectors of a polygon whose corners stand as far outside the circle as its sides' middles inside, both at
/// most `chord`.
struct Polygon {
  Polygon(double radius, double chord) {
    const double sagitta = std::min(0.5, chord / radius);
    constexpr double least = 8;
    const double wanted = std::ceil(pi / std::acos((1 - sagitta) / (1 + sagitta)));
    sectors = static_cast<std::uint32_t>(std::max(least, wanted));
    corner_share = 2 / (1 + std::cos(pi / sectors));
  }
  std::uint32_t sectors;
  double corner_share;  ///< radius of the corners over that of the circle
};

/// Puts vertices and triangles round the axis.
class Lathe {
 public:
  Lathe(GeneratrixFacets& facets, const Polygon& polygon) : facets_(facets), polygon_(polygon) {}

  /// @out   number of the ring's first vertex; a ring on the axis has no other
  std::uint32_t ring(const Vector2& at) {
    const auto first = static_cast<std::uint32_t>(facets_.mesh.vertices.size());
    const double r = facets_.scale * at.x() * polygon_.corner_share, z = facets_.scale * at.y();
    const bool on_axis = r <= axis_radius;
    for (std::uint32_t i = 0; i < (on_axis ? 1 : polygon_.sectors); ++i) {
      // Between the corners, so that the planes of coordinates, where rays often run, meet facets' middles.
      const double phi = 2 * pi * (i + 0.5) / polygon_.sectors;
      facets_.mesh.vertices.push_back({on_axis ? 0 : static_cast<float>(r * std::cos(phi)),
                                       on_axis ? 0 : static_cast<float>(r * std::sin(phi)),
                                       static_cast<float>(z)});
    }
    return first;
  }

  void strip(std::uint32_t inner, std::uint32_t outer) {
    const bool inner_point = outer - inner == 1;
    const bool outer_point = facets_.mesh.vertices.size() - outer == 1;
    const auto number = static_cast<std::uint32_t>(facets_.strips.size() - 1);
    const auto add = [&](std::array<std::uint32_t, 3> corners) {
      facets_.mesh.triangles.push_back(corners);
      FacetPlace place{number, {}};
      for (std::size_t i = 0; i < 3; ++i) place.on_outer[i] = corners[i] >= outer;
      facets_.places.push_back(place);
    };
    for (std::uint32_t i = 0; i < polygon_.sectors; ++i) {
      const std::uint32_t next = (i + 1) % polygon_.sectors;
      const std::uint32_t a = inner + (inner_point ? 0 : i), b = inner + (inner_point ? 0 : next);
      const std::uint32_t c = outer + (outer_point ? 0 : i), d = outer + (outer_point ? 0 : next);
      if (!outer_point) add({a, c, d});
      if (!inner_point) add({a, d, b});
    }
  }

 private:
  GeneratrixFacets& facets_;
  const Polygon& polygon_;
};

}  // namespace

GeneratrixFacets::GeneratrixFacets(const SpanTable& table, double chord_mm)
    : scale(std::exp2(-std::ceil(std::log2(table.size)))) {
  std::vector<Chord> chords;
  Flattener flattener(table.degree, 0.5 * chord_mm, chords);
  for (const Piece<meridian::Quad>& span : table.exact)
    if (!table.spans[static_cast<std::size_t>(span.span)].is_point) flattener.run(meridian::rounded(span), 0);
  const bool closed = !table.exact.front().free_lo;
  // A ray that comes in flat meets the facets before or behind the surface: up to sixteen chord errors away
  // when it comes at sixteen to one.
  constexpr double flattest = 16;
  if (!closed) extend(chords, flattest * chord_mm);
  mark_crowded(chords, 4 * chord_mm, closed);

  const Polygon polygon(table.r_extent, 0.5 * chord_mm);
  if (2 * polygon.sectors * chords.size() > most_triangles)
    throw InputError({fmt::format("the chord error of {:.3g} mm asks for {} x {} facets", chord_mm,
                                  polygon.sectors, 2 * chords.size()),
                      "", fmt::format("{} are the most", most_triangles), "take a larger one"});
  Lathe lathe(*this, polygon);
  std::uint32_t inner = lathe.ring(chords.front().start);
  for (const Chord& chord : chords) {
    strips.push_back(chord.strip);
    const std::uint32_t outer = lathe.ring(chord.end);
    lathe.strip(inner, outer);
    inner = outer;
  }
}

}  // namespace catoptric::cad::detail
