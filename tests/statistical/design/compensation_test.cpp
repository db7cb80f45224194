#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "design/run.h"
#include "design/scene.h"

using namespace catoptric;
using namespace catoptric::design;

TEST_CASE("a mirror made for an extended source lights evenly where a point's mirror does not", "[long]") {
  Settings settings = Settings::read(CATOPTRIC_DATA "/examples/uniform_disc.toml", scene_keys());
  for (const Override& change :
       {Override{"source.kind", "\"disc\"", "test"}, Override{"source.radius", "5", "test"},
        Override{"model.rung", "\"rings\"", "test"}, Override{"model.photons", "262144", "test"}})
    settings.set(change);
  const Scene compensated = make_scene(settings);
  // The wrong twin: the mirror that the same wishes make for a point that radiates alike.
  settings.set({"source.kind", "\"point\"", "test"});
  settings.set({"source.exponent", "1", "test"});
  settings.remove("source.radius");
  Scene for_a_point = make_scene(settings);
  for_a_point.source = compensated.source;

  // Judged on streams that the compensation never saw.
  const auto truth_rel = [](const Scene& scene) {
    const Figure& figure = run_simulation(scene, {}).mirror.judgement.objective;
    return figure.value - figure.bias;
  };
  CHECK(truth_rel(compensated) < 0.01);
  CHECK(truth_rel(for_a_point) > 0.1);
}

TEST_CASE(
    "a mirror for an extended source is made for a table beside the axis, on a bare plane and said so") {
  Settings settings = Settings::read(CATOPTRIC_DATA "/examples/uniform_disc.toml", scene_keys());
  for (const Override& change :
       {Override{"source.kind", "\"disc\"", "test"}, Override{"source.radius", "5", "test"},
        Override{"near_field.center", "[100, 0, -1000]", "test"}})
    settings.set(change);
  const Scene scene = make_scene(settings);
  CHECK(std::ranges::count_if(scene.profile_notes, [](const std::string& note) {
          return note.find("as if nothing stood") != std::string::npos;
        }) == 1);
}
