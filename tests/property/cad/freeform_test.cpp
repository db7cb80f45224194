#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <thread>

#include "base/tolerance.h"
#include "cad/engines.h"
#include "cad/meridian_reflector.h"
#include "support/cad/random_profile.h"
#include "support/cad/rays.h"

using namespace catoptric;
using namespace catoptric::test;

namespace {

using Wide = long double;

struct WidePoint {
  Wide r, z;
};

/// De Casteljau in 64 bits, written apart from the engine's evaluators.
WidePoint evaluate_wide(const RationalSpan& span, Wide s) {
  std::vector<Wide> r(span.rw.begin(), span.rw.end()), z(span.zw.begin(), span.zw.end()),
      w(span.w.begin(), span.w.end());
  for (std::size_t n = w.size() - 1; n > 0; --n)
    for (std::size_t i = 0; i < n; ++i) {
      r[i] += s * (r[i + 1] - r[i]);
      z[i] += s * (z[i + 1] - z[i]);
      w[i] += s * (w[i + 1] - w[i]);
    }
  return {r[0] / w[0], z[0] / w[0]};
}

/// Crossings by brute force: the whole generatrix sampled densely, every change of sign and every dip towards
/// zero followed up by bisection and golden section. Shares no method with the engine.
class BruteForce {
 public:
  explicit BruteForce(const Profile& profile) : profile_(profile) {
    for (const RationalSpan& span : profile.spans())
      for (int i = 0; i <= samples; ++i)
        points_.push_back(evaluate_wide(span, static_cast<Wide>(i) / samples));
  }

  struct Result {
    std::size_t count = 0;
    bool doubtful = false;
  };

  Result count(const Ray& ray) const {
    Result result;
    const Wide size = profile_.diagonal_mm();
    const std::size_t per_span = samples + 1;
    for (std::size_t k = 0; k < profile_.spans().size(); ++k) {
      const RationalSpan& span = profile_.spans()[k];
      const auto f = [&](Wide s) { return residual(ray, evaluate_wide(span, s)); };
      std::vector<Wide> values;
      for (std::size_t i = 0; i < per_span; ++i) values.push_back(residual(ray, points_[k * per_span + i]));
      for (std::size_t i = 0; i + 1 < per_span; ++i) {
        result.count += (values[i] < 0) != (values[i + 1] < 0);
        if (i == 0) continue;
        const Wide before = std::abs(values[i - 1]), here = std::abs(values[i]),
                   after = std::abs(values[i + 1]);
        const bool same = (values[i - 1] < 0) == (values[i] < 0) && (values[i] < 0) == (values[i + 1] < 0);
        if (!same || here > before || here > after) continue;
        const Wide sign = values[i] < 0 ? -1 : 1;
        const Wide extreme = least([&](Wide s) { return sign * f(s); }, static_cast<Wide>(i - 1) / samples,
                                   static_cast<Wide>(i + 1) / samples);
        if (std::abs(extreme) < 1e-12L * size) result.doubtful = true;
        if (extreme < 0) result.count += 2;
      }
      // The ends: a hit within rounding of the rim may count or not.
      if (std::abs(values.front()) < 1e-13L * size || std::abs(values.back()) < 1e-13L * size)
        result.doubtful = true;
    }
    return result;
  }

 private:
  static constexpr int samples = 400;

  static Wide residual(const Ray& ray, const WidePoint& p) {
    const Wide dz = ray.direction.z(), height = p.z - ray.origin_mm.z();
    const Wide x = dz * ray.origin_mm.x() + height * ray.direction.x();
    const Wide y = dz * ray.origin_mm.y() + height * ray.direction.y();
    return std::abs(dz) * p.r - std::hypot(x, y);
  }

  template <typename Function>
  static Wide least(const Function& f, Wide low, Wide high) {
    const Wide golden = (std::sqrt(5.0L) - 1) / 2;
    Wide a = high - golden * (high - low), b = low + golden * (high - low);
    Wide fa = f(a), fb = f(b);
    for (int i = 0; i < 60; ++i) {
      if (fa < fb) {
        high = b;
        b = a;
        fb = fa;
        a = high - golden * (high - low);
        fa = f(a);
      } else {
        low = a;
        a = b;
        fa = fb;
        b = low + golden * (high - low);
        fb = f(b);
      }
      if (std::min(fa, fb) < 0) break;
    }
    return std::min(fa, fb);
  }

  const Profile& profile_;
  std::vector<WidePoint> points_;
};

Ray line_through(const Ray& ray, double size) {  // all crossings of the line lie ahead
  return {ray.origin_mm - 20 * size * ray.direction, ray.direction};
}

}  // namespace

TEST_CASE("every degree: hits lie on ray and surface, and are as many as brute force finds",
          "[meridian][long]") {
  for (int degree = 1; degree <= 9; ++degree) {
    std::size_t rays = 0, hits = 0, wrong = 0, doubtful = 0;
    double backward = 0;
    std::uint64_t halved = 0, exact = 0;
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      const Profile profile = random_profile(degree, seed);
      const double size = profile.diagonal_mm();
      const auto reflector = cad::make_meridian_reflector(profile);
      const auto probe = reflector->probe();
      const BruteForce brute(profile);
      std::vector<Ray> lines;
      std::vector<std::optional<Hit>> firsts;
      for (const RayClass which : all_classes)
        for (std::uint64_t i = 0; i < 700; ++i) {
          const Ray ray = line_through(random_ray(which, profile, {1, 2, 30}, seed, i), size);
          const std::vector<Hit> found = probe->all_hits(ray, 0);
          const BruteForce::Result truth = brute.count(ray);
          ++rays;
          hits += found.size();
          doubtful += truth.doubtful;
          if (!truth.doubtful && truth.count != found.size()) {
            ++wrong;
            UNSCOPED_INFO("degree " << degree << " seed " << seed << " class " << name(which) << " ray " << i
                                    << ": " << found.size() << " hits, brute force " << truth.count);
          }
          lines.push_back(ray);
          firsts.push_back(found.empty() ? std::nullopt : std::optional(found.front()));
          for (std::size_t k = 0; k < found.size(); ++k) {
            backward = std::max(backward, backward_error(profile, ray, found[k]) / size);
            CHECK(found[k].normal.norm() == Approx(1).epsilon(1e-14));
            CHECK(found[k].normal.dot(ray.direction) <= 0);
            if (k > 0) CHECK(found[k].distance_mm >= found[k - 1].distance_mm);
          }
        }
      std::vector<std::optional<Hit>> batch(lines.size());
      probe->first_hits(lines, 0, batch);
      for (std::size_t i = 0; i < lines.size(); ++i) {
        INFO("degree " << degree << " seed " << seed << " ray " << i << " in a batch");
        REQUIRE(batch[i].has_value() == firsts[i].has_value());
        if (batch[i]) CHECK(batch[i]->distance_mm == firsts[i]->distance_mm);
      }
      const auto& counts = dynamic_cast<const cad::MeridianProbe&>(*probe).counts();
      halved += counts.halved;
      exact += counts.exact;
    }
    fmt::print(
        "degree {}: {} rays, {} hits, {} wrong, {} doubtful, backward {:.1e}; halved {}, 113 bits {}\n",
        degree, rays, hits, wrong, doubtful, backward, halved, exact);
    CHECK(wrong == 0);
    CHECK(backward <= 1e-13);
    CHECK(doubtful <= rays / 100);
  }
}

TEST_CASE("forty wavy spans: culling loses nothing that brute force finds", "[meridian][long]") {
  std::vector<ControlPoint> points;
  for (int i = 0; i < 43; ++i) {
    const double r = 2.0 * i;
    points.push_back({r, 60 - r * r / 150 + 2 * std::sin(1.7 * i), 1 + 0.5 * std::cos(2.3 * i)});
  }
  const Profile profile(3, Profile::uniform_knots(3, points.size()), points);
  REQUIRE(profile.spans().size() == 40);
  const double size = profile.diagonal_mm();
  const auto reflector = cad::make_meridian_reflector(profile);
  const auto probe = reflector->probe();
  const BruteForce brute(profile);
  std::size_t most = 0, doubtful = 0;
  for (const RayClass which : all_classes)
    for (std::uint64_t i = 0; i < 700; ++i) {
      const Ray ray = line_through(random_ray(which, profile, {1, 2, 40}, 17, i), size);
      const std::vector<Hit> found = probe->all_hits(ray, 0);
      const BruteForce::Result truth = brute.count(ray);
      doubtful += truth.doubtful;
      most = std::max(most, found.size());
      INFO("class " << name(which) << " ray " << i);
      if (!truth.doubtful) CHECK(found.size() == truth.count);
      const auto first = probe->first_hit(ray, 0);
      REQUIRE(first.has_value() == !found.empty());
      if (first) CHECK(first->distance_mm == found.front().distance_mm);
      // From between the hits only the later ones count.
      if (found.size() < 2) continue;
      const double between = 0.5 * (found[0].distance_mm + found[1].distance_mm);
      CHECK(probe->all_hits(ray, between).size() == found.size() - 1);
      CHECK(probe->first_hit(ray, between)->distance_mm == found[1].distance_mm);
    }
  CHECK(most >= 5);
  CHECK(doubtful <= 28);
}

TEST_CASE("normals are across the generatrix and across the azimuth", "[meridian]") {
  for (int degree = 1; degree <= 9; ++degree) {
    const Profile profile = random_profile(degree, 7);
    const auto reflector = cad::make_meridian_reflector(profile);
    const auto probe = reflector->probe();
    for (std::uint64_t i = 0; i < 500; ++i) {
      const Ray ray = random_ray(RayClass::from_focus, profile, {0, 0, 20}, 3, i);
      const auto hit = probe->first_hit(ray, 0);
      if (!hit) continue;
      const MeridianPoint p = profile.at(hit->parameter);
      const Vector2 e = hit->point_mm.head<2>().normalized();
      const double speed = std::hypot(p.dr, p.dz);
      const Vector3 meridian(e.x() * p.dr / speed, e.y() * p.dr / speed, p.dz / speed);
      CHECK(std::abs(hit->normal.dot(meridian)) <= 1e-11);
      CHECK(std::abs(hit->normal.dot(Vector3(-e.y(), e.x(), 0))) <= 1e-14);
    }
  }
}

TEST_CASE("a part twice as large is hit at the same parameters, bit for bit", "[meridian]") {
  for (int degree = 1; degree <= 9; ++degree) {
    const Profile profile = random_profile(degree, 11);
    for (const double factor : {0x1p-20, 0.5, 2.0, 0x1p+20, 1e-3, 1e3}) {
      std::vector<ControlPoint> points = profile.points();
      for (ControlPoint& point : points) {
        point.r_mm *= factor;
        point.z_mm *= factor;
      }
      const Profile scaled(profile.degree(), profile.knots(), points);
      const auto reflector = cad::make_meridian_reflector(profile);
      const auto other = cad::make_meridian_reflector(scaled);
      const auto probe = reflector->probe(), other_probe = other->probe();
      const bool exactly = factor != 1e-3 && factor != 1e3;
      for (const RayClass which : all_classes)
        for (std::uint64_t i = 0; i < 100; ++i) {
          const Ray ray = random_ray(which, profile, {1, 2, 30}, 5, i);
          const std::vector<Hit> a = probe->all_hits(ray, 0);
          const std::vector<Hit> b = other_probe->all_hits({factor * ray.origin_mm, ray.direction}, 0);
          REQUIRE(a.size() == b.size());
          for (std::size_t k = 0; k < a.size(); ++k) {
            if (exactly) {
              CHECK(a[k].parameter == b[k].parameter);
              CHECK(a[k].distance_mm * factor == b[k].distance_mm);
              CHECK(a[k].point_mm * factor == b[k].point_mm);
              CHECK(a[k].normal == b[k].normal);
            } else if (std::abs(a[k].normal.dot(ray.direction)) > 0.01) {
              CHECK((a[k].point_mm * factor - b[k].point_mm).norm() <= 1e-12 * scaled.diagonal_mm());
            }
          }
        }
    }
  }
}

TEST_CASE("probes on several threads give the same bits", "[meridian]") {
  const Profile profile = random_profile(4, 2);
  const auto reflector = cad::make_meridian_reflector(profile);
  constexpr std::uint64_t count = 20000;
  const auto trace = [&] {
    const auto probe = reflector->probe();
    std::vector<double> numbers;
    for (std::uint64_t i = 0; i < count; ++i)
      for (const Hit& hit : probe->all_hits(random_ray(all_classes[i % 4], profile, {1, 2, 30}, 9, i), 0))
        numbers.insert(numbers.end(), {hit.distance_mm, hit.parameter, hit.normal.x(), hit.normal.z()});
    std::vector<Ray> rays;
    for (std::uint64_t i = 0; i < count; ++i)
      rays.push_back(random_ray(all_classes[i % 4], profile, {1, 2, 30}, 9, i));
    std::vector<std::optional<Hit>> hits(count);
    probe->first_hits(rays, 0, hits);
    for (const auto& hit : hits)
      if (hit) numbers.insert(numbers.end(), {hit->distance_mm, hit->parameter, hit->normal.x()});
    return numbers;
  };
  const std::vector<double> alone = trace();
  std::vector<std::vector<double>> together(4);
  std::vector<std::thread> threads;
  for (auto& numbers : together) threads.emplace_back([&numbers, &trace] { numbers = trace(); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& numbers : together) CHECK(numbers == alone);
}
