#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "report/figures.h"
#include "report/plot_script.h"

namespace catoptric::report {
namespace {

/// The greatest intensity, over which the circles run.
double greatest_intensity(const PolarFigure& figure) {
  double most = 0;
  for (const Curve& curve : figure.curves)
    for (const double value : curve.y)
      if (std::isfinite(value)) most = std::max(most, value);
  return most > 0 ? most : 1;
}

/// Distance of the circles: a round number, of which four or so reach the greatest value.
double circle_step(double most) {
  const double decade = std::pow(10, std::floor(std::log10(most / 4)));
  double step = 10 * decade;
  for (const double round : {5.0, 2.0, 1.0})
    if (round * decade >= most / 4) step = round * decade;
  return step;
}

std::string label_at(const std::string& text, double angle_deg, double radius, int size) {
  const double angle = angle_deg * pi / 180;
  return fmt::format("set label {} at {},{} center front font ',{}'\n", gnuplot_text(text),
                     plot_number(radius * std::sin(angle)), plot_number(-radius * std::cos(angle)), size);
}

/// Circles and angles to the axis on both sides, as luminaires are catalogued.
std::string polar_net(double step, int circles) {
  constexpr double beside_the_rays_deg = 105;
  const double reach = step * circles;
  std::string net = fmt::format(
      "set rrange [0:{0}]\nset xrange [-{1}:{1}]\nset yrange [-{1}:{1}]\nset rtics {2} format '' scale 0\n",
      plot_number(reach), plot_number(1.12 * reach), plot_number(step));
  for (int at = 0; at < 360; at += 30)
    net += label_at(fmt::format("{}°", at <= 180 ? at : 360 - at), at, 1.08 * reach, 13);
  for (int i = 1; i <= circles; ++i)
    net += label_at(fmt::format("{:.6g}", i * step), beside_the_rays_deg, i * step, 11);
  return net;
}

}  // namespace

std::string polar_script(const PolarFigure& figure) {
  const double most = greatest_intensity(figure), step = circle_step(most);
  std::string script = preamble(figure.title);
  script += "set polar\nset angles degrees\nset theta bottom ccw\nset size ratio -1\nunset border\n";
  script += "unset xtics\nunset ytics\nunset raxis\nset grid polar 30 lc rgb '#d4d4d4' lw 0.7 dt 1\n";
  script += polar_net(step, static_cast<int>(std::ceil(most / step - 1e-9)));
  script +=
      fmt::format("set label {} at screen 0.5, screen 0.03 center\n", gnuplot_text(figure.intensity_label));
  script += "set bmargin 3\nset key outside right top vertical Left reverse spacing 1.2 samplen 3\n";
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < figure.curves.size(); ++i) {
    const Curve& curve = figure.curves[i];
    script += data_block(fmt::format("curve{}", i), {&curve.x, &curve.y});
    parts.push_back(fmt::format("$curve{} using 1:2 with lines {} title {}", i, line_look(curve.role, i),
                                gnuplot_text(curve.label)));
  }
  return script + plot_command("plot", parts);
}

}  // namespace catoptric::report
