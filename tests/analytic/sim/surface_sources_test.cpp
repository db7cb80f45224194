#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "base/errors.h"
#include "base/random_stream.h"
#include "base/units.h"
#include "sim/cylinder_source.h"
#include "sim/frame.h"
#include "sim/rectangle_source.h"
#include "sim/simulation.h"
#include "sim/sphere_source.h"
#include "support/flat_mirror.h"

/// Direct and reflected light of surfaces that radiate by Lambert's law, against sums over their parts.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr double power = 3;

/// A part of a surface: place, outward normal, area.
struct Part {
  Vector3 at, normal;
  double area;
};

double sum_over(const std::vector<Part>& parts, const Vector3& point, const Vector3& normal) {
  double sum = 0, area = 0;
  for (const Part& part : parts) {
    const Vector3 way = part.at - point;
    sum += std::max(0.0, way.dot(normal)) * std::max(0.0, -way.dot(part.normal)) /
           std::pow(way.squaredNorm(), 2) * part.area;
    area += part.area;
  }
  return power / area / pi * sum;
}

std::vector<Part> rectangle(const Vector3& center, const Eigen::Matrix3d& frame, double width, double height,
                            int n) {
  std::vector<Part> parts;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      parts.push_back({center + ((i + 0.5) / n - 0.5) * width * frame.col(0) +
                           ((j + 0.5) / n - 0.5) * height * frame.col(1),
                       frame.col(2), width * height / (n * n)});
  return parts;
}

std::vector<Part> sphere(const Vector3& center, double radius, int n) {
  std::vector<Part> parts;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double z = 1 - 2 * (i + 0.5) / n, r = std::sqrt(1 - z * z), a = pi * (j + 0.5) / n;
      const Vector3 out(r * std::cos(a), r * std::sin(a), z);
      parts.push_back({center + radius * out, out, 2 * pi * radius * radius / (n * n)});
    }
  return parts;
}

std::vector<Part> cylinder(const Vector3& center, const Eigen::Matrix3d& frame, double radius, double length,
                           int n) {
  std::vector<Part> parts;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double a = pi * (j + 0.5) / n;
      const Vector3 out = std::cos(a) * frame.col(0) + std::sin(a) * frame.col(1);
      parts.push_back({center + ((i + 0.5) / n - 0.5) * length * frame.col(2) + radius * out, out,
                       pi * radius * length / (n * n)});
    }
  return parts;
}

/// Places and directions of elements about a source of size 1.
struct Element {
  Vector3 point, normal, axis, center;
};
Element element(std::uint64_t i) {
  RandomStream stream(3, Purpose::test, i);
  const auto vector = [&] {
    const double x = stream.uniform(), y = stream.uniform(), z = stream.uniform();
    return Vector3(2 * x - 1, 2 * y - 1, 2 * z - 1);
  };
  const Vector3 center = vector(), axis = vector().normalized(), normal = vector().normalized();
  return {center + (1.6 + 2 * stream.uniform()) * vector().normalized(), normal, axis, center};
}

/// Compares with the sum, which is good to `coarse` of the greatest value there is.
void check_direct(const std::function<std::pair<double, double>(const Element&)>& both, double coarse) {
  int lit = 0;
  for (std::uint64_t i = 0; i < 100; ++i) {
    const auto [got, wanted] = both(element(i));
    CAPTURE(i);
    CHECK(got == Approx(wanted).epsilon(2e-4).margin(coarse));
    lit += wanted > 0;
  }
  CHECK(lit > 20);
}

}  // namespace

TEST_CASE("a rectangle's direct light anywhere is what a sum over its parts gives, cut by the plane or not") {
  check_direct(
      [](const Element& e) {
        const Eigen::Matrix3d frame = frame_about(e.axis);
        const LambertianRectangle source(e.center, e.axis, frame.col(0) + 0.4 * e.axis, 1.2, 0.5, power);
        return std::pair(source.unhindered_w_per_mm2(e.point, e.normal),
                         sum_over(rectangle(e.center, frame, 1.2, 0.5, 200), e.point, e.normal));
      },
      1e-6);
}

TEST_CASE("a sphere's direct light anywhere is what a sum over its parts gives, cut by the plane or not") {
  check_direct(
      [](const Element& e) {
        return std::pair(LambertianSphere(e.center, 0.7, power).unhindered_w_per_mm2(e.point, e.normal),
                         sum_over(sphere(e.center, 0.7, 200), e.point, e.normal));
      },
      1e-5);
  const LambertianSphere globe({0, 0, 10}, 2, power);
  CHECK(globe.unhindered_w_per_mm2({0, 0, 0}, {0, 0, 1}) == Approx(power / (4 * pi * 100)).epsilon(1e-14));
  CHECK(globe.unhindered_w_per_mm2({0, 0, 9}, {0, 0, 1}) == 0);  // within
  CHECK(globe.unhindered_w_per_mm2({0, 0, 0}, {0, 0, -1}) == 0);
}

TEST_CASE("a cylinder's direct light anywhere is what a sum over its parts gives, cut by the plane or not",
          "[long]") {
  check_direct(
      [](const Element& e) {
        const Eigen::Matrix3d frame = frame_about(e.axis);
        const LambertianCylinder source(e.center, e.axis, 0.3, 1.4, power);
        return std::pair(source.unhindered_w_per_mm2(e.point, e.normal),
                         sum_over(cylinder(e.center, frame, 0.3, 1.4, 200), e.point, e.normal));
      },
      1e-5);
  // From afar it is a point whose intensity goes like the sine.
  const LambertianCylinder rod({0, 0, 0}, {0, 0, 1}, 1e-6, 1e-5, power);
  for (const double angle : {0.1, 0.8, 1.5}) {
    const Vector3 way(std::sin(angle), 0, std::cos(angle));
    CHECK(rod.unhindered_w_per_mm2(100 * way, -way) ==
          Approx(power / (pi * pi) * std::sin(angle) / 1e4).epsilon(1e-5));
    CHECK(rod.intensity_w_per_sr(way) == Approx(power / (pi * pi) * std::sin(angle)).epsilon(1e-12));
  }
}

TEST_CASE("the sine law's integral and inverse are each other's, to its ends") {
  const CosineLaw law = CosineLaw::sine();
  CHECK(2 * pi * (law.integral(1) - law.integral(-1)) == Approx(law.total_sr()).epsilon(1e-15));
  for (const double cosine : {0.0, 1e-9, 0.3, 0.9, 0.999999, 1 - 1e-12, 1.0}) {
    CAPTURE(cosine);
    CHECK(law.inverse(law.integral(cosine)) == Approx(cosine).margin(1e-10));
    CHECK(law.inverse(law.integral(-cosine)) == Approx(-cosine).margin(1e-10));
  }
  // Its derivative is the law itself.
  for (const double cosine : {-0.9, 0.1, 0.7})
    CHECK((law.integral(cosine + 1e-6) - law.integral(cosine - 1e-6)) / 2e-6 ==
          Approx(law(cosine)).epsilon(1e-8));
}

TEST_CASE("a flat mirror shows a surface's image: its light is the image's direct light", "[long]") {
  // Mirror at 20, wide enough for all ways from the source at 10 to the field at 0: the image is at 30.
  const test::FlatMirror mirror(20, 30);
  const NearField field = NearField::disc({0, 0, 0}, {0, 0, 1}, 10);
  const std::vector<FieldSample> samples = field.samples(40);
  const Vector3 along(1, 0.3, 0), leaning = Vector3(0.2, 0, 1).normalized(),
                                  image_leaning(leaning.x(), 0, -leaning.z());
  // A rod is dark along its axis, where a kernel is biased: that is turned away from the field.
  const Vector3 lying = Vector3(1, -0.4, 0.5).normalized(), image_lying(lying.x(), lying.y(), -lying.z());
  const LambertianRectangle flat({1, 2, 10}, {0, 0, 1}, along, 6, 3, power),
      flat_image({1, 2, 30}, {0, 0, -1}, along, 6, 3, power);
  const LambertianSphere ball({1, 2, 10}, 3, power), ball_image({1, 2, 30}, 3, power);
  const LambertianCylinder rod({1, 2, 10}, lying, 1, 6, power),
      rod_image({1, 2, 30}, image_lying, 1, 6, power);
  for (const auto& [source, image] : {std::pair<const Source*, const Source*>{&flat, &flat_image},
                                      {&ball, &ball_image},
                                      {&rod, &rod_image}}) {
    CAPTURE(source->words());
    const PhotonOptions photons{1 << 20, Sampler::sobol, 5};
    const FieldEstimate got =
        simulate({*source, mirror, {}, field}, samples, photons, {Kernel::silverman, std::nullopt, 2.0});
    for (std::size_t i = 0; i < samples.size(); ++i)
      CHECK(got.reflected[i] ==
            Approx(image->unhindered_w_per_mm2(samples[i].point_mm, samples[i].normal)).epsilon(0.03));
  }
}

TEST_CASE("sizes that are none are refused") {
  CHECK_THROWS_AS(LambertianSphere({0, 0, 0}, 0, 1), InputError);
  CHECK_THROWS_AS(LambertianCylinder({0, 0, 0}, {0, 0, 1}, 1, -1, 1), InputError);
  CHECK_THROWS_AS(LambertianRectangle({0, 0, 0}, {0, 0, 1}, {0, 0, 2}, 1, 1, 1), InputError);
  CHECK_THROWS_AS(LambertianRectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, NAN, 1, 1), InputError);
}
