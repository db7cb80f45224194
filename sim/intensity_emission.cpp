#include "sim/intensity_emission.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace catoptric::sim {
namespace {

constexpr double rad_per_degree = pi / 180;
constexpr double widest_deg = 2;  ///< of a cell: what is beside the mirror is left out no finer

/// Pieces of each step between ascending angles, none wider than widest_deg.
std::vector<double> fine_angles(const std::vector<double>& angles, double end) {
  std::vector<double> fine;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next = i + 1 < angles.size() ? angles[i + 1] : end;
    const int pieces = std::max(1, static_cast<int>(std::ceil((next - angles[i]) / widest_deg)));
    for (int k = 0; k < pieces && next > angles[i]; ++k)
      fine.push_back(angles[i] + (next - angles[i]) * k / pieces);
  }
  fine.push_back(end);
  return fine;
}

/// Integral of sin(gamma) times the line from `first` at a to `last` at b, up to `to`.
double light_up_to(double a, double b, double first, double last, double to) {
  // With u from a: sin(a + u) (first + slope u), by parts; u^2 terms cancel for short ways, which costs
  // digits that a photon does not miss: cells are wide.
  const double slope = (last - first) / (b - a), u = to - a;
  const double half = 0.5 * u, middle = a + half;
  const double sines = 2 * std::sin(middle) * std::sin(half);  // integral of the sine alone
  const double risen = std::sin(to) - std::sin(a) - u * std::cos(to);
  return first * sines + slope * risen;
}

/// The gamma up to which a share of the cell's light lies.
double gamma_of(double a, double b, double first, double last, double share) {
  const double whole = light_up_to(a, b, first, last, b), wanted = share * whole;
  double low = a, high = b, at = a + (b - a) * share;
  for (int i = 0; i < 60; ++i) {
    const double off = light_up_to(a, b, first, last, at) - wanted;
    (off > 0 ? high : low) = at;
    const double rate = std::sin(at) * (first + (last - first) * (at - a) / (b - a));
    const double next = rate > 0 ? at - off / rate : low;
    const double step = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(step - at) <= 1e-15 * b) return step;
    at = step;
  }
  return at;
}

/// The share of a way up to which a share of what rises from `first` to `last` along it lies.
double line_share(double first, double last, double share) {
  const double square = first * first + share * (last * last - first * first);
  const double sum = first + std::sqrt(std::max(0.0, square));
  return sum > 0 ? std::clamp(share * (first + last) / sum, 0.0, 1.0) : share;
}

Vector3 direction_of(double gamma_rad, double c_rad) {
  const double sine = std::sin(gamma_rad);
  return {sine * std::cos(c_rad), sine * std::sin(c_rad), std::cos(gamma_rad)};
}

/// The element of an ascending list of parts that holds `light`.
template <typename Part>
const Part& part_at(const std::vector<Part>& parts, double light) {
  const auto after = std::upper_bound(parts.begin() + 1, parts.end(), light,
                                      [](double value, const Part& part) { return value < part.before; });
  return *std::prev(after);
}

}  // namespace

IntensityEmission::IntensityEmission(const Vector3& position_mm, const Eigen::Matrix3d& frame,
                                     const IntensityTable& table, const ProjectionMap* towards,
                                     double power_w)
    : position_mm_(position_mm), frame_(frame) {
  const std::vector<double> gammas =
      fine_angles({table.gamma_deg().begin(), table.gamma_deg().end() - 1}, table.gamma_deg().back());
  double all = 0;
  for (const bool only_towards : {false, true}) {
    rows_.clear();
    light_ = 0;
    for (std::size_t i = 0; i + 1 < gammas.size(); ++i)
      add_row(table, gammas[i], gammas[i + 1], only_towards ? towards : nullptr);
    if (!only_towards) all = light_;
    if (!towards) break;
  }
  power_w_ = all > 0 ? power_w * light_ / all : 0;
}

void IntensityEmission::add_row(const IntensityTable& table, double low_deg, double high_deg,
                                const ProjectionMap* towards) {
  const std::vector<double> planes = fine_angles(table.c_deg(), 360);
  Row row{low_deg * rad_per_degree, high_deg * rad_per_degree, {}};
  row.before = light_;
  for (std::size_t k = 0; k + 1 < planes.size(); ++k) {
    const double first_deg = planes[k], last_deg = planes[k + 1];
    Cell cell{first_deg * rad_per_degree,
              (last_deg - first_deg) * rad_per_degree,
              table.at(low_deg, first_deg),
              table.at(low_deg, last_deg),
              table.at(high_deg, first_deg),
              table.at(high_deg, last_deg),
              row.light};
    const double middle_c = cell.first_c_rad + 0.5 * cell.width_c_rad;
    if (towards) {
      const Vector3 middle = direction_of(0.5 * (row.low_rad + row.high_rad), middle_c);
      // No corner is farther than half of both widths together.
      const double half_rad = 0.5 * (row.high_rad - row.low_rad + cell.width_c_rad);
      if (!towards->touches(frame_ * middle, half_rad)) continue;
    }
    const double light =
        cell.width_c_rad * light_up_to(row.low_rad, row.high_rad, 0.5 * (cell.low_first + cell.low_last),
                                       0.5 * (cell.high_first + cell.high_last), row.high_rad);
    if (!(light > 0)) continue;
    row.light += light;
    row.cells.push_back(cell);
  }
  if (row.cells.empty()) return;
  light_ += row.light;
  rows_.push_back(std::move(row));
}

Ray IntensityEmission::emit(const std::array<double, 4>& numbers, std::uint64_t) const {
  if (rows_.empty()) return {position_mm_, frame_.col(2)};
  const double along = numbers[0] * light_;
  const Row& row = part_at(rows_, along);
  const double around = numbers[1] * row.light;
  const Cell& cell = part_at(row.cells, around);
  const auto next = static_cast<std::size_t>(&cell - row.cells.data()) + 1;
  const double end = next < row.cells.size() ? row.cells[next].before : row.light;
  const double gamma_share = std::clamp((along - row.before) / row.light, 0.0, 1.0);
  const double c_share = std::clamp((around - cell.before) / (end - cell.before), 0.0, 1.0);

  const double gamma = gamma_of(row.low_rad, row.high_rad, 0.5 * (cell.low_first + cell.low_last),
                                0.5 * (cell.high_first + cell.high_last), gamma_share);
  const double t = (gamma - row.low_rad) / (row.high_rad - row.low_rad);
  const double first = std::lerp(cell.low_first, cell.high_first, t),
               last = std::lerp(cell.low_last, cell.high_last, t);
  const double c = cell.first_c_rad + cell.width_c_rad * line_share(first, last, c_share);
  return {position_mm_, frame_ * direction_of(gamma, c)};
}

}  // namespace catoptric::sim
