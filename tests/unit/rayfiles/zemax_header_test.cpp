#include "rayfiles/zemax_header.h"

#include <catch2/catch.hpp>

#include "base/errors.h"
#include "support/ray_bytes.h"

using namespace catoptric;
using namespace catoptric::rayfiles;
using namespace catoptric::test;

namespace {

ZemaxReading read(const std::string& file) { return read_zemax_header(as_bytes(file), "f.dat"); }

std::string full_header() {
  Bytes file;
  file.u32(1010).u32(0xEE6B2800).text("lamp", 100).floats({1, 2, 3, 4, 5, 6, 7}).u32(1);
  file.floats({8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20}).u32(2).u32(0).u32(21).u32(22);
  return file.str();
}

}  // namespace

TEST_CASE("every field of a Zemax header is read from its place and written to it") {
  const std::string file = full_header();
  const ZemaxReading reading = read(file);
  const ZemaxHeader& header = reading.header;
  CHECK(header.ray_count == 4'000'000'000u);
  CHECK(header.description == "lamp");
  CHECK(header.source_flux == 1.0f);
  CHECK(header.ray_set_flux == 2.0f);
  CHECK(header.wavelength_um == 3.0f);
  CHECK(header.inclination_deg == std::array<float, 2>{4, 5});
  CHECK(header.azimuth_deg == std::array<float, 2>{6, 7});
  CHECK(header.unit == ZemaxUnit::inch);
  CHECK(header.location == std::array<float, 3>{8, 9, 10});
  CHECK(header.rotation_rad == std::array<float, 3>{11, 12, 13});
  CHECK(header.scale == std::array<float, 3>{14, 15, 16});
  CHECK(header.unused == std::array<float, 4>{17, 18, 19, 20});
  CHECK(header.rays == ZemaxRays::spectral_color);
  CHECK(header.flux == ZemaxFlux::watts);
  CHECK(header.reserved == std::array<std::int32_t, 2>{21, 22});
  CHECK(reading.notes.size() == 1);  // translation and rotation
  CHECK(columns(header).size() == 8);
  CHECK(zemax_header_bytes(header) == file);
}

TEST_CASE("a Zemax header cut at any byte is refused") {
  const std::string file = full_header();
  for (std::size_t size = 0; size < file.size(); ++size)
    CHECK_THROWS_WITH(read(file.substr(0, size)), Catch::Contains("ends inside its header"));
  CHECK_NOTHROW(read(file));
}

TEST_CASE("what is wrong in a Zemax header is said with byte, field and rule") {
  const std::string sound = zemax_file(3, 4, 0, 1, {});
  CHECK(read(sound).notes.empty());
  const auto refused = [&](std::size_t at, std::uint32_t value, const char* part) {
    INFO(at << " " << value);
    CHECK_THROWS_WITH(read(with_u32(sound, at, value)),
                      Catch::Contains(part) && Catch::Contains("f.dat, byte " + std::to_string(at)));
  };
  refused(0, 0xF2030000, "big-endian");
  refused(0, 1011, "identifier 1011");
  refused(4, 0, "no rays");
  refused(4, 4'000'000'001u, "too many");
  refused(136, 5, "unit 5");
  refused(192, 1, "ray format 1");
  refused(196, 2, "flux type 2");
  CHECK_THROWS_WITH(read(with_u32(sound, 192, 2)), Catch::Contains("lumens in the spectral format"));
}
