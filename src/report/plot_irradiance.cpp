#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/figures.h"
#include "report/plot_script.h"

namespace catoptric::report {
namespace {

struct Scale {
  double least, greatest;
};

/// From 0 (irradiance has a natural zero) to the greatest value, unless the figure says otherwise; never
/// empty.
Scale colour_scale(const IrradianceFigure& figure) {
  double greatest = 0;
  for (double value : figure.field.value)
    if (std::isfinite(value)) greatest = std::max(greatest, value);
  Scale scale{figure.least.value_or(0), figure.greatest.value_or(greatest)};
  if (!(scale.greatest > scale.least)) scale.greatest = scale.least + 1;
  return scale;
}

std::string axes(const IrradianceFigure& figure) {
  const Scale scale = colour_scale(figure);
  return fmt::format("set xlabel {}\nset ylabel {}\nset cblabel {} offset char 1.2,0\n",
                     gnuplot_text(axis_label("x", figure.length_unit)),
                     gnuplot_text(axis_label("y", figure.length_unit)),
                     gnuplot_text(axis_label(figure.irradiance_name, figure.irradiance_unit))) +
         viridis_palette() +
         fmt::format("set cbrange [{}:{}]\n", plot_number(scale.least), plot_number(scale.greatest));
}

/// Extent of an axis with half a cell on either side.
std::string axis_range(char name, const std::vector<double>& axis) {
  const double half_low = (axis[1] - axis[0]) / 2, half_high = (axis.back() - axis[axis.size() - 2]) / 2;
  return fmt::format("set {}range [{}:{}]\n", name, plot_number(axis.front() - half_low),
                     plot_number(axis.back() + half_high));
}

/// The grid thinned out: a surface is drawn as polygons, and some two thousand of them are legible.
GridField thinned(const GridField& field) {
  constexpr std::size_t most = 42;
  if (std::max(field.x.size(), field.y.size()) <= most) return field;
  return refined(field, static_cast<int>(most) - 1);
}

}  // namespace

std::string irradiance_map_script(const IrradianceFigure& figure) {
  require_sound(figure.field);
  std::string script = preamble(figure.title) + axes(figure);
  script += axis_range('x', figure.field.x) + axis_range('y', figure.field.y);
  script += "set size ratio -1\nset tics front out\nunset grid\nunset key\n";
  script += grid_block("field", figure.field);
  std::vector<std::string> parts{"$field using 1:2:3 with image"};
  if (figure.disc_radius) {
    const std::string radius = plot_number(*figure.disc_radius);
    script += fmt::format("radius = {}\nset samples 801\nset trange [-radius:radius]\n", radius);
    // cells stick out over the edge: cover them from the circle to the frame
    for (std::string_view side : {"", "-"})
      parts.push_back(
          fmt::format("[t=-radius:radius] '+' using (t):({0}sqrt(abs(radius**2-t**2))):({0}radius*1.1) with "
                      "filledcurves lc rgb '#ffffff'",
                      side));
    script += fmt::format(
        "set object 1 circle at 0,0 size {} front fillstyle empty border lc rgb '#404040' lw 1\n", radius);
  }
  return script + plot_command("plot", parts);
}

std::string irradiance_surface_script(const IrradianceFigure& figure, const SurfaceView& view) {
  require_sound(figure.field);
  const Scale scale = colour_scale(figure);
  std::string script = preamble(figure.title) + axes(figure);
  script += axis_range('x', figure.field.x) + axis_range('y', figure.field.y);
  script += fmt::format("set zrange [{0}:{1}]\nset xyplane at {0}\nset zlabel {2} rotate parallel\n",
                        plot_number(scale.least), plot_number(scale.greatest),
                        gnuplot_text(axis_label(figure.irradiance_name, figure.irradiance_unit)));
  script += surface_layout(view);
  script += grid_block("field", thinned(figure.field));
  return script + plot_command("splot", {"$field using 1:2:3 with pm3d"});
}

}  // namespace catoptric::report
