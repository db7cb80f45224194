#include "support/extreme_scenes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "base/random_stream.h"
#include "support/scaled_scene.h"

namespace catoptric::test {
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

bool is_sound(const std::vector<double>& values, bool signless) {
  return std::all_of(values.begin(), values.end(),
                     [&](double each) { return std::isfinite(each) && (signless || each >= 0); });
}

}  // namespace

ExtremeScene extreme_scene(std::uint64_t number) {
  RandomStream random(5, Purpose::test, number);
  const auto pick = [&](const Choices& list) -> const std::string& {
    const double ordinary = random.uniform(), which = random.uniform();
    return ordinary < 0.5 ? list.front()
                          : list[static_cast<std::size_t>(which * static_cast<double>(list.size()))];
  };
  const double size = random.uniform();
  const double scale = scales[static_cast<std::size_t>(size * std::size(scales))];
  std::string parts = "[source]\npower = 2\n" + pick(sources);
  parts += "\n[reflector]\n" + pick(mirrors) + "\n" + pick(surfaces);
  parts += "\n[near_field]\nsamples = 24\n" + pick(near_fields);
  parts += "\n[model]\nreplicates = 4\nmost_photons = 20000\n";
  const std::string budget = pick(photons) + "\n" + pick(bandwidths) + "\n";
  return {scaled_text(parts, scale), scaled_text(budget, scale), scale};
}

std::string defect(const design::Scene& scene, const design::Judgement& judgement) {
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

}  // namespace catoptric::test
