#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "report/figures.h"

/// What all figures' scripts are made of. Inside this room only.
namespace catoptric::report {

/// The text as a gnuplot string that means exactly these characters: single quotes, where gnuplot interprets
/// nothing, and the terminal's markup is off (see preamble()). An apostrophe becomes a typographic one, since
/// gnuplot 5.4 does not read a doubled quote at the start of a string as one.
std::string gnuplot_text(std::string_view text);

/// The text over at most three lines, as a gnuplot string expression.
std::string gnuplot_title(std::string_view text);

/// As many digits as it takes; NaN for anything not finite.
std::string plot_number(double value);

/// "name [unit]"
std::string axis_label(std::string_view name, std::string_view unit);

/// A here-document $name with one point per line.
/// @fails InputError when the columns differ in length
std::string data_block(std::string_view name, std::initializer_list<const std::vector<double>*> columns);

/// A here-document with x, y, value lines, a blank line after each row.
std::string grid_block(std::string_view name, const GridField& field);

/// Size, font, colours, title.
std::string preamble(std::string_view title);

/// The viridis colours: even steps for the eye, readable in grey and by colour-blind people.
std::string viridis_palette();

/// "lc rgb '#...' lw ... dt ..." for a curve: its role's look, or the next of eight colour-blind-safe ones.
std::string line_look(CurveRole role, std::size_t index);

/// The colour alone.
std::string line_colour(CurveRole role, std::size_t index);

/// A gnuplot point type for one of several curves, so that they are not told apart by colour alone.
int point_shape(std::size_t index);

/// A point in front of everything with its name beside it, at "x,y" or "x,y,z"; nothing where a coordinate is
/// not finite.
std::string mark_label(const Mark& mark, std::string_view place);

/// What all surfaces share: view, room for labels and colour bar, shading.
std::string surface_layout(const SurfaceView& view);

/// "plot a, b, c" over several lines.
std::string plot_command(std::string_view command, const std::vector<std::string>& parts);

}  // namespace catoptric::report
