#include "sim/planner.h"

#include <catch2/catch.hpp>

#include "base/errors.h"
#include "support/analytic_reflectors.h"

using namespace catoptric;
using namespace catoptric::sim;

namespace {

const test::QuadricReflector mirror = test::paraboloid();
const EstimateOptions fixed{Kernel::silverman, {}, 5.0};

Plan plan_of(const Vector3& source_mm, const Vector3& normal, const EstimateOptions& estimate,
             std::optional<Rung> wanted, std::optional<Material> surface = {}) {
  const PointSource source(source_mm, 1);
  const NearField field = NearField::disc({0, 0, 0}, normal, 50, surface);
  return make_plan({source, mirror, {}, field}, estimate, wanted);
}

}  // namespace

TEST_CASE("the planner takes tubes where they are valid and says why") {
  const Plan plan = plan_of({0, 0, 50}, {0, 0, 1}, fixed, {});
  CHECK(plan.rung == Rung::tubes);
  CHECK(plan.findings.size() >= 5);
  for (const Finding& finding : plan.findings)
    CHECK_FALSE((finding.found.empty() || finding.consequence.empty()));
  CHECK(plan_of({0, 0, 50}, {0, 0, 1}, fixed, Rung::photons).rung == Rung::photons);
}

TEST_CASE("what tubes cannot do goes to photons, and forcing tubes there is an error with the reason") {
  const auto refused = [](const Vector3& source_mm, const Vector3& normal, const EstimateOptions& estimate,
                          std::optional<Material> surface, const char* reason) {
    INFO(reason);
    CHECK(plan_of(source_mm, normal, estimate, {}, surface).rung == Rung::photons);
    CHECK_THROWS_WITH(plan_of(source_mm, normal, estimate, Rung::tubes, surface), Catch::Contains(reason));
  };
  refused({1, 0, 50}, {0, 0, 1}, fixed, {}, "axis");
  refused({0, 0, 50}, {0, 1, 1}, fixed, {}, "tilted");
  refused({0, 0, 50}, {0, 0, 1}, {Kernel::silverman, 100, {}}, {}, "number of photons");
  refused({0, 0, 50}, {0, 0, 1}, {Kernel::cone, {}, 5.0}, {}, "cone");
  refused({0, 0, 50}, {0, 0, 1}, fixed, Material{0.5, 0}, "near field");
}
