#include "report/view_3d.h"

#include <catch2/catch.hpp>

#include "report/run_view.h"

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

TEST_CASE("objects near the mirror are drawn and those far away are told of") {
  const design::Scene scene = design::read_scene(CATOPTRIC_DATA "/paper/paraboloid.toml",
                                                 {{"objects.board.kind", "\"disc\"", "test"},
                                                  {"objects.board.center", "[0, 0, 5.5]", "test"},
                                                  {"objects.board.radius", "1", "test"},
                                                  {"objects.wall.kind", "\"rectangle\"", "test"},
                                                  {"objects.wall.center", "[900, 0, 0]", "test"},
                                                  {"objects.wall.normal", "[-1, 0, 0]", "test"},
                                                  {"objects.wall.width", "10", "test"},
                                                  {"objects.wall.height", "10", "test"}});
  const View3d view = view_of(scene, scene.profile, scene.source, {});
  REQUIRE(view.objects.size() == 1);
  for (const Vector3& point : view.objects.front()) {
    CHECK((point - Vector3(0, 0, 5.5)).norm() == Approx(1));  // in the scene's cm
  }
  CHECK(view.caption.find("Green: objects") != std::string::npos);
  CHECK(view.caption.find("1 object is too far") != std::string::npos);
  CHECK(view_json(view).find("\"objects\":[[[") != std::string::npos);
}
