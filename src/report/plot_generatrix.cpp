#include <fmt/format.h>

#include "report/figures.h"
#include "report/plot_script.h"

namespace catoptric::report {
namespace {

void add_curve(const GeneratrixCurve& curve, std::size_t index, std::string& script,
               std::vector<std::string>& parts) {
  script += data_block(fmt::format("curve{}", index), {&curve.r, &curve.z});
  parts.push_back(fmt::format("$curve{} using 1:2 with lines {} title {}", index,
                              line_look(curve.role, index), gnuplot_text(curve.label)));
  if (curve.control_r.empty() && curve.control_z.empty()) return;
  script += data_block(fmt::format("control{}", index), {&curve.control_r, &curve.control_z});
  parts.push_back(
      fmt::format("$control{} using 1:2 with linespoints lc rgb '{}' lw 0.8 dt (3,4) pt 6 ps 0.8 notitle",
                  index, line_colour(curve.role, index)));
}

}  // namespace

std::string generatrix_script(const GeneratrixFigure& figure) {
  std::string script = preamble(figure.title);
  script += fmt::format("set xlabel {}\n", gnuplot_text(axis_label("r", figure.length_unit)));
  script += fmt::format("set ylabel {}\n", gnuplot_text(axis_label("z", figure.length_unit)));
  script += "set size ratio -1\n";
  script += "set offsets graph 0.06, graph 0.06, graph 0.08, graph 0.06\n";
  script += "set key outside right top vertical Left reverse spacing 1.2\n";
  script +=
      "set arrow from first 0, graph 0 to first 0, graph 1 nohead lc rgb '#777777' lw 1 dt (12,4,3,4) back\n";
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < figure.curves.size(); ++i) add_curve(figure.curves[i], i, script, parts);
  if (!figure.near_field.empty()) {
    std::vector<double> r, z;
    for (const PlanePoint& point : figure.near_field) {
      r.push_back(point.x);
      z.push_back(point.y);
    }
    script += data_block("field", {&r, &z});
    parts.push_back("$field using 1:2 with lines lc rgb '#777777' lw 5 title 'near field'");
  }
  if (figure.source) {
    const std::vector<double> r{figure.source->x}, z{figure.source->y};
    script += data_block("source", {&r, &z});
    parts.push_back("$source using 1:2 with points lc rgb '#e69f00' pt 7 ps 1.5 title 'source'");
  }
  return script + plot_command("plot", parts);
}

}  // namespace catoptric::report
