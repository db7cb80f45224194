#include <catch2/catch.hpp>

#include "base/errors.h"
#include "photometry/lm63.h"
#include "support/photometric_texts.h"

using namespace catoptric;
using namespace catoptric::photometry;
using namespace catoptric::test;

namespace {

/// Refuses the sound file after one change, with every part of the message.
void refused(const std::string& from, const std::string& to, const std::string& where,
             const std::string& why) {
  const std::string text = replaced(sound_ies(), from, to);
  INFO(from << " -> " << to);
  REQUIRE(!text.empty());
  try {
    parse_lm63(text, "a.ies");
    FAIL_CHECK("accepted");
  } catch (const InputError& error) {
    CHECK(error.parts().where == where);
    CHECK_THAT(error.what(), Catch::Contains(why));
  }
}

}  // namespace

TEST_CASE("an IES file that breaks a rule is refused with line and field") {
  refused("1 1000 1 3", "0 1000 1 3", "a.ies:7, number of lamps", "whole number");
  refused("1 1000 1 3", "1 0 1 3", "a.ies:7, lumens per lamp", "-1 stands for absolute");
  refused("1 1000 1 3", "1 1000 -1 3", "a.ies:7, candela multiplier", "above 0");
  refused("1 1000 1 3", "1 1000 nan 3", "a.ies:7, candela multiplier", "no finite number");
  refused("1 1000 1 3", "1 1000 1e400 3", "a.ies:7, candela multiplier", "no finite number");
  refused("1 1000 1 3", "1 1000 1e99 3", "a.ies:12, candela multiplier", "1e100");
  refused("1 1000 1 3", "1 1000 1 2.5", "a.ies:7, number of vertical angles", "whole number");
  refused("1 1000 1 3", "1 1000 1 1", "a.ies:7, number of vertical angles", "from 2");
  refused("3 2 1 2 0.1", "3 2 4 2 0.1", "a.ies:7, photometric type", "from 1 to 3");
  refused("3 2 1 2 0.1", "3 2 1 0 0.1", "a.ies:7, units type", "from 1 to 2");
  refused("1 1 10", "0 1 10", "a.ies:8, ballast factor", "above 0");
  refused("1 1 10", "1 1 -10", "a.ies:8, input watts", "not negative");
  refused("0 45 90", "0 95 90", "a.ies:9, vertical angles", "ascend");
  refused("0 45 90", "0 45 45", "a.ies:9, vertical angles", "none is there twice");
  refused("0 45 90", "0 45 60", "a.ies:9, vertical angles", "from 0 to 90");
  refused("\n0 90\n", "\n0 60\n", "a.ies:10, horizontal angles", "from 0 to 90, 180 or 360");
  refused("200 60 10", "200 -60 10", "a.ies:12, candela value at vertical angle 45, horizontal angle 90",
          "not negative");
  refused("200 60 10", "200 inf 10", "a.ies:12, candela values", "no finite number");
  refused("200 60 10", "200 6O 10", "a.ies:12, candela values", "\"6O\" is no finite number");
}

TEST_CASE("wrong counts and truncated IES files are refused") {
  refused("200 60 10\n", "200 60\n", "a.ies:13, candela values", "the file ends here");
  refused("200 60 10\n", "200 60 10 11\n", "a.ies:12, candela values", "follows the last");
  refused("1 1000 1 3", "1 1000 1 4", "a.ies:10, vertical angles", "ascend");
  const std::string sound = sound_ies();
  for (std::size_t length = 0; length + 2 < sound.size(); ++length) {
    INFO(length);
    CHECK_THROWS_AS(parse_lm63(sound.substr(0, length), "a.ies"), InputError);
  }
  CHECK_THROWS_WITH(parse_lm63("hello\n", "a.ies"), Catch::Contains("TILT="));
  CHECK_THROWS_WITH(parse_lm63(std::string("I\0E\0S\0", 6), "a.ies"), Catch::Contains("NUL"));
}

TEST_CASE("counts without end are refused before there is room for them") {
  refused("1 1000 1 3 2", "1 1000 1 10000001 2", "a.ies:7, number of vertical angles", "10000000");
  refused("1 1000 1 3 2", "1 1000 1 10000 10000", "a.ies:7, number of horizontal angles", "10000000 values");
  refused("1 1000 1 3 2", "1 1000 1 1000000 2", "a.ies:8, vertical angles", "room for");
}

TEST_CASE("what is common and harmless in an IES file is accepted and told") {
  const auto note = [](const std::string& from, const std::string& to, const std::string& part) {
    const Lm63Reading reading = parse_lm63(replaced(sound_ies(), from, to), "a.ies");
    INFO(to);
    REQUIRE(reading.notes.size() == 1);
    CHECK_THAT(reading.notes[0], Catch::Contains(part));
  };
  note("200 60 10\n", "200 60 10\nEND\n", "Text behind the last");
  note("1 1 10", "1 0 10", "ballast-lamp factor is 0");
  note("[TEST] 1\n", "[MORE] lost\n[TEST] 1\n", "nothing to continue");
  note("[TEST] 1\n", "[TEST] " + std::string(300, 'x') + "\n", "longer than 254 bytes");
}

TEST_CASE("a plane at 360 degrees may differ a little from the one at 0, and no more") {
  const auto closing = [](const std::string& value) {
    return parse_lm63(small_ies("IESNA:LM-63-2002\n", "1 1000 1 2 3 1 2 0 0 0\n1 1 10",
                                "0 90\n0 180 360\n100 0 50 0 " + value + " 0"),
                      "a.ies");
  };
  CHECK(closing("100").notes.empty());
  const Lm63Reading near = closing("101");
  REQUIRE(near.notes.size() == 1);
  CHECK_THAT(near.notes[0], Catch::Contains("differs by up to 1"));
  CHECK(intensity_of(near.file).at(0, 0) == 100);
  CHECK_THROWS_WITH(closing("110"), Catch::Contains("both are the same plane"));
}
