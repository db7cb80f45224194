#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/ray.h"
#include "cad/meridian_spans.h"

namespace catoptric::cad::meridian {

struct FastTable;

/// Nearest hits of rays side by side. It does what FastProbe::first_hit does with a ray that gives it no
/// trouble, operation by operation, so the hit is the same to the last bit: a ray is answered here only if
/// each piece of the generatrix is certainly missed or certainly crossed once, and Newton's method settles
/// without leaving the piece. All other rays are left to FastProbe.
class BatchSolver {
 public:
  static constexpr std::size_t most_rays =
      64;  ///< at a time: what is kept of them fits the first-level cache

  BatchSolver(const SpanTable& table, const FastTable& fast);
  ~BatchSolver();

  /// @in    at most `most_rays` rays, as many hits
  /// @out   which of the rays are left to be done alone; their hits mean nothing
  const std::array<bool, most_rays>& solve(std::span<const Ray> rays, double beyond_mm,
                                           std::span<std::optional<Hit>> hits);

 private:
  struct Work;
  const SpanTable& table_;
  const FastTable& fast_;
  std::unique_ptr<Work> work_;
};

}  // namespace catoptric::cad::meridian
