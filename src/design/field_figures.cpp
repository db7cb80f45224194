#include "design/field_figures.h"

#include <algorithm>
#include <cmath>

#include "base/ordered_sum.h"
#include "design/evaluator.h"

namespace catoptric::design {
namespace {

constexpr std::size_t rings_of_a_disc = 4;

/// Zones by their outer radii, rising; samples at a radius belong to the zone within it.
struct Zones {
  std::vector<double> outer_mm;
  bool about_axis = false;
  std::vector<std::vector<std::size_t>> samples;  ///< of each, and of what lies beyond
};

Zones zones_of(const Scene& scene, std::span<const sim::FieldSample> samples) {
  Zones zones;
  const sim::NearField& field = scene.near_field;
  if (scene.target.kind == TargetKind::csv) return zones;
  if (scene.target.kind == TargetKind::zones) {
    zones.outer_mm = scene.target.radii_mm;
    zones.about_axis = true;
  } else if (field.shape() == sim::NearField::Shape::disc) {
    for (std::size_t i = 1; i < rings_of_a_disc; ++i)
      zones.outer_mm.push_back(field.half_width_mm() * static_cast<double>(i) / rings_of_a_disc);
  } else {
    return zones;
  }
  zones.samples.resize(zones.outer_mm.size() + 1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vector3& point_mm = samples[i].point_mm;
    const double radius_mm =
        zones.about_axis ? std::hypot(point_mm.x(), point_mm.y()) : field.to_plane(point_mm).norm();
    const auto zone = std::lower_bound(zones.outer_mm.begin(), zones.outer_mm.end(), radius_mm);
    zones.samples[static_cast<std::size_t>(zone - zones.outer_mm.begin())].push_back(i);
  }
  return zones;
}

/// Average, least, greatest, their ratios, the sum's flux; then flux and average of each zone with samples.
std::vector<double> numbers_of(const std::vector<double>& total, double area_of_a_sample_mm2,
                               const Zones& zones) {
  const auto [least, greatest] = std::minmax_element(total.begin(), total.end());
  const double sum_of_all = ordered_sum(total), average = sum_of_all / static_cast<double>(total.size());
  std::vector<double> numbers{average,
                              *least,
                              *greatest,
                              average > 0 ? *least / average : 0.0,
                              *greatest > 0 ? *least / *greatest : 0.0,
                              sum_of_all * area_of_a_sample_mm2};
  for (const auto& members : zones.samples) {
    if (members.empty()) continue;
    std::vector<double> values;
    for (const std::size_t i : members) values.push_back(total[i]);
    const double light = ordered_sum(values);
    numbers.push_back(light * area_of_a_sample_mm2);
    numbers.push_back(light / static_cast<double>(values.size()));
  }
  return numbers;
}

/// The samples of one field, with their light.
struct Part {
  std::vector<sim::FieldSample> samples;
  std::vector<double> direct;
  Rows reflected, sharp;
};

Part part_of(std::size_t field, std::span<const sim::FieldSample> samples, const std::vector<double>& direct,
             const Rows& reflected, const Rows& sharp) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (samples[i].field == field) places.push_back(i);
  const auto picked = [&](const std::vector<double>& values) {
    std::vector<double> own;
    for (const std::size_t i : places) own.push_back(values[i]);
    return own;
  };
  Part part;
  for (const std::size_t i : places) part.samples.push_back(samples[i]);
  part.direct = picked(direct);
  for (const std::vector<double>& row : reflected) part.reflected.push_back(picked(row));
  for (const std::vector<double>& row : sharp) part.sharp.push_back(picked(row));
  return part;
}

/// Least, greatest and their ratios, places 1 to 4, may be off by what noise picks out besides.
void widen_extremes(std::vector<Figure>& figures, const Part& part) {
  if (!figures[1].half_interval) return;
  Spread total = spread(part.sharp);
  total.mean = sum(part.direct, total.mean);
  const ExtremesMargin margin = extremes_margin(total);
  const double average = figures[0].value, greatest = figures[2].value;
  *figures[1].half_interval += margin.least;
  *figures[2].half_interval += margin.greatest;
  if (average > 0) *figures[3].half_interval += margin.least / average;
  if (greatest > 0)
    *figures[4].half_interval += (margin.least + figures[4].value * margin.greatest) / greatest;
}

std::vector<Figure> figures_of_part(const Part& part, double area_of_a_sample_mm2, const Zones& zones) {
  std::vector<Figure> figures = figures_of(
      part.reflected, part.sharp,
      [&](const std::vector<double>& field) {
        return numbers_of(sum(part.direct, field), area_of_a_sample_mm2, zones);
      },
      [&](const Spread& fields) {
        return numbers_of(sum(part.direct, fields.mean), area_of_a_sample_mm2, zones);
      });
  widen_extremes(figures, part);
  return figures;
}

}  // namespace

FieldFigures field_figures(const Scene& scene, std::span<const sim::FieldSample> samples,
                           const std::vector<double>& direct, const Rows& reflected, const Rows& sharp) {
  const Part part = part_of(0, samples, direct, reflected, sharp);
  const Zones zones = zones_of(scene, part.samples);
  const double area_mm2 = scene.near_field.area_mm2() / static_cast<double>(part.samples.size());
  const std::vector<Figure> figures = figures_of_part(part, area_mm2, zones);
  FieldFigures result{figures[0], figures[1], figures[2], figures[3], figures[4], {}, {}, zones.about_axis};
  if (scene.target.kind != TargetKind::csv) result.flux_w = figures[5];
  std::size_t next = 6;
  for (std::size_t i = 0; i < zones.samples.size(); ++i) {
    if (zones.samples[i].empty()) continue;
    ZoneFigures zone;
    zone.from_mm = i == 0 ? 0.0 : zones.outer_mm[i - 1];
    if (i < zones.outer_mm.size()) zone.to_mm = zones.outer_mm[i];
    if (!zones.about_axis && !zone.to_mm) zone.to_mm = scene.near_field.half_width_mm();
    zone.samples = zones.samples[i].size();
    zone.flux_w = figures[next++];
    zone.irradiance_w_per_mm2 = figures[next++];
    result.zones.push_back(zone);
  }
  return result;
}

std::vector<FurtherFigures> further_figures(const Scene& scene, std::span<const sim::FieldSample> samples,
                                            const std::vector<double>& direct, const Rows& reflected,
                                            const Rows& sharp) {
  std::vector<FurtherFigures> list;
  for (std::size_t i = 0; i < scene.fields.size(); ++i) {
    const Part part = part_of(i + 1, samples, direct, reflected, sharp);
    if (part.samples.empty()) continue;  // a target of the near field alone
    const double of_a_sample_mm2 =
        scene.surroundings->fields()[i].field.area_mm2() / static_cast<double>(part.samples.size());
    const std::vector<Figure> found = figures_of_part(part, of_a_sample_mm2, {});
    list.push_back({scene.fields[i].name,
                    part.samples.size(),
                    std::sqrt(of_a_sample_mm2),
                    {found[0], found[1], found[2], found[3], found[4], found[5], {}, false}});
  }
  return list;
}

}  // namespace catoptric::design
