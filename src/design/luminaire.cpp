#include "design/luminaire.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "base/units.h"
#include "design/stage.h"
#include "design/variables.h"
#include "sim/far_intensity.h"
#include "sim/frame.h"

namespace catoptric::design {
namespace {

/// Streams that no search and no verdict uses.
constexpr std::uint64_t luminaire_stream = std::uint64_t{1} << 37;

/// Towards the near field along the mirror's axis, C = 0 along x.
Eigen::Matrix3d luminaire_frame(const Scene& scene, const Profile& profile) {
  const double middle_mm = 0.5 * (profile.z_min_mm() + profile.z_max_mm());
  const Vector3 normal = scene.near_field.normal();
  // A near field across the axis looks at the mirror; one along it tells by where it lies.
  const bool up = std::abs(normal.z()) > 0.5 ? normal.z() < 0 : scene.near_field.center_mm().z() > middle_mm;
  return sim::frame_along(up ? Vector3::UnitZ() : Vector3(-Vector3::UnitZ()), Vector3::UnitX());
}

Measured measured(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Measured result;
  for (const double value : values) result.value += value / n;
  double square = 0;
  for (const double value : values) square += (value - result.value) * (value - result.value);
  if (values.size() > 1) result.noise = std::sqrt(square / (n - 1) / n);
  return result;
}

/// Where the line from (a, first) to (b, last) falls to `level`.
double crossing(double a, double b, double first, double last, double level) {
  return a + (b - a) * (first - level) / (first - last);
}

/// How far from the axis the intensity of one plane first falls to a level; nothing when it never does.
std::optional<double> falls_at(const IntensityTable& table, double c_deg, double level) {
  const std::vector<double>& gamma = table.gamma_deg();
  double before = table.at(gamma.front(), c_deg);
  if (before < level) return std::nullopt;
  for (std::size_t i = 1; i < gamma.size(); ++i) {
    const double now = table.at(gamma[i], c_deg);
    if (now < level) return crossing(gamma[i - 1], gamma[i], before, now, level);
    before = now;
  }
  return std::nullopt;
}

class Replicates {
 public:
  Replicates(const Scene& scene, const sim::IntensityGrid& grid) : scene_(scene), grid_(grid) {}

  void add(std::vector<double> w_per_sr, double departed_w) {
    tables_.emplace_back(scene_.source.quantity, grid_.gamma_deg, grid_.c_deg, std::move(w_per_sr));
    departed_w_.push_back(departed_w);
  }

  template <typename Value>
  Measured of_each(const Value& value) const {
    std::vector<double> values;
    for (const IntensityTable& table : tables_) values.push_back(value(table));
    return measured(values);
  }
  Measured departed() const { return measured(departed_w_); }
  std::size_t nodes() const { return tables_.front().values().size(); }

 private:
  const Scene& scene_;
  const sim::IntensityGrid& grid_;
  std::vector<IntensityTable> tables_;
  std::vector<double> departed_w_;
};

/// Root mean square over the sphere of values at the table's nodes.
double rms(const sim::IntensityGrid& grid, const std::vector<double>& values) {
  double sum = 0, weight = 0;
  for (std::size_t plane = 0; plane < grid.c_deg.size(); ++plane)
    for (std::size_t i = 0; i < grid.gamma_deg.size(); ++i) {
      const double value = values[plane * grid.gamma_deg.size() + i];
      const double area = std::sin(grid.gamma_deg[i] * pi / 180);
      sum += area * value * value;
      weight += area;
    }
  return weight > 0 ? std::sqrt(sum / weight) : 0;
}

void find_peak(LuminaireIntensity& result) {
  const std::vector<double>& values = result.table.values();
  const auto top = static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  const std::size_t rows = result.table.gamma_deg().size();
  result.peak = {values[top], result.noise[top]};
  result.peak_gamma_deg = result.table.gamma_deg()[top % rows];
  result.peak_c_deg = result.table.c_deg()[top / rows];
}

/// Borders of the zones that lighting engineers add light up in.
constexpr std::array zone_borders_deg{0.0, 30.0, 40.0, 60.0, 80.0, 90.0, 120.0, 180.0};

}  // namespace

BeamAngle beam_angle(const IntensityTable& table, double c_deg) {
  const auto width = [&](double share) -> std::optional<double> {
    const double level = share * table.maximum();
    const auto here = falls_at(table, c_deg, level), there = falls_at(table, c_deg + 180, level);
    if (!here || !there) return std::nullopt;
    return *here + *there;
  };
  return {c_deg, width(0.5), width(0.1)};
}

LuminaireIntensity run_intensity(const Scene& scene, const RunControl& control) {
  const auto begin = std::chrono::steady_clock::now();
  if (scene.model.photons.photons == 0)
    throw scene.settings.error("model.photons", "is 0", "an intensity is counted from photons", "1000000");
  const Candidate start = start_candidate(scene);
  const Stage stage(scene, start);
  const bool round = sim::shines_round(stage.scene);
  const sim::IntensityGrid grid =
      sim::even_grid(scene.intensity.gamma_step_deg, round ? 0 : scene.intensity.c_step_deg,
                     luminaire_frame(scene, start.profile));
  Replicates replicates(scene, grid);
  sim::PhotonOptions photons = scene.model.photons;
  photons.seed = scene.seed;
  photons.stop = control.stop;
  std::uint64_t emitted = 0;
  for (std::uint64_t i = 0; i < scene.model.replicates; ++i) {
    control.tell({"intensity", static_cast<double>(i) / static_cast<double>(scene.model.replicates), NAN, 0});
    photons.stream = luminaire_stream + 1 + i;
    sim::FarIntensity one = far_intensity(stage.scene, grid, photons);
    emitted += one.totals.counts.emitted;
    replicates.add(std::move(one.w_per_sr), one.departed_w);
  }

  std::vector<double> values, noise;
  for (std::size_t node = 0; node < replicates.nodes(); ++node) {
    const Measured one =
        replicates.of_each([&](const IntensityTable& table) { return table.values()[node]; });
    values.push_back(one.value);
    noise.push_back(one.noise);
  }
  std::vector<double> bias = step_bias(grid, values);
  const double all = rms(grid, values), noise_rms = rms(grid, noise), bias_rms = rms(grid, bias);
  LuminaireIntensity result{
      start.profile,
      IntensityTable(scene.source.quantity, grid.gamma_deg, grid.c_deg, std::move(values)),
      std::move(noise),
      std::move(bias),
      grid.frame.col(2),
      start.source.power_w,
      replicates.departed()};
  find_peak(result);
  for (const double c_deg : {0.0, 90.0}) {
    if (c_deg > 0 && result.table.is_rotational()) continue;
    result.angles.push_back(beam_angle(result.table, c_deg));
  }
  for (std::size_t i = 0; i + 1 < zone_borders_deg.size(); ++i) {
    const double from = zone_borders_deg[i], to = zone_borders_deg[i + 1];
    result.zones.push_back({from, to, replicates.of_each([&](const IntensityTable& table) {
                              return table.zonal_flux(from, to);
                            })});
  }
  if (all > 0) {
    result.noise_rel = noise_rms / all;
    result.bias_rel = bias_rms / all;
  }
  constexpr double most_bias_rel = 0.05;
  if (result.bias_rel > most_bias_rel)
    result.remark = fmt::format(
        "The light is narrower than the table's steps of {:.3g} degrees: peak and beam angles are the "
        "table's, not "
        "the lamp's. Try --set intensity.gamma_step={:.2g}; light that is parallel has no intensity at any "
        "step.",
        scene.intensity.gamma_step_deg, 0.2 * scene.intensity.gamma_step_deg);
  result.photons = emitted;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace catoptric::design
