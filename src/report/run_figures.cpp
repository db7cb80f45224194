#include "report/run_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "design/field_targets.h"
#include "design/metrics.h"
#include "report/figures.h"

namespace catoptric::report {
namespace {

constexpr double most_sizes_apart = 4;  ///< a mirror beside a field farther away would be a speck
constexpr int curve_points = 200;       ///< along a drawn generatrix
constexpr int radial_bins = 40;         ///< along a radial cut
constexpr int grid_cells = 120;         ///< across an irradiance map

std::string unit_of(const design::Scene& scene) { return std::string(symbol(scene.unit)); }

/// "Irradiance" or "Illuminance".
std::string heading(const design::Scene& scene) {
  std::string name(irradiance_name(scene.source.quantity));
  name.front() = 'I';
  return name;
}

std::string metric_label(const design::Scene& scene) {
  if (scene.search.metric != design::Metric::rmse) return design::objective_name(scene.search.metric);
  return fmt::format("RMSE ({})", printed(design::objective_unit(scene)));
}

std::string variable_label(const design::Scene& scene, const std::string& name) {
  const std::string unit = design::unit_of_variable(name, scene.unit);
  return unit.empty() ? name : fmt::format("{} ({})", name, unit);
}

GeneratrixCurve generatrix_curve(const design::Scene& scene, const Profile& profile, const std::string& label,
                                 CurveRole role) {
  GeneratrixCurve curve{label, role, {}, {}, {}, {}};
  for (int i = 0; i <= curve_points; ++i) {
    const double share = static_cast<double>(i) / curve_points;
    const MeridianPoint p = profile.at(profile.first_parameter() +
                                       share * (profile.last_parameter() - profile.first_parameter()));
    curve.r.push_back(scene.to_scene_unit(p.r_mm));
    curve.z.push_back(scene.to_scene_unit(p.z_mm));
  }
  for (const ControlPoint& point : profile.points()) {
    curve.control_r.push_back(scene.to_scene_unit(point.r_mm));
    curve.control_z.push_back(scene.to_scene_unit(point.z_mm));
  }
  return curve;
}

/// The mirror that the target was made with, when the scene names one.
std::optional<Profile> target_profile(const design::Scene& scene) {
  if (scene.target.kind == design::TargetKind::reflector) return scene.target.reference;
  if (scene.target.kind != design::TargetKind::paraboloid) return std::nullopt;
  const double a = scene.target.focal_length_mm, rim = scene.target.rim_radius_mm;
  const double focus_z = scene.source.position_mm.z();
  // z = focus + a - r^2 / (4 a) as a quadratic Bezier over [0, rim]; paper eq. 11
  return Profile::bezier(
      {{0, focus_z + a, 1}, {rim / 2, focus_z + a, 1}, {rim, focus_z + a - rim * rim / (4 * a), 1}});
}

GeneratrixFigure generatrix_figure(const design::Scene& scene, const design::SourceSpec& source,
                                   std::vector<GeneratrixCurve> curves) {
  GeneratrixFigure figure{"Generatrix", unit_of(scene), std::move(curves), {}, {}};
  if (const auto wanted = target_profile(scene))
    figure.curves.insert(figure.curves.begin(),
                         generatrix_curve(scene, *wanted, "target", CurveRole::target));
  const Vector3& source_mm = source.position_mm;
  figure.source = PlanePoint{scene.to_scene_unit(std::hypot(source_mm.x(), source_mm.y())),
                             scene.to_scene_unit(source_mm.z())};
  const Vector3& center_mm = scene.near_field.center_mm();
  const double apart_mm = std::abs(center_mm.z() - source_mm.z());
  if (apart_mm > most_sizes_apart * scene.profile.diagonal_mm()) {
    figure.title += fmt::format(" (the near field is {:.4g} {} from the source, not drawn)",
                                scene.to_scene_unit(apart_mm), unit_of(scene));
  } else if (std::abs(scene.near_field.normal().z()) >
             0.5) {  // a steeper field has no readable section with the meridian
    const double r_mm = std::hypot(center_mm.x(), center_mm.y());
    figure.near_field = {
        {scene.to_scene_unit(std::max(0.0, r_mm - scene.near_field.half_width_mm())),
         scene.to_scene_unit(center_mm.z())},
        {scene.to_scene_unit(r_mm + scene.near_field.half_width_mm()), scene.to_scene_unit(center_mm.z())}};
  }
  return figure;
}

/// Irradiance in W/m^2 at the samples, by plane coordinates in the scene's unit.
ScatteredField scattered(const design::Scene& scene, const design::Target& target,
                         const std::vector<double>& w_per_mm2) {
  ScatteredField field;
  for (const std::size_t i : design::samples_of_field(target, 0)) {
    const Vector2 plane_mm = scene.near_field.to_plane(target.samples[i].point_mm);
    field.x.push_back(scene.to_scene_unit(plane_mm.x()));
    field.y.push_back(scene.to_scene_unit(plane_mm.y()));
    field.value.push_back(to_w_per_m2(w_per_mm2[i]));
  }
  return field;
}

std::vector<double> total(const design::Judgement& judgement) {
  std::vector<double> sum(judgement.direct);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += judgement.reflected[i];
  return sum;
}

/// One field to draw. Views that share their scale can be compared by colour.
struct FieldView {
  std::string name, title;
  std::vector<double> w_per_mm2;
  bool shares_scale = true;
};

double greatest_of(const FieldView& view) {
  double greatest = 0;
  for (double value : view.w_per_mm2) greatest = std::max(greatest, to_w_per_m2(value));
  return greatest;
}

std::vector<NamedFigure> irradiance_figures(const design::Scene& scene, const design::Target& target,
                                            const std::vector<FieldView>& views) {
  if (design::samples_of_field(target, 0).size() < 3) return {};
  double shared = 0;
  for (const FieldView& view : views)
    if (view.shares_scale) shared = std::max(shared, greatest_of(view));
  std::optional<double> disc;
  if (scene.near_field.shape() == sim::NearField::Shape::disc && scene.target.kind != design::TargetKind::csv)
    disc = scene.to_scene_unit(scene.near_field.half_width_mm());
  std::vector<NamedFigure> figures;
  for (const FieldView& view : views) {
    IrradianceFigure figure{view.title,
                            unit_of(scene),
                            std::string(irradiance_name(scene.source.quantity)),
                            printed(irradiance_unit(scene.source.quantity)),
                            gridded(scattered(scene, target, view.w_per_mm2), grid_cells, disc),
                            0.0,
                            {},
                            disc};
    const double greatest = view.shares_scale ? shared : greatest_of(view);
    if (greatest > 0) figure.greatest = greatest;
    figures.push_back({"irradiance-" + view.name, view.title, irradiance_map_script(figure)});
    figures.push_back({"surface-" + view.name, view.title, irradiance_surface_script(figure)});
  }
  return figures;
}

/// A curve's band at the samples, W/mm^2: how far it reaches, and what the curve lies above its middle.
struct SampleBand {
  std::vector<double> half, bias;
};

/// Means over rings of equal width about the near field's centre.
RadialCurve ring_means(const design::Scene& scene, const design::Target& target,
                       const std::vector<double>& w_per_mm2, const SampleBand& band, const std::string& label,
                       CurveRole role) {
  double reach_mm = 0;
  std::vector<double> distance_mm;
  for (const std::size_t i : design::samples_of_field(target, 0)) {  // these come first
    distance_mm.push_back(scene.near_field.to_plane(target.samples[i].point_mm).norm());
    reach_mm = std::max(reach_mm, distance_mm.back());
  }
  std::vector<double> sum(radial_bins), radius(radial_bins), square(radial_bins), bias(radial_bins);
  std::vector<int> count(radial_bins);
  for (std::size_t i = 0; i < distance_mm.size(); ++i) {
    const auto bin = std::min<std::size_t>(
        radial_bins - 1, static_cast<std::size_t>(distance_mm[i] / (reach_mm * (1 + 1e-12)) *
                                                  radial_bins));  // the outermost sample stays inside
    sum[bin] += w_per_mm2[i];
    radius[bin] += distance_mm[i];
    if (!band.half.empty()) {
      square[bin] += band.half[i] * band.half[i];
      bias[bin] += band.bias[i];
    }
    ++count[bin];
  }
  RadialCurve curve{label, {}, {}, {}, role};
  for (std::size_t bin = 0; bin < radial_bins; ++bin) {
    if (count[bin] == 0) continue;
    curve.r.push_back(scene.to_scene_unit(radius[bin] / count[bin]));
    curve.irradiance.push_back(to_w_per_m2(sum[bin] / count[bin]));
    // neighbouring samples share photons, so the band is that of one sample, not of the ring's mean
    if (band.half.empty()) continue;
    curve.half_band.push_back(to_w_per_m2(std::sqrt(square[bin] / count[bin])));
    curve.band_shift.push_back(-to_w_per_m2(bias[bin] / count[bin]));
  }
  return curve;
}

NamedFigure radial_figure(const design::Scene& scene, const design::Target& target,
                          const design::Judgement& judgement) {
  const std::string name = heading(scene);
  RadialCutFigure figure{name + " by distance from the near field's centre",
                         unit_of(scene),
                         std::string(irradiance_name(scene.source.quantity)),
                         printed(irradiance_unit(scene.source.quantity)),
                         {}};
  if (judgement.has_objective)
    figure.curves.push_back(
        ring_means(scene, target, target.irradiance_w_per_mm2, {}, "target", CurveRole::target));
  figure.curves.push_back(ring_means(scene, target, judgement.direct, {}, "direct", CurveRole::direct));
  figure.curves.push_back(
      ring_means(scene, target, judgement.reflected, {}, "reflected", CurveRole::reflected));
  const bool spread = std::any_of(judgement.half_interval.begin(), judgement.half_interval.end(),
                                  [](double half) { return half > 0; });
  SampleBand band;
  if (spread) band = {judgement.half_interval, judgement.bias};  // tubes have none
  figure.curves.push_back(ring_means(scene, target, total(judgement), band, "total", CurveRole::obtained));
  figure.curves.back().band_label = "95 % interval of a sample";
  std::string caption = name + " by distance from the near field's centre: means over rings.";
  if (spread)
    caption +=
        " The band holds the field of one sample with 95 % probability, the kernel's bias taken off; where "
        "it "
        "does not lie about the line, the kernel blurs the field.";
  return {"radial", caption, radial_cut_script(figure)};
}

/// The kernel of a stage of a coarse-to-fine search, which its moves name after a comma; else empty.
std::string kernel_of(const optim::Iterate& iterate) {
  const auto comma = iterate.move.find(", ");
  return comma == std::string::npos ? "" : iterate.move.substr(comma + 2);
}

/// Values that are no ranks of mirrors that break constraints.
Curve best_so_far(const std::vector<optim::Iterate>& history) {
  Curve curve;
  for (const optim::Iterate& each : history) {
    if (!(each.value < design::infeasible_floor)) continue;
    curve.x.push_back(static_cast<double>(each.evaluations));
    curve.y.push_back(each.value);
  }
  return curve;
}

/// One curve a kernel, since the objectives of different kernels are different ones.
NamedFigure convergence_figure(const design::Scene& scene, const optim::Outcome& outcome) {
  std::vector<Curve> curves;
  for (const optim::Iterate& each : outcome.history) {
    if (!(each.value < design::infeasible_floor)) continue;  // a rank of mirrors that break constraints
    const std::string kernel = kernel_of(each), label = kernel.empty() ? "best so far" : kernel;
    if (curves.empty() || curves.back().label != label)
      curves.push_back({label, {}, {}, kernel.empty() ? CurveRole::obtained : CurveRole::other});
    curves.back().x.push_back(static_cast<double>(each.evaluations));
    curves.back().y.push_back(each.value);
  }
  const bool staged = curves.size() > 1;
  return {"convergence",
          staged ? "Convergence of the search: the best objective so far, each kernel's own, since a wide "
                   "kernel's objective is not a narrow one's."
                 : "Convergence of the search: the best objective so far.",
          convergence_script({"Convergence", metric_label(scene), std::move(curves)})};
}

/// Where a path begins and ends; paths that begin together share a mark with all their names.
void add_marks(std::vector<Mark>& marks, const std::string& name, PlanePoint begin, PlanePoint end) {
  const auto same = std::find_if(marks.begin(), marks.end(), [&](const Mark& mark) {
    return mark.kind == MarkKind::start && mark.x == begin.x && mark.y == begin.y;
  });
  if (same == marks.end())
    marks.push_back({name, begin.x, begin.y, MarkKind::start});
  else
    same->label += ", " + name;
  marks.push_back({"", end.x, end.y, MarkKind::end});
}

NamedFigure landscape_line(const design::Scene& scene, const design::Landscape& landscape) {
  LineFigure figure{"Objective",
                    variable_label(scene, landscape.names[0]),
                    metric_label(scene),
                    {{"objective", landscape.axes[0], landscape.objective, CurveRole::obtained}},
                    {}};
  for (const design::SearchPath& path : landscape.paths) {
    if (path.values.empty()) continue;  // nothing says how high it lies
    add_marks(figure.marks, path.name, {path.points.front()[0], path.values.front()},
              {path.points.back()[0], path.values.back()});
    Curve curve{path.label, {}, path.values};
    for (const auto& point : path.points) curve.x.push_back(point[0]);
    figure.curves.push_back(std::move(curve));
  }
  return {"landscape", "Objective over one variable", line_script(figure)};
}

LandscapeFigure landscape_of_two(const design::Scene& scene, const design::Landscape& landscape) {
  LandscapeFigure figure{"Objective",
                         variable_label(scene, landscape.names[0]),
                         variable_label(scene, landscape.names[1]),
                         metric_label(scene),
                         {landscape.axes[0], landscape.axes[1], {}},
                         {},
                         {},
                         {}};
  for (std::size_t j = 0; j < landscape.axes[1].size(); ++j)
    for (std::size_t i = 0; i < landscape.axes[0].size(); ++i)
      figure.objective.value.push_back(landscape.objective[i * landscape.axes[1].size() + j]);
  for (const design::SearchPath& path : landscape.paths) {
    Curve curve{path.label, {}, {}};
    for (const auto& point : path.points) {
      curve.x.push_back(point[0]);
      curve.y.push_back(point[1]);
    }
    if (curve.x.empty()) continue;
    add_marks(figure.marks, path.name, {curve.x.front(), curve.y.front()}, {curve.x.back(), curve.y.back()});
    figure.paths.push_back(std::move(curve));
  }
  figure.scale = AxisScale::logarithmic;  // the valley's floor and the caustics' peaks are decades apart
  return figure;
}

/// Both sides of one plane over the angle to the axis, C + 180 on the other one.
Curve section_of(const design::LuminaireIntensity& luminaire, double c_deg) {
  const bool round = luminaire.table.is_rotational();
  Curve curve{round ? "all C" : fmt::format("C{:g}, C{:g}", c_deg, c_deg + 180), {}, {}};
  const std::vector<double>& gamma = luminaire.table.gamma_deg();
  for (auto angle = gamma.rbegin(); angle != gamma.rend(); ++angle) {
    curve.x.push_back(-*angle);
    curve.y.push_back(luminaire.table.at(*angle, c_deg + 180));
  }
  for (const double angle : gamma) {
    curve.x.push_back(angle);
    curve.y.push_back(luminaire.table.at(angle, c_deg));
  }
  return curve;
}

}  // namespace

std::vector<NamedFigure> design_figures(const design::Scene& scene, const design::DesignResult& result) {
  std::vector<NamedFigure> figures{
      {"generatrix",
       "Generatrix before and after the search, with control points, in a plane through the axis",
       generatrix_script(generatrix_figure(
           scene, result.best.source,
           {generatrix_curve(scene, result.start.profile, "start", CurveRole::initial),
            generatrix_curve(scene, result.best.profile, "result", CurveRole::obtained)}))}};
  figures.push_back(radial_figure(scene, result.target, result.best.judgement));
  if (result.search.value < design::infeasible_floor)
    figures.push_back(convergence_figure(scene, result.search));
  for (NamedFigure& figure :
       irradiance_figures(scene, result.target,
                          {{"result", heading(scene) + " of the result", total(result.best.judgement)},
                           {"target", "Target", result.target.irradiance_w_per_mm2},
                           {"start", heading(scene) + " of the start (its own scale)",
                            total(result.start.judgement), false}}))
    figures.push_back(std::move(figure));
  return figures;
}

std::vector<NamedFigure> simulation_figures(const design::Scene& scene,
                                            const design::SimulationResult& result) {
  std::vector<NamedFigure> figures{mirror_picture(scene, result.mirror.profile, result.mirror.source)};
  figures.push_back(radial_figure(scene, result.target, result.mirror.judgement));
  std::vector<FieldView> views{{"result", heading(scene), total(result.mirror.judgement)}};
  if (result.mirror.judgement.has_objective)
    views.push_back({"target", "Target", result.target.irradiance_w_per_mm2});
  for (NamedFigure& figure : irradiance_figures(scene, result.target, views))
    figures.push_back(std::move(figure));
  return figures;
}

std::vector<NamedFigure> landscape_figures(const design::Scene& scene, const design::Landscape& landscape) {
  std::vector<NamedFigure> figures{landscape_picture(scene, landscape)};
  if (landscape.axes.size() == 1) return figures;
  LandscapeFigure figure = landscape_of_two(scene, landscape);
  figure.paths.clear();
  figure.scale = AxisScale::linear;
  figure.greatest = scene.landscape->greatest;
  const SurfaceView views[] = {{55, 35}, {55, 125}, {70, 260}};
  for (std::size_t i = 0; i < 3; ++i)
    figures.push_back({fmt::format("surface-{}", i + 1), "The same as a surface",
                       landscape_surface_script(figure, views[i])});
  return figures;
}

NamedFigure mirror_picture(const design::Scene& scene, const Profile& profile,
                           const design::SourceSpec& source) {
  return {"generatrix", "Generatrix with its control points, in a plane through the axis",
          generatrix_script(generatrix_figure(
              scene, source, {generatrix_curve(scene, profile, "mirror", CurveRole::obtained)}))};
}

std::vector<NamedFigure> study_figures(const std::vector<StudyRow>& rows) {
  constexpr std::size_t most = 8;  // more curves are not told apart
  std::vector<GeneratrixCurve> mirrors;
  std::vector<Curve> searches;
  const StudyRow* first = nullptr;
  for (const StudyRow& row : rows) {
    if (mirrors.size() == most || (!row.designed && !row.simulated)) continue;
    // one figure has one unit, and one metric
    if (first &&
        (first->scene->unit != row.scene->unit || first->scene->search.metric != row.scene->search.metric))
      continue;
    if (!first) first = &row;
    const design::Judged& judged = row.designed ? row.designed->best : row.simulated->mirror;
    mirrors.push_back(generatrix_curve(*row.scene, judged.profile, "run " + row.run.name, CurveRole::other));
    mirrors.back().control_r.clear();
    mirrors.back().control_z.clear();
    if (!row.designed || !(row.designed->search.value < design::infeasible_floor)) continue;
    Curve search = best_so_far(row.designed->search.history);
    search.label = "run " + row.run.name;
    searches.push_back(std::move(search));
  }
  if (!first) return {};
  const design::SourceSpec& source =
      (first->designed ? first->designed->best : first->simulated->mirror).source;
  const std::string which = rows.size() > most ? fmt::format(" of the first {} runs", most) : " of the runs";
  std::vector<NamedFigure> figures{
      {"generatrices", "The mirrors" + which + ", in a plane through the axis",
       generatrix_script(generatrix_figure(*first->scene, source, std::move(mirrors)))}};
  if (!searches.empty())
    figures.push_back(
        {"convergence", "The searches" + which + ": the best objective so far",
         convergence_script({"Convergence", metric_label(*first->scene), std::move(searches)})});
  return figures;
}

NamedFigure landscape_picture(const design::Scene& scene, const design::Landscape& landscape) {
  if (landscape.axes.size() == 1) return landscape_line(scene, landscape);
  return {"contours", "Objective over two variables",
          landscape_contour_script(landscape_of_two(scene, landscape))};
}

std::vector<Curve> intensity_sections(const design::LuminaireIntensity& luminaire) {
  std::vector<Curve> sections;
  for (const double c_deg : {0.0, 45.0, 90.0, 135.0}) {
    if (c_deg > 0 && luminaire.table.is_rotational()) continue;
    sections.push_back(section_of(luminaire, c_deg));
  }
  return sections;
}

NamedFigure polar_picture(const design::LuminaireIntensity& luminaire) {
  PolarFigure figure{
      "Intensity", fmt::format("intensity ({})", printed(intensity_unit(luminaire.table.quantity()))), {}};
  figure.curves = intensity_sections(luminaire);
  return {"intensity-polar", "Intensity by the angle to the axis of the beam, which points down",
          polar_script(figure)};
}

}  // namespace catoptric::report
