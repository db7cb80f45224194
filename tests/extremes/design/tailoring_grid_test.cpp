#include <catch2/catch.hpp>
#include <map>

#include "design/run.h"
#include "design/tailored_start.h"
#include "support/refusal.h"
#include "support/scaled_scene.h"

using namespace catoptric;
using namespace catoptric::design;

namespace {

/// Near fields from within the package to ten million of its sizes away, and from a spot to nearly all of the
/// half space; light from a millionth of what there is to more than that.
constexpr double distances[] = {20, 70, 1000, 1e6, 1e9};
constexpr double widths[] = {1e-4, 0.01, 0.3, 1, 5, 100};  // radius over distance
constexpr double shares[] = {1e-6, 0.3, 0.9, 0.999, 1.2};
constexpr const char* exponents[] = {"", "exponent = 30\n"};
constexpr double scales[] = {1e-5, 1, 1e3};
constexpr const char* targets[] = {
    "kind = \"uniform\"\nradius = @{0}\nirradiance = %{1}\n",
    "kind = \"gaussian\"\nsigma = @{2}\npeak = %{1}\n",
    "kind = \"ring\"\ninner_radius = @{2}\nouter_radius = @{0}\nirradiance = %{1}\n",
    "kind = \"ring\"\ninner_radius = @{2}\nouter_radius = @{0}\nirradiance = %{1}\nbackground = %{3}\n"};

std::string task(double distance, double width, double share, const char* exponent, std::size_t number) {
  const double radius = width * distance, power = 10,
               even = share * power / (3.14159 * radius * radius) * 1e6;
  const std::string text = fmt::format(
      "start = \"tailored\"\n[source]\nposition = [0, 0, 0]\npower = {}\n{}"
      "[constraints]\nrim_radius_max = @60\nheight_max = @50\n"
      "[near_field]\ncenter = [0, 0, @{}]\nradius = @{}\nsamples = 40\n"
      "[model]\nrung = \"tubes\"\nphotons = 2000\nreplicates = 2\nkernel_radius = @{}\n"
      "[search]\nmetric = \"relative-rmse\"\n[target]\n",
      power, exponent, -distance, radius, radius / 20);
  return test::scaled_text(
      text + fmt::format(fmt::runtime(targets[number % 4]), radius, even, radius / 2, even / 4),
      scales[number / 4 % 3]);
}

struct Found {
  std::size_t tasks = 0, made = 0, within_percent = 0;
  std::map<std::string, std::size_t> refusals;
};

void run(const std::string& text, Found& found) {
  ++found.tasks;
  try {
    const Scene scene = test::scene_of(text);
    const TailoredStart start = tailored_from_nothing(scene);
    REQUIRE(start.light_error_rel);
    const SimulationResult result = run_simulation(scene, {});
    const double error = result.mirror.judgement.objective.value;
    const double r_most = start.profile.r_max_mm(),
                 z_span = start.profile.z_max_mm() - start.profile.z_min_mm();
    CHECK(r_most <= *scene.constraints.rim_radius_max_mm * (1 + 1e-12));
    CHECK(z_span <= *scene.constraints.height_max_mm * (1 + 1e-12));
    ++found.made;
    found.within_percent += error < 0.01;
    // The kernel smooths away much of what tubes see, and adds what it blurs.
    CHECK(error <= 1.1 * *start.light_error_rel + start.unreachable_rel + 0.02);
  } catch (const Error& error) {
    test::check_refusal(error);
    CHECK(error.exit_code() == ExitCode::scene_invalid);
    ++found.refusals[error.parts().what.substr(0, 50) + ": " + error.parts().why];
  }
}

/// Every so-manieth task of the grid.
Found run_every(std::size_t stride) {
  Found found;
  std::size_t number = 0;
  for (const double distance : distances)
    for (const double width : widths)
      for (const double share : shares)
        for (const char* exponent : exponents) {
          if (number++ % stride != 0) continue;
          const std::string text = task(distance, width, share, exponent, found.tasks);
          INFO("task " << number << ":\n" << text);
          run(text, found);
        }
  return found;
}

}  // namespace

TEST_CASE(
    "mirrors from nothing at extreme distances, widths and powers are refused in words, or light as said",
    "[long]") {
  const Found found = run_every(7);
  CHECK(found.made > 10);
  CHECK(found.refusals.size() > 2);
}

TEST_CASE("the same with all of the grid", "[.][extremes]") {
  const Found found = run_every(1);
  fmt::print("| mirrors from nothing | {} tasks | {} made, {} of them within 1 % |\n", found.tasks,
             found.made, found.within_percent);
  for (const auto& [what, count] : found.refusals) fmt::print("    {:5} {}\n", count, what);
}
