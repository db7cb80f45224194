#include "design/variables.h"

#include <charconv>

#include "base/contract.h"

namespace catoptric::design {

std::optional<Component> parse_component(std::string_view name, std::size_t point_count) {
  if (name.size() < 2 || (name[0] != 'r' && name[0] != 'z' && name[0] != 'w')) return std::nullopt;
  if (name.size() > 2 && name[1] == '0') return std::nullopt;
  std::size_t point = 0;
  const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size(), point);
  if (error != std::errc{} || end != name.data() + name.size() || point >= point_count) return std::nullopt;
  return Component{name[0], point};
}

double component_value(const Profile& profile, const Component& component, LengthUnit unit) {
  const ControlPoint& point = profile.points()[component.point];
  if (component.coordinate == 'w') return point.weight;
  return (component.coordinate == 'r' ? point.r_mm : point.z_mm) / millimetres_per(unit);
}

ProfileFamily::ProfileFamily(Profile base, const std::vector<std::string>& names, LengthUnit unit)
    : base_(std::move(base)), unit_mm_(millimetres_per(unit)) {
  for (const std::string& name : names) {
    const auto component = parse_component(name, base_.points().size());
    CATOPTRIC_EXPECTS(component.has_value());
    components_.push_back(*component);
  }
}

std::optional<Profile> ProfileFamily::at(std::span<const double> values) const {
  CATOPTRIC_EXPECTS(values.size() == components_.size());
  std::vector<ControlPoint> points = base_.points();
  for (std::size_t i = 0; i < components_.size(); ++i) {
    ControlPoint& point = points[components_[i].point];
    switch (components_[i].coordinate) {
      case 'r':
        point.r_mm = values[i] * unit_mm_;
        break;
      case 'z':
        point.z_mm = values[i] * unit_mm_;
        break;
      default:
        point.weight = values[i];
        break;
    }
  }
  if (Profile::find_defect(base_.degree(), base_.knots(), points)) return std::nullopt;
  return Profile(base_.degree(), base_.knots(), std::move(points));
}

}  // namespace catoptric::design
