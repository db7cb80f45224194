#include "base/ranks.h"

#include <catch2/catch.hpp>
#include <limits>
#include <string>
#include <vector>

#include "base/byte_record.h"
#include "base/errors.h"
#include "base/recorded_ranks.h"

using namespace catoptric;

TEST_CASE("values come back from bytes as they were to the last bit") {
  const std::vector<std::vector<double>> rows{{1.5, -0.0, std::numeric_limits<double>::denorm_min()}, {}};
  const std::string text("with\0zero", 9);
  const Bytes bytes = ByteWriter().put(rows).put(text).put(7).put(std::vector<std::string>{"a", ""}).take();
  ByteReader reader(bytes);
  const auto again = reader.get<std::vector<std::vector<double>>>();
  CHECK(again == rows);
  CHECK(std::signbit(again[0][1]));
  CHECK(reader.get<std::string>() == text);
  CHECK(reader.get<int>() == 7);
  CHECK(reader.get<std::vector<std::string>>() == std::vector<std::string>{"a", ""});
  CHECK(reader.at_end());
  CHECK_THROWS_AS(reader.get<char>(), std::runtime_error);
}

TEST_CASE("bytes that end early are refused and not read past") {
  const Bytes bytes = ByteWriter().put(std::vector<double>{1, 2, 3}).take();
  const Bytes cut = bytes.substr(0, bytes.size() - 1);
  CHECK_THROWS_AS(ByteReader(cut).get<std::vector<double>>(), std::runtime_error);
  const Bytes lie = ByteWriter().put(std::numeric_limits<std::uint64_t>::max()).take();
  CHECK_THROWS_AS(ByteReader(lie).get<std::string>(), std::runtime_error);
}

namespace {

/// Work of several joins, one of them within a task and one that fails.
std::string work(Ranks& ranks, int& computed) {
  std::string all;
  for (const Bytes& each : ranks.share(3, [&](std::size_t i) {
         ++computed;
         return ranks.from_first([&] { return std::to_string(i); }) + "!";
       }))
    all += each;
  try {
    ranks.share(2, [&](std::size_t i) -> Bytes {
      ++computed;
      throw CadError({"task " + std::to_string(i), "a place", "a rule", "a hint"});
    });
  } catch (const CadError& error) {
    all += error.what();
  }
  return all + ranks.from_first([&] {
    ++computed;
    return Bytes("end");
  });
}

}  // namespace

TEST_CASE("recorded work is repeated elsewhere without computing a task") {
  int alone = 0, recorded = 0, repeated = 0;
  Ranks one;
  const std::string expected = work(one, alone);
  RecordingRanks recording;
  CHECK(work(recording, recorded) == expected);
  RepeatingRanks repeating(recording.log());
  CHECK(work(repeating, repeated) == expected);
  CHECK(alone == 5);
  CHECK(recorded == alone);
  CHECK(repeated == 0);
  CHECK_THROWS_AS(repeating.from_first([] { return Bytes(); }), std::runtime_error);
}
