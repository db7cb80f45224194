#include "photometry/lm63.h"

#include <catch2/catch.hpp>

#include "support/photometric_texts.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::photometry;
using namespace catoptric::test;

namespace {

const std::string lamps = "1 1000 1 3 1 1 2 0 0 0\n1 1 10";
const std::string one_plane = "0 45 90\n0\n100 50 10";

std::vector<double> planes_of(const std::string& horizontal, const std::string& candela, int count,
                              const std::string& first = "IESNA:LM-63-2002\n") {
  const std::string counts = "1 1000 1 2 " + std::to_string(count) + " 1 2 0 0 0\n1 1 10";
  return intensity_of(
             parse_lm63(small_ies(first, counts, "0 90\n" + horizontal + "\n" + candela), "a.ies").file)
      .c_deg();
}

}  // namespace

TEST_CASE("each edition is told by its first line") {
  const auto version = [](const std::string& first) {
    return parse_lm63(small_ies(first, lamps, one_plane), "a.ies").file.version;
  };
  CHECK(version("") == Lm63Version::of_1986);
  CHECK(version("IESNA91\n") == Lm63Version::of_1991);
  CHECK(version("IESNA:LM-63-1995\n") == Lm63Version::of_1995);
  CHECK(version("IESNA:LM-63-2002 \r\n") == Lm63Version::of_2002);
  CHECK(version("\xEF\xBB\xBFIES:LM-63-2019\n") == Lm63Version::of_2019);
  CHECK_THROWS_WITH(version("IESNA:LM-63-2031\n"), Catch::Contains("IESNA:LM-63-2031"));
}

TEST_CASE("an IES file is read field by field, and a sound one gives no note") {
  const Lm63Reading reading = parse_lm63(sound_ies(), "a.ies");
  CHECK(reading.notes.empty());
  const Lm63File& file = reading.file;
  CHECK(file.keywords.size() == 4);
  CHECK(file.lamp_count == 1);
  CHECK(file.lumens_per_lamp == 1000);
  CHECK(file.type == PhotometricType::c);
  CHECK(file.units == Lm63Units::metres);
  CHECK(file.vertical_deg == std::vector<double>{0, 45, 90});
  CHECK(file.horizontal_deg == std::vector<double>{0, 90});
  CHECK(file.candela == std::vector<double>{100, 50, 0, 200, 60, 10});
  CHECK(file.input_w == 10);
  CHECK(opening_of(file) == LuminousOpening{200, 100, 0, false});
}

TEST_CASE("factors multiply candela once each, and the code of 2019 is none") {
  const auto at_nadir = [](const std::string& first) {
    const std::string text = small_ies(first, "2 -1 3 3 1 1 1 -1 0 2\n0.5 1.25 10", one_plane);
    return intensity_of(parse_lm63(text, "a.ies").file).at(0, 0);
  };
  CHECK(at_nadir("IESNA:LM-63-2002\n") == 100 * 3 * 0.5 * 1.25);
  CHECK(at_nadir("IES:LM-63-2019\n") == 100 * 3 * 0.5);
  const Lm63File file =
      parse_lm63(small_ies("IESNA91\n", "2 -1 3 3 1 1 1 -1 0 2\n0.5 1.25 10", one_plane), "a.ies").file;
  CHECK(!file.lumens_per_lamp);
  CHECK(opening_of(file) == LuminousOpening{304.8, 304.8, 609.6, true});  // feet, round
}

TEST_CASE("keywords, continued by MORE, and labels of 1986 are kept") {
  const std::string header =
      "IES:LM-63-2019\n[test] 5\n[OTHER] first\n[MORE] second\nno keyword\nTILT=NONE\n";
  const Lm63Reading reading = parse_lm63(header + lamps + "\n" + one_plane, "a.ies");
  CHECK(reading.file.keywords == std::vector<Lm63Keyword>{{"TEST", "5"}, {"OTHER", "first\nsecond"}});
  REQUIRE(reading.notes.size() == 4);  // the line, and three keywords that are missing
  CHECK_THAT(reading.notes[0], Catch::Contains("Line 5"));
  CHECK_THAT(reading.notes[1], Catch::Contains("[MANUFAC]"));
  const Lm63Reading old =
      parse_lm63("A lamp\n[TEST] is text here\nTILT=NONE\n" + lamps + "\n" + one_plane, "a");
  CHECK(old.notes.empty());
  CHECK(old.file.keywords == std::vector<Lm63Keyword>{{"", "A lamp"}, {"", "[TEST] is text here"}});
}

TEST_CASE("values wrap and are separated at will") {
  const std::string text =
      small_ies("IESNA91\r\n", "1,1000,+1.0,3\r\n1 1 2, 0 0 .0 1\n1\t10", "0\n45 90 0\n1e2,\n\n50\t10.");
  CHECK(parse_lm63(text, "a.ies").file.candela == std::vector<double>{100, 50, 10});
}

TEST_CASE("text that is no UTF-8 is taken for Latin-1, and the note says so") {
  const std::string text = replaced(sound_ies(), "[MANUFAC] us", "[MANUFAC] M\xFCller");
  const Lm63Reading reading = parse_lm63(text, "a.ies");
  CHECK(reading.file.keywords.back().value == "M\xC3\xBCller");
  REQUIRE(reading.notes.size() == 1);
  CHECK_THAT(reading.notes[0], Catch::Contains("Latin-1"));
  CHECK(parse_lm63(replaced(text, "\xFC", "\xC3\xBC"), "a.ies").notes.empty());
}

TEST_CASE("symmetric planes are spread over the full turn") {
  CHECK(planes_of("0", "1 2", 1) == std::vector<double>{0});
  CHECK(planes_of("0 30 90", "1 2 3 4 5 6", 3) == std::vector<double>{0, 30, 90, 150, 180, 210, 270, 330});
  CHECK(planes_of("0 30 180", "1 2 3 4 5 6", 3) == std::vector<double>{0, 30, 180, 330});
  CHECK(planes_of("0 30 360", "1 2 3 4 1 2", 3) == std::vector<double>{0, 30});
  CHECK(planes_of("0 120 240", "1 2 3 4 5 6", 3) == std::vector<double>{0, 120, 240});
  CHECK(planes_of("90 120 180 270", "1 2 3 4 5 6 7 8", 4) == std::vector<double>{0, 60, 90, 120, 180, 270});
  CHECK(planes_of("90 180 200 270", "1 2 3 4 5 6 7 8", 4) == std::vector<double>{0, 90, 180, 200, 270, 340});
  CHECK(planes_of("90 120 270", "1 2 3 4 5 6", 3) == std::vector<double>{0, 60, 90, 120, 270});
}

TEST_CASE("a spread plane has the values of its mirror image") {
  const auto table = [](const std::string& horizontal, const std::string& candela, int count) {
    const std::string counts = "1 1000 1 2 " + std::to_string(count) + " 1 2 0 0 0\n1 1 10";
    return intensity_of(
        parse_lm63(small_ies("IESNA:LM-63-2002\n", counts, "0 90\n" + horizontal + "\n" + candela), "a")
            .file);
  };
  const IntensityTable quadrant = table("0 30 90", "0 2 0 4 0 6", 3);
  for (const double c : {30, 150, 210, 330}) CHECK(quadrant.at(90, c) == 4);
  CHECK(quadrant.at(90, 180) == 2);
  CHECK(quadrant.at(90, 270) == 6);
  const IntensityTable half = table("0 30 180", "0 2 0 4 0 6", 3);
  CHECK(half.at(90, 330) == 4);
  CHECK(half.at(90, 180) == 6);
  const IntensityTable about_c90 = table("90 120 180 270", "0 2 0 4 0 6 0 8", 4);
  CHECK(about_c90.at(90, 60) == 4);
  CHECK(about_c90.at(90, 0) == 6);
  CHECK(about_c90.at(90, 270) == 8);
  const IntensityTable no_180 = table("90 120 270", "0 2 0 4 0 8", 3);
  CHECK(no_180.at(90, 0) == Approx(std::lerp(8.0, 4.0, 90.0 / 150)));
  CHECK(no_180.at(90, 180) == Approx(std::lerp(4.0, 8.0, 60.0 / 150)));
}

TEST_CASE("tilt is read from the file or from one beside it, and told") {
  const std::string tilt = "1\n3\n0 45 90\n1 0.9 0.8\n";
  const std::string included = replaced(sound_ies(), "TILT=NONE\n", "TILT=INCLUDE\n" + tilt);
  const Lm63Reading reading = parse_lm63(included, "a.ies");
  REQUIRE(reading.file.tilt);
  CHECK(reading.file.tilt->factors == std::vector<double>{1, 0.9, 0.8});
  REQUIRE(reading.notes.size() == 1);
  CHECK_THAT(reading.notes[0], Catch::Contains("were not applied"));

  const TemporaryFolder folder;
  const std::string named = replaced(sound_ies(), "TILT=NONE", "TILT=lamp.tlt");
  write_whole(folder / "a.ies", named);
  CHECK_THROWS_WITH(read_lm63(folder / "a.ies"),
                    Catch::Contains("a.ies:6, TILT") && Catch::Contains("not beside"));
  write_whole(folder / "lamp.tlt", tilt);
  CHECK(read_lm63(folder / "a.ies").file == reading.file);
  CHECK_THROWS_WITH(parse_lm63(named, "a.ies"), Catch::Contains("not beside"));
  CHECK_THROWS_WITH(parse_lm63(replaced(named, "lamp.tlt", "../lamp.tlt"), "a.ies", folder.path()),
                    Catch::Contains("not beside"));
  CHECK_THROWS_WITH(parse_lm63(replaced(named, "IESNA:LM-63-2002", "IES:LM-63-2019"), "a.ies", folder.path()),
                    Catch::Contains("in 2019"));
}
