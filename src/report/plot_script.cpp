#include "report/plot_script.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/errors.h"
#include "report/text.h"

namespace catoptric::report {
namespace {

// Okabe & Ito 2008, Color Universal Design: told apart with every kind of colour vision
constexpr std::string_view vermillion = "#d55e00", blue = "#0072b2", green = "#009e73", orange = "#e69f00",
                           sky = "#56b4e9", purple = "#cc79a7", black = "#000000", grey = "#777777";

/// Cuts after at most `width` characters, at a blank if there is one in the second half.
std::size_t line_end(std::string_view text, std::size_t width) {
  std::size_t end = 0, characters = 0, blank = 0;
  for (; end < text.size(); ++end) {
    const bool begins = (static_cast<unsigned char>(text[end]) & 0xC0) != 0x80;
    if (begins && characters++ == width) break;
    if (text[end] == ' ' && characters > width / 2) blank = end;
  }
  return end == text.size() || blank == 0 ? end : blank;
}

}  // namespace

std::string gnuplot_text(std::string_view text) {
  std::string inside;
  for (char c : clean_line(text)) inside += c == '\'' ? std::string("’") : std::string(1, c);
  return '\'' + inside + '\'';
}

std::string gnuplot_title(std::string_view text) {
  constexpr std::size_t width = 80, most_lines = 3;  // 800 pixels at the title's size
  const std::string clean = clean_line(text);
  std::string_view rest = clean;
  std::string expression;
  for (std::size_t line = 0; line < most_lines; ++line) {
    const std::size_t end = line_end(rest, width);
    const bool cut = line + 1 == most_lines && end < rest.size();
    expression +=
        (line ? ".\"\\n\"." : "") + gnuplot_text(std::string(rest.substr(0, end)) + (cut ? " …" : ""));
    rest.remove_prefix(end);
    if (rest.empty()) break;
    if (rest.front() == ' ') rest.remove_prefix(1);
  }
  return expression;
}

std::string plot_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "NaN"; }

std::string axis_label(std::string_view name, std::string_view unit) {
  return unit.empty() ? std::string(name) : fmt::format("{} [{}]", name, unit);
}

std::string data_block(std::string_view name, std::initializer_list<const std::vector<double>*> columns) {
  const std::size_t rows = (*columns.begin())->size();
  for (const auto* column : columns)
    if (column->size() != rows)
      throw InputError({"a curve cannot be drawn", "",
                        fmt::format("{} and {} coordinates", rows, column->size()), "as many of each"});
  std::string block = fmt::format("${} << EOD\n", name);
  // a curve without points still needs a line that gnuplot can read
  if (rows == 0)
    for (std::size_t i = 0; i < columns.size(); ++i) block += i ? " NaN" : "NaN";
  for (std::size_t row = 0; row < rows; ++row) {
    bool first = true;
    for (const auto* column : columns) {
      block += (first ? "" : " ") + plot_number((*column)[row]);
      first = false;
    }
    block += '\n';
  }
  return block + (rows == 0 ? "\nEOD\n" : "EOD\n");
}

std::string grid_block(std::string_view name, const GridField& field) {
  std::string block = fmt::format("${} << EOD\n", name);
  for (std::size_t j = 0; j < field.y.size(); ++j) {
    for (std::size_t i = 0; i < field.x.size(); ++i)
      block += fmt::format("{} {} {}\n", plot_number(field.x[i]), plot_number(field.y[j]),
                           plot_number(field.at(i, j)));
    block += '\n';
  }
  return block + "EOD\n";
}

std::string preamble(std::string_view title) {
  return fmt::format(
      "# A gnuplot script with its data: gnuplot THIS > picture.svg\n"
      "set encoding utf8\n"
      "set terminal svg size 800,600 noenhanced font 'sans-serif,15' background '#ffffff'\n"
      "set border lc rgb '#404040'\n"
      "set grid lc rgb '#d4d4d4' lw 0.7 dt 1\n"
      "set tics nomirror\n"
      "set format '%g'\n"
      "set style textbox opaque fillcolor '#ffffff' noborder margins 0.6,0.4\n"
      "set title {} font ',17'\n",
      gnuplot_title(title));
}

std::string viridis_palette() {
  // nine even samples of the viridis map of matplotlib (Smith & van der Walt 2015, CC0)
  return "set palette defined (0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', 4 '#21918c', "
         "5 '#28ae80', 6 '#5ec962', 7 '#addc30', 8 '#fde725')\n";
}

std::string line_colour(CurveRole role, std::size_t index) {
  constexpr std::array<std::string_view, 8> others{blue, vermillion, green, purple, orange, sky, black, grey};
  switch (role) {
    case CurveRole::initial:
      return std::string(vermillion);
    case CurveRole::target:
      return std::string(black);
    case CurveRole::obtained:
      return std::string(blue);
    case CurveRole::direct:
      return std::string(orange);
    case CurveRole::reflected:
      return std::string(green);
    case CurveRole::other:
      break;
  }
  return std::string(others[index % others.size()]);
}

std::string line_look(CurveRole role, std::size_t index) {
  const auto look = [&](double width, std::string_view dashes) {
    return fmt::format("lc rgb '{}' lw {} dt {}", line_colour(role, index), width, dashes);
  };
  switch (role) {
    case CurveRole::target:
      return look(3.5, "1");
    case CurveRole::obtained:
      return look(2.5, "(12,6)");
    case CurveRole::direct:
      return look(2, "(4,4)");
    case CurveRole::reflected:
      return look(2, "(12,4,3,4)");
    case CurveRole::initial:
    case CurveRole::other:
      break;
  }
  constexpr std::array<std::string_view, 4> dashes{"1", "(12,6)", "(4,4)", "(12,4,3,4)"};
  return look(2, role == CurveRole::initial ? "1" : dashes[index % dashes.size()]);
}

int point_shape(std::size_t index) {
  constexpr std::array<int, 10> shapes{7, 5, 9, 13, 11, 6, 4, 8, 12, 10};
  return shapes[index % shapes.size()];
}

std::string mark_label(const Mark& mark, std::string_view place) {
  if (place.find("NaN") != std::string_view::npos) return {};
  const auto symbol = [&] {
    switch (mark.kind) {
      case MarkKind::start:
        return "pt 7 ps 1.0";  // disc
      case MarkKind::end:
        return "pt 5 ps 0.9";  // square
      case MarkKind::minimum:
        break;
    }
    return "pt 9 ps 1.3";  // triangle
  }();
  // a white rim about symbol and name, so that they read on any colour
  std::string text = fmt::format("set label at {} front point lc rgb '#ffffff' {} lw 5\n", place, symbol);
  const auto name = [&](std::string_view colour, double right, double up) {
    text += fmt::format("set label {} at {} front textcolor rgb '{}' offset char {},{}\n",
                        gnuplot_text(mark.label), place, colour, 0.9 + right, 0.6 + up);
  };
  for (double right : {-0.15, 0.0, 0.15})
    for (double up : {-0.07, 0.0, 0.07}) name("#ffffff", right, up);
  name("#000000", 0, 0);
  return text + fmt::format("set label at {} front point lc rgb '#010101' {}\n", place, symbol);
}

std::string surface_layout(const SurfaceView& view) {
  return fmt::format(
      "set view {}, {}, 0.97, 1.05\n"
      "set colorbox user origin screen 0.9, screen 0.35 size screen 0.025, screen 0.4\n"
      "set pm3d depthorder clip z border lc rgb '#30404040' lw 0.3\n"
      "unset key\nunset cblabel\n",
      plot_number(view.tilt_deg), plot_number(view.turn_deg));
}

std::string plot_command(std::string_view command, const std::vector<std::string>& parts) {
  std::string text(command);
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? ", \\\n     " : " ") + parts[i];
  return text + "\n";
}

}  // namespace catoptric::report
