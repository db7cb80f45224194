#include "sim/tubes.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "base/units.h"
#include "sim/tube_kernel.h"
#include "support/analytic_reflectors.h"

/// The rung "tubes" against closed forms, pointwise and smoothed.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

constexpr double a_mm = 50;
const PointSource focus({0, 0, a_mm}, pi / 100);
const FieldPlane ground{0, true};

std::vector<double> steps(double first, double last, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(first + (last - first) * i / (count - 1));
  return values;
}

/// Paper eq. 12: parallel light, dense near the axis. W/mm^2.
double paraboloid_irradiance(double r) {
  if (r >= 2 * a_mm) return 0;
  // Intensity over the square of the distance from the focus to the mirror, 2 a / (1 + cos) of a parabola.
  const double z = 2 * a_mm - r * r / (4 * a_mm);
  const double distance = std::hypot(r, z - a_mm);
  return focus.power_w() / (4 * pi * distance * distance);
}

TubesOptions smooth(double h, double tolerance_w_per_m2 = 1e-6) {
  TubesOptions options;
  options.kernel_radius_mm = h;
  options.tolerance_w_per_mm2 = from_w_per_m2(tolerance_w_per_m2);
  return options;
}

/// A field E(r) about the axis under the Silverman kernel, by quadrature in the kernel's own polar
/// coordinates: nothing in common with the rings. `jump` is a radius where E is not smooth.
template <typename Field>
double smoothed_truth(const Field& field, double h, double r, double jump) {
  using Rule = boost::math::quadrature::gauss_kronrod<double, 61>;
  return Rule::integrate(
      [&](double d) {
        const auto at = [&](double azimuth) {
          return field(std::sqrt(std::max(0.0, r * r + d * d + 2 * r * d * std::cos(azimuth))));
        };
        // The azimuth at which the circle of radius d crosses the jump.
        const double cosine = r > 0 && d > 0 ? (jump * jump - r * r - d * d) / (2 * r * d) : 2;
        double ring;
        if (std::abs(cosine) < 1) {
          const double cut = std::acos(cosine);
          ring = Rule::integrate(at, 0.0, cut, 5, 1e-13) + Rule::integrate(at, cut, pi, 5, 1e-13);
        } else {
          ring = Rule::integrate(at, 0.0, pi, 5, 1e-13);
        }
        const double rest = 1 - d * d / (h * h);
        return 3 * rest * rest / (pi * h * h) * 2 * d * ring;
      },
      0.0, h, 12, 1e-12);
}

}  // namespace

TEST_CASE("the kernel's mean over a ring is that of a fine sum", "[tubes]") {
  for (const double h : {1.0, 10.0, 300.0})
    for (const double r : {0.0, 1e-6, 0.3, 5.0, 60.0, 1e4})
      for (const double off : {-0.999, -0.7, -0.1, 0.0, 0.2, 0.6, 0.999}) {
        const double ring = std::abs(r + off * h);
        const double edge = r > 0 && ring > 0 ? (r * r + ring * ring - h * h) / (2 * r * ring) : -1;
        const double last = edge < -1 ? pi : edge > 1 ? 0 : std::acos(edge);
        const double sum = boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
            [&](double azimuth) {
              const double s = std::sin(azimuth / 2);
              const double t2 = ((r - ring) * (r - ring) + 4 * r * ring * s * s) / (h * h);
              return t2 < 1 ? 3 * (1 - t2) * (1 - t2) : 0.0;
            },
            0.0, last, 8, 1e-14);
        INFO("h " << h << ", r " << r << ", ring " << ring);
        // Near the edge r - ring itself is known to a rounding of 1e4: 1e-12 of h.
        const RingMean kernel = kernel_ring_mean(r / h, ring / h);
        CHECK(3 * kernel.value == Approx(sum / pi).epsilon(1e-11).margin(1e-12));
        // Its derivative by the ring's radius, by Richardson's differences, away from the kernel's edges.
        const double at = r / h, q = ring / h, step = 1e-3;
        if (std::min({q, std::abs(q - at - 1), std::abs(q - std::abs(at - 1))}) < 2 * step || q > 100)
          continue;
        const auto difference = [&](double d) {
          return (kernel_ring_mean(at, q + d).value - kernel_ring_mean(at, q - d).value) / (2 * d);
        };
        CHECK(kernel.slope ==
              Approx((4 * difference(step / 2) - difference(step)) / 3).epsilon(1e-7).margin(1e-9));
      }
}

TEST_CASE("tubes reach the paraboloid's closed form, centre and rim included", "[tubes]") {
  const auto mirror = test::paraboloid(a_mm);
  std::vector<double> radii = steps(0, 99.9, 40);
  for (const double r : {1e-9, 1e-3, 100 * (1 - 1e-6), 100 * (1 - 1e-9), 100 * (1 + 1e-9), 150.0})
    radii.push_back(r);
  const TubesField field = tubes_field(focus, mirror.profile(), {}, ground, radii, {});
  for (std::size_t i = 0; i < radii.size(); ++i) {
    INFO("r " << radii[i]);
    CHECK(field.irradiance[i] == Approx(paraboloid_irradiance(radii[i])).epsilon(1e-11).margin(0));
  }
  CHECK(field.irradiance[0] == Approx(from_w_per_m2(1)).epsilon(1e-11));
  CHECK(field.rays < 300);
  CHECK(field.landed_w == Approx(focus.power_w() / 2).epsilon(1e-12));
  CHECK(field.cut_off_w == 0);
}

TEST_CASE("a tolerance spares the rays that polish", "[tubes]") {
  const auto mirror = test::paraboloid(a_mm);
  const std::vector<double> radii = steps(0, 110, 1024);
  TubesOptions options;
  options.pointwise_tolerance_w_per_mm2 = from_w_per_m2(5e-7);
  const TubesField field = tubes_field(focus, mirror.profile(), {}, ground, radii, options);
  CHECK(field.rays <= 40);
  CHECK(field.error_w_per_mm2 <= from_w_per_m2(5e-7));
  for (std::size_t i = 0; i < radii.size(); ++i) {
    INFO("r " << radii[i]);
    CHECK(std::abs(field.irradiance[i] - paraboloid_irradiance(radii[i])) <= field.error_w_per_mm2);
  }
}

TEST_CASE("a tolerance spares rays at folds too", "[tubes]") {
  // The paper's start A, whose beam is folded inside the field: against every branch polished by rays.
  const Profile start_a = Profile::bezier({{0, 100, 1}, {50, 100, 1.6}, {90, 50, 1}});
  const std::vector<double> radii = steps(0, 110, 1024);
  const TubesField polished = tubes_field(focus, start_a, {}, ground, radii, {});
  TubesOptions options;
  options.pointwise_tolerance_w_per_mm2 = from_w_per_m2(5e-7);
  const TubesField field = tubes_field(focus, start_a, {}, ground, radii, options);
  CHECK(field.rays < polished.rays / 5);
  CHECK(field.error_w_per_mm2 <= from_w_per_m2(5e-7));
  for (std::size_t i = 0; i < radii.size(); ++i) {
    INFO("r " << radii[i]);
    CHECK(std::abs(field.irradiance[i] - polished.irradiance[i]) <=
          field.error_w_per_mm2 + 1e-9 * polished.irradiance[i]);
  }
}

TEST_CASE("tubes reach the paraboloid smoothed, over its sharp rim", "[tubes]") {
  const auto mirror = test::paraboloid(a_mm);
  const std::vector<double> radii = steps(0, 120, 31);
  for (const double h : {2.0, 5.0, 30.0}) {
    const TubesField field = tubes_field(focus, mirror.profile(), {}, ground, radii, smooth(h, 5e-7));
    CHECK(field.error_w_per_mm2 <= from_w_per_m2(5e-7));
    if (h >= 5) CHECK(field.rays <= 65);
    for (std::size_t i = 0; i < radii.size(); ++i) {
      INFO("h " << h << ", r " << radii[i] << ", rays " << field.rays);
      const double truth = smoothed_truth(paraboloid_irradiance, h, radii[i], 2 * a_mm);
      CHECK(std::abs(field.irradiance[i] - truth) <= field.error_w_per_mm2 + 1e-9 * from_w_per_m2(1));
    }
  }
}

TEST_CASE("a sphere about the source sends each ray back: reflected is direct", "[tubes]") {
  const auto mirror = test::half_ellipsoid(a_mm, 50, 50);
  const std::vector<double> radii = steps(0, 300, 31);
  const auto direct = [](double r) {
    const double d = std::hypot(r, a_mm);
    return focus.power_w() / (4 * pi) * a_mm / (d * d * d);
  };
  const TubesField field = tubes_field(focus, mirror.profile(), {0.8, 0}, ground, radii, {});
  for (std::size_t i = 0; i < radii.size(); ++i) {
    INFO("r " << radii[i]);
    CHECK(field.irradiance[i] == Approx(0.8 * direct(radii[i])).epsilon(1e-11));
  }
  const TubesField blurred = tubes_field(focus, mirror.profile(), {0.8, 0}, ground, radii, smooth(20));
  for (std::size_t i = 0; i < radii.size(); ++i)
    CHECK(std::abs(blurred.irradiance[i] - 0.8 * smoothed_truth(direct, 20, radii[i], -1)) <=
          blurred.error_w_per_mm2 + 1e-9 * from_w_per_m2(1));
  CHECK(field.landed_w == Approx(0.8 * focus.power_w() / 2).epsilon(1e-12));
}

TEST_CASE("tubes carry the reflectance at each ray's incidence", "[tubes]") {
  const auto mirror = test::paraboloid(a_mm);
  const std::vector<double> radii = steps(0, 110, 300);
  // The table bends where rays land at r = 2 a tan of its angles, and reaches 0.
  for (const Material& material : {Material::metal(1.1, 6.6), Material::metal(0.3, 1.2),
                                   Material::with_table({0, 0.3, 0.5, 0.7}, {0.9, 0.5, 0.7, 0.1}),
                                   Material::with_table({0.2, 0.6}, {1, 0})}) {
    const auto truth = [&](double r) {
      return material.reflectance_at(1 / std::hypot(1.0, r / (2 * a_mm))) * paraboloid_irradiance(r);
    };
    const TubesField exact = tubes_field(focus, mirror.profile(), material, ground, radii, {});
    TubesOptions rough;
    rough.pointwise_tolerance_w_per_mm2 = from_w_per_m2(1e-5);
    const TubesField near = tubes_field(focus, mirror.profile(), material, ground, radii, rough);
    const TubesField blurred = tubes_field(focus, mirror.profile(), material, ground, radii, smooth(5));
    CAPTURE(exact.rays, near.rays, blurred.rays, near.error_w_per_mm2, blurred.error_w_per_mm2);
    CHECK(near.rays < exact.rays);
    CHECK(blurred.error_w_per_mm2 < from_w_per_m2(2e-6));
    for (std::size_t i = 0; i < radii.size(); ++i) {
      INFO("r " << radii[i]);
      CHECK(exact.irradiance[i] == Approx(truth(radii[i])).epsilon(1e-11).margin(1e-20));
      CHECK(std::abs(near.irradiance[i] - truth(radii[i])) <= near.error_w_per_mm2);
      if (i % 50 == 0)
        CHECK(std::abs(blurred.irradiance[i] - smoothed_truth(truth, 5, radii[i], 2 * a_mm)) <=
              blurred.error_w_per_mm2 + from_w_per_m2(1e-8));
    }
  }
}

TEST_CASE("tubes refuse mirrors that scatter", "[tubes]") {
  const auto mirror = test::paraboloid(a_mm);
  const auto flat = NearField::disc({0, 0, 0}, {0, 0, 1}, 50);
  for (const Material& material : {Material{0.8, 0, 0.1}, Material{1, 0, 0, 0.1}}) {
    CHECK(tubes_objection(focus, mirror.profile(), material, flat)->find("scatters") != std::string::npos);
    CHECK_THROWS_AS(tubes_field(focus, mirror.profile(), material, ground, std::vector<double>{1.0}, {}),
                    InputError);
  }
  CHECK_FALSE(tubes_objection(focus, mirror.profile(), Material::metal(1.1, 6.6), flat));
  CHECK_FALSE(tubes_objection(focus, mirror.profile(), Material{0, 0.5, 0, 0.1}, flat));  // nothing is rough
}

TEST_CASE("a cone's light comes from the mirrored source, a cylinder's too", "[tubes]") {
  // In its meridian a straight mirror makes an image point: rho = image_r + (distance) tan, a flux of rings.
  struct Case {
    double r_low, z_low, r_high, z_high;
  };
  for (const Case& c : {Case{100, 50, 40, 90}, Case{60, 10, 60, 20}, Case{70, 5, 60, 20}}) {
    const auto mirror = test::cone(c.r_low, c.z_low, c.r_high, c.z_high);
    const double tx = c.r_high - c.r_low, tz = c.z_high - c.z_low, length = std::hypot(tx, tz);
    const double nx = -tz / length, nz = tx / length;
    const double off = 2 * ((0 - c.r_low) * nx + (a_mm - c.z_low) * nz);
    const double image_x = -off * nx, image_z = a_mm - off * nz;
    const auto landing = [&](double x, double z) {  // of the ray over the mirror's point (x, z)
      return image_x + (x - image_x) * image_z / (image_z - z);
    };
    const double first = landing(c.r_low, c.z_low), last = landing(c.r_high, c.z_high);
    const double low = std::min(first, last), high = std::max(first, last);
    const auto truth = [&](double r) {
      double sum = 0;
      for (const double rho : {r, -r}) {
        if (!(rho > low && rho < high)) continue;
        // The image's ray to rho, and the emission angle it comes from: both turn alike.
        const double d = std::hypot(rho - image_x, image_z);
        // Where it meets the mirror's line.
        const double ux = (rho - image_x) / d, uz = -image_z / d;
        const double t = ((c.r_low - image_x) * nx + (c.z_low - image_z) * nz) / (ux * nx + uz * nz);
        const double x = image_x + t * ux, z = image_z + t * uz;
        const double sine = x / std::hypot(x, z - a_mm);
        sum += focus.power_w() / (4 * pi) * sine / r * image_z / (d * d);
      }
      return sum;
    };
    const std::vector<double> radii = steps(0.5, 200, 50);
    const TubesField field = tubes_field(focus, mirror.profile(), {}, ground, radii, {});
    for (std::size_t i = 0; i < radii.size(); ++i) {
      INFO("cone from " << c.r_low << " to " << c.r_high << ", r " << radii[i]);
      CHECK(field.irradiance[i] == Approx(truth(radii[i])).epsilon(1e-10).margin(1e-20));
    }
  }
}

TEST_CASE("an ellipsoid gathers all light in its other focus", "[tubes]") {
  // Half axes 50 across and sqrt(50^2 + 40^2) along: foci 40 from the centre at z = 40, so at 80 and 0.
  const double height = std::sqrt(50.0 * 50 + 40.0 * 40);
  const auto mirror = test::half_ellipsoid(40, 50, height);
  const PointSource upper({0, 0, 80}, 1);
  const std::vector<double> radii{0, 3, 9.9, 10.1};
  const TubesField field = tubes_field(upper, mirror.profile(), {}, ground, radii, smooth(10));
  const double power = field.landed_w;
  CHECK(power == Approx(0.5 * (1 + 40 / std::hypot(50.0, 40.0))).epsilon(1e-12));
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double rest = std::max(0.0, 1 - radii[i] * radii[i] / 100);
    CHECK(field.irradiance[i] == Approx(power * 3 * rest * rest / (pi * 100)).epsilon(1e-11).margin(1e-15));
  }
}

TEST_CASE("what is on the plane is what the mirror caught", "[tubes]") {
  // Start A folds nothing and starts nothing a second time; the field over the whole plane holds its power.
  const Profile start_a = Profile::bezier({{0, 100, 1}, {50, 100, 1.6}, {90, 50, 1}});
  const Material dull{0.7, 0};
  const double h = 10, reach = 400;
  using Rule = boost::math::quadrature::gauss<double, 20>;
  std::vector<double> radii, weights;
  constexpr int parts = 400;
  for (int part = 0; part < parts; ++part)
    for (std::size_t k = 0; k < Rule::abscissa().size(); ++k)
      for (const double sign : {-1.0, 1.0}) {
        radii.push_back(reach / parts * (part + 0.5 + 0.5 * sign * Rule::abscissa()[k]));
        weights.push_back(0.5 * reach / parts * Rule::weights()[k]);
      }
  const TubesField field = tubes_field(focus, start_a, dull, ground, radii, smooth(h, 1e-9));
  double sum = 0;
  for (std::size_t i = 0; i < radii.size(); ++i) sum += 2 * pi * radii[i] * weights[i] * field.irradiance[i];
  const double caught = 0.5 * focus.power_w();  // the rim lies at the source's height
  CHECK(field.landed_w == Approx(0.7 * caught).epsilon(1e-12));
  CHECK(sum == Approx(field.landed_w).epsilon(1e-9));
}

TEST_CASE("the error bound holds against a hundred times finer tubes", "[tubes]") {
  for (const Profile& profile : {Profile::bezier({{0, 100, 1}, {50, 100, 1.6}, {90, 50, 1}}),
                                 Profile::bezier({{0, 100, 1}, {50, 100, 1.8}, {70, 50, 1}}),
                                 Profile::bezier({{30, 90, 1}, {70, 80, 1}, {60, 10, 1}})}) {
    const std::vector<double> radii = steps(0, 60, 41);
    const TubesField fine = tubes_field(focus, profile, {}, ground, radii, smooth(5, 1e-9));
    REQUIRE(fine.error_w_per_mm2 <= from_w_per_m2(1e-9));
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      const TubesField field = tubes_field(focus, profile, {}, ground, radii, smooth(5, tolerance));
      REQUIRE(field.error_w_per_mm2 <= from_w_per_m2(tolerance));
      double worst = 0;
      for (std::size_t i = 0; i < radii.size(); ++i)
        worst = std::max(worst, std::abs(field.irradiance[i] - fine.irradiance[i]));
      INFO("tolerance " << tolerance << " rays " << field.rays << " against " << fine.rays << ", error "
                        << to_w_per_m2(worst) << " bound " << to_w_per_m2(field.error_w_per_mm2));
      CHECK(worst <= field.error_w_per_mm2 + fine.error_w_per_mm2);
    }
  }
}

TEST_CASE("the error bound holds on random generatrices, interpolated between radii", "[tubes][long]") {
  std::mt19937_64 engine(20260814);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  const std::vector<double> radii = steps(0, 70, 300);
  int judged = 0;
  double nearest = 0;  // of the true error to its bound
  for (int i = 0; i < 40; ++i) {
    std::vector<ControlPoint> points{{0, uniform(90, 110), 1}};
    const int more = 2 + i % 3;
    for (int k = 1; k <= more; ++k)
      points.push_back({100.0 * k / more + uniform(-15, 15),
                        100 - 50.0 * k * k / more / more + uniform(-15, 15), uniform(0.4, 2.5)});
    const Profile profile = Profile::bezier(points);
    const double h = i % 2 == 0 ? 5 : 1.5;
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
      const TubesField field = tubes_field(focus, profile, {}, ground, radii, smooth(h, tolerance));
      const TubesField fine = tubes_field(focus, profile, {}, ground, radii, smooth(h, tolerance / 100));
      double worst = 0;
      for (std::size_t k = 0; k < radii.size(); ++k)
        worst = std::max(worst, std::abs(field.irradiance[k] - fine.irradiance[k]));
      INFO("mirror " << i << ", tolerance " << tolerance << ", rays " << field.rays << ", error "
                     << to_w_per_m2(worst) << ", bound " << to_w_per_m2(field.error_w_per_mm2));
      CHECK(worst <= field.error_w_per_mm2 + fine.error_w_per_mm2);
      CHECK(field.error_w_per_mm2 < 3 * from_w_per_m2(tolerance));
      judged += fine.error_w_per_mm2 < 0.1 * field.error_w_per_mm2;
      nearest = std::max(nearest, worst / field.error_w_per_mm2);
    }
  }
  CHECK(judged > 100);    // the finer run is fine enough to judge
  CHECK(nearest > 0.01);  // and the bound is not an idle one
}

TEST_CASE("light through the mirror counts, and light that comes from below does not", "[tubes]") {
  // A half-silvered dome about the source: transmitted light leaves upwards, the reflected half comes down,
  // passes the source and never meets the dome again.
  const auto mirror = test::half_ellipsoid(a_mm, 50, 50);
  const std::vector<double> radii{0, 40};
  const TubesField below = tubes_field(focus, mirror.profile(), {0.25, 0.75}, ground, radii, {});
  CHECK(below.irradiance[0] == Approx(0.25 * focus.power_w() / (4 * pi * 2500)).epsilon(1e-12));
  const TubesField above = tubes_field(focus, mirror.profile(), {0.25, 0.75}, {150, false}, radii, {});
  CHECK(above.irradiance[0] == Approx(0.75 * focus.power_w() / (4 * pi * 10000)).epsilon(1e-12));
  CHECK(tubes_field(focus, mirror.profile(), {0.25, 0.75}, {150, true}, radii, {}).irradiance[0] == 0);
}

TEST_CASE("the rung says in words what it cannot light", "[tubes]") {
  const auto mirror = test::paraboloid(a_mm);
  const NearField flat = NearField::disc({3, 4, 0}, {0, 0, 1}, 50);
  CHECK_FALSE(tubes_objection(focus, mirror.profile(), {}, flat));
  CHECK(tubes_objection(PointSource({1, 0, 50}, 1), mirror.profile(), {}, flat)->find("off the axis") !=
        std::string::npos);
  CHECK(tubes_objection(focus, mirror.profile(), {}, NearField::disc({0, 0, 0}, {0.1, 0, 1}, 50))
            ->find("tilted") != std::string::npos);
  CHECK(tubes_objection(focus, mirror.profile(), {},
                        NearField::disc({0, 0, 0}, {0, 0, 1}, 50, Material::matt(0.5)))
            ->find("real object") != std::string::npos);
  CHECK_THROWS_AS(tubes_field(PointSource({1, 0, 50}, 1), mirror.profile(), {}, ground, steps(0, 9, 2), {}),
                  InputError);
}
