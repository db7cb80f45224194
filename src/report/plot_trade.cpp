#include <fmt/format.h>

#include "report/figures.h"
#include "report/plot_script.h"

namespace catoptric::report {

std::string trade_script(const TradeFigure& figure) {
  std::string script = preamble(figure.title);
  script += fmt::format("set xlabel {} offset 0,0.5\nset ylabel {}\n", gnuplot_text(figure.x_label),
                        gnuplot_text(figure.y_label));
  script += "set logscale xy 10\nset mxtics 10\nset mytics 10\nset format '10^{%T}'\nset format '%g'\n";
  script += "set key outside bottom center horizontal maxcols 3 height 0.8 spacing 1.1 font ',12'\n";
  for (const double level : figure.levels)
    script += fmt::format(
        "set arrow from graph 0, first {0} to graph 1, first {0} nohead dt (4,4) lc rgb "
        "'#777777' back\nset label {1} at graph 0.995, first {0} right offset 0,0.5 font ',12' "
        "textcolor rgb '#777777'\n",
        plot_number(level), gnuplot_text(fmt::format("{:g} %", 100 * level)));
  std::vector<std::string> parts;
  if (!figure.front.x.empty()) {
    script += data_block("front", {&figure.front.x, &figure.front.y});
    // what the front reaches is reached by all dearer settings too
    parts.push_back(fmt::format("$front using 1:2 with steps lc rgb '#000000' lw 2 title {}",
                                gnuplot_text(figure.front.label)));
  }
  for (std::size_t i = 0; i < figure.groups.size(); ++i) {
    const Curve& group = figure.groups[i];
    script += data_block(fmt::format("group{}", i), {&group.x, &group.y});
    parts.push_back(fmt::format("$group{} using 1:2 with points lc rgb '{}' pt {} ps 0.9 title {}", i,
                                line_colour(CurveRole::other, i), point_shape(i), gnuplot_text(group.label)));
  }
  return script + plot_command("plot", parts);
}

}  // namespace catoptric::report
