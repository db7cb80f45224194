#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "base/float_traps.h"
#include "base/tolerance.h"
#include "cad/detail/facet_refine.h"
#include "cad/detail/generatrix_facets.h"
#include "cad/detail/triangle_scene.h"
#include "cad/engines.h"

namespace catoptric::cad {
namespace {

using meridian::Candidate;
using meridian::NearRay;

/// The chord error in mm, checked.
double chord_mm(const Profile& profile, const MeshOptions& options) {
  const UntrappedFloats untrapped;                 // NaN is one of the things refused
  constexpr double least = 1e-6, greatest = 0.05;  // a float's resolution; a polygon of 8
  const double diagonal = profile.diagonal_mm();
  const double relative = options.chord_error_mm ? *options.chord_error_mm / diagonal : options.chord_error;
  if (!(relative >= least && relative <= greatest))
    throw InputError({fmt::format("a chord error of {:.3g} of the part's diagonal is out of range", relative),
                      "", fmt::format("it lies between {:.0e} and {}", least, greatest), ""});
  if (!(options.newton_tolerance > 0))
    throw InputError({fmt::format("a Newton tolerance of {} is no tolerance", options.newton_tolerance), "",
                      "it is more than 0, over the part's diagonal", "1e-14 refines fully, 1 not at all"});
  return relative * diagonal;
}

/// What all probes share.
struct Model {
  Model(const Profile& profile, const MeshOptions& options)
      : table(profile),
        chord(chord_mm(profile, options)),
        tolerance(options.newton_tolerance * profile.diagonal_mm()),
        reach(std::sqrt(table.reach_squared) + 20 * chord),
        same(same_hit(profile.diagonal_mm(), options.newton_tolerance)),
        facets(table, chord),
        scene(std::move(facets.mesh)) {}

  /// Two hits nearer along the ray than this are one, found by two facets.
  double same_hit(double diagonal, double newton_tolerance) const {
    constexpr double of_floats = 1e-6;  // two facets meet a ray at their edge within this
    return std::clamp(8 * newton_tolerance * diagonal, Tolerance::for_scale(diagonal).lift_mm,
                      of_floats * diagonal);
  }

  meridian::SpanTable table;
  double chord;
  double tolerance;
  double reach;  ///< radius that holds the facets
  double same;
  detail::GeneratrixFacets facets;  ///< without the triangles, which the scene has
  detail::TriangleScene scene;
};

template <int Degree>
class MeshProbe final : public Probe {
 public:
  explicit MeshProbe(const Model& model)
      : model_(model), refine_(model.table, model.facets, model.chord, model.tolerance) {}

  std::optional<Hit> first_hit(const Ray& ray, double beyond_mm) override {
    std::optional<Hit> hit;
    first_hits({&ray, 1}, beyond_mm, {&hit, 1});
    return hit;
  }

  std::vector<Hit> all_hits(const Ray& ray, double beyond_mm) override {
    const Piece piece(ray, beyond_mm, model_);
    std::vector<Hit> hits;
    if (piece.misses) return hits;
    find_all(piece, beyond_mm);
    for (const Candidate& candidate : candidates_)
      hits.push_back(meridian::make_hit(model_.table, piece.near, candidate));
    return hits;
  }

  void first_hits(std::span<const Ray> rays, double beyond_mm, std::span<std::optional<Hit>> hits) override {
    constexpr std::size_t most = 64;
    for (std::size_t from = 0; from < rays.size(); from += most) {
      const std::size_t count = std::min(most, rays.size() - from);
      answer(rays.subspan(from, count), beyond_mm, hits.subspan(from, count));
    }
  }

 private:
  /// The piece of a ray on which it may meet facets whose hits count, in mesh units.
  struct Piece {
    Piece(const Ray& ray, double beyond_mm, const Model& model) : near(ray, model.table) {
      const UntrappedFloats untrapped;  // a ray that is no number misses
      const double scale = model.facets.scale;
      // A facet may lie before the hit that it stands for: farther the flatter the ray meets it.
      const double slack = 16 * model.chord;
      start_mm = std::max(beyond_mm - near.shift - slack, -model.reach);
      misses = !near.passes(model.table) || !(start_mm < model.reach);
      const Vector3 d(near.dx, near.dy, near.dz);
      line = {scale * (Vector3(near.ox, near.oy, near.oz) + start_mm * d), d,
              scale * (model.reach - start_mm)};
    }
    NearRay near;
    double start_mm;  ///< of the piece, from the near origin
    bool misses;
    detail::TriangleRay line;
  };

  void answer(std::span<const Ray> rays, double beyond_mm, std::span<std::optional<Hit>> hits);
  std::optional<Candidate> candidate(const Piece& piece, std::uint32_t triangle) const;
  void find_all(const Piece& piece, double beyond_mm);

  const Model& model_;
  detail::FacetRefiner<Degree> refine_;
  std::vector<Piece> pieces_;
  std::vector<std::size_t> asked_;
  std::vector<detail::TriangleRay> lines_;
  std::vector<std::uint32_t> triangles_, met_;
  std::vector<Candidate> candidates_;
};

template <int Degree>
void MeshProbe<Degree>::answer(std::span<const Ray> rays, double beyond_mm,
                               std::span<std::optional<Hit>> hits) {
  pieces_.clear();
  lines_.clear();
  asked_.clear();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits[i].reset();
    const Piece piece(rays[i], beyond_mm, model_);
    if (piece.misses) continue;
    pieces_.push_back(piece);
    lines_.push_back(piece.line);
    asked_.push_back(i);
  }
  triangles_.resize(lines_.size());
  model_.scene.first(lines_, triangles_);
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    if (triangles_[k] == detail::no_triangle) continue;
    const Piece& piece = pieces_[k];
    const bool crowded = model_.facets.strips[model_.facets.places[triangles_[k]].strip].crowded;
    auto found = crowded ? std::nullopt : candidate(piece, triangles_[k]);
    if (!found || !(piece.near.shift + found->t > beyond_mm)) {
      // The first facet stands for no hit, or not for one that counts: another may.
      find_all(piece, beyond_mm);
      if (candidates_.empty()) continue;
      found = candidates_.front();
    }
    hits[asked_[k]] = meridian::make_hit(model_.table, piece.near, *found);
  }
}

/// The hit that a facet stands for.
template <int Degree>
std::optional<Candidate> MeshProbe<Degree>::candidate(const Piece& piece, std::uint32_t triangle) const {
  const auto at = model_.scene.locate(piece.line, triangle);
  if (!at) return std::nullopt;
  const double t = piece.start_mm + at->t / model_.facets.scale;
  const bool refined = model_.tolerance < model_.chord;
  if (!refined && model_.facets.strips[model_.facets.places[triangle].strip].beyond) return std::nullopt;
  return refine_(piece.near, t, *at);
}

/// All hits that count into candidates_, nearest first, each once.
template <int Degree>
void MeshProbe<Degree>::find_all(const Piece& piece, double beyond_mm) {
  candidates_.clear();
  model_.scene.all(piece.line, met_);
  std::sort(met_.begin(), met_.end());
  for (const std::uint32_t triangle : met_)
    if (const auto found = candidate(piece, triangle); found && piece.near.shift + found->t > beyond_mm)
      candidates_.push_back(*found);
  std::stable_sort(candidates_.begin(), candidates_.end(),
                   [](const Candidate& a, const Candidate& b) { return a.t < b.t; });
  const auto same = [this](const Candidate& a, const Candidate& b) { return b.t - a.t <= model_.same; };
  candidates_.erase(std::unique(candidates_.begin(), candidates_.end(), same), candidates_.end());
}

template <int Degree>
class MeshReflector final : public Reflector {
 public:
  MeshReflector(const Profile& profile, const MeshOptions& options)
      : profile_(profile), model_(profile_, options) {}
  std::unique_ptr<Probe> probe() const override { return std::make_unique<MeshProbe<Degree>>(model_); }
  const Profile& profile() const override { return profile_; }
  std::string_view engine() const override { return "mesh"; }

 private:
  Profile profile_;
  Model model_;
};

template <int... Offsets>
std::unique_ptr<Reflector> make(const Profile& profile, const MeshOptions& options,
                                std::integer_sequence<int, Offsets...>) {
  std::unique_ptr<Reflector> made;
  ((profile.degree() == Offsets + 1 &&
    (made = std::make_unique<MeshReflector<Offsets + 1>>(profile, options), true)) ||
   ...);
  return made;
}

}  // namespace

std::unique_ptr<Reflector> make_mesh_reflector(const Profile& profile, const MeshOptions& options) {
  return make(profile, options, std::make_integer_sequence<int, meridian::most_degree>{});
}

}  // namespace catoptric::cad
