#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "design/stage.h"
#include "design/tradeoff.h"

namespace catoptric::design {
namespace {

/// Writes the list, one knob after the other.
class SettingList {
 public:
  SettingList(const Scene& scene, const Profile& profile)
      : scene_(scene), stage_(scene, profile), radius_mm_(base_radius_mm(scene)) {}

  std::vector<TradeSetting> write() {
    if (valid(sim::Rung::tubes)) tubes();
    if (valid(sim::Rung::rings)) rings();
    photons();
    kernels();
    engines();
    threads();
    accuracies();
    return std::move(list_);
  }

 private:
  static double base_radius_mm(const Scene& scene) {
    if (scene.model.estimate.kernel_radius_mm) return *scene.model.estimate.kernel_radius_mm;
    return 0.1 * std::min(scene.near_field.half_width_mm(), scene.near_field.half_height_mm());
  }

  /// The scene's model with the default bandwidth, so that one knob at a time can be turned.
  TradeSetting base(sim::Rung rung) const {
    TradeSetting setting{rung, scene_.model, 0, {}};
    setting.model.rung = rung;
    setting.model.engine = Engine::meridian;
    setting.model.engine_asked_for = false;
    setting.model.estimate = {sim::Kernel::silverman, {}, radius_mm_};
    setting.model.photons.sampler = sim::Sampler::sobol;
    return setting;
  }

  bool valid(sim::Rung rung) const {
    return !sim::rung_objection(rung, stage_.scene, {base(rung).model.estimate, {}, {}});
  }

  std::vector<std::uint64_t> counts(std::uint64_t first, std::uint64_t step) const {
    std::vector<std::uint64_t> list;
    for (std::uint64_t n = first; n <= scene_.tradeoff.most_photons; n *= step) list.push_back(n);
    return list;
  }

  void tubes() {
    for (const double factor : {0.0, 0.125, 0.25, 0.5, 1.0, 2.0}) {
      TradeSetting setting = base(sim::Rung::tubes);
      setting.model.estimate.kernel_radius_mm = factor * radius_mm_;
      list_.push_back(setting);
    }
  }

  void rings() {
    for (const sim::Sampler sampler : {sim::Sampler::random, sim::Sampler::sobol})
      for (const std::uint64_t n : counts(1'000, 10))
        for (const double factor : {0.5, 1.0, 2.0, 4.0}) {
          TradeSetting setting = base(sim::Rung::rings);
          setting.model.photons.sampler = sampler;
          setting.model.photons.photons = n;
          setting.model.estimate.kernel_radius_mm = factor * radius_mm_;
          list_.push_back(setting);
        }
  }

  void photons() {
    for (const sim::Sampler sampler : {sim::Sampler::random, sim::Sampler::sobol})
      for (const std::uint64_t n : counts(1'000, 10)) {
        TradeSetting setting = base(sim::Rung::photons);
        setting.model.photons.sampler = sampler;
        setting.model.photons.photons = n;
        for (const double factor : {0.25, 0.5, 1.0, 2.0}) {
          setting.model.estimate = {sim::Kernel::silverman, {}, factor * radius_mm_};
          list_.push_back(setting);
        }
        for (const std::size_t neighbours : {std::size_t{50}, std::size_t{200}, std::size_t{800}}) {
          if (10 * neighbours > n) continue;
          setting.model.estimate = {sim::Kernel::silverman, neighbours, {}};
          list_.push_back(setting);
        }
      }
  }

  void kernels() {
    for (const sim::Kernel kernel :
         {sim::Kernel::epanechnikov, sim::Kernel::cone, sim::Kernel::gaussian, sim::Kernel::constant}) {
      TradeSetting setting = base(sim::Rung::photons);
      setting.model.photons.photons = std::min<std::uint64_t>(100'000, scene_.tradeoff.most_photons);
      setting.model.estimate.kernel = kernel;
      list_.push_back(setting);
    }
  }

  void engines() {
    for (const std::uint64_t n : {std::uint64_t{1'000}, std::uint64_t{10'000}}) {
      TradeSetting setting = base(sim::Rung::photons);
      setting.model.engine = Engine::occt;
      setting.model.engine_asked_for = true;
      setting.model.photons.photons = std::min(n, scene_.tradeoff.most_photons);
      list_.push_back(setting);
    }
    for (const double chord_error : {1e-2, 1e-3, 1e-4})
      for (const double newton_tolerance : {1.0, 1e-14}) {  // 1: the facets' own hits
        TradeSetting setting = base(sim::Rung::photons);
        setting.model.engine = Engine::mesh;
        setting.model.engine_asked_for = true;
        setting.model.mesh.chord_error = chord_error;
        setting.model.mesh.newton_tolerance = newton_tolerance;
        setting.model.photons.photons = std::min<std::uint64_t>(100'000, scene_.tradeoff.most_photons);
        list_.push_back(setting);
      }
  }

  void threads() {
    for (const sim::Rung rung : sim::all_rungs)
      for (const std::uint64_t n : {std::uint64_t{100'000}, std::uint64_t{1'000'000}}) {
        if (!valid(rung) || n > scene_.tradeoff.most_photons) continue;
        TradeSetting setting = base(rung);
        setting.model.photons.photons = n;
        setting.threads = 1;
        list_.push_back(setting);
        if (rung == sim::Rung::tubes) break;
      }
  }

  void accuracies() {
    for (const sim::Rung rung : sim::all_rungs)
      for (const double accuracy : {0.1, 0.01, 0.001}) {
        if (!valid(rung)) continue;
        TradeSetting setting = base(rung);
        setting.accuracy_rel = accuracy;
        list_.push_back(setting);
      }
  }

  const Scene& scene_;
  Stage stage_;
  double radius_mm_;
  std::vector<TradeSetting> list_;
};

}  // namespace

std::vector<TradeSetting> trade_settings(const Scene& scene, const Profile& profile) {
  return SettingList(scene, profile).write();
}

std::string words(const Scene& scene, const TradeSetting& setting) {
  std::string text(name(setting.rung));
  if (setting.accuracy_rel) return fmt::format("{}, accuracy = {:g}", text, *setting.accuracy_rel);
  const sim::EstimateOptions& estimate = setting.model.estimate;
  if (setting.rung != sim::Rung::tubes)
    text += fmt::format(", {} {} photons", setting.model.photons.photons,
                        setting.model.photons.sampler == sim::Sampler::sobol ? "Sobol" : "random");
  if (estimate.neighbours)
    text += fmt::format(", {} neighbours", *estimate.neighbours);
  else if (*estimate.kernel_radius_mm > 0)
    text += fmt::format(", kernel radius {:.4g} {}", scene.to_scene_unit(*estimate.kernel_radius_mm),
                        symbol(scene.unit));
  else
    text += ", pointwise";
  if (estimate.kernel != sim::Kernel::silverman) text += fmt::format(", {} kernel", name(estimate.kernel));
  if (setting.model.engine != Engine::meridian)
    text += fmt::format(", engine {}", name(setting.model.engine));
  if (setting.model.engine == Engine::mesh)
    text += fmt::format(" with chord error {:g}, {}", setting.model.mesh.chord_error,
                        setting.model.mesh.newton_tolerance < setting.model.mesh.chord_error
                            ? fmt::format("Newton to {:g}", setting.model.mesh.newton_tolerance)
                            : "not refined");
  if (setting.threads > 0)
    text += fmt::format(", {} thread{}", setting.threads, setting.threads > 1 ? "s" : "");
  return text;
}

}  // namespace catoptric::design
