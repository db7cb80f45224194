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
             std::optional<Rung> wanted, std::optional<Material> surface = {},
             std::optional<std::string> engine = {}) {
  const PointSource source(source_mm, 1);
  const NearField field = NearField::disc({0, 0, 0}, normal, 50, surface);
  return make_plan({source, mirror, {}, field}, {estimate, wanted, std::move(engine)});
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

TEST_CASE("what tubes cannot do goes to the next rung, and forcing tubes there is an error with the reason") {
  const auto refused = [](const Vector3& source_mm, const Vector3& normal, const EstimateOptions& estimate,
                          std::optional<Material> surface, Rung instead, const char* reason) {
    INFO(reason);
    CHECK(plan_of(source_mm, normal, estimate, {}, surface).rung == instead);
    CHECK_THROWS_WITH(plan_of(source_mm, normal, estimate, Rung::tubes, surface), Catch::Contains(reason));
    if (instead == Rung::photons)
      CHECK_THROWS_WITH(plan_of(source_mm, normal, estimate, Rung::rings, surface),
                        Catch::Contains("rung rings cannot"));
  };
  refused({1, 0, 50}, {0, 0, 1}, fixed, {}, Rung::photons, "axis");
  refused({0, 0, 50}, {0, 1, 1}, fixed, {}, Rung::photons, "tilted");
  refused({0, 0, 50}, {0, 0, 1}, {Kernel::silverman, 100, {}}, {}, Rung::photons, "number of photons");
  refused({0, 0, 50}, {0, 0, 1}, {Kernel::cone, {}, 5.0}, {}, Rung::photons, "cone");
  refused({0, 0, 50}, {0, 0, 1}, fixed, Material::matt(0.5), Rung::rings, "near field");
}

TEST_CASE("an engine that was asked for is used: tubes, which have their own, are not") {
  CHECK(plan_of({0, 0, 50}, {0, 0, 1}, fixed, {}, {}, "occt").rung == Rung::rings);
  CHECK_THROWS_WITH(plan_of({0, 0, 50}, {0, 0, 1}, fixed, Rung::tubes, {}, "occt"), Catch::Contains("occt"));
  CHECK(plan_of({0, 0, 50}, {0, 0, 1}, fixed, Rung::tubes, {}, "meridian").rung == Rung::tubes);
}

TEST_CASE("the planner says whether the field may jump, where photons would blur it") {
  const auto found = [](double radius_mm, std::optional<Rung> rung) {
    const PointSource source({0, 0, 50}, 1);
    const NearField field = NearField::disc({0, 0, 0}, {0, 0, 1}, radius_mm);
    for (const Finding& finding : make_plan({source, mirror, {}, field}, {fixed, rung, {}}).findings)
      if (finding.feature == "jumps of the field") return finding.found;
    return std::string();
  };
  CHECK_THAT(found(50, Rung::photons), Catch::StartsWith("none"));
  CHECK_THAT(found(150, Rung::photons), Catch::Contains("edge of the beam"));
  CHECK_THAT(found(150, Rung::rings), Catch::StartsWith("none"));  // they know the edge
  CHECK(found(150, Rung::tubes).empty());                          // these have nothing to blur
}

TEST_CASE("the plan says what is modelled of the mirror's surface") {
  const auto said = [](const Material& surface, const char* feature) {
    const PointSource source({0, 0, 50}, 1);
    const NearField field = NearField::disc({0, 0, 0}, {0, 0, 1}, 50);
    const Plan plan = make_plan({source, mirror, surface, field}, {fixed, {}, {}});
    CHECK(plan.rung == (is_specular(surface) ? Rung::tubes : Rung::rings));
    for (const Finding& finding : plan.findings)
      if (finding.feature == feature) return finding.found + "; " + finding.consequence;
    return std::string();
  };
  CHECK_THAT(said({0.9, 0}, "mirror"), Catch::Contains("roughness is left out"));
  CHECK_THAT(said({0.9, 0, 0, 0.2}, "mirror"), Catch::Contains("alpha 0.2") && Catch::Contains("is lost"));
  CHECK_THAT(said(Material::matt(0.9), "mirror"), Catch::StartsWith("matt"));
  CHECK_THAT(said({0.6, 0, 0.3}, "mirror"), Catch::StartsWith("partly matt"));
  CHECK_THAT(said({0.6, 0, 0.3}, "losses"), Catch::Contains("diffuse 0.3"));
  CHECK_THAT(said(Material::matt(0.9), "source"), Catch::Contains("three dimensions"));
  CHECK_THAT(said({0.6, 0}, "source"), Catch::Contains("two dimensions"));
  CHECK_THAT(said(Material::with_table({0, 1}, {0.5, 0.9}), "reflectance by angle"),
             Catch::Contains("0.5 head-on"));
  CHECK(said({0.6, 0}, "reflectance by angle").empty());
}

TEST_CASE("every rung has a name that reads back") {
  for (const Rung rung : all_rungs) CHECK(parse_rung(name(rung)) == rung);
  CHECK_FALSE(parse_rung("tube"));
}
