#include "design/ray_bundle.h"

#include "rayfiles/ray_check.h"
#include "rayfiles/ray_file.h"
#include "rayfiles/ray_picker.h"

namespace catoptric::design {
namespace {

class FileBundle final : public sim::RayBundle {
 public:
  FileBundle(std::shared_ptr<const rayfiles::RaySet> rays, const rayfiles::RayStatistics& all)
      : rays_(std::move(rays)),
        picker_(rays_),
        lit_(all.lit),
        extent_mm_(all.sphere.centre_mm.norm() + all.sphere.radius_mm) {}
  std::uint64_t count() const override { return lit_; }
  double extent_mm() const override { return extent_mm_; }
  Ray pick(double number) const override {
    const rayfiles::SourceRay ray = rays_->ray(picker_.pick(number).ray);
    return {ray.position_mm, ray.direction};
  }
  double flux() const { return picker_.total_flux(); }

 private:
  std::shared_ptr<const rayfiles::RaySet> rays_;
  rayfiles::RayPicker picker_;
  std::uint64_t lit_;
  double extent_mm_;
};

/// With the flux that is wanted where the file has it, else with the one it has: the scene says how much
/// light there is, and then only the rays' shares of it count.
std::shared_ptr<const rayfiles::RayFile> opened(const std::filesystem::path& file,
                                                std::optional<LightQuantity> wanted) {
  const auto rays = rayfiles::RayFile::open(file);
  if (!wanted || rays->header().quantity == *wanted) return rays;
  const auto* both = std::get_if<rayfiles::Tm25Header>(&rays->file_header());
  const bool has_it =
      both && (*wanted == LightQuantity::luminous ? both->has_luminous_flux : both->has_radiant_flux);
  return has_it ? rayfiles::RayFile::open(file, wanted) : rays;
}

}  // namespace

RayFileLight read_rays(const std::filesystem::path& file, std::optional<LightQuantity> wanted) {
  const auto rays = opened(file, wanted);
  const rayfiles::RayCheck check = check_rays(*rays);
  require_sound(check);
  const auto bundle = std::make_shared<const FileBundle>(rays, check.statistics);
  return {bundle, rays->header().quantity, bundle->flux()};
}

}  // namespace catoptric::design
