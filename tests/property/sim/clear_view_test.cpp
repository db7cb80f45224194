#include "sim/clear_view.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cad/engines.h"
#include "sim/simulation.h"

/// What is called clear is clear to an intersection engine, for any mirror, source and near field; and the
/// proof is not so careful that it never holds.

using namespace catoptric;
using namespace catoptric::sim;

namespace {

struct Case {
  Profile profile;
  Vector3 from_mm;
  NearField field;
};

class Cases {
 public:
  Case next() {
    std::vector<ControlPoint> points;
    const int count = 3 + static_cast<int>(uniform(0, 3));
    for (int i = 0; i < count; ++i) points.push_back({uniform(0, 100), uniform(-20, 100), uniform(0.3, 3)});
    // Now and then a vertex on the axis, and a rim at the very height of the source.
    if (uniform(0, 1) < 0.5) points.front().r_mm = 0;
    const bool on_axis = uniform(0, 1) < 0.7;
    Vector3 from(on_axis ? 0 : uniform(-60, 60), on_axis ? 0 : uniform(-60, 60), uniform(-40, 120));
    if (uniform(0, 1) < 0.3) {
      for (ControlPoint& point : points) point.z_mm = std::max(point.z_mm, from.z());
      points.back().z_mm = from.z();
    }
    const bool level = uniform(0, 1) < 0.6;
    const Vector3 normal(level ? 0 : uniform(-1, 1), level ? 0 : uniform(-1, 1),
                         uniform(0, 1) < 0.5 ? 1 : -1);
    const Vector3 centre(level ? 0 : uniform(-30, 30), level ? 0 : uniform(-30, 30), uniform(-80, 60));
    return {Profile::bezier(points), from, NearField::disc(centre, normal, uniform(5, 150))};
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  std::mt19937_64 engine_{20260814};
};

}  // namespace

TEST_CASE("a view called clear is clear to the intersection engine", "[clear-view][long]") {
  Cases cases;
  int clear = 0, blocked = 0, doubtful = 0;
  for (int i = 0; i < 4000; ++i) {
    const Case each = cases.next();
    const auto samples = each.field.samples(60);
    const auto mirror = cad::make_meridian_reflector(each.profile);
    const double lift_mm = 1e-9 * each.profile.diagonal_mm();
    const auto probe = mirror->probe();
    bool any = false;
    for (const FieldSample& sample : samples)
      any = any || probe->blocks(each.from_mm, sample.point_mm, lift_mm);
    const bool told = is_view_clear(each.profile, each.from_mm, samples);
    INFO("case " << i);
    CHECK_FALSE((told && any));
    clear += told;
    blocked += any;
    doubtful += !told && !any;
  }
  CHECK(clear > 600);
  CHECK(blocked > 600);
  // Off the axis and at overlapping heights nothing is tried; most of the rest is proved.
  CHECK(doubtful < 1400);
}

TEST_CASE("the paper's scene is proved clear, and its direct light does not depend on the proof",
          "[clear-view]") {
  const PointSource source({0, 0, 50}, 1);
  const auto field = NearField::disc({0, 0, 0}, {0, 0, 1}, 50);
  const auto samples = field.samples(64);
  const auto mirror =
      cad::make_meridian_reflector(Profile::bezier({{0, 100, 1}, {50, 100, 1.6}, {90, 50, 1}}));
  REQUIRE(is_view_clear(mirror->profile(), source.position_mm(), samples));
  const auto direct = direct_field({source, *mirror, {}, field}, samples);
  const auto probe = mirror->probe();
  for (std::size_t i = 0; i < samples.size(); ++i)
    CHECK(direct[i] == source.direct_w_per_mm2(samples[i].point_mm, samples[i].normal, *probe, 1e-7));
  // A shade between source and field leaves the field's rim dark.
  const auto shade = cad::make_meridian_reflector(Profile::bezier({{20, 60, 1}, {25, 50, 1}, {30, 5, 1}}));
  CHECK_FALSE(is_view_clear(shade->profile(), source.position_mm(), samples));
  const auto shaded = direct_field({source, *shade, {}, field}, samples);
  CHECK(shaded.front() > 0);
  CHECK(shaded.back() == 0);
}
