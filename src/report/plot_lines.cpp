#include <fmt/format.h>

#include <limits>

#include "report/figures.h"
#include "report/plot_script.h"

namespace catoptric::report {
namespace {

/// Where it lies on no curve.
constexpr const char* key_below =
    "set key outside below horizontal font ',12' samplen 3 height 0.8 spacing 1.1\nset xlabel offset 0,0.5\n";

/// A logarithmic axis has no place for numbers that are not above 0.
std::vector<double> on_scale(std::vector<double> values, AxisScale scale) {
  if (scale == AxisScale::logarithmic)
    for (double& value : values)
      if (!(value > 0)) value = std::numeric_limits<double>::quiet_NaN();
  return values;
}

std::string labels(std::string_view x, std::string_view y) {
  return fmt::format("set xlabel {}\nset ylabel {}\n", gnuplot_text(x), gnuplot_text(y));
}

std::string log_axis(char axis, AxisScale scale) {
  return scale == AxisScale::linear ? "" : fmt::format("set logscale {0} 10\nset m{0}tics 10\n", axis);
}

void add_band(const RadialCurve& curve, std::size_t index, std::string& script,
              std::vector<std::string>& parts) {
  if (curve.half_band.empty()) return;
  const std::vector<double> shift =
      curve.band_shift.empty() ? std::vector<double>(curve.r.size(), 0.0) : curve.band_shift;
  script += data_block(fmt::format("band{}", index), {&curve.r, &curve.irradiance, &curve.half_band, &shift});
  parts.push_back(
      fmt::format("$band{} using 1:($2+$4-$3):($2+$4+$3) with filledcurves fc rgb '{}' fs transparent solid "
                  "0.22 noborder {}",
                  index, line_colour(curve.role, index),
                  curve.band_label.empty() ? "notitle" : "title " + gnuplot_text(curve.band_label)));
}

}  // namespace

std::string radial_cut_script(const RadialCutFigure& figure) {
  std::string script =
      preamble(figure.title) + labels(axis_label("distance from the axis", figure.length_unit),
                                      axis_label(figure.irradiance_name, figure.irradiance_unit));
  script += std::string("set yrange [0:*]\nset autoscale xfix\n") + key_below;
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < figure.curves.size(); ++i) add_band(figure.curves[i], i, script, parts);
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    const RadialCurve& curve = figure.curves[i];
    script += data_block(fmt::format("curve{}", i), {&curve.r, &curve.irradiance});
    parts.push_back(fmt::format("$curve{} using 1:2 with lines {} title {}", i, line_look(curve.role, i),
                                gnuplot_text(curve.label)));
  }
  return script + plot_command("plot", parts);
}

std::string convergence_script(const ConvergenceFigure& figure) {
  std::string script = preamble(figure.title) + labels(figure.effort_label, figure.objective_label);
  script += log_axis('y', figure.scale) + key_below + "set xrange [0:*]\n";
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    const Curve& curve = figure.curves[i];
    const std::vector<double> y = on_scale(curve.y, figure.scale);
    script += data_block(fmt::format("curve{}", i), {&curve.x, &y});
    // the best value stands until a better one is found
    parts.push_back(fmt::format("$curve{} using 1:2 with steps {} title {}", i, line_look(curve.role, i),
                                gnuplot_text(curve.label)));
    constexpr std::size_t many = 40;  // points would hide the line
    parts.push_back(fmt::format("$curve{} using 1:2 with points lc rgb '{}' pt {} ps {} notitle", i,
                                line_colour(curve.role, i), point_shape(i), y.size() > many ? 0.35 : 0.6));
  }
  return script + plot_command("plot", parts);
}

std::string line_script(const LineFigure& figure) {
  std::string script = preamble(figure.title) + labels(figure.x_label, figure.y_label);
  script += log_axis('x', figure.x_scale) + log_axis('y', figure.y_scale) + "set autoscale xfix\n";
  constexpr std::size_t few = 4;  // more labels would lie on the lines
  script += figure.curves.size() > few ? key_below : "set key top right spacing 1.1\n";
  if (figure.y_scale == AxisScale::linear) script += "set offsets graph 0, graph 0, graph 0.05, graph 0.02\n";
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    const Curve& curve = figure.curves[i];
    const auto x = on_scale(curve.x, figure.x_scale), y = on_scale(curve.y, figure.y_scale);
    script += data_block(fmt::format("curve{}", i), {&x, &y});
    parts.push_back(fmt::format("$curve{} using 1:2 with lines {} title {}", i, line_look(curve.role, i),
                                gnuplot_text(curve.label)));
  }
  for (const Mark& mark : figure.marks)
    script += mark_label(mark, plot_number(mark.x) + "," + plot_number(mark.y));
  return script + plot_command("plot", parts);
}

}  // namespace catoptric::report
