#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/profile.h"
#include "base/units.h"

namespace catoptric::design {

/// One component of the design vector (r_0, z_0, w_0, ..., r_n, z_n, w_n).
/// @from paper eq. 6
struct Component {
  char coordinate;  ///< 'r', 'z' or 'w'
  std::size_t point;
};

/// "r2" -> {r, 2}; nothing for other names or an index beyond `point_count`.
std::optional<Component> parse_component(std::string_view name, std::size_t point_count);

/// The component's value in the profile: lengths in `unit`, weights plain.
double component_value(const Profile& profile, const Component& component, LengthUnit unit);

/// Moves named components of a fixed profile; the rest stays.
class ProfileFamily {
 public:
  /// @in names valid components of `base`
  ProfileFamily(Profile base, const std::vector<std::string>& names, LengthUnit unit);

  /// The profile with the components set, or nothing when these values are no generatrix (it crosses the
  /// axis, ...).
  std::optional<Profile> at(std::span<const double> values) const;

 private:
  Profile base_;
  std::vector<Component> components_;
  double unit_mm_;
};

}  // namespace catoptric::design
