#include "sim/surroundings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "base/float_traps.h"

namespace catoptric::sim {
namespace {

/// Far above any glass, and below what makes a transmitted direction lose digits.
constexpr double greatest_index = 10;

void check(const Object& object) {
  const UntrappedFloats untrapped;  // NaN is one of the things refused
  if (object.faces.empty())
    throw InputError({"has no surface", object.name, "light can meet it nowhere", "give it a shape"});
  if (auto defect = find_defect(object.material)) {
    defect->where = object.name;
    throw InputError(std::move(*defect));
  }
  if (!object.glass) return;
  const auto [index, absorption] = *object.glass;
  if (!(index >= 1 && index <= greatest_index))
    throw InputError({fmt::format("a refractive index of {}", index), object.name,
                      fmt::format("it lies between 1 and {:g}", greatest_index),
                      "1.49 is acrylic, 1.52 window glass"});
  if (!(std::isfinite(absorption) && absorption >= 0))
    throw InputError({fmt::format("an absorption of {} per mm", absorption), object.name,
                      "it is finite and not negative", "0 is clear glass"});
}

bool goes_on(const Material& material) { return surviving_share(material) > 0; }

}  // namespace

Surroundings::Surroundings(std::vector<Object> objects, std::vector<MoreField> fields)
    : objects_(std::move(objects)), fields_(std::move(fields)) {
  for (const Object& object : objects_) {
    check(object);
    sends_light_on_ = sends_light_on_ || object.glass || goes_on(object.material);
    lets_light_through_ = lets_light_through_ || object.glass || object.material.transmittance > 0;
    may_shade_ = true;
  }
  for (const MoreField& more : fields_) {
    const auto& material = more.field.material();
    if (!material) continue;
    sends_light_on_ = sends_light_on_ || goes_on(*material);
    lets_light_through_ = lets_light_through_ || material->transmittance > 0;
    may_shade_ = true;
  }
}

std::optional<Surroundings::Stop> Surroundings::first(const Ray& ray, std::optional<Face> on,
                                                      std::optional<std::size_t> inside,
                                                      double reach_mm) const {
  std::optional<Stop> nearest;
  const std::size_t begin = inside.value_or(0), end = inside ? *inside + 1 : objects_.size();
  for (std::size_t object = begin; object < end; ++object)
    for (std::size_t i = 0; i < objects_[object].faces.size(); ++i) {
      const Face face{object, i};
      const auto meeting = objects_[object].faces[i]->meet(ray, on == face, reach_mm);
      if (!meeting) continue;
      reach_mm = meeting->distance_mm;
      nearest = Stop{face, *meeting};
    }
  return nearest;
}

std::optional<double> Surroundings::first_opaque(const Ray& ray, double reach_mm) const {
  std::optional<double> nearest;
  const auto nearer = [&](double distance_mm) { nearest = reach_mm = distance_mm; };
  for (const Object& object : objects_)
    for (const auto& face : object.faces)
      if (!object.glass)
        if (const auto meeting = face->meet(ray, false, reach_mm)) nearer(meeting->distance_mm);
  for (const MoreField& more : fields_)
    if (more.field.material())
      for (const Arrival& arrival : more.field.meet(ray, false, reach_mm))
        if (more.field.contains(arrival.plane_mm)) {
          nearer(arrival.distance_mm);
          break;
        }
  return nearest;
}

std::optional<std::string> Surroundings::asymmetry() const {
  if (!fields_.empty())
    return fmt::format("{} is a further field, whose light is not folded about the axis",
                       fields_.front().name);
  for (const Object& object : objects_)
    for (const auto& face : object.faces)
      if (!face->is_round()) return fmt::format("{} is not round about the axis", object.name);
  return std::nullopt;
}

std::optional<std::size_t> Surroundings::body_around(const Vector3& point_mm) const {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (!objects_[i].glass) continue;
    for (const Vector3& way : {Vector3(0, 0, 1), Vector3(0, 0, -1), Vector3(1, 0, 0), Vector3(0, 1, 0)})
      if (const auto stop = first({point_mm, way}, {}, i, HUGE_VAL);
          stop && stop->meeting.normal.dot(way) > 0)
        return i;
  }
  return std::nullopt;
}

Surroundings Surroundings::luminaire() const {
  std::vector<Object> own;
  std::ranges::copy_if(objects_, std::back_inserter(own), &Object::of_luminaire);
  return {std::move(own), {}};
}

}  // namespace catoptric::sim
