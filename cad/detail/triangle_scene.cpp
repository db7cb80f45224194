#include "cad/detail/triangle_scene.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include "base/errors.h"
#include "base/float_traps.h"

namespace catoptric::cad::detail {
namespace {

/// While it lives, this thread's tiny floats count as zero, which spares Embree's kernels slow paths, and
/// what their lanes divide by zero stops nothing; then the state is as it was.
class FlushedDenormals {
  UntrappedFloats untrapped_;  // first, so that it ends last: the other sets the whole state

 public:
#ifdef __SSE__
  FlushedDenormals() : before_(_mm_getcsr()) {
    constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
    _mm_setcsr(before_ | flush_to_zero | denormals_are_zero);
  }
  ~FlushedDenormals() { _mm_setcsr(before_); }

 private:
  unsigned before_;
#else
  FlushedDenormals() {}  // not an aggregate, so that a name for it is no unused variable
#endif
 public:
  FlushedDenormals(const FlushedDenormals&) = delete;
  FlushedDenormals& operator=(const FlushedDenormals&) = delete;
};

[[noreturn]] void fail(const char* what, RTCDevice device) {
  throw CadError({what, "",
                  "Embree reports error " + std::to_string(static_cast<int>(rtcGetDeviceError(device))),
                  "take engine meridian"});
}

/// One device for the process, kept until its end. It is not told a number of threads: Embree would put that
/// limit on all of TBB.
RTCDevice device() {
  static const RTCDevice made = rtcNewDevice("");
  if (made == nullptr) fail("the ray tracing library does not start", nullptr);
  return made;
}

RTCRayHit packed(const TriangleRay& ray) {
  RTCRayHit packed;
  packed.ray.org_x = static_cast<float>(ray.origin.x());
  packed.ray.org_y = static_cast<float>(ray.origin.y());
  packed.ray.org_z = static_cast<float>(ray.origin.z());
  packed.ray.dir_x = static_cast<float>(ray.direction.x());
  packed.ray.dir_y = static_cast<float>(ray.direction.y());
  packed.ray.dir_z = static_cast<float>(ray.direction.z());
  packed.ray.tnear = 0;
  packed.ray.tfar = static_cast<float>(ray.length);
  packed.ray.time = 0;
  packed.ray.mask = 0xffffffff;
  packed.ray.id = 0;
  packed.ray.flags = 0;
  packed.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  packed.hit.primID = RTC_INVALID_GEOMETRY_ID;
  packed.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return packed;
}

/// Collects every triangle instead of ending the ray there.
struct Collector {
  RTCIntersectContext context;  // first: the filter is given its address
  std::vector<std::uint32_t>* found;

  static void add(const RTCFilterFunctionNArguments* call) {
    const auto& self = *reinterpret_cast<const Collector*>(call->context);
    for (unsigned i = 0; i < call->N; ++i) {
      if (call->valid[i] == 0) continue;
      self.found->push_back(RTCHitN_primID(call->hit, call->N, i));
      call->valid[i] = 0;
    }
  }
};

Vector3 corner(const TriangleMesh& mesh, std::uint32_t triangle, std::size_t which) {
  const auto& at = mesh.vertices[mesh.triangles[triangle][which]];
  return {at[0], at[1], at[2]};
}

}  // namespace

struct TriangleScene::Handles {
  RTCScene scene = nullptr;
  RTCGeometry geometry = nullptr;
  ~Handles() {
    if (geometry != nullptr) rtcReleaseGeometry(geometry);
    if (scene != nullptr) rtcReleaseScene(scene);
  }
};

TriangleScene::TriangleScene(TriangleMesh mesh)
    : mesh_(std::move(mesh)), handles_(std::make_unique<Handles>()) {
  const std::size_t vertices = mesh_.vertices.size();
  mesh_.vertices.push_back({0, 0, 0});  // Embree reads 16 bytes of the last one
  const RTCScene scene = handles_->scene = rtcNewScene(device());
  const RTCGeometry geometry = handles_->geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  if (scene == nullptr || geometry == nullptr) fail("no room for the triangles", device());
  rtcSetSceneFlags(
      scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh_.vertices.data(), 0,
                             sizeof(mesh_.vertices[0]), vertices);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh_.triangles.data(), 0,
                             sizeof(mesh_.triangles[0]), mesh_.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  const UntrappedFloats untrapped;  // the arena's tasks have what holds where it is made
  // On one thread: the order of triangles in a leaf must not depend on how many there are.
  tbb::task_arena(1).execute([scene] {
    const FlushedDenormals flushed;
    rtcCommitScene(scene);
  });
  if (rtcGetDeviceError(device()) != RTC_ERROR_NONE) fail("the triangles cannot be sorted", device());
}

TriangleScene::~TriangleScene() = default;

void TriangleScene::first(std::span<const TriangleRay> rays, std::span<std::uint32_t> triangles) const {
  const FlushedDenormals flushed;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    alignas(16) RTCRayHit ray = packed(rays[i]);
    rtcIntersect1(handles_->scene, &context, &ray);
    triangles[i] = ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? no_triangle : ray.hit.primID;
  }
}

void TriangleScene::all(const TriangleRay& ray, std::vector<std::uint32_t>& triangles) const {
  const FlushedDenormals flushed;
  triangles.clear();
  Collector collector;
  rtcInitIntersectContext(&collector.context);
  collector.context.filter = &Collector::add;
  collector.found = &triangles;
  alignas(16) RTCRayHit query = packed(ray);
  rtcIntersect1(handles_->scene, &collector.context, &query);
}

/// @from  Moller & Trumbore 1997
std::optional<TriangleHit> TriangleScene::locate(const TriangleRay& ray, std::uint32_t triangle) const {
  const Vector3 base = corner(mesh_, triangle, 0);
  const Vector3 edge1 = corner(mesh_, triangle, 1) - base, edge2 = corner(mesh_, triangle, 2) - base;
  const Vector3 across = ray.direction.cross(edge2);
  const double volume = edge1.dot(across);
  if (volume == 0) return std::nullopt;
  const Vector3 from_base = ray.origin - base;
  const Vector3 turned = from_base.cross(edge1);
  double share1 = std::clamp(from_base.dot(across) / volume, 0.0, 1.0);
  const double share2 = std::clamp(ray.direction.dot(turned) / volume, 0.0, 1.0);
  share1 = std::min(share1, 1 - share2);
  return TriangleHit{triangle, edge2.dot(turned) / volume, share1, share2};
}

}  // namespace catoptric::cad::detail
