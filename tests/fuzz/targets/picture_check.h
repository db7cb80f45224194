#pragma once

#include <cmath>
#include <functional>
#include <string_view>

#include "design/picture.h"
#include "fuzz/targets/csv.h"
#include "images/image_file.h"

namespace catoptric::fuzz {

/// Reads a picture. What is accepted has as many values as it says, each finite and not negative; some
/// small ones go on to be a scene's target.
inline void try_picture(std::string_view bytes) {
  static const InputFile file;
  const bool read = accepted([&] {
    const images::GreyImage image = images::parse_image(bytes, "fuzz.img");
    if (image.values.size() != image.columns * image.rows || image.values.empty()) finding("another size");
    for (const double value : image.values)
      if (!(value >= 0 && value < HUGE_VAL && (!image.has_white || value <= 1)))
        finding("a value that is none");
    if (image.stated_gamma && !(*image.stated_gamma > 0 && *image.stated_gamma < HUGE_VAL))
      finding("a gamma that is none");
  });
  // A scene takes a thousand times as long as a picture, so one in some hundred goes on.
  constexpr std::size_t small = 2000, one_in = 128;
  if (!read || bytes.size() > small || std::hash<std::string_view>{}(bytes) % one_in != 0) return;
  accepted([&] {
    const design::Scene scene = scene_with("kind = \"image\"\nwidth = 3\nscale = \"free\"\nfile = '" +
                                           file.with(bytes.data(), bytes.size()) + "'\n");
    check_target(design::make_target(scene));
    check_scene(scene);
  });
}

}  // namespace catoptric::fuzz
