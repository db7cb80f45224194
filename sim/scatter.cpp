#include "sim/scatter.h"

#include "sim/frame.h"
#include "sim/microfacets.h"

namespace catoptric::sim {
namespace {

/// @in frame: gives columns two directions along the surface, normal towards the incoming light
template <typename Frame>
Scattered scatter_in(const Material& material, Roulette roulette, const Vector3& incoming,
                     const Vector3& normal, const Frame& frame, RandomStream& chance) {
  const double cosine = std::abs(incoming.dot(normal));
  const Choice choice = choose_lobe(material, roulette, cosine, [&] { return chance.uniform(); });
  if (choice.lobe == Lobe::none) return {Interaction::absorbed, incoming};
  if (choice.lobe == Lobe::through) return {Interaction::transmitted, incoming};
  if (choice.lobe == Lobe::mirror && !(material.roughness > 0))
    return {Interaction::reflected, reflect(incoming, normal)};
  const double first = chance.uniform(), second = chance.uniform();
  const Eigen::Matrix3d axes = frame();
  if (choice.lobe == Lobe::diffuse)
    return {Interaction::reflected, diffuse_direction(axes.col(0), axes.col(1), axes.col(2), first, second)};
  const Microfacets facets(material.roughness);
  Vector3 from = -(axes.transpose() * incoming);
  from.z() = cosine;
  const Vector3 facet = facets.visible_normal(from, first, second);
  const Vector3 to = reflect(Vector3(-from), facet);
  if (!(to.z() > 0)) return {Interaction::absorbed, incoming};
  const double kept =
      material.reflectance_at(std::min(1.0, std::abs(from.dot(facet)))) * facets.unshadowed(from, to);
  if (!(choice.number < kept)) return {Interaction::absorbed, incoming};
  return {Interaction::reflected, (axes * to).normalized()};
}

}  // namespace

Scattered scatter(const Material& material, Roulette roulette, const Vector3& incoming, const Vector3& normal,
                  RandomStream& chance) {
  const auto frame = [&] { return frame_about(incoming.dot(normal) > 0 ? Vector3(-normal) : normal); };
  return scatter_in(material, roulette, incoming, normal, frame, chance);
}

Scattered scatter(const Material& material, Roulette roulette, const Vector3& incoming,
                  const Eigen::Matrix3d& frame, RandomStream& chance) {
  const auto facing = [&] {
    Eigen::Matrix3d axes = frame;
    if (incoming.dot(axes.col(2)) > 0) axes.col(2) = -axes.col(2);
    return axes;
  };
  return scatter_in(material, roulette, incoming, frame.col(2), facing, chance);
}

double bsdf(const Material& material, const Vector3& in, const Vector3& out, const Vector3& normal) {
  const Vector3 facing = in.dot(normal) > 0 ? Vector3(-normal) : normal;
  const double cosine_in = -in.dot(facing), cosine_out = out.dot(facing);
  if (!(cosine_in > 0 && cosine_out > 0)) return 0;
  double sum = material.diffuse / pi;
  if (material.reflectance > 0 && material.roughness > 0) {
    const Eigen::Matrix3d axes = frame_about(facing);
    const Vector3 from = axes.transpose() * -in, to = axes.transpose() * out;
    sum += material.reflectance_at(std::min(1.0, from.dot((from + to).normalized()))) *
           Microfacets(material.roughness).distribution(from, to);
  }
  return sum;
}

}  // namespace catoptric::sim
