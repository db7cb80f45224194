#include <fmt/format.h>

#include "base/errors.h"
#include "images/image_file.h"
#include "images/netpbm_header.h"

namespace catoptric::images {
namespace {

constexpr std::size_t greatest_of_two_bytes = 65535;

std::size_t binary_value(std::string_view pixels, std::size_t place, std::size_t bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(pixels[i]); };
  return bytes == 1 ? byte(place) : 256 * std::size_t{byte(2 * place)} + byte(2 * place + 1);
}

}  // namespace

GreyImage parse_pgm(std::string_view bytes, const std::string& name) {
  const bool is_text = bytes.starts_with("P2");
  NetpbmWords words(bytes.substr(2), name);
  GreyImage image{.format = "PGM", .values = {}, .has_white = true, .stated_gamma = {}};
  image.columns = words.integer("width", 1, longest_side);
  image.rows = words.integer("height", 1, longest_side);
  const std::size_t white = words.integer("greatest value", 1, greatest_of_two_bytes);
  require_few_pixels(image.columns, image.rows, name);
  const std::size_t count = image.columns * image.rows, width = white > 255 ? 2 : 1;
  if (is_text && words.left().size() < count)
    throw InputError({fmt::format("it ends before its {} values", count), name, "the file is cut off", ""});
  if (!is_text) {
    words.end_header();
    require_bytes(words.left().size(), count * width, name);
  }
  image.values.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = [&] { return place_of(i / image.columns, i % image.columns); };
    std::size_t value = 0;
    if (is_text) {
      value = words.integer("value of " + place(), 0, white);
    } else {
      value = binary_value(words.left(), i, width);
      if (value > white)
        throw InputError({fmt::format("{} is above {}", value, white), fmt::format("{}, {}", name, place()),
                          "the header names the greatest value, which is white", ""});
    }
    image.values.push_back(static_cast<double>(value) / static_cast<double>(white));
  }
  if (is_text && !words.next().empty())
    throw InputError({fmt::format("more than {} values", count), name, "columns times rows", ""});
  return image;
}

}  // namespace catoptric::images
