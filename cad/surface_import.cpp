#include "cad/surface_import.h"

#include <fmt/format.h>

#include <BRepBndLib.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/float_traps.h"
#include "cad/detail/byte_packet.h"
#include "cad/detail/exchange_check.h"
#include "cad/detail/exchange_file.h"
#include "cad/detail/isolated.h"
#include "cad/detail/occt_guard.h"
#include "cad/detail/shape_facets.h"
#include "cad/detail/triangle_scene.h"

namespace catoptric::cad {
namespace {

/// What the reading process sends.
struct ReadFaces {
  Facets facets;
  std::size_t faces = 0;
};

void add_face(const TopoDS_Face& face, Facets& facets) {
  TopLoc_Location place;
  const auto mesh = BRep_Tool::Triangulation(face, place);
  const auto first = static_cast<std::uint32_t>(facets.points_mm.size());
  for (int i = 1; i <= mesh->NbNodes(); ++i) {
    const gp_Pnt at = mesh->Node(i).Transformed(place.Transformation());
    facets.points_mm.emplace_back(at.X(), at.Y(), at.Z());
  }
  const bool reversed = face.Orientation() == TopAbs_REVERSED;
  for (int i = 1; i <= mesh->NbTriangles(); ++i) {
    int a = 0, b = 0, c = 0;
    mesh->Triangle(i).Get(a, b, c);
    if (reversed) std::swap(b, c);
    const auto index = [first](int node) { return first + static_cast<std::uint32_t>(node - 1); };
    facets.corners.push_back({index(a), index(b), index(c)});
  }
}

/// What the child does: reads, meshes, counts.
ReadFaces faces_here(const std::filesystem::path& file, detail::ExchangeKind kind, double chord_error) {
  using detail::ExchangeKind;
  kind == ExchangeKind::step ? detail::check_step_layout(file) : detail::check_iges_layout(file);
  const TopoDS_Shape shape = kind == ExchangeKind::step ? detail::read_step(file) : detail::read_iges(file);
  return detail::guarded("mesh the faces", file.string(), [&] {
    ReadFaces read;
    Bnd_Box box;
    BRepBndLib::Add(shape, box, false);
    if (!TopExp_Explorer(shape, TopAbs_FACE).More() || box.IsVoid())
      throw CadError({"holds no face", file.string(), "light can meet nothing there",
                      "export faces or solids, not curves alone"});
    detail::put_facets(shape, chord_error * std::sqrt(box.SquareExtent()));
    for (TopExp_Explorer i(shape, TopAbs_FACE); i.More(); i.Next(), ++read.faces)
      add_face(TopoDS::Face(i.Current()), read.facets);
    return read;
  });
}

std::string pack(const ReadFaces& read) {
  const Facets& facets = read.facets;
  detail::BytePacket packet;
  packet.put(read.faces);
  packet.put(facets.points_mm.size());
  for (const Vector3& point : facets.points_mm)
    for (const double x : point) packet.put(x);
  packet.put(facets.corners.size());
  for (const auto& triangle : facets.corners)
    for (const std::uint32_t corner : triangle) packet.put(std::size_t{corner});
  return packet.bytes();
}

ReadFaces unpack(const std::string& bytes, const std::filesystem::path& file) {
  detail::ByteReader reader(bytes);
  ReadFaces read;
  Facets& facets = read.facets;
  read.faces = reader.count();
  facets.points_mm.resize(reader.count_of(3 * sizeof(double)));
  bool right = true;
  for (Vector3& point : facets.points_mm) {
    for (double& x : point) x = reader.number();
    right = right && point.allFinite();
  }
  facets.corners.resize(reader.count_of(3 * sizeof(std::size_t)));
  for (auto& triangle : facets.corners)
    for (std::uint32_t& corner : triangle) {
      const std::size_t index = reader.count();
      right = right && index < facets.points_mm.size();
      corner = static_cast<std::uint32_t>(index);
    }
  if (!right || !reader.is_whole() || facets.corners.empty())
    throw CadError(
        {"its faces cannot be used", file.string(), "the reading process sent broken triangles", ""});
  return read;
}

/// Triangles in a ball of radius 1 about the origin, where Embree's floats are finest.
class FacetShape final : public SurfaceShape {
 public:
  FacetShape(const Facets& facets, const Vector3& center_mm, double size_mm)
      : center_mm_(center_mm), size_mm_(size_mm), scene_(mesh_of(facets)), outlines_(facets.outlines()) {
    for (const auto& [a, b, c] : facets.corners) {
      const Vector3 &from = facets.points_mm[a], along = facets.points_mm[b] - from;
      normals_.push_back(along.cross(facets.points_mm[c] - from).stableNormalized());
    }
  }

  std::optional<Meeting> meet(const Ray& ray, bool starts_here, double reach_mm) const override {
    const Vector3 from = (ray.origin_mm - center_mm_) / size_mm_;
    const double middle = -from.dot(ray.direction);  // nearest to the ball's centre
    const double start = std::max(starts_here ? start_above : 0.0, middle - ball);
    const double end = std::min(middle + ball, reach_mm / size_mm_);
    if (!(end > start)) return std::nullopt;
    const detail::TriangleRay piece{from + start * ray.direction, ray.direction, end - start};
    std::uint32_t triangle = detail::no_triangle;
    scene_.first({&piece, 1}, {&triangle, 1});
    if (triangle == detail::no_triangle) return std::nullopt;
    const auto hit = scene_.locate(piece, triangle);
    if (!hit) return std::nullopt;
    const double distance_mm = (start + hit->t) * size_mm_;
    if (!(distance_mm <= reach_mm)) return std::nullopt;
    return Meeting{distance_mm, normals_[triangle], triangle};
  }

  std::vector<std::vector<Vector3>> outlines() const override { return outlines_; }

 private:
  static constexpr double start_above = 1e-5;  ///< a hundred times a float's resolution of the part
  static constexpr double ball = 1.001;        ///< what rounding may lift a corner by

  detail::TriangleMesh mesh_of(const Facets& facets) const {
    detail::TriangleMesh mesh;
    for (const Vector3& point : facets.points_mm) {
      const Vector3 at = (point - center_mm_) / size_mm_;
      mesh.vertices.push_back(
          {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())});
    }
    mesh.triangles = facets.corners;
    return mesh;
  }

  Vector3 center_mm_;
  double size_mm_;
  detail::TriangleScene scene_;
  std::vector<Vector3> normals_;
  std::vector<std::vector<Vector3>> outlines_;
};

void check_chord(double chord_error) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  constexpr double least = 1e-6, greatest = 0.1;
  if (!(chord_error >= least && chord_error <= greatest))
    throw InputError({fmt::format("a chord error of {:.3g} of the part's size is out of range", chord_error),
                      "", fmt::format("it lies between {:.0e} and {}", least, greatest), ""});
}

}  // namespace

ImportedSurface import_surface(const std::filesystem::path& file, const SurfaceImportOptions& options) {
  check_chord(options.chord_error);
  const detail::ExchangeKind kind = detail::kind_of_file(file);
  ReadFaces read =
      unpack(detail::run_isolated(
                 file.string(), detail::limits_for_file(file, options.time_limit, (std::size_t{2} << 30), 64),
                 [&] { return pack(faces_here(file, kind, options.chord_error)); }),
             file);
  Vector3 least = Vector3::Constant(std::numeric_limits<double>::infinity()), greatest = -least;
  for (const Vector3& point : read.facets.points_mm) {
    least = least.cwiseMin(point);
    greatest = greatest.cwiseMax(point);
  }
  const double size_mm = 0.5 * (greatest - least).norm();
  if (!(size_mm > 0))
    throw CadError({"its faces have no size", file.string(), "all corners are one point", "check the unit"});
  auto facets = std::make_shared<const Facets>(std::move(read.facets));
  return {std::make_shared<FacetShape>(*facets, 0.5 * (least + greatest), size_mm), facets, read.faces, least,
          greatest};
}

}  // namespace catoptric::cad
