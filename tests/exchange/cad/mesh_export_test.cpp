#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "cad/export.h"
#include "support/cad/sample_profiles.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using cad::ExportOptions;
using test::TemporaryFolder;

namespace {

using Corner = std::array<float, 3>;
struct Facet {
  Corner normal;
  std::array<Corner, 3> corners;
};

/// Binary STL, by its definition: 80 bytes, a count, 50 bytes a facet.
std::vector<Facet> facets_of(const std::string& file) {
  std::uint32_t count = 0;
  std::memcpy(&count, file.data() + 80, 4);
  REQUIRE(file.size() == 84 + 50 * std::size_t(count));
  std::vector<Facet> facets(count);
  for (std::size_t i = 0; i < count; ++i) std::memcpy(&facets[i], file.data() + 84 + 50 * i, 48);
  return facets;
}

std::vector<Facet> exported(const Profile& profile, const ExportOptions& options) {
  const TemporaryFolder folder;
  const auto report = cad::export_reflector(profile, folder / "mirror.stl", options);
  const auto facets = facets_of(test::read_whole(folder / "mirror.stl"));
  CHECK(static_cast<int>(facets.size()) == report.triangle_count);
  return facets;
}

/// Volume by the divergence theorem: right only when the facets close and all look outward.
double volume(const std::vector<Facet>& facets) {
  double sum = 0;
  for (const auto& [normal, c] : facets) {
    const Vector3 a(c[0][0], c[0][1], c[0][2]), b(c[1][0], c[1][1], c[1][2]), d(c[2][0], c[2][1], c[2][2]);
    sum += a.dot(b.cross(d)) / 6;
  }
  return sum;
}

}  // namespace

TEST_CASE("STL facets of the paraboloid lie on it within the chord tolerance") {
  ExportOptions options;
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    options.chord_tolerance_rel = tolerance;
    const double chord_mm = tolerance * test::paraboloid().diagonal_mm();
    double farthest_middle = 0, farthest_corner = 0;
    for (const Facet& facet : exported(test::paraboloid(), options)) {
      Vector3 middle(0, 0, 0);
      for (const Corner& c : facet.corners) {
        middle += Vector3(c[0], c[1], c[2]) / 3;
        farthest_corner =
            std::max(farthest_corner, std::abs(c[2] - (100 - (c[0] * c[0] + c[1] * c[1]) / 200.0)));
      }
      // Distance along z is at least the distance to the surface.
      const double drop = std::abs(middle.z() - (100 - middle.head<2>().squaredNorm() / 200));
      farthest_middle = std::max(farthest_middle, drop / std::sqrt(2.0));  // slope at most 1
    }
    CAPTURE(tolerance);
    CHECK(farthest_corner < 3e-5);  // float numbers of 100 mm
    CHECK(farthest_middle < chord_mm);
  }
}

TEST_CASE("STL of a walled mirror closes, looks outward and scales with the unit", "[long]") {
  ExportOptions options;
  options.wall = cad::Wall{2};
  options.chord_tolerance_rel = 1e-4;
  const double exact = 2.0 / 3.0 * pi * (52. * 52 * 52 - 50. * 50 * 50);
  const double in_mm = volume(exported(test::hemisphere(50), options));
  // A chord error of e on both sides moves at most e times the area, 2 pi (50^2 + 52^2).
  CHECK(std::abs(in_mm - exact) < 1e-4 * test::hemisphere(50).diagonal_mm() * 2 * pi * (2500 + 2704));
  options.unit = LengthUnit::inch;
  CHECK(volume(exported(test::hemisphere(50), options)) ==
        Approx(in_mm / (25.4 * 25.4 * 25.4)).epsilon(1e-3));
}

TEST_CASE("GLB: metres, y up, and the triangles that the report counts") {
  const TemporaryFolder folder;
  const auto report = cad::export_reflector(test::paraboloid(), folder / "mirror.glb");
  const std::string file = test::read_whole(folder / "mirror.glb");
  REQUIRE(file.substr(0, 4) == "glTF");
  std::uint32_t length = 0;
  std::memcpy(&length, file.data() + 8, 4);
  CHECK(length == file.size());
  // The axis z becomes y; 50 to 100 mm along it.
  CHECK(file.find("\"min\":[-0.1,0.05") != std::string::npos);
  CHECK(file.find("\"max\":[0.1,0.1") != std::string::npos);
  CHECK(file.find("\"count\":" + std::to_string(3 * report.triangle_count) + ",\"type\":\"SCALAR\"") !=
        std::string::npos);
  CHECK(file.find("\"reflector\"") != std::string::npos);
}

TEST_CASE("Meshes are the same bytes each time") {
  const TemporaryFolder folder;
  for (const char* name : {"a.stl", "a.glb"}) {
    cad::export_reflector(test::paraboloid(), folder / name);
    const std::string first = test::read_whole(folder / name);
    cad::export_reflector(test::paraboloid(), folder / name);
    CHECK(first == test::read_whole(folder / name));
  }
}

TEST_CASE("A chord tolerance out of range is refused") {
  const TemporaryFolder folder;
  for (const double tolerance : {0.0, -1.0, 1e-7, 1.0, std::nan("")}) {
    ExportOptions options;
    options.chord_tolerance_rel = tolerance;
    CHECK_THROWS_AS(cad::export_reflector(test::paraboloid(), folder / "a.stl", options), InputError);
  }
  CHECK(folder.is_empty());
}
