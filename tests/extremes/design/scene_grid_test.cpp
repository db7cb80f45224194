#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <chrono>
#include <map>

#include "base/units.h"
#include "design/run.h"
#include "support/cad/exact_hits.h"
#include "support/extreme_scenes.h"
#include "support/refusal.h"
#include "support/scaled_scene.h"

/// Whole scenes drawn from a grid of extremes, each by every rung: refused in words, or sound numbers that
/// agree with each other and with what can be known of them without a light room.
using namespace catoptric;
using namespace catoptric::design;

namespace {

/// Direct light of a point source by exact numbers: unhindered where the way is free. Negative where a ray
/// passes the mirror's edge or surface too near to tell.
double exact_direct(const Scene& scene, const test::ExactHits& mirror, const sim::FieldSample& sample) {
  const Vector3 way = sample.point_mm - scene.source.position_mm;
  const double distance = way.norm(), size = scene.profile.diagonal_mm();
  if (!(distance > 0)) return -1;
  const Vector3 direction = way / distance;
  double intensity = scene.source.power_w / (4 * pi);
  if (scene.source.exponent > 0)
    intensity = scene.source.power_w * (scene.source.exponent + 1) / (2 * pi) *
                std::pow(std::max(0.0, direction.dot(scene.source.axis.normalized())), scene.source.exponent);
  const double cosine = std::max(0.0, -direction.dot(sample.normal));
  const double open = intensity * cosine / (distance * distance);
  // A ray that passes a rim of the mirror within a millionth: slightly shifted ones tell.
  std::vector<std::size_t> counts;
  const Vector3 aside = direction.unitOrthogonal(), other = direction.cross(aside);
  for (const Vector3& shift : {Vector3(0, 0, 0), aside, Vector3(-aside), other, Vector3(-other)}) {
    const Ray ray{scene.source.position_mm + 1e-6 * size * shift, direction};
    std::size_t count = 0;
    for (const auto& hit : mirror(ray, -1e-5 * size)) {
      if (hit.distance < 1e-5 * size || abs(hit.distance - distance) < 1e-5 * size) return -1;
      count += hit.distance < distance;
    }
    counts.push_back(count);
  }
  if (*std::max_element(counts.begin(), counts.end()) != *std::min_element(counts.begin(), counts.end()))
    return -1;
  return counts[0] > 0 ? 0 : open;
}

/// The greatest of what was found.
struct Found {
  std::size_t scenes = 0, refused = 0, by_rung[3] = {}, direct = 0, compared = 0;
  double direct_off = 0, slowest = 0, sigmas = 0;
  std::map<std::string, std::size_t> refusals;
};

void check_direct(const Scene& scene, const Judgement& judgement, const Target& target, Found& found) {
  if (scene.source.kind != SourceKind::point) return;
  const test::ExactHits mirror(scene.profile);
  for (std::size_t i = 0; i < target.samples.size(); i += 5) {
    const double exact = exact_direct(scene, mirror, target.samples[i]);
    if (exact < 0) continue;
    ++found.direct;
    const double off = std::abs(judgement.direct[i] - exact) / std::max(exact, 1e-300);
    INFO("sample " << i << " has " << judgement.direct[i] << ", by exact numbers " << exact);
    if (exact == 0)
      CHECK(judgement.direct[i] == 0);
    else
      CHECK(off < 1e-11);
    if (exact > 0) found.direct_off = std::max(found.direct_off, off);
  }
}

/// Mean reflected light over the samples, and a bound of its standard error.
std::pair<double, double> mean_light(const Judgement& judgement) {
  double sum = 0, noise = 0;
  const double n = static_cast<double>(judgement.reflected.size());
  for (std::size_t i = 0; i < judgement.reflected.size(); ++i) {
    sum += judgement.reflected[i] / n;
    noise += judgement.noise[i] / n;
  }
  return {sum, noise};
}

void run(std::uint64_t number, Found& found) {
  const test::ExtremeScene drawn = test::extreme_scene(number);
  INFO("scene " << number << ":\n" << drawn.text());
  ++found.scenes;
  std::map<std::string, Judgement> fields;
  for (const char* rung : {"tubes", "rings", "photons"}) {
    INFO(rung);
    const auto begin = std::chrono::steady_clock::now();
    try {
      const Scene scene = test::scene_of(drawn.text(), {{"model.rung", rung}});
      SimulationResult result = run_simulation(scene, {});
      const std::string wrong = test::defect(scene, result.mirror.judgement);
      CHECK(wrong == "");
      if (fields.empty()) check_direct(scene, result.mirror.judgement, result.target, found);
      ++found.by_rung[fields.size()];
      fields.emplace(rung, std::move(result.mirror.judgement));
    } catch (const Error& error) {
      test::check_refusal(error);
      ++found.refused;
      ++found.refusals[error.parts().what + ": " + error.parts().why];
    }
    found.slowest = std::max(found.slowest,
                             std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  for (const auto& [name, field] : fields)
    for (const auto& [other, against] : fields) {
      if (name >= other || field.rung == against.rung) continue;
      const auto [a, a_noise] = mean_light(field);
      const auto [b, b_noise] = mean_light(against);
      INFO(name << " " << a << " +- " << a_noise << ", " << other << " " << b << " +- " << b_noise);
      // Noise is known from four replicates if photons are many in a kernel; without photons there is none.
      const bool enough = [&] {
        for (const Judgement* each : {&field, &against})
          if (each->rung != sim::Rung::tubes &&
              (each->photons < 100 || !(mean_light(*each).second < 0.1 * mean_light(*each).first)))
            return false;
        return true;
      }();
      if (!enough) continue;
      const double noise = std::hypot(a_noise, b_noise) + 3e-4 * std::max(a, b);
      ++found.compared;
      CHECK(std::abs(a - b) <= 8 * noise);
      if (noise > 0) found.sigmas = std::max(found.sigmas, std::abs(a - b) / noise);
    }
}

void print(const Found& found) {
  fmt::print(
      "| scenes | {} drawn, by three rungs | {} refused | {} direct values, {:.1e} off | {} pairs of rungs, "
      "{:.1f} sigma | slowest {:.2f} s |\n",
      found.scenes, found.refused, found.direct, found.direct_off, found.compared, found.sigmas,
      found.slowest);
  for (const auto& [what, count] : found.refusals) fmt::print("    {:5} {}\n", count, what);
}

}  // namespace

TEST_CASE("scenes from a grid of extremes are refused in words, or sound and of one mind by every rung",
          "[extremes][long]") {
  Found found;
  for (std::uint64_t number = 0; number < 150; ++number) run(number, found);
  print(found);
}
