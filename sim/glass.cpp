#include "sim/glass.h"

#include <algorithm>
#include <cmath>

#include "sim/fresnel.h"
#include "sim/scatter.h"

namespace catoptric::sim {

GlassLight cross_face(const Glass& glass, const GlassLight& light, const Vector3& outward,
                      RandomStream& chance) {
  const double ratio = light.inside ? 1 / glass.index : glass.index;
  const auto onwards = refract(light.direction, outward, ratio);
  const double cosine = std::min(1.0, std::abs(light.direction.dot(outward)));
  const PolarisedReflectance share = polarised_reflectance(cosine, ratio);
  const double thrown_back = !light.inside ? share.mean() : light.along ? share.along : share.across;
  if (!onwards || chance.uniform() < thrown_back)
    return {reflect(light.direction, outward), light.inside, light.along};
  if (light.inside) return {*onwards, false};
  return {*onwards, true, chance.uniform() * (2 - share.across - share.along) < 1 - share.along};
}

double internal_transmittance(const Glass& glass, double way_mm) {
  return std::exp(-glass.absorption_per_mm * way_mm);
}

}  // namespace catoptric::sim
