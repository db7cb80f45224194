#include "design/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/ordered_sum.h"
#include "base/units.h"
#include "design/source_settings.h"
#include "images/image_file.h"

namespace catoptric::design {
namespace {

/// Light for a grey value of 0 to 1.  @from IEC 61966-2-1 (sRGB)
double srgb_light(double grey) {
  return grey <= 0.04045 ? grey / 12.92 : std::pow((grey + 0.055) / 1.055, 2.4);
}

images::GreyImage image_of(const Settings& settings) {
  return images::read_image(*settings.text("target.file"));
}

/// Place between pixel centres 0 to count - 1, and the share of the second of two neighbours.
struct Between {
  std::size_t first, second;
  double share;
};

Between between(double place, std::size_t count) {
  const double last = static_cast<double>(count - 1), at = std::clamp(place, 0.0, last);
  const auto first = static_cast<std::size_t>(at);
  return {first, std::min(first + 1, count - 1), at - std::floor(at)};
}

/// What a file says of its grey becomes the scene's own, so that scene.toml says it too.
void complete_transfer(Settings& settings, const images::GreyImage& image) {
  constexpr double least_gamma = 0.1, greatest_gamma = 10;  // as the key's
  if (!image.has_white) {
    for (const char* key : {"target.transfer", "target.gamma"})
      if (settings.has(key))
        throw settings.error(key, "has no effect", "a PFM holds irradiance itself", "remove it");
    return;
  }
  if (settings.has("target.gamma")) settings.fill("target.transfer", "\"gamma\"");
  if (!settings.has("target.transfer")) {
    if (image.has_profile)
      throw settings.error("target.transfer", "is missing", "the PNG has an ICC profile, which is not read",
                           "target.transfer = \"srgb\", or \"linear\" where grey is proportional to light");
    if (image.is_srgb) settings.fill("target.transfer", "\"srgb\"");
    if (image.stated_gamma && *image.stated_gamma >= least_gamma && *image.stated_gamma <= greatest_gamma) {
      settings.fill("target.transfer", "\"gamma\"");
      settings.fill("target.gamma", fmt::format("{}", *image.stated_gamma));
    }
    settings.fill("target.transfer", "\"linear\"");
  }
  const bool is_power = settings.text("target.transfer") == "gamma";
  if (is_power && !settings.has("target.gamma"))
    throw settings.error("target.gamma", "is missing", "light goes like grey to that power",
                         "target.gamma = 2.2");
  if (!is_power && settings.has("target.gamma"))
    throw settings.error("target.gamma", "has no effect",
                         "target.transfer is \"" + *settings.text("target.transfer") + "\"", "remove it");
}

double light_of(const Settings& settings, double grey) {
  const auto transfer = settings.text("target.transfer");
  if (transfer == "srgb") return srgb_light(grey);
  return transfer == "gamma" ? std::pow(grey, *settings.number("target.gamma")) : grey;
}

std::string transfer_note(const Settings& settings, const images::GreyImage& image) {
  const std::string white = fmt::format("white is {:g} {}", *settings.number("target.peak"),
                                        irradiance_unit(light_quantity(settings)));
  const std::string transfer = *settings.text("target.transfer");
  if (transfer == "srgb") return "the picture's grey is taken by sRGB's curve, " + white;
  if (transfer == "gamma")
    return fmt::format("the picture's light goes like grey to the power {:g}, {}",
                       *settings.number("target.gamma"), white);
  const bool says = image.is_srgb || image.has_profile || image.stated_gamma;
  return fmt::format("the picture's grey is taken for proportional to light, {}{}", white,
                     says ? "" : ", for the file does not say how grey stands for light");
}

/// The irradiance of 1 in the image's own numbers, W/m^2 or lx.
double scale_of(const Settings& settings, const images::GreyImage& image, double greatest) {
  const auto peak = settings.number("target.peak");
  if (image.has_white) return *peak;
  return peak ? *peak / greatest : 1.0;
}

}  // namespace

bool Picture::covers(const Vector2& plane_mm) const {
  return std::abs(plane_mm.x()) <= 0.5 * width_mm && std::abs(plane_mm.y()) <= 0.5 * height_mm;
}

double Picture::at(const Vector2& plane_mm) const {
  if (!covers(plane_mm)) return 0;
  const Between x = between((plane_mm.x() / width_mm + 0.5) * static_cast<double>(columns) - 0.5, columns);
  const Between y = between((0.5 - plane_mm.y() / height_mm) * static_cast<double>(rows) - 0.5, rows);
  const auto row_at = [&](std::size_t row) {
    const double* pixels = irradiance_w_per_mm2.data() + row * columns;
    return (1 - x.share) * pixels[x.first] + x.share * pixels[x.second];
  };
  return (1 - y.share) * row_at(y.first) + y.share * row_at(y.second);
}

void complete_picture(Settings& settings) {
  settings.make_absolute("target.file");
  const images::GreyImage image = image_of(settings);
  const double columns = static_cast<double>(image.columns), rows = static_cast<double>(image.rows);
  const auto width = settings.number("target.width"), height = settings.number("target.height");
  if (!width && !height)
    throw settings.error("target.width", "is missing", "a picture needs its size on the near field",
                         "target.width or target.height; the other follows");
  if (!width) settings.fill("target.width", fmt::format("{}", *height * columns / rows));
  if (!height) settings.fill("target.height", fmt::format("{}", *width * rows / columns));
  complete_transfer(settings, image);
  if (settings.text("target.scale") == "free" && image.has_white) settings.fill("target.peak", "1.0");
  if (image.has_white && !settings.has("target.peak"))
    throw settings.error("target.peak", "is missing",
                         fmt::format("a {} says what is white, not how much light that is", image.format),
                         "target.peak = 100.0, or target.scale = \"free\"");
}

Picture read_picture(const Settings& settings, double unit_mm, std::vector<std::string>& notes) {
  const images::GreyImage image = image_of(settings);
  const std::string file = *settings.text("target.file");
  const double greatest = *std::max_element(image.values.begin(), image.values.end());
  if (!(greatest > 0))
    throw settings.error("target.file", "the picture is black everywhere", "no light is wanted", "");
  Picture picture{image.columns, image.rows, {}, 0, 0};
  picture.width_mm = *settings.number("target.width") * unit_mm;
  picture.height_mm = *settings.number("target.height") * unit_mm;
  const double scale = scale_of(settings, image, greatest);
  picture.irradiance_w_per_mm2.reserve(image.values.size());
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const double wanted = scale * (image.has_white ? light_of(settings, image.values[i]) : image.values[i]);
    if (!(wanted <= greatest_irradiance_w_per_m2))
      throw InputError(
          {fmt::format("irradiance {} is out of range", wanted),
           fmt::format("{}, row {}, column {}", file, i / image.columns + 1, i % image.columns + 1),
           fmt::format("it lies between 0 and {}", greatest_irradiance_w_per_m2),
           "target.peak is what the greatest value stands for"});
    picture.irradiance_w_per_mm2.push_back(from_w_per_m2(wanted));
  }
  if (image.has_white) notes.push_back(transfer_note(settings, image));
  if (image.stated_factor != 1)
    notes.push_back(fmt::format("the PFM's values are multiplied by {:g}, which its third line says",
                                image.stated_factor));
  return picture;
}

double asymmetry_rel(const Picture& picture, const sim::NearField& field) {
  const Vector3 foot_mm{0, 0, field.center_mm().z()};
  const Vector2 axis_mm = field.to_plane(foot_mm);
  // Rings that do not meet both the picture and the field have no light.
  const double half_mm = std::min(std::hypot(field.half_width_mm(), field.half_height_mm()),
                                  0.5 * std::hypot(picture.width_mm, picture.height_mm));
  const double first_mm = std::max(0.0, axis_mm.norm() - half_mm), reach_mm = axis_mm.norm() + half_mm;
  const double pixel_mm = std::min(picture.width_mm / static_cast<double>(picture.columns),
                                   picture.height_mm / static_cast<double>(picture.rows));
  const auto radii =
      static_cast<std::size_t>(std::clamp(std::ceil((reach_mm - first_mm) / pixel_mm), 256.0, 1024.0));
  const auto directions =
      static_cast<std::size_t>(std::clamp(std::ceil(2 * pi * reach_mm / pixel_mm), 512.0, 2048.0));
  std::vector<double> squares, departures;
  for (std::size_t i = 0; i < radii; ++i) {
    const double radius_mm =
        first_mm + (reach_mm - first_mm) * (static_cast<double>(i) + 0.5) / static_cast<double>(radii);
    std::vector<double> ring;
    for (std::size_t j = 0; j < directions; ++j) {
      const double azimuth = 2 * pi * (static_cast<double>(j) + 0.5) / static_cast<double>(directions);
      const Vector2 place_mm = axis_mm + radius_mm * Vector2(std::cos(azimuth), std::sin(azimuth));
      if (field.contains(place_mm)) ring.push_back(picture.at(place_mm));
    }
    if (ring.empty()) continue;
    const double mean = ordered_sum(ring) / static_cast<double>(ring.size());
    std::vector<double> square, departure;
    for (const double each : ring) {
      square.push_back(each * each);
      departure.push_back((each - mean) * (each - mean));
    }
    squares.push_back(radius_mm * ordered_sum(square));
    departures.push_back(radius_mm * ordered_sum(departure));
  }
  const double all = ordered_sum(squares);
  return all > 0 ? std::sqrt(ordered_sum(departures) / all) : 0.0;
}

}  // namespace catoptric::design
