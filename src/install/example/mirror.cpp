// The irradiance below a paraboloid, by photons: 2 W/m^2 at the centre, half of it straight from the source.
#include <cstdio>

#include "base/profile.h"
#include "base/units.h"
#include "cad/engines.h"
#include "sim/simulation.h"

int main() {
  using namespace catoptric;
  const auto mirror =
      cad::make_meridian_reflector(Profile::bezier({{0, 100, 1}, {50, 100, 1}, {100, 50, 1}}));
  const sim::PointSource source({0, 0, 50}, pi / 100);  // mm, W
  const auto field = sim::NearField::disc({0, 0, 0}, {0, 0, 1}, 50);
  const sim::Scene scene{source, *mirror, {1, 0}, field};
  const auto light = sim::simulate(scene, field.samples(5), {100'000, sim::Sampler::sobol, 1},
                                   {sim::Kernel::silverman, {}, 5.0});
  for (std::size_t i = 0; i < light.direct.size(); ++i)
    std::printf("direct %.4f, reflected %.4f W/m^2\n", 1e6 * light.direct[i], 1e6 * light.reflected[i]);
}
