#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "base/errors.h"
#include "images/image_file.h"
#include "images/netpbm_header.h"

namespace catoptric::images {
namespace {

constexpr double least_factor = 1e-30, greatest_factor = 1e30;

double read_factor(std::string_view word, const std::string& name) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = error == std::errc{} && end == word.data() + word.size();
  if (!whole || !(std::abs(value) >= least_factor && std::abs(value) <= greatest_factor))
    throw InputError(
        {"its factor is no number that can be used", name,
         fmt::format("behind the size stands a number from {:g} to {:g}, negative where the least "
                     "byte of a value comes first",
                     least_factor, greatest_factor),
         "-1.0"});
  return value;
}

std::uint32_t four_bytes(std::string_view at, bool least_first) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i)
    bits = (bits << 8) | static_cast<unsigned char>(at[least_first ? 3 - i : i]);
  return bits;
}

/// What is wrong with a value; null when nothing is. By its bits, so that no NaN is computed with.
const char* defect_of(std::uint32_t bits) {
  constexpr std::uint32_t sign = 0x80000000u, exponent = 0x7F800000u;
  if ((bits & exponent) == exponent) return "is not finite";
  return (bits & sign) != 0 && bits != sign ? "is negative" : nullptr;
}

}  // namespace

GreyImage parse_pfm(std::string_view bytes, const std::string& name) {
  NetpbmWords words(bytes.substr(2), name);
  GreyImage image{.format = "PFM", .values = {}, .stated_gamma = {}};
  image.columns = words.integer("width", 1, longest_side);
  image.rows = words.integer("height", 1, longest_side);
  require_few_pixels(image.columns, image.rows, name);
  const double factor = read_factor(words.next(), name);
  image.stated_factor = std::abs(factor);
  words.end_header();
  const std::size_t count = image.columns * image.rows;
  require_bytes(words.left().size(), 4 * count, name);
  image.values.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t bits = four_bytes(words.left().substr(4 * i, 4), factor < 0);
    const std::size_t row = image.rows - 1 - i / image.columns,
                      column = i % image.columns;  // from the bottom
    if (const char* defect = defect_of(bits))
      throw InputError({fmt::format("the value {}", defect),
                        fmt::format("{}, {}", name, place_of(row, column)),
                        "irradiance is finite and not negative", "write 0 where no light is wanted"});
    image.values[row * image.columns + column] =
        image.stated_factor * std::abs(static_cast<double>(std::bit_cast<float>(bits)));
  }
  return image;
}

}  // namespace catoptric::images
