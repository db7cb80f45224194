#include "rayfiles/bounding_sphere.h"

#include <algorithm>

#include "base/contract.h"

namespace catoptric::rayfiles {
namespace {

constexpr int directions[13][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 0},  {1, -1, 0},
                                   {1, 0, 1},  {1, 0, -1}, {0, 1, 1},  {0, 1, -1}, {1, 1, 1},
                                   {1, 1, -1}, {1, -1, 1}, {1, -1, -1}};

}  // namespace

void ExtremePoints::add(const Vector3& point_mm) {
  for (std::size_t i = 0; i < lowest_.size(); ++i) {
    const double along =
        directions[i][0] * point_mm.x() + directions[i][1] * point_mm.y() + directions[i][2] * point_mm.z();
    if (!lowest_[i] || along < lowest_[i]->along) lowest_[i] = {along, point_mm};
    if (!highest_[i] || along > highest_[i]->along) highest_[i] = {along, point_mm};
  }
}

Vector3 ExtremePoints::centre_mm() const {
  CATOPTRIC_EXPECTS(!empty());
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < lowest_.size(); ++i) {
    points.push_back(lowest_[i]->point_mm);
    points.push_back(highest_[i]->point_mm);
  }
  Vector3 centre = 0.5 * (points[0] + points[1]);
  constexpr int steps = 1000;  // the radius is then right to a thousandth
  for (int step = 1; step <= steps; ++step) {
    const auto farthest =
        std::max_element(points.begin(), points.end(), [&](const Vector3& a, const Vector3& b) {
          return (a - centre).squaredNorm() < (b - centre).squaredNorm();
        });
    centre += (*farthest - centre) / (step + 1);
  }
  return centre;
}

}  // namespace catoptric::rayfiles
