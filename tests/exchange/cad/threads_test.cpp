#include <array>
#include <catch2/catch.hpp>
#include <thread>

#include "cad/export.h"
#include "cad/profile_import.h"
#include "support/cad/sample_profiles.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using test::TemporaryFolder;

// unsanitized: readers are forked, and asan's allocator may then be locked by another thread for ever
TEST_CASE("Four threads export and import at once, each its own mirror, all right", "[unsanitized]") {
  const TemporaryFolder folder;
  constexpr int rounds = 6;
  std::array<int, 4> right{};
  std::array<std::string, 4> trouble;
  const auto work = [&](std::size_t which) {
    try {
      for (int i = 0; i < rounds; ++i) {
        const Profile profile = test::wavy_profile(static_cast<int>(which) + 2, i % 2 == 0);
        cad::ExportOptions options;
        // Units differ between threads: a setting that leaks shows as a factor.
        options.unit = which % 2 == 0 ? LengthUnit::millimetre : LengthUnit::inch;
        const char* extension = (i + static_cast<int>(which)) % 2 == 0 ? ".step" : ".igs";
        const auto path = folder / (std::to_string(which) + "_" + std::to_string(i) + extension);
        cad::export_reflector(profile, path, options);
        const Profile back = cad::import_profile(path).profile;
        double difference = back.degree() == profile.degree() ? 0 : 1;
        for (std::size_t k = 0; k < profile.points().size(); ++k)
          difference = std::max(difference, std::abs(back.points()[k].r_mm - profile.points()[k].r_mm));
        right[which] += difference < 1e-12;
      }
    } catch (const std::exception& error) {
      trouble[which] = error.what();
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < right.size(); ++i) threads.emplace_back(work, i);
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < right.size(); ++i) {
    CAPTURE(i, trouble[i]);
    CHECK(right[i] == rounds);
  }
}
