#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/ray.h"

namespace catoptric::cad::detail {

/// Any set of triangles, in coordinates of about unit size: they are floats.
struct TriangleMesh {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A piece of a ray, origin + t direction for t in [0, length], in the mesh's coordinates.
struct TriangleRay {
  Vector3 origin;
  Vector3 direction;
  double length;
};

/// A triangle that a ray meets.
struct TriangleHit {
  std::uint32_t triangle;
  double t;
  double share1, share2;  ///< barycentric coordinates of its second and third corner, within [0, 1]
};

inline constexpr std::uint32_t no_triangle = 0xffffffff;

/// Triangles that rays can be asked against, by Embree. Watertight across shared edges. Immutable, safe to
/// share; the caller's floating-point state is as before after each call.
///
/// Embree works in float and says which triangle; where on it is computed here, in double, so that it does
/// not depend on the processor's instruction set.
/// @fails CadError when Embree cannot start or build
class TriangleScene {
 public:
  explicit TriangleScene(TriangleMesh mesh);
  ~TriangleScene();
  TriangleScene(const TriangleScene&) = delete;
  TriangleScene& operator=(const TriangleScene&) = delete;

  /// The triangle that each ray meets first, or no_triangle. No answer depends on the other rays.
  /// @cost  0.1 to 0.2 us a ray for some thousand triangles
  void first(std::span<const TriangleRay> rays, std::span<std::uint32_t> triangles) const;

  /// All triangles that a ray meets, in no order; at an edge both.
  void all(const TriangleRay& ray, std::vector<std::uint32_t>& triangles) const;

  /// Where the ray meets the triangle's plane, drawn to the triangle when that is beside it; nothing when the
  /// ray runs in the plane.
  std::optional<TriangleHit> locate(const TriangleRay& ray, std::uint32_t triangle) const;

 private:
  struct Handles;
  TriangleMesh mesh_;
  std::unique_ptr<Handles> handles_;
};

}  // namespace catoptric::cad::detail
