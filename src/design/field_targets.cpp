#include "design/field_targets.h"

#include <algorithm>

namespace catoptric::design {
namespace {

/// The first so many, of a list that may be empty.
template <typename T>
std::vector<T> first_of(const std::vector<T>& list, std::size_t count) {
  return {list.begin(), list.begin() + static_cast<std::ptrdiff_t>(std::min(count, list.size()))};
}

}  // namespace

void append_fields(const Scene& scene, Target& target) {
  if (scene.fields.empty()) return;
  const std::size_t near_samples = target.samples.size();
  const double area_mm2 = scene.near_field.area_mm2() / static_cast<double>(near_samples);
  const bool wants = std::ranges::any_of(
      scene.fields, [](const FieldSpec& spec) { return spec.irradiance_w_per_mm2.has_value(); });
  if (target.irradiance_w_per_mm2.empty() && wants) {
    target.irradiance_w_per_mm2.assign(near_samples, 0.0);
    target.weights.assign(near_samples, 0.0);
    target.within_reach.assign(near_samples, 0);
    target.lit.assign(near_samples, 0);
  }
  const bool has_target = !target.irradiance_w_per_mm2.empty();
  target.areas_mm2.assign(near_samples, area_mm2);
  if (has_target && target.weights.empty()) target.weights.assign(near_samples, 1.0);
  for (std::size_t i = 0; i < scene.fields.size(); ++i) {
    const FieldSpec& spec = scene.fields[i];
    const sim::NearField& field = scene.surroundings->fields()[i].field;
    std::vector<sim::FieldSample> samples = field.samples(spec.samples);
    const double share_mm2 = field.area_mm2() / static_cast<double>(samples.size());
    const bool counts = spec.irradiance_w_per_mm2.has_value();
    for (sim::FieldSample& sample : samples) {
      sample.field = i + 1;
      target.samples.push_back(sample);
      target.areas_mm2.push_back(share_mm2);
      target.within_reach.push_back(counts ? 1 : 0);
      target.lit.push_back(spec.irradiance_w_per_mm2.value_or(0) > 0 ? 1 : 0);
      if (!has_target) continue;
      target.irradiance_w_per_mm2.push_back(spec.irradiance_w_per_mm2.value_or(0));
      target.weights.push_back(spec.weight * share_mm2 / area_mm2);
    }
  }
}

std::vector<std::size_t> samples_of_field(const Target& target, std::size_t field) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < target.samples.size(); ++i)
    if (target.samples[i].field == field) places.push_back(i);
  return places;
}

Target near_field_alone(const Target& target) {
  const std::size_t count = samples_of_field(target, 0).size();  // they come first
  Target alone = target;
  alone.samples = first_of(target.samples, count);
  alone.irradiance_w_per_mm2 = first_of(target.irradiance_w_per_mm2, count);
  alone.weights = first_of(target.weights, count);
  alone.areas_mm2 = first_of(target.areas_mm2, count);
  alone.within_reach = first_of(target.within_reach, count);
  alone.lit = first_of(target.lit, count);
  return alone;
}

}  // namespace catoptric::design
