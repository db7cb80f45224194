#include "design/foresight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/byte_record.h"
#include "base/errors.h"

namespace catoptric::design {
namespace {

constexpr double no_better = std::numeric_limits<double>::infinity();
/// Computed in one go at most: what a rank that dies loses.
constexpr std::size_t certain_points_of_a_rank = 8;

/// What a rank says of a point.
struct Answer {
  double value = no_better;
  bool stopped = false;
  bool broken_off = false;
};

}  // namespace

/// New points that the search comes to if each of them, by its number, got such an answer.
Foresight::Points Foresight::asked_next(std::size_t most,
                                        const std::function<double(std::size_t)>& answer) const {
  Points points;
  const optim::Problem guessed{light_.variables, [&](std::span<const double> asked) {
                                 std::vector<double> point(asked.begin(), asked.end());
                                 if (const auto found = known_.find(point); found != known_.end())
                                   return found->second;
                                 const auto found = std::ranges::find(points, point);
                                 const auto number = static_cast<std::size_t>(found - points.begin());
                                 if (found == points.end() && points.size() < most)
                                   points.push_back(std::move(point));
                                 return answer(number);
                               }};
  rehearse_(guessed, [&] { return points.size() >= most; });
  return points;
}

Foresight::Points Foresight::next_points(std::span<const double> x) const {
  const Points only{{x.begin(), x.end()}};
  if (!rehearse_) return only;
  const std::size_t ranks = static_cast<std::size_t>(ranks_.size()), most = certain_points_of_a_rank * ranks;
  Points points = asked_next(most, [](std::size_t) { return no_better; });
  if (points.empty() || points.front() != only.front()) return only;
  double best = 1;
  for (const auto& [point, value] : known_) best = std::min(best, value);
  // By little, so that no search takes it for its goal.
  const double step = 1e-6 * std::max(std::abs(best), 1e-6);
  const Points if_better =
      asked_next(most, [&](std::size_t i) { return best - step * static_cast<double>(i + 1); });
  const auto certain = std::ranges::mismatch(points, if_better).in1 - points.begin();
  points.resize(std::min(points.size(), std::max(ranks, static_cast<std::size_t>(certain))));
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
