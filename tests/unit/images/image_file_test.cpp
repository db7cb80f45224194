#include "images/image_file.h"

#include <catch2/catch.hpp>
#include <limits>

#include "support/pfm_bytes.h"
#include "support/png_bytes.h"
#include "support/refusal.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::images;
using namespace catoptric::test;

namespace {

void refused(const std::string& bytes, const std::string& part) {
  INFO(bytes.substr(0, 40));
  try {
    parse_image(bytes, "p.img");
    FAIL_CHECK("accepted");
  } catch (const InputError& error) {
    check_refusal(error);
    CHECK_THAT(error.what(), Catch::Contains("p.img") && Catch::Contains(part));
  }
}

std::string bytes_of(std::initializer_list<int> values) {
  std::string text;
  for (const int each : values) text += static_cast<char>(each);
  return text;
}

}  // namespace

TEST_CASE("grey PNGs of 1 to 16 bits are read row by row from the top") {
  const GreyImage eight = parse_image(grey_png({bytes_of({0, 51, 255}), bytes_of({102, 153, 204})}), "a.png");
  CHECK(eight.format == "PNG");
  CHECK(eight.columns == 3);
  CHECK(eight.rows == 2);
  CHECK(eight.has_white);
  CHECK(eight.values == std::vector<double>{0, 51.0 / 255, 1, 102.0 / 255, 153.0 / 255, 204.0 / 255});
  const GreyImage sixteen =
      parse_image(PngBytes(2, 1, 16, 0).with_rows({bytes_of({1, 2, 255, 255})}), "a.png");
  CHECK(sixteen.values == std::vector<double>{258.0 / 65535, 1});
  const GreyImage four = parse_image(PngBytes(3, 1, 4, 0).with_rows({bytes_of({0x5A, 0xF0})}), "a.png");
  CHECK(four.values == std::vector<double>{5.0 / 15, 10.0 / 15, 1});
  const GreyImage one = parse_image(PngBytes(9, 1, 1, 0).with_rows({bytes_of({0xA0, 0x80})}), "a.png");
  CHECK(one.values == std::vector<double>{1, 0, 1, 0, 0, 0, 0, 0, 1});
}

TEST_CASE("an interlaced PNG is the same picture") {
  // Adam7 of 3 x 2: pass 1 has (0, 0); 6 has the odd column of even rows; 7 the odd row; 4 column 2 of row 0.
  const std::string bytes =
      PngBytes(3, 2, 8, 0, 1)
          .with_rows({bytes_of({10}), bytes_of({30}), bytes_of({20}), bytes_of({40, 50, 60})});
  const GreyImage image = parse_image(bytes, "a.png");
  REQUIRE(image.values.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) CHECK(image.values[i] == static_cast<double>(10 * (i + 1)) / 255);
}

TEST_CASE("what a PNG says of its grey is kept") {
  const auto with = [](const std::string& name, const std::string& data) {
    return parse_image(PngBytes(1, 1, 8, 0).chunk(name, data).with_rows({bytes_of({7})}), "a.png");
  };
  CHECK(with("sRGB", bytes_of({0})).is_srgb);
  const GreyImage gamma = with("gAMA", bytes_of({0, 0, 0xB1, 0x8F}));  // 45455
  CHECK_FALSE(gamma.is_srgb);
  REQUIRE(gamma.stated_gamma);
  CHECK(*gamma.stated_gamma == Approx(2.2).epsilon(1e-5));
  const GreyImage silent = parse_image(grey_png({bytes_of({7})}), "a.png");
  CHECK_FALSE(silent.is_srgb);
  CHECK_FALSE(silent.stated_gamma);
  CHECK_FALSE(silent.has_profile);
}

TEST_CASE("PNGs with colours or transparency, or damaged ones, are refused") {
  refused(PngBytes(1, 1, 8, 2).with_rows({bytes_of({1, 2, 3})}), "has colours");
  refused(PngBytes(1, 1, 8, 6).with_rows({bytes_of({1, 2, 3, 4})}), "has colours");
  refused(PngBytes(1, 1, 8, 3).chunk("PLTE", bytes_of({1, 2, 3})).with_rows({bytes_of({0})}), "has colours");
  refused(PngBytes(1, 1, 8, 4).with_rows({bytes_of({1, 2})}), "transparent");
  refused(PngBytes(1, 1, 8, 0).chunk("tRNS", bytes_of({0, 1})).with_rows({bytes_of({1})}), "transparent");
  const std::string sound = grey_png({bytes_of({1, 2, 3}), bytes_of({4, 5, 6})});
  for (std::size_t length = 4; length < sound.size(); ++length) {
    INFO(length);
    CHECK_THROWS_AS(parse_image(sound.substr(0, length), "a.png"), InputError);
  }
  std::string broken = sound;
  broken[broken.size() - 20] = static_cast<char>(broken[broken.size() - 20] ^ 1);  // in the pixels' checksum
  refused(broken, "cannot be read");
  refused(PngBytes(50000, 50000, 8, 0).with_rows({bytes_of({1})}), "too many");
  refused(PngBytes(4000, 4000, 16, 0).with_rows({bytes_of({1})}), "cannot hold so many pixels");
  refused(PngBytes(0, 1, 8, 0).with_rows({""}), "cannot be read");
}

TEST_CASE("PGMs are read as text and as bytes of one or two, with comments") {
  const GreyImage text =
      parse_image("P2 # a comment\n# another\n3 2\n100\n0 50 100\n25 # here\n75 10\n", "a.pgm");
  CHECK(text.format == "PGM");
  CHECK(text.columns == 3);
  CHECK(text.values == std::vector<double>{0, 0.5, 1, 0.25, 0.75, 0.1});
  const GreyImage one = parse_image("P5\n2 2\n200\n" + bytes_of({0, 100, 200, 50}), "a.pgm");
  CHECK(one.values == std::vector<double>{0, 0.5, 1, 0.25});
  const GreyImage two = parse_image("P5 1 2 1000\n" + bytes_of({3, 232, 1, 244}), "a.pgm");
  CHECK(two.values == std::vector<double>{1, 0.5});
  // The header ends with one blank: a first pixel that looks like a blank is a pixel.
  CHECK(parse_image("P5 1 1 255\n\n", "a.pgm").values == std::vector<double>{10.0 / 255});
}

TEST_CASE("PGMs that break a rule are refused with the place") {
  refused("P2 2 1 100\n1 101\n", "value of row 1, column 2 is \"101\"");
  refused("P2 2 1 100\n1 x\n", "\"x\"");
  refused("P2 2 1 100\n1 -1\n", "\"-1\"");
  refused("P2 2 2 100\n1 1 1\n", "row 2, column 2");
  refused("P2 2 1 100\n1 1 1\n", "more than 2 values");
  refused("P5 2 1 100\n" + bytes_of({1, 101}), "row 1, column 2");
  refused("P5 2 1 100\n" + bytes_of({1}), "1 bytes of pixels, where 2 belong");
  refused("P5 2 1 100\n" + bytes_of({1, 1, 1}), "one picture");
  refused("P5 2 1 65536\n" + bytes_of({1, 1}), "greatest value");
  refused("P5 0 1 255\n", "width");
  refused("P5 99999 99999 255\n", "too many");
  refused("P2 5000 5000 255\n1", "ends before");
  refused("P5", "width");
}

TEST_CASE("PFMs of both byte orders give the same values, from the bottom row up") {
  const std::vector<std::vector<float>> rows{{1.5f, 0.0f}, {2.25f, 1e-10f}, {-0.0f, 3e38f}};
  for (const char* factor : {"1.0", "-1.0"}) {
    INFO(factor);
    const GreyImage image = parse_image(pfm_bytes(rows, factor), "a.pfm");
    CHECK(image.format == "PFM");
    CHECK_FALSE(image.has_white);
    CHECK(image.rows == 3);
    REQUIRE(image.values.size() == 6);
    CHECK(image.value(0, 0) == 1.5);
    CHECK(image.value(1, 0) == 2.25);
    CHECK(image.value(1, 1) == static_cast<double>(1e-10f));
    CHECK(image.value(2, 0) == 0);
    CHECK(image.value(2, 1) == static_cast<double>(3e38f));
  }
  const GreyImage factored = parse_image(pfm_bytes({{3.0f}}, "-0.5"), "a.pfm");
  CHECK(factored.values == std::vector<double>{1.5});
  CHECK(factored.stated_factor == 0.5);
}

TEST_CASE("PFMs with values that are no irradiance are refused with row and column from the top left") {
  const float infinite = std::numeric_limits<float>::infinity(),
              nan = std::numeric_limits<float>::quiet_NaN();
  refused(pfm_bytes({{1, 1, 1}, {1, -1e-20f, 1}}, "-1"), "row 2, column 2: the value is negative");
  refused(pfm_bytes({{1, 1, infinite}, {1, 1, 1}}, "1"), "row 1, column 3: the value is not finite");
  refused(pfm_bytes({{nan}}, "-1"), "not finite");
  refused("Pf 2 1 -1\nabcdefg", "7 bytes of pixels, where 8 belong");
  refused("Pf 2 1 -1\nabcdefghi", "9 bytes of pixels, where 8 belong");
  refused("Pf 2 1 0\nabcdefgh", "factor");
  refused("Pf 2 1 x\nabcdefgh", "factor");
  refused("Pf 2 1 nan\nabcdefgh", "factor");
  refused("Pf 2\n", "height");
  refused("Pf 1000000 1000000 -1\n", "too many");
  refused("PF 1 1 -1\nabcdabcdabcd", "three colours");
}

TEST_CASE("what is no picture is refused by name, and a file is read as its bytes") {
  refused("", "no picture that is known");
  refused("hello", "no picture that is known");
  refused(bytes_of({0xFF, 0xD8, 0xFF, 0xE0}), "a JPEG");
  refused("P6 1 1 255\nabc", "a PPM of three colours");
  const TemporaryFolder folder;
  write_whole(folder / "a.pgm", "P2 1 1 4 3");
  CHECK(read_image(folder / "a.pgm").values == std::vector<double>{0.75});
  CHECK_THROWS_WITH(read_image(folder / "none.pgm"), Catch::Contains("none.pgm"));
}
