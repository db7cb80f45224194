#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <chrono>
#include <map>

#include "base/random_stream.h"
#include "base/units.h"
#include "design/run.h"
#include "support/cad/exact_hits.h"
#include "support/scaled_scene.h"

/// Whole scenes drawn from a grid of extremes, each by every rung: refused in words, or sound numbers that
/// agree with each other and with what can be known of them without a light room.
using namespace catoptric;
using namespace catoptric::design;

namespace {

using Choices = std::vector<std::string>;

const Choices mirrors{
    "points = [[0, @100], [@50, @100], [@100, @50]]",
    "points = [[0, @100], [@100, @100], [@100, 0]]\nweights = [1, 0.7071067811865476, 1]",
    "points = [[0, @80], [@100, @20]]",
    "points = [[@40, @100], [@40, @10]]",
    "points = [[0, @100], [@90, @100]]",
    "points = [[0, @100], [0, @100], [@50, @100], [@100, @50]]\ndegree = 3",
    "points = [[0, @100], [@50, @75], [@100, @50]]\nweights = [1, 3, 1]",
    "points = [[@50, 0], [@-50, @50], [@50, @100]]",
    "points = [[@20, @95], [@60, @100], [@100, @50]]",
    "points = [[0, @100], [@50, @100], [@100, @50]]\nweights = [1, 1e6, 1]",
    "points = [[0, @100], [@50, @100], [@100, @50]]\nweights = [1, 1e-6, 1]",
    "points = [[0, @100], [@50, @100], [@100, @50]]\nweights = [1, 1, 1e-6]",
    "points = [[0, @100], [@50, @100], [@100, @50]]\nweights = [1e6, 1, 1]",
    "points = [[0, @100], [@50, @100], [@100, @50]]\nweights = [1e8, 1, 1e-8]",
    "points = [[0, @100], [@-50, @100], [@100, @50]]",
    "points = [[0, @100], [0, @50], [0, 0]]",
    "points = [[0, @100], [@20, @100], [@40, @92], [@60, @80], [@80, @60], [@100, @20]]\ndegree = 5",
    "points = [[0, 0], [@50, 0], [@100, @50]]",
};

/// On the axis at, below, above the rim and on the vertex, off it, inside, outside and on the mirror, far
/// away.
const Choices sources{
    "position = [0, 0, @50]",
    "position = [0, 0, @70]",
    "position = [0, 0, @100]",
    "position = [0, 0, @99.999999]",
    "position = [0, 0, @-200]",
    "position = [0, 0, @160]",
    "position = [@30, 0, @50]",
    "position = [@1e-9, 0, @50]",
    "position = [@100, 0, @50]",
    "position = [@300, @10, @50]",
    "position = [0, 0, @1e8]",
    "position = [0, 0, @-1e8]",
    "position = [0, 0, 0]",
    "position = [0, 0, @50]\nexponent = 1000",
    "position = [0, 0, @50]\nexponent = 0.001\naxis = [0, 0, -1]",
    "position = [@20, 0, @40]\nexponent = 2\naxis = [1, 0, 1]",
    "kind = \"disc\"\nposition = [0, 0, @50]\nradius = @1e-6",
    "kind = \"disc\"\nposition = [0, 0, @50]\nradius = @10",
    "kind = \"disc\"\nposition = [0, 0, @30]\nradius = @1000",
    "kind = \"disc\"\nposition = [0, 0, @50]\nradius = @20\naxis = [1, 0, 0]",
};

/// From a thousandth to a million part sizes away and wide, through mirror and source, across and along the
/// axis, seen or real.
const Choices near_fields{
    "radius = @50",
    "center = [0, 0, @-1e8]\nradius = @1e8",
    "center = [0, 0, @-1e8]\nradius = @50",
    "center = [0, 0, @49.9]\nradius = @50",
    "center = [0, 0, @60]\nradius = @150",
    "center = [0, 0, @50]\nradius = @40",
    "radius = @1e-4",
    "center = [@10, 0, @-30]\nnormal = [0.3, 0, 1]\nradius = @80",
    "center = [0, 0, @-20]\nnormal = [1, 0, 0]\nradius = @80",
    "center = [0, 0, @150]\nnormal = [0, 0, -1]\nradius = @80",
    "normal = [0, 0, -1]\nradius = @50",
    "shape = \"rectangle\"\nwidth = @1000\nheight = @0.01",
    "radius = @120\nreal = true",
    "radius = @120\nreal = true\nreflectance = 1",
    "radius = @120\nreal = true\nreflectance = 0.5\ntransmittance = 0.5",
    "center = [0, 0, @-200]\nradius = @300",
};

const Choices surfaces{"reflectance = 1",
                       "reflectance = 0",
                       "reflectance = 0.7",
                       "reflectance = 0\ntransmittance = 1",
                       "reflectance = 0.5\ntransmittance = 0.5",
                       "reflectance = 1e-9"};

const Choices bandwidths{"",
                         "kernel_radius = @10",
                         "neighbours = 40",
                         "kernel_radius = @1e-5",
                         "kernel_radius = @1e4",
                         "neighbours = 1\nkernel = \"gaussian\"",
                         "kernel_radius = @10\nkernel = \"cone\""};

const Choices photons{"photons = 600",
                      "photons = 0",
                      "photons = 1",
                      "photons = 2",
                      "photons = 600\nsampler = \"random\"",
                      "photons = 600\ninteractions = 1"};

/// Micrometres to a hundred metres: the parts are 100 in size.
constexpr double scales[] = {1e-5, 1, 1e3};

struct Drawn {
  std::string text;
  double scale;
};

/// @in number: another number is another scene
Drawn draw(std::uint64_t number) {
  RandomStream random(5, Purpose::test, number);
  // Two thirds of what is drawn is the ordinary choice, which comes first: a scene of nothing but extremes
  // tells little of each.
  const auto pick = [&](const Choices& list) -> const std::string& {
    const double ordinary = random.uniform(), which = random.uniform();
    return ordinary < 0.5 ? list.front()
                          : list[static_cast<std::size_t>(which * static_cast<double>(list.size()))];
  };
  const double size = random.uniform();
  const double scale = scales[static_cast<std::size_t>(size * std::size(scales))];
  std::string text = "[source]\npower = 2\n" + pick(sources);
  text += "\n[reflector]\n" + pick(mirrors) + "\n" + pick(surfaces);
  text += "\n[near_field]\nsamples = 24\n" + pick(near_fields);
  text +=
      "\n[model]\nreplicates = 4\nmost_photons = 20000\n" + pick(photons) + "\n" + pick(bandwidths) + "\n";
  return {test::scaled_text(text, scale), scale};
}

bool is_sound(const std::vector<double>& values, bool signless) {
  return std::all_of(values.begin(), values.end(),
                     [&](double each) { return std::isfinite(each) && (signless || each >= 0); });
}

/// What is wrong with a result by itself, or nothing.
std::string defect(const Scene& scene, const Judgement& judgement) {
  if (!is_sound(judgement.direct, false)) return "direct light is not sound";
  if (!is_sound(judgement.reflected, false)) return "reflected light is not sound";
  if (!is_sound(judgement.noise, false)) return "noise is not sound";
  if (!is_sound(judgement.bias, true)) return "bias is not sound";
  if (!is_sound(judgement.half_interval, false)) return "intervals are not sound";
  const sim::EnergyLedger& energy = judgement.energy;
  const double sum =
      energy.missed_w + energy.absorbed_w + energy.received_w + energy.escaped_w + energy.cut_off_w;
  if (!(std::abs(sum - energy.emitted_w) <= 1e-12 * energy.emitted_w)) return "energy is not kept";
  if (!(energy.emitted_w <= scene.source.power_w * (1 + 1e-12))) return "more is emitted than there is";
  if (scene.mirror.reflectance + scene.mirror.transmittance == 0 &&
      *std::max_element(judgement.reflected.begin(), judgement.reflected.end()) > 0)
    return "a black mirror shines";
  return {};
}

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
  const Drawn drawn = draw(number);
  INFO("scene " << number << ":\n" << drawn.text);
  ++found.scenes;
  std::map<std::string, Judgement> fields;
  for (const char* rung : {"tubes", "rings", "photons"}) {
    INFO(rung);
    const auto begin = std::chrono::steady_clock::now();
    try {
      const Scene scene = test::scene_of(drawn.text, {{"model.rung", rung}});
      SimulationResult result = run_simulation(scene, {});
      const std::string wrong = defect(scene, result.mirror.judgement);
      CHECK(wrong == "");
      if (fields.empty()) check_direct(scene, result.mirror.judgement, result.target, found);
      ++found.by_rung[fields.size()];
      fields.emplace(rung, std::move(result.mirror.judgement));
    } catch (const Error& error) {
      CHECK(!error.parts().what.empty());
      CHECK(!(error.parts().why.empty() && error.parts().hint.empty()));
      CHECK((error.exit_code() == ExitCode::scene_invalid ||
             error.exit_code() == ExitCode::geometry_or_exchange));
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
          "[extremes]") {
  Found found;
  for (std::uint64_t number = 0; number < 150; ++number) run(number, found);
  print(found);
}
