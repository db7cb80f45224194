#include "photometry/lm63_angles.h"

#include <fmt/format.h>

#include <algorithm>

namespace catoptric::photometry {
namespace {

constexpr std::string_view vertical_field = "vertical angles", horizontal_field = "horizontal angles";

std::string span_of(const std::vector<double>& angles) {
  return fmt::format("they go from {} to {} degrees", angles.front(), angles.back());
}

void check_vertical_c(const std::vector<double>& angles, const NumberStream& numbers) {
  const bool begins = angles.front() == 0 || angles.front() == 90;
  const bool ends = angles.back() == 90 || angles.back() == 180;
  if (!begins || !ends || angles.size() < 2)
    numbers.refuse(span_of(angles), vertical_field,
                   "of type C they go from 0 to 90, from 90 to 180 or from 0 to 180 degrees",
                   "add the missing angles, with 0 cd where it is dark");
}

/// Whether nothing but the plane at 360 degrees is missing of a full turn.
bool lacks_last_plane(const std::vector<double>& angles) {
  if (angles.front() != 0 || angles.back() <= 180 || angles.back() >= 360) return false;
  double widest = 0;
  for (std::size_t i = 1; i < angles.size(); ++i) widest = std::max(widest, angles[i] - angles[i - 1]);
  return 360 - angles.back() <= widest + least_angle_step_deg;
}

void check_horizontal_c(const Lm63File& file, const NumberStream& numbers, std::vector<std::string>& notes) {
  const auto& angles = file.horizontal_deg;
  if (angles.size() == 1) {
    if (angles[0] != 0)
      notes.push_back(fmt::format("The only horizontal angle is {} instead of 0.", angles[0]));
    return;
  }
  if (lacks_last_plane(angles)) {
    notes.push_back("The plane at 360 degrees is missing; the one at 0 degrees stands for it.");
    return;
  }
  const bool from_0 =
      angles.front() == 0 && (angles.back() == 90 || angles.back() == 180 || angles.back() == 360);
  const bool about_90 = angles.front() == 90 && angles.back() == 270;
  if (!from_0 && !about_90)
    numbers.refuse(span_of(angles), horizontal_field,
                   "of type C there is one, or they go from 0 to 90, 180 or 360 degrees, or from 90 to 270",
                   "add the missing planes");
  if (about_90 && file.version < Lm63Version::of_1995)
    notes.push_back("Horizontal angles from 90 to 270 degrees came with the edition of 1995.");
}

/// Types A and B: from -90 or, mirrored, from 0 to 90.
void check_half_circle(const std::vector<double>& angles, std::string_view field, const NumberStream& numbers,
                       std::vector<std::string>& notes) {
  if (angles.front() < -90 || angles.back() > 90 || angles.front() > 0 || angles.back() <= 0)
    numbers.refuse(span_of(angles), field, "of types A and B they go from -90 or 0 to 90 degrees");
  if (angles.back() != 90 || (angles.front() != -90 && angles.front() != 0))
    notes.push_back(fmt::format("The {} end before 90 degrees; beyond them it is dark.", field));
  if (angles.front() == 0)
    notes.push_back(
        fmt::format("The {} begin at 0 degrees; the other half was taken for its mirror image.", field));
}

}  // namespace

void read_lm63_angles(Lm63File& file, std::size_t vertical_count, std::size_t horizontal_count,
                      NumberStream& numbers, std::vector<std::string>& notes) {
  file.vertical_deg = numbers.next_angles(vertical_count, vertical_field);
  if (file.type == PhotometricType::c)
    check_vertical_c(file.vertical_deg, numbers);
  else
    check_half_circle(file.vertical_deg, vertical_field, numbers, notes);
  file.horizontal_deg = numbers.next_angles(horizontal_count, horizontal_field);
  if (file.type == PhotometricType::c)
    check_horizontal_c(file, numbers, notes);
  else
    check_half_circle(file.horizontal_deg, horizontal_field, numbers, notes);
}

PlaneSymmetry plane_symmetry(const std::vector<double>& horizontal_deg) {
  if (horizontal_deg.size() == 1) return PlaneSymmetry::rotational;
  if (horizontal_deg.front() == 90) return PlaneSymmetry::about_c90;
  if (horizontal_deg.back() == 90) return PlaneSymmetry::quadrant;
  if (horizontal_deg.back() == 180) return PlaneSymmetry::about_c0;
  return horizontal_deg.back() == 360 ? PlaneSymmetry::none_closed : PlaneSymmetry::none_open;
}

}  // namespace catoptric::photometry
