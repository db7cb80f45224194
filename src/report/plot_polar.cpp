#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

/// Angles to the axis on both sides, as luminaires are catalogued.
std::string angle_tics() {
  std::string tics;
  for (int at = 0; at < 360; at += 30)
    tics += fmt::format("{}'{}°' {}", at ? ", " : "", at <= 180 ? at : 360 - at, at);
  return "set ttics (" + tics + ") font ',13'\n";
}

}  // namespace

std::string polar_script(const PolarFigure& figure) {
  std::string script = preamble(figure.title);
  script += "set polar\nset angles degrees\nset theta bottom ccw\nset size square\n";
  script += "unset border\nunset xtics\nunset ytics\nset grid polar 30 lc rgb '#d4d4d4' lw 0.7 dt 1\n";
  script += angle_tics();
  script += fmt::format("set rrange [0:{}]\nset rtics font ',11'\n",
                        plot_number(1.05 * greatest_intensity(figure)));
  script +=
      fmt::format("set label {} at screen 0.5, screen 0.03 center\n", gnuplot_text(figure.intensity_label));
  script += "set bmargin 4\nset key outside right top vertical Left reverse spacing 1.2 samplen 3\n";
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
