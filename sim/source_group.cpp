#include "sim/source_group.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"

namespace catoptric::sim {
namespace {

/// The first number picks the part by its power, and what is left of it is the part's own first number: so
/// evenly spread numbers stay even within each.
class GroupEmission final : public Emission {
 public:
  explicit GroupEmission(std::vector<std::unique_ptr<Emission>> parts) {
    for (auto& part : parts) {
      if (!(part->power_w() > 0)) continue;
      numbers_ = std::max(numbers_, part->numbers());
      power_w_ += part->power_w();
      parts_.push_back({std::move(part), power_w_});
    }
    if (parts_.empty() && !parts.empty()) parts_.push_back({std::move(parts.front()), 0});
  }
  double power_w() const override { return power_w_; }
  std::size_t numbers() const override { return numbers_; }

  Ray emit(const std::array<double, 4>& numbers, std::uint64_t stream) const override {
    const double power = numbers[0] * power_w_;
    const auto after = std::upper_bound(parts_.begin(), parts_.end() - 1, power,
                                        [](double value, const Part& part) { return value < part.up_to_w; });
    const double before_w = after == parts_.begin() ? 0 : std::prev(after)->up_to_w;
    std::array<double, 4> own = numbers;
    constexpr double last = 1 - 0x1p-53;
    const double width_w = after->up_to_w - before_w;
    own[0] = width_w > 0 ? std::clamp((power - before_w) / width_w, 0.0, last) : numbers[0];
    return after->emission->emit(own, stream);
  }

 private:
  struct Part {
    std::unique_ptr<Emission> emission;
    double up_to_w;  ///< power of the parts up to this one
  };
  std::vector<Part> parts_;
  double power_w_ = 0;
  std::size_t numbers_ = 1;
};

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts)
    if (all.find(text) == std::string::npos) all += (all.empty() ? "" : "; ") + text;
  return all;
}

}  // namespace

SourceGroup::SourceGroup(std::vector<std::unique_ptr<const Source>> parts) : parts_(std::move(parts)) {
  if (parts_.empty()) throw InputError({"a group of no sources", "source", "a group has one at least", ""});
  Vector3 low = parts_.front()->position_mm(), high = low;
  for (const auto& part : parts_) {
    low = low.cwiseMin(part->position_mm());
    high = high.cwiseMax(part->position_mm());
    is_sampled_ = is_sampled_ || part->is_sampled();
  }
  middle_mm_ = low + 0.5 * (high - low);
  for (const auto& part : parts_)
    extent_mm_ = std::max(extent_mm_, (part->position_mm() - middle_mm_).norm() + part->extent_mm());
}

double SourceGroup::power_w() const {
  double sum = 0;
  for (const auto& part : parts_) sum += part->power_w();
  return sum;
}

bool SourceGroup::is_round() const {
  return std::all_of(parts_.begin(), parts_.end(), [](const auto& part) {
    return part->is_round() && part->tilt_rad() == 0 && part->position_mm().x() == 0 &&
           part->position_mm().y() == 0;
  });
}

double SourceGroup::intensity_w_per_sr(const Vector3& direction) const {
  if (is_sampled_) return 0;
  double sum = 0;
  for (const auto& part : parts_) sum += part->intensity_w_per_sr(direction);
  return sum;
}

std::string SourceGroup::words() const {
  std::vector<std::string> words;
  for (const auto& part : parts_) words.push_back(part->words());
  return fmt::format("{} sources ({})", parts_.size(), joined(words));
}

std::string SourceGroup::left_out() const {
  std::vector<std::string> words;
  for (const auto& part : parts_) words.push_back(part->left_out());
  return joined(words);
}

std::unique_ptr<Emission> SourceGroup::emission_to(const Profile& mirror) const {
  if (is_sampled_) return emission();
  std::vector<std::unique_ptr<Emission>> list;
  for (const auto& part : parts_) list.push_back(part->emission_to(mirror));
  return std::make_unique<GroupEmission>(std::move(list));
}

std::unique_ptr<Emission> SourceGroup::emission() const {
  std::vector<std::unique_ptr<Emission>> list;
  for (const auto& part : parts_) list.push_back(part->emission());
  return std::make_unique<GroupEmission>(std::move(list));
}

double SourceGroup::unhindered_w_per_mm2(const Vector3& point_mm, const Vector3& normal) const {
  if (is_sampled_) return 0;
  double sum = 0;
  for (const auto& part : parts_) sum += part->unhindered_w_per_mm2(point_mm, normal);
  return sum;
}

double SourceGroup::direct_w_per_mm2(const Vector3& point_mm, const Vector3& normal, Probe& mirror,
                                     double lift_mm) const {
  if (is_sampled_) return 0;
  double sum = 0;
  for (const auto& part : parts_) sum += part->direct_w_per_mm2(point_mm, normal, mirror, lift_mm);
  return sum;
}

}  // namespace catoptric::sim
