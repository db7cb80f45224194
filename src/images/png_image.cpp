#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

#include "base/errors.h"
#include "images/image_file.h"
#include "images/netpbm_header.h"

namespace catoptric::images {
namespace {

/// libpng leaves by longjmp, over whatever lies between: so all that has a destructor is kept here, outside
/// of the functions that are jumped out of.
struct Decoding {
  explicit Decoding(std::string_view bytes) : left(bytes) {}
  ~Decoding() { png_destroy_read_struct(&png, &info, nullptr); }
  Decoding(const Decoding&) = delete;
  Decoding& operator=(const Decoding&) = delete;

  std::string_view left;
  char message[200] = "";
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::vector<png_byte> pixels;
  std::vector<png_bytep> rows;
};

extern "C" {

[[noreturn]] void catoptric_png_failed(png_structp png, png_const_charp message) {
  auto* decoding = static_cast<Decoding*>(png_get_error_ptr(png));
  std::strncpy(decoding->message, message, sizeof decoding->message - 1);
  png_longjmp(png, 1);
}

void catoptric_png_warned(png_structp, png_const_charp) {}  // of chunks that say nothing of pixels

void catoptric_png_bytes(png_structp png, png_bytep to, png_size_t count) {
  auto* decoding = static_cast<Decoding*>(png_get_io_ptr(png));
  if (decoding->left.size() < count) png_error(png, "it is cut off");
  std::memcpy(to, decoding->left.data(), count);
  decoding->left.remove_prefix(count);
}

}  // extern "C"

/// @out   false: decoding.message says why not
bool read_header(Decoding& decoding) {
  decoding.png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoding, catoptric_png_failed, catoptric_png_warned);
  if (!decoding.png) return false;
  if (setjmp(png_jmpbuf(decoding.png))) return false;
  decoding.info = png_create_info_struct(decoding.png);
  png_set_read_fn(decoding.png, &decoding, catoptric_png_bytes);
  png_set_user_limits(decoding.png, longest_side, longest_side);
  png_read_info(decoding.png, decoding.info);
  return true;
}

/// @in    rows are there
bool read_pixels(Decoding& decoding) {
  if (setjmp(png_jmpbuf(decoding.png))) return false;
  png_set_packing(decoding.png);  // fewer than 8 bits: a byte each
  png_read_image(decoding.png, decoding.rows.data());
  png_read_end(decoding.png, nullptr);
  return true;
}

[[noreturn]] void refuse_damaged(const Decoding& decoding, const std::string& name) {
  std::string message;
  for (const char* c = decoding.message; *c; ++c) message += *c >= ' ' && *c <= '~' ? *c : '?';
  throw InputError({"the PNG cannot be read", name, message, "write it anew from the program it came from"});
}

void require_grey(const Decoding& decoding, const std::string& name) {
  const png_byte colour = png_get_color_type(decoding.png, decoding.info);
  const bool is_clear =
      (colour & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(decoding.png, decoding.info, PNG_INFO_tRNS) != 0;
  if ((colour & PNG_COLOR_MASK_COLOR) != 0)
    throw InputError({"the PNG has colours", name, "which of them stand for how much light is not said",
                      "turn it into grey"});
  if (is_clear)
    throw InputError({"the PNG has transparent parts", name, "how much light is wanted there is not said",
                      "lay it on black and remove the alpha channel"});
}

/// More than zlib can make of a file is not there, whatever the header says.
void require_room(std::size_t columns, std::size_t rows, std::size_t bits, std::size_t file_bytes,
                  const std::string& name) {
  constexpr std::size_t most_per_byte = 1032;
  if (rows * (columns * bits / 8) <= most_per_byte * file_bytes) return;
  throw InputError({fmt::format("{} columns by {} rows are not in it", columns, rows), name,
                    fmt::format("its {} bytes cannot hold so many pixels", file_bytes),
                    "the file is cut off"});
}

void read_statements(const Decoding& decoding, GreyImage& image) {
  int intent = 0;
  png_fixed_point gamma = 0;
  constexpr double fixed_point = 100000;
  image.is_srgb = png_get_sRGB(decoding.png, decoding.info, &intent) != 0;
  if (image.is_srgb) return;
  image.has_profile = png_get_valid(decoding.png, decoding.info, PNG_INFO_iCCP) != 0;
  if (!image.has_profile && png_get_gAMA_fixed(decoding.png, decoding.info, &gamma) != 0 && gamma > 0)
    image.stated_gamma = fixed_point / gamma;
}

}  // namespace

GreyImage parse_png(std::string_view bytes, const std::string& name) {
  Decoding decoding(bytes);
  if (!read_header(decoding)) refuse_damaged(decoding, name);
  require_grey(decoding, name);
  GreyImage image{.format = "PNG", .values = {}, .has_white = true, .stated_gamma = {}};
  image.columns = png_get_image_width(decoding.png, decoding.info);
  image.rows = png_get_image_height(decoding.png, decoding.info);
  const std::size_t bits = png_get_bit_depth(decoding.png, decoding.info), width = bits == 16 ? 2 : 1;
  require_few_pixels(image.columns, image.rows, name);
  require_room(image.columns, image.rows, bits, bytes.size(), name);
  read_statements(decoding, image);
  decoding.pixels.resize(image.columns * image.rows * width);
  for (std::size_t row = 0; row < image.rows; ++row)
    decoding.rows.push_back(decoding.pixels.data() + row * image.columns * width);
  if (!read_pixels(decoding)) refuse_damaged(decoding, name);
  const double white = static_cast<double>((1u << bits) - 1);
  image.values.reserve(image.columns * image.rows);
  for (std::size_t i = 0; i < image.columns * image.rows; ++i)
    image.values.push_back(
        (width == 1 ? decoding.pixels[i] : 256 * decoding.pixels[2 * i] + decoding.pixels[2 * i + 1]) /
        white);
  return image;
}

}  // namespace catoptric::images
