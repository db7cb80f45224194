#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "support/iges_text.h"

namespace catoptric::test {

/// The starting profiles in data/profiles, as text by the IGES standard. A test compares the files with
/// these.
struct ProfileFile {
  std::string name;
  std::string text;
};

/// The plane XT, YT of a planar entity laid into x, z: x = XT, y = -ZT, z = YT + height.
inline IgesText::Matrix upright(double height) { return {{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, height}}}; }

/// Paper start A, (0, 10), (5, 10), (9, 5) cm with weights 1, 1.6, 1, in the xz plane.
inline std::string start_a_text() {
  IgesText file(10, "CM");
  file.spline(2, {0, 0, 0, 1, 1, 1}, {1, 1.6, 1}, {{0, 0, 10}, {5, 0, 10}, {9, 0, 5}});
  return file.text();
}

/// The same about an axis through (1, 2, 3) cm along (2, 3, 6), z = 0 at that point, with the axis as a line.
/// The plane's other direction is (6, 2, -3); both have length 7, so all numbers are sevenths.
inline std::string start_a_tilted_text() {
  const auto place = [](double r, double z) {
    return IgesText::Point{1 + (6 * r + 2 * z) / 7, 2 + (2 * r + 3 * z) / 7, 3 + (-3 * r + 6 * z) / 7};
  };
  IgesText file(10, "CM");
  file.spline(2, {0, 0, 0, 1, 1, 1}, {1, 1.6, 1}, {place(0, 10), place(5, 10), place(9, 5)});
  file.line(place(0, 0), place(0, 12));
  return file.text();
}

/// A spherical cap of radius 50 mm (arc 100) and a straight skirt (line 110) as one composite (102).
inline std::string cap_and_skirt_text() {
  IgesText file;
  const int plane = file.matrix(upright(100));
  const int arc = file.arc(0, {0, -50}, {30, -10}, {0, 0}, plane, IgesText::Role::dependent);
  const int line = file.line({30, 0, 90}, {60, 0, 50}, IgesText::Role::dependent);
  file.composite({arc, line});
  return file.text();
}

/// Three facets as a polyline (106 form 12).
inline std::string facets_text() {
  IgesText file;
  file.polyline({{0, 0, 100}, {40, 0, 95}, {80, 0, 60}, {85, 0, 10}});
  return file.text();
}

/// The paraboloid z = 100 mm - r^2 / 200 mm out to 100 mm as a conic (104 form 3).
inline std::string parabola_text() {
  IgesText file;
  const int plane = file.matrix(upright(100));
  file.conic(3, {0.005, 0, 0, 0, 1, 0}, {0, 0}, {100, -50}, plane);
  return file.text();
}

inline std::vector<ProfileFile> profile_files() {
  return {{"start_a.igs", start_a_text()},
          {"start_a_tilted.igs", start_a_tilted_text()},
          {"cap_and_skirt.igs", cap_and_skirt_text()},
          {"facets.igs", facets_text()},
          {"parabola.igs", parabola_text()}};
}

}  // namespace catoptric::test
