#include "design/field_change.h"

#include <algorithm>
#include <cmath>

#include "base/ordered_sum.h"
#include "design/evaluator.h"
#include "design/sampling.h"

namespace catoptric::design {
namespace {

using Index = std::size_t;

/// Streams of a sensitivity's photons, which no search, verdict or trade uses.
constexpr std::uint64_t sensitivity_stream = std::uint64_t{1} << 35;
constexpr int cut_points = 60;

/// Means over some of the replicates at one point.
double mean_without(const Changes& changes, Index point, std::optional<Index> left_out) {
  double sum = 0;
  for (Index r = 0; r < changes.w_per_mm2.size(); ++r)
    if (r != left_out) sum += changes.w_per_mm2[r][point];
  return sum / static_cast<double>(changes.w_per_mm2.size() - (left_out ? 1 : 0));
}

/// Mean over the points of the squared mean over replicates, less that mean's variance.
double mean_square(const Changes& changes, Index points, std::optional<Index> left_out) {
  const Index count = changes.w_per_mm2.size() - (left_out ? 1 : 0);
  std::vector<double> squares(points);
  for (Index i = 0; i < points; ++i) {
    const double mean = mean_without(changes, i, left_out);
    double spread = 0;
    for (Index r = 0; r < changes.w_per_mm2.size(); ++r)
      if (r != left_out) spread += (changes.w_per_mm2[r][i] - mean) * (changes.w_per_mm2[r][i] - mean);
    squares[i] = mean * mean;
    if (count > 1) squares[i] -= spread / static_cast<double>(count * (count - 1));
  }
  return ordered_sum(squares) / static_cast<double>(points);
}

}  // namespace

FieldChanger::FieldChanger(const Scene& scene, const Profile& profile)
    : scene_(scene), profile_(profile), points_(field_samples(scene)), samples_(points_.size()) {
  for (int i = 0; i < cut_points; ++i) {
    radii_mm_.push_back(scene.near_field.half_width_mm() * i / cut_points);
    points_.push_back({scene.near_field.to_space({radii_mm_.back(), 0.0}), scene.near_field.normal()});
  }
  const Changes& field = own(make_plan(scene, profile).rung);
  rms_ = std::sqrt(std::max(0.0, mean_square(field, samples_, {})));
  if (!(rms_ > 0))
    throw InputError(
        {"the near field is dark", "", "changes are relative to its light", "turn it to the mirror"});
}

std::uint64_t FieldChanger::replicates(sim::Rung rung) const {
  return rung == sim::Rung::tubes ? 1 : scene_.model.replicates;
}

std::uint64_t FieldChanger::photons_of_a_scene(sim::Rung rung) const {
  return rung == sim::Rung::tubes ? 0 : replicates(rung) * scene_.model.photons.photons;
}

Changes FieldChanger::fields(const Scene& scene, const Profile& profile, sim::Rung rung) {
  Changes result;
  for (std::uint64_t r = 0; r < replicates(rung); ++r)
    result.w_per_mm2.push_back(total_by_rung(scene, rung, profile, points_, sensitivity_stream + r));
  return result;
}

const Changes& FieldChanger::own(sim::Rung rung) {
  const auto found = own_.find(rung);
  return found != own_.end() ? found->second
                             : own_.emplace(rung, fields(scene_, profile_, rung)).first->second;
}

std::optional<Changes> FieldChanger::changes(const Deviation& deviation, double amount, sim::Rung rung) {
  const auto varied = deviation.at(amount);
  if (!varied) return std::nullopt;
  Changes result = fields(varied->scene, varied->profile, rung);
  photons_ += photons_of_a_scene(rung);
  const Changes& nominal = own(rung);
  for (Index r = 0; r < result.w_per_mm2.size(); ++r)
    for (Index i = 0; i < points_.size(); ++i) result.w_per_mm2[r][i] -= nominal.w_per_mm2[r][i];
  return result;
}

FieldChange FieldChanger::measure(const Changes& changes) const {
  const auto root = [&](std::optional<Index> left_out) {
    return std::sqrt(std::max(0.0, mean_square(changes, samples_, left_out))) / rms_;
  };
  FieldChange change{root({}), 0};
  const Index count = changes.w_per_mm2.size();
  if (count < 3) return change;
  std::vector<double> without;  // jackknife
  for (Index r = 0; r < count; ++r) without.push_back(root(r));
  const double mean = ordered_sum(without) / static_cast<double>(count);
  double spread = 0;
  for (const double each : without) spread += (each - mean) * (each - mean);
  change.noise_rel = std::sqrt(spread * static_cast<double>(count - 1) / static_cast<double>(count));
  return change;
}

std::vector<double> FieldChanger::along_cut(const Changes& changes) const {
  std::vector<double> cut;
  for (Index i = samples_; i < points_.size(); ++i) cut.push_back(mean_without(changes, i, {}));
  return cut;
}

std::vector<double> FieldChanger::noise_along_cut(const Changes& changes) const {
  std::vector<double> noise(points_.size() - samples_, 0.0);
  const Index count = changes.w_per_mm2.size();
  if (count < 2) return noise;
  for (Index i = samples_; i < points_.size(); ++i) {
    const double mean = mean_without(changes, i, {});
    double spread = 0;
    for (const auto& each : changes.w_per_mm2) spread += (each[i] - mean) * (each[i] - mean);
    noise[i - samples_] = std::sqrt(spread / static_cast<double>(count * (count - 1)));
  }
  return noise;
}

std::vector<double> FieldChanger::field_along_cut(sim::Rung rung) { return along_cut(own(rung)); }

}  // namespace catoptric::design
