#include "images/image_file.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "base/errors.h"
#include "base/whole_file.h"

namespace catoptric::images {
namespace {

using namespace std::string_view_literals;

/// First bytes of pictures that are known and not taken, and why not.
constexpr std::pair<std::string_view, std::string_view> not_taken[] = {
    {"PF"sv, "a PFM of three colours"},
    {"P1"sv, "a bitmap of black and white"},
    {"P4"sv, "a bitmap of black and white"},
    {"P3"sv, "a PPM of three colours"},
    {"P6"sv, "a PPM of three colours"},
    {"P7"sv, "a PAM"},
    {"\xFF\xD8\xFF"sv, "a JPEG"},
    {"GIF8"sv, "a GIF"},
    {"BM"sv, "a Windows bitmap"},
    {"II*\0"sv, "a TIFF"},
    {"MM\0*"sv, "a TIFF"},
    {"#?RADIANCE"sv, "a Radiance picture"},
    {"\x76\x2F\x31\x01"sv, "an OpenEXR file"},
};

}  // namespace

GreyImage parse_image(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("\x89PNG"sv)) return parse_png(bytes, name);
  if (bytes.starts_with("P2"sv) || bytes.starts_with("P5"sv)) return parse_pgm(bytes, name);
  if (bytes.starts_with("Pf"sv)) return parse_pfm(bytes, name);
  std::string_view what = "this is no picture that is known";
  std::string found;
  for (const auto& [first, kind] : not_taken)
    if (bytes.starts_with(first)) what = found = fmt::format("this is {}", kind);
  throw InputError({std::string(what), name, "a picture of light is a grey PNG, a PGM (P2, P5) or a PFM (Pf)",
                    "turn it into grey, as PNG or PGM of 16 bits"});
}

GreyImage read_image(const std::filesystem::path& file) {
  auto content = read_whole_file(file);
  if (auto* parts = std::get_if<ErrorParts>(&content)) {
    parts->where = file.string();
    throw InputError(std::move(*parts));
  }
  return parse_image(std::get<std::string>(content), file.string());
}

}  // namespace catoptric::images
