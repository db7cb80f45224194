#pragma once

#include <chrono>
#include <filesystem>
#include <string>

namespace catoptric::report {

struct GnuplotOptions {
  std::string program = "gnuplot";  ///< looked up in PATH
  std::chrono::milliseconds time_limit{30000};
};

/// What became of a figure.
struct Drawing {
  std::filesystem::path script;  ///< always written, data inside: `gnuplot x.gp > x.svg` draws it anywhere
  std::filesystem::path svg;     ///< written when the figure was drawn
  std::string svg_text;          ///< the picture itself, empty when it was not drawn
  std::string sentence;          ///< why it was not drawn and what to do, empty when it was
  bool drawn() const { return !svg_text.empty(); }
};

/// Writes `folder`/`name`.gp and, by gnuplot as a child process, `folder`/`name`.svg. A missing or failing
/// gnuplot is no error: the script with its data stays and the drawing says why there is no picture.
/// @in    script as the functions of figures.h make it
/// @fails IoError when a file cannot be written
Drawing draw(const std::string& script, const std::filesystem::path& folder, const std::string& name,
             const GnuplotOptions& options = {});

}  // namespace catoptric::report
