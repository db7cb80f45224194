#include <catch2/catch.hpp>

#include "base/random_stream.h"
#include "fuzz/targets/rayfile.h"
#include "support/ray_bytes.h"

using namespace catoptric;
using namespace catoptric::test;

TEST_CASE("ray files with a few changed bytes are read, or refused in words", "[long]") {
  std::string tm25 = "\1" + tm25_file(3, three_rays());
  tm25.erase(1 + 288, 36000);  // as the target takes them
  const std::string zemax = std::string(1, '\0') + zemax_file(3, 4, 0, 0, three_rays());
  RandomStream random(1, Purpose::test, 0);
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
  };
  for (int i = 0; i < 20'000; ++i) {
    std::string file = i % 2 == 0 ? tm25 : zemax;
    for (std::size_t changes = 1 + below(3); changes > 0; --changes)
      file[1 + below(file.size() - 1)] = static_cast<char>(random.bits());
    if (below(10) == 0) file.resize(1 + below(file.size()));
    REQUIRE_NOTHROW(fuzz::try_rayfile(file));
  }
}
