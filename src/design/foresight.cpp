#include "design/foresight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/byte_record.h"
#include "base/errors.h"

namespace catoptric::design {
namespace {

constexpr double no_better = std::numeric_limits<double>::infinity();

/// What a rank says of a point.
struct Answer {
  double value = no_better;
  bool stopped = false;
  bool broken_off = false;
};

}  // namespace

std::vector<std::vector<double>> Foresight::next_points(std::span<const double> x) const {
  const std::size_t wanted = static_cast<std::size_t>(ranks_.size());
  std::vector<std::vector<double>> points;
  const optim::Problem guessed{
      light_.variables, [&](std::span<const double> asked) {
        std::vector<double> point(asked.begin(), asked.end());
        if (const auto found = known_.find(point); found != known_.end()) return found->second;
        if (points.size() < wanted && std::ranges::find(points, point) == points.end())
          points.push_back(std::move(point));
        return no_better;
      }};
  if (rehearse_) rehearse_(guessed, [&] { return points.size() >= wanted; });
  if (points.empty() || !std::ranges::equal(points.front(), x)) return {{x.begin(), x.end()}};
  return points;
}

double Foresight::evaluate(std::span<const double> x) {
  const std::vector<double> here(x.begin(), x.end());
  if (const auto found = known_.find(here); found != known_.end()) return found->second;
  const auto points = next_points(x);
  const auto results = ranks_.share(points.size(), [&](std::size_t i) {
    Answer answer;
    try {
      answer.value = light_.evaluate(points[i]);
    } catch (const Interrupted&) {
      answer.broken_off = true;
    }
    answer.stopped = stop_ && stop_->load(std::memory_order_relaxed);
    return ByteWriter().put(answer).take();
  });
  bool broken_off = false;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto answer = ByteReader(results[i]).get<Answer>();
    if (answer.stopped || answer.broken_off) stopped_ = true;
    if (answer.broken_off)
      broken_off = broken_off || i == 0;
    else
      known_[points[i]] = std::isnan(answer.value) ? no_better : answer.value;
  }
  if (broken_off) throw Interrupted();
  return known_.at(here);
}

}  // namespace catoptric::design
