#include "rayfiles/tm25_header.h"

#include <catch2/catch.hpp>

#include "base/errors.h"
#include "support/ray_bytes.h"

using namespace catoptric;
using namespace catoptric::rayfiles;
using namespace catoptric::test;

namespace {

/// A header that has everything: measured, both fluxes, all flags, two tables, one more column, a text.
std::string full_file() {
  Bytes file;
  file.text("TM25", 4).u32(2013).u32(1).f32(100).f32(0.5f).u64(12).text("2020-01-02", 28).u32(7).u32(4);
  file.u32(signalling_nan).f32(380).f32(780).u32(2).u32(1).u32(32).text("", 168);
  for (int i = 0; i < 8; ++i) file.u32(1);
  for (char32_t c = U'a'; c <= U'i'; ++c) file.wide(std::u32string(3, c), 4000);
  file.u32(1).f32(400).f32(1).u32(2).f32(500).f32(0.5f).f32(600).f32(0.25f);  // 32 bytes: nothing to fill up
  return file.wide(U"age", 512).wide(U"n\U0001F4A1te", 32).str();
}

Tm25Reading read(const std::string& file) { return read_tm25_header(as_bytes(file), "f.tm25ray"); }

}  // namespace

TEST_CASE("every field of a TM-25 header is read from its place") {
  const Tm25Reading reading = read(full_file());
  const Tm25Header& header = reading.header;
  CHECK(header.creation_method == 1);
  CHECK(header.luminous_flux == 100.0f);
  CHECK(header.radiant_flux == 0.5f);
  CHECK(header.ray_count == 12);
  CHECK(header.date == "2020-01-02");
  CHECK(header.start_position == 7);
  CHECK(header.spectrum == Tm25Spectrum::table_of_ray);
  CHECK(!header.wavelength_nm);
  CHECK(header.least_wavelength_nm == 380.0f);
  CHECK(header.greatest_wavelength_nm == 780.0f);
  CHECK(header.text(Tm25Text::light_source) == "aaa");
  CHECK(header.text(Tm25Text::operation) == "ggg");
  CHECK(header.text(Tm25Text::data_reference) == "iii");
  REQUIRE(header.spectra.size() == 2);
  CHECK(header.spectra[0] == std::vector<std::pair<float, float>>{{400.0f, 1.0f}});
  CHECK(header.spectra[1] == std::vector<std::pair<float, float>>{{500.0f, 0.5f}, {600.0f, 0.25f}});
  CHECK(header.additional_columns == std::vector<std::string>{"age"});
  CHECK(header.additional_text == "n\xF0\x9F\x92\xA1te");
  CHECK(reading.first_ray_byte == 256 + 32 + 36000 + 32 + 512 + 32);
  CHECK(reading.notes.empty());
  CHECK(columns(header) == std::vector<std::string>{"x", "y", "z", "kx", "ky", "kz", "phi", "lambda", "Tri_Y",
                                                    "S1", "S2", "S3", "PolEllipseX", "PolEllipseY",
                                                    "PolEllipseZ", "Tri_X", "Tri_Z", "spectrumIdx", "age"});
}

TEST_CASE("a TM-25 header is written to the bytes it was read from") {
  for (const std::string& file : {full_file(), tm25_file(3, {})})
    CHECK(tm25_header_bytes(read(file).header) == file);
}

TEST_CASE("tables of spectra are filled up to 32 bytes") {
  Tm25Header header;
  header.spectra = {{{500.0f, 1.0f}}};
  header.ray_count = 1;
  const std::string bytes = tm25_header_bytes(header);
  CHECK(bytes.size() == 36288 + 32);
  CHECK(read(bytes).first_ray_byte == bytes.size());
}

TEST_CASE("a TM-25 header cut at any byte is refused") {
  const std::string file = full_file();
  std::size_t accepted = 0;
  for (std::size_t size = 0; size < file.size(); ++size) {
    try {
      read(file.substr(0, size));
      ++accepted;
    } catch (const InputError& error) {
      if (error.parts().what != "the file ends inside its header") ++accepted;
    }
  }
  CHECK(accepted == 0);
  CHECK_NOTHROW(read(file));
}

TEST_CASE("what is wrong in a TM-25 header is said with byte, field and rule") {
  const std::string sound = tm25_file(3, {});
  const auto refused = [&](std::size_t at, std::uint32_t value, const char* part) {
    INFO(at << " " << value);
    CHECK_THROWS_WITH(read(with_u32(sound, at, value)),
                      Catch::Contains(part) && Catch::Contains("f.tm25ray, byte " + std::to_string(at)));
  };
  refused(4, 2020, "version 2020 is not known");
  refused(4, 0xDD070000, "big-endian");
  refused(12, 0xBF800000, "-1 is no flux");
  refused(16, 0x7F800000, "inf is no flux");
  refused(52 + 8, 5, "no spectral data identifier");
  refused(76, 0xFFFFFFFF, "-1 is no count");
  refused(80, 0x80000000, "is no count");
  refused(84, 6, "no UTF-32");
  refused(256, 0, "the flag is not set");
  refused(260, 2, "2 is no flag");
  CHECK_THROWS_WITH(read(with_u32(sound, 264, 0)),
                    Catch::Contains("rays have no flux") && Catch::Contains("byte 272"));
}

TEST_CASE(
    "counts of a TM-25 header that no file can hold are refused before anything is allocated for them") {
  const std::string sound = tm25_file(3, {});
  for (const std::size_t at : {76, 80}) {
    CHECK_THROWS_WITH(read(with_u32(sound, at, 0x7FFFFFFF)), Catch::Contains("headers up to 64 MiB"));
    CHECK_THROWS_AS(read(with_u32(sound, at, 5)), InputError);
  }
  CHECK_THROWS_WITH(read(with_u32(sound, 84, 0x7FFFFFFC)), Catch::Contains("headers up to 64 MiB"));
  const std::string table = with_u32(sound, 76, 1) + Bytes().u32(0x7FFFFFFF).str();
  CHECK_THROWS_WITH(read(table), Catch::Contains("spectrum 1") && Catch::Contains("17179869176 bytes"));
  CHECK_THROWS_WITH(read(with_u32(sound, 76, 1) + Bytes().u32(0).str()), Catch::Contains("table is empty"));
}

TEST_CASE("what is odd in a TM-25 header but harmless is a note") {
  const std::string sound = tm25_file(3, {});
  CHECK(read(sound).notes.empty());
  const auto noted = [&](std::size_t at, std::uint32_t value) {
    INFO(at);
    CHECK(read(with_u32(sound, at, value)).notes.size() == 1);
  };
  noted(8, 2);                // creation method
  noted(56, 8);               // start position
  noted(64, signalling_nan);  // one wavelength, but none
  noted(60, 2);               // a column of wavelengths, but none
  noted(284, 1);              // tables by ray, but none
}

TEST_CASE("a TM-25 header that cannot be written is refused") {
  Tm25Header header;
  header.date = std::string(29, '1');
  CHECK_THROWS_AS(tm25_header_bytes(header), InputError);
  header.date.clear();
  header.spectra = {{}};
  CHECK_THROWS_AS(tm25_header_bytes(header), InputError);
}
