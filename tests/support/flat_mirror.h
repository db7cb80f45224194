#pragma once

#include <cmath>

#include "base/profile.h"
#include "base/ray.h"

namespace catoptric::test {

/// A flat round mirror at one height: the closed form of its light is that of an image source behind it.
class FlatMirror final : public Reflector {
 public:
  FlatMirror(double z_mm, double radius_mm)
      : z_(z_mm), radius_(radius_mm), profile_(Profile::bezier({{0, z_mm, 1}, {radius_mm, z_mm, 1}})) {}

  std::unique_ptr<Probe> probe() const override { return std::make_unique<FlatProbe>(z_, radius_); }
  const Profile& profile() const override { return profile_; }
  std::string_view engine() const override { return "flat"; }

 private:
  class FlatProbe final : public Probe {
   public:
    FlatProbe(double z, double radius) : z_(z), radius_(radius) {}
    std::optional<Hit> first_hit(const Ray& ray, double beyond_mm) override {
      const double distance = (z_ - ray.origin_mm.z()) / ray.direction.z();
      if (!(std::isfinite(distance) && distance > beyond_mm)) return std::nullopt;
      Vector3 point = ray.origin_mm + distance * ray.direction;
      point.z() = z_;
      if (std::hypot(point.x(), point.y()) > radius_) return std::nullopt;
      return Hit{distance, point, Vector3(0, 0, ray.direction.z() > 0 ? -1 : 1), 0};
    }
    std::vector<Hit> all_hits(const Ray& ray, double beyond_mm) override {
      const auto hit = first_hit(ray, beyond_mm);
      return hit ? std::vector<Hit>{*hit} : std::vector<Hit>{};
    }

   private:
    double z_, radius_;
  };

  double z_, radius_;
  Profile profile_;
};

}  // namespace catoptric::test
