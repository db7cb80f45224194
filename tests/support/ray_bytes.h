#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rayfiles/ray_set.h"

namespace catoptric::test {

/// Bytes of a file, put down one number after the other, by nothing of the program's own.
class Bytes {
 public:
  Bytes& u32(std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) text_ += static_cast<char>(value >> shift & 0xFF);
    return *this;
  }
  Bytes& u64(std::uint64_t value) {
    u32(static_cast<std::uint32_t>(value));
    return u32(static_cast<std::uint32_t>(value >> 32));
  }
  Bytes& f32(float value) { return u32(std::bit_cast<std::uint32_t>(value)); }
  Bytes& floats(const std::vector<float>& values) {
    for (const float value : values) f32(value);
    return *this;
  }
  Bytes& text(const std::string& value, std::size_t size) {
    text_ += value;
    text_.append(size - value.size(), '\0');
    return *this;
  }
  /// UTF-32 in a block of so many bytes.
  Bytes& wide(const std::u32string& value, std::size_t size) {
    for (const char32_t c : value) u32(static_cast<std::uint32_t>(c));
    text_.append(size - 4 * value.size(), '\0');
    return *this;
  }
  const std::string& str() const { return text_; }

 private:
  std::string text_;
};

inline std::span<const std::byte> as_bytes(const std::string& text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

/// A text with the 32-bit number at a byte changed.
inline std::string with_u32(std::string text, std::size_t at, std::uint32_t value) {
  return text.replace(at, 4, Bytes().u32(value).str());
}
inline std::string with_f32(std::string text, std::size_t at, float value) {
  return with_u32(std::move(text), at, std::bit_cast<std::uint32_t>(value));
}

inline constexpr std::uint32_t signalling_nan = 0x7FA00000;

/// A TM-25 file of radiant rays in one wavelength, which the header says to be so many.
inline std::string tm25_file(std::uint64_t count, const std::vector<float>& rays) {
  Bytes file;
  file.text("TM25", 4).u32(2013).u32(1).u32(signalling_nan).f32(3.0f).u64(count);
  file.text("2013-09-04T08:30:29+01:00", 28)
      .u32(4)
      .u32(1)
      .f32(550.0f)
      .u32(signalling_nan)
      .u32(signalling_nan);
  file.u32(0).u32(0).u32(0).text("", 168);
  for (const std::uint32_t flag : {1, 1, 1, 0, 0, 0, 0, 0}) file.u32(flag);
  file.wide(U"LED \u00b5", 4000);
  for (int i = 1; i < 9; ++i) file.wide(U"unknown", 4000);
  return file.floats(rays).str();
}

/// A Zemax file.
inline std::string zemax_file(std::uint32_t count, std::uint32_t unit, std::uint32_t rays_type,
                              std::uint32_t flux_type, const std::vector<float>& rays) {
  Bytes file;
  file.u32(1010).u32(count).text("an LED", 100).floats({4.0f, 3.0f, 0.55f, 0, 90, 0, 360}).u32(unit);
  file.floats({0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0}).u32(rays_type).u32(flux_type).u32(0).u32(0);
  return file.floats(rays).str();
}

/// Three rays of seven numbers: fluxes 1, 2 and 0 of a total of 3.
inline std::vector<float> three_rays() {
  return {1, 2, 3, 0, 0, 1, 1, 4, 5, 6, 0.6f, 0, -0.8f, 2, -7, 8, 9, 0, 1, 0, 0};
}

/// Rays in memory.
class ListedRays final : public rayfiles::RaySet {
 public:
  explicit ListedRays(std::vector<rayfiles::SourceRay> rays) : rays_(std::move(rays)) {
    header_.name = "list";
    header_.count = rays_.size();
  }
  /// Rays that differ in their flux alone.
  static std::shared_ptr<const ListedRays> of_fluxes(const std::vector<double>& fluxes) {
    std::vector<rayfiles::SourceRay> rays;
    for (const double flux : fluxes) rays.push_back({Vector3::Zero(), Vector3::UnitZ(), flux});
    return std::make_shared<const ListedRays>(std::move(rays));
  }
  const rayfiles::RaySetHeader& header() const override { return header_; }
  rayfiles::SourceRay as_stored(std::uint64_t i) const override { return rays_.at(i); }
  double flux(std::uint64_t i) const override { return rays_.at(i).flux; }
  std::string place(std::uint64_t i, rayfiles::RayField) const override {
    return "list, ray " + std::to_string(i);
  }

  rayfiles::RaySetHeader header_;

 private:
  std::vector<rayfiles::SourceRay> rays_;
};

}  // namespace catoptric::test
