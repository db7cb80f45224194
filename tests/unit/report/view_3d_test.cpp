#include "report/view_3d.h"

#include <catch2/catch.hpp>

using namespace catoptric;
using namespace catoptric::report;

TEST_CASE("a ray is cut where it leaves the ball for good, and only there") {
  const Vector3 center(0, 0, 0);
  const Polyline out_and_back{{0, 0, 0}, {0, 0, 5}, {0, 0, -0.5}};
  CHECK(within(out_and_back, center, 1) == out_and_back);
  const Polyline away = within({{0, 0, 0}, {0.5, 0, 0}, {4.5, 0, 0}}, center, 1);
  REQUIRE(away.size() == 3);
  CHECK((away.back() - Vector3(1, 0, 0)).norm() < 1e-12);
  // through the ball and out on the other side
  const Polyline through = within({{-9, 0, 0}, {9, 0, 0}}, center, 1);
  CHECK((through.back() - Vector3(1, 0, 0)).norm() < 1e-12);
  CHECK(within({{2, 0, 0}, {2, 0, 9}}, center, 1).size() == 1);  // never in it
}

TEST_CASE("what would end a script is written otherwise, and nothing else") {
  CHECK(inside_script("a</script>b") == "a\\u003c/script>b");
  CHECK(inside_script("</SCRIPT") == "\\u003c/SCRIPT");
  CHECK(inside_script("<!-- <Script") == "\\u003c!-- \\u003cScript");
  const std::string harmless = "if (a<b && c</d/.test(s) <! <scrip <!- <";
  CHECK(inside_script(harmless) == harmless);
}
