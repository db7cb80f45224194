#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/figures.h"
#include "report/plot_script.h"

namespace catoptric::report {
namespace {

struct Range {
  double least, greatest;
};

/// Of the values a figure tells apart; never empty.
Range value_range(const LandscapeFigure& figure) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Range range{infinity, -infinity};
  for (double value : figure.objective.value) {
    if (!std::isfinite(value) || (figure.scale == AxisScale::logarithmic && value <= 0)) continue;
    range = {std::min(range.least, value), std::max(range.greatest, value)};
  }
  if (figure.greatest) range.greatest = std::min(range.greatest, *figure.greatest);
  if (range.least > range.greatest) range = {1, 10};
  // four decades: an exact minimum's 1e-12 would leave no colours for the rest
  if (figure.scale == AxisScale::logarithmic) range.least = std::max(range.least, range.greatest / 10000);
  if (range.least == range.greatest) range.greatest += std::max(std::abs(range.least), 1.0);
  return range;
}

/// Round numbers that divide the range into about ten.
std::vector<double> linear_levels(Range range) {
  const double rough = (range.greatest - range.least) / 10;
  const double decade = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * decade;
  for (double round : {5.0, 2.0, 1.0})
    if (round * decade >= rough) step = round * decade;
  std::vector<double> levels;
  for (double i = std::floor(range.least / step) + 1; i * step < range.greatest; ++i)
    levels.push_back(i * step);
  return levels;
}

/// 1, 2 and 5 of every decade.
std::vector<double> logarithmic_levels(Range range) {
  std::vector<double> levels;
  const int first = static_cast<int>(std::floor(std::log10(range.least)));
  const int last = static_cast<int>(std::floor(std::log10(range.greatest)));
  for (int decade = first; decade <= last; ++decade)
    for (double digit : {1.0, 2.0, 5.0}) {
      const double level = digit * std::pow(10, decade);
      if (level > range.least && level < range.greatest) levels.push_back(level);
    }
  return levels;
}

std::string contour_levels(const LandscapeFigure& figure, Range range) {
  const auto levels = figure.scale == AxisScale::linear ? linear_levels(range) : logarithmic_levels(range);
  std::string list;
  for (double level : levels) list += (list.empty() ? "" : ", ") + fmt::format("{:.6g}", level);
  return list;
}

std::string axes(const LandscapeFigure& figure, Range range) {
  std::string text = fmt::format("set xlabel {}\nset ylabel {}\nset cblabel {} offset char 1.2,0\n",
                                 gnuplot_text(figure.x_label), gnuplot_text(figure.y_label),
                                 gnuplot_text(figure.value_label));
  text += viridis_palette();
  if (figure.scale == AxisScale::logarithmic) {
    text += "set logscale cb 10\nset logscale z 10\n";
    // of less than a decade gnuplot names no more than one value
    if (const std::string levels = contour_levels(figure, range);
        range.greatest < 10 * range.least && !levels.empty())
      text += "set cbtics (" + levels + ")\n";
  }
  text += fmt::format("set cbrange [{}:{}]\nset zrange [{}:{}]\n", plot_number(range.least),
                      plot_number(range.greatest), plot_number(range.least), plot_number(range.greatest));
  text += fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", plot_number(figure.objective.x.front()),
                      plot_number(figure.objective.x.back()), plot_number(figure.objective.y.front()),
                      plot_number(figure.objective.y.back()));
  return text;
}

/// The grid with values too small for the logarithmic scale lifted to its foot.
GridField shown(const LandscapeFigure& figure, Range range) {
  GridField field = figure.objective;
  for (double& value : field.value)
    if (figure.scale == AxisScale::logarithmic && value < range.least) value = range.least;
  return field;
}

/// What the marks stand for, for the key; the minimum's name is written at it.
std::vector<std::string> mark_legend(const std::vector<Mark>& marks) {
  std::vector<std::string> entries;
  for (const auto& [kind, entry] :
       {std::pair{MarkKind::start, "keyentry with points lc rgb '#808080' pt 7 ps 1.0 title 'start'"},
        {MarkKind::end, "keyentry with points lc rgb '#808080' pt 5 ps 0.9 title 'end'"}})
    if (std::any_of(marks.begin(), marks.end(), [&](const Mark& mark) { return mark.kind == kind; }))
      entries.emplace_back(entry);
  return entries;
}

}  // namespace

std::string landscape_contour_script(const LandscapeFigure& figure) {
  require_sound(figure.objective);
  const Range range = value_range(figure);
  std::string script = preamble(figure.title) + axes(figure, range);
  script +=
      "set key outside below horizontal font ',12' samplen 2\nset xlabel offset 0,0.6\nset tics front "
      "out\nunset "
      "grid\n";
  script += "set object 1 rectangle from graph 0,0 to graph 1,1 behind fc rgb '#dddddd' fs solid noborder\n";
  const GridField field = shown(figure, range);
  constexpr int picture_cells = 160;
  script += grid_block("grid", field) + grid_block("picture", refined(field, picture_cells));
  const std::string levels = contour_levels(figure, range);
  std::vector<std::string> parts{"$picture using 1:2:3 with image notitle"};
  if (!levels.empty()) {
    script +=
        "set contour base\nunset surface\nset cntrparam linear\nset cntrparam levels discrete " + levels +
        "\nset table $lines\nsplot $grid using 1:2:3 notitle\nunset table\nunset contour\nset surface\n";
    parts.push_back("$lines using 1:2 with lines lc rgb '#ffffff' lw 0.8 notitle");
    const std::size_t apart = std::max<std::size_t>(20, field.x.size() + field.y.size());
    parts.push_back(
        fmt::format("$lines using 1:2:(sprintf('%g',$3)) every {}::{} with labels boxed font ',11' "
                    "textcolor rgb '#010101' notitle",
                    apart, apart / 4));
  }
  for (std::size_t i = 0; i < figure.paths.size(); ++i) {
    const Curve& path = figure.paths[i];
    script += data_block(fmt::format("path{}", i), {&path.x, &path.y});
    parts.push_back(fmt::format(
        "$path{} using 1:2 with linespoints lc rgb '#010101' lw 4 pt {} ps 0.7 notitle", i, point_shape(i)));
    parts.push_back(fmt::format("$path{} using 1:2 with linespoints {} pt {} ps 0.45 title {}", i,
                                line_look(path.role, i), point_shape(i), gnuplot_text(path.label)));
  }
  for (const Mark& mark : figure.marks)
    script += mark_label(mark, plot_number(mark.x) + "," + plot_number(mark.y));
  for (std::string& entry : mark_legend(figure.marks)) parts.push_back(std::move(entry));
  return script + plot_command("plot", parts);
}

std::string landscape_surface_script(const LandscapeFigure& figure, const SurfaceView& view) {
  require_sound(figure.objective);
  const Range range = value_range(figure);
  std::string script = preamble(figure.title) + axes(figure, range);
  script += fmt::format("set xyplane at {}\nset zlabel {} rotate parallel\n", plot_number(range.least),
                        gnuplot_text(figure.value_label));
  script += surface_layout(view);
  const GridField field = shown(figure, range);
  script += grid_block("grid", field.x.size() * field.y.size() > 2500 ? refined(field, 48) : field);
  const std::vector<std::string> parts{"$grid using 1:2:3 with pm3d notitle"};
  for (const Mark& mark : figure.marks)
    script += mark_label(mark, fmt::format("{},{},{}", plot_number(mark.x), plot_number(mark.y),
                                           plot_number(interpolated(field, mark.x, mark.y))));
  return script + plot_command("splot", parts);
}

}  // namespace catoptric::report
