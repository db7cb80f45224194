#include "rayfiles/ray_file_writer.h"

#include <catch2/catch.hpp>
#include <limits>

#include "base/errors.h"
#include "support/ray_bytes.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::rayfiles;
using namespace catoptric::test;

namespace {

/// Reads a file and writes what was read.
std::string rewritten(const TemporaryFolder& folder, const std::string& content) {
  write_whole(folder / "in", content);
  const auto file = RayFile::open(folder / "in");
  RayFileWriter writer(folder / "out", file->file_header());
  std::vector<float> ray(file->columns().size());
  for (std::uint64_t i = 0; i < file->count(); ++i) {
    for (std::size_t k = 0; k < ray.size(); ++k) ray[k] = file->stored(i, k);
    writer.add(ray);
  }
  writer.commit();
  return read_whole(folder / "out");
}

}  // namespace

TEST_CASE("what is read from a hand-made file is written to the same bytes") {
  const TemporaryFolder folder;
  for (const std::string& content :
       {tm25_file(3, three_rays()), zemax_file(3, 1, 0, 1, three_rays()),
        zemax_file(2, 4, 2, 0, {1, 2, 3, 0, 0, 1, 5, 0.5f, 4, 5, 6, 1, 0, 0, 7, 0.6f})})
    CHECK(rewritten(folder, content) == content);
}

TEST_CASE("numbers of no use to us are written to the bit, NaN included") {
  const TemporaryFolder folder;
  Bytes file;
  file.text(with_u32(tm25_file(1, {}), 80, 1), 36288).wide(U"age", 512);
  file.floats({0, 0, 0, 0, 0, 1, 3}).u32(signalling_nan);
  CHECK(rewritten(folder, file.str()) == file.str());
}

TEST_CASE("counts and totals that are left out are filled in") {
  const TemporaryFolder folder;
  Tm25Header tm25;
  tm25.has_luminous_flux = true;
  RayFileWriter writer(folder / "out", tm25);
  CHECK(writer.columns().size() == 8);
  writer.add(std::vector<float>{0, 0, 0, 0, 0, 1, 1, 100});
  writer.add(std::vector<float>{0, 0, 0, 0, 0, 1, 2, 300});
  writer.commit();
  const auto luminous = RayFile::open(folder / "out", LightQuantity::luminous);
  CHECK(luminous->count() == 2);
  CHECK(luminous->header().total_flux == 400.0);
  CHECK(RayFile::open(folder / "out")->header().total_flux == 3.0);

  RayFileWriter zemax(folder / "out", ZemaxHeader{});
  zemax.add(std::vector<float>{0, 0, 0, 0, 0, 1, 5});
  zemax.commit();
  CHECK(RayFile::open(folder / "out")->header().total_flux == 5.0);
}

TEST_CASE("a file appears when it is whole, or not at all") {
  const TemporaryFolder folder;
  {
    RayFileWriter writer(folder / "out", Tm25Header{});
    writer.add(std::vector<float>{0, 0, 0, 0, 0, 1, 1});
    CHECK(!std::filesystem::exists(folder / "out"));
  }
  CHECK(folder.is_empty());
  CHECK_THROWS_WITH(RayFileWriter(folder / "out", Tm25Header{}).commit(), Catch::Contains("no rays"));
  CHECK(folder.is_empty());
  CHECK_THROWS_AS(RayFileWriter(folder / "none" / "out", Tm25Header{}), IoError);
}

TEST_CASE("what a reader would refuse is not written") {
  const TemporaryFolder folder;
  RayFileWriter writer(folder / "out", Tm25Header{});
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refused = [&](const std::vector<float>& ray, const char* part) {
    CHECK_THROWS_WITH(writer.add(ray), Catch::Contains(part) && Catch::Contains("ray 0"));
  };
  refused({nan, 0, 0, 0, 0, 1, 1}, "start point");
  refused({0, 0, 0, 0, 0, 0, 1}, "no length");
  refused({0, 0, 0, 0, 0, 2, 1}, "unit length");
  refused({0, 0, 0, 0, 0, 1, -1}, "negative");
  Tm25Header dark;
  dark.has_radiant_flux = false;
  CHECK_THROWS_WITH(RayFileWriter(folder / "out", dark), Catch::Contains("no flux"));
}

TEST_CASE("a disk that is full is told") {
  if (!std::filesystem::exists("/dev/full")) return;
  const TemporaryFolder folder;
  // The writer's temporary name is a link to a device that is always full.
  const PendingFile name(folder / "out.dat");
  const auto temporary = name.temporary_path();
  std::filesystem::remove(temporary);
  std::filesystem::create_symlink("/dev/full", temporary);
  const auto write = [&] {
    RayFileWriter writer(folder / "out.dat", ZemaxHeader{});
    for (int i = 0; i < 100000; ++i) writer.add(std::vector<float>{0, 0, 0, 0, 0, 1, 1});
    writer.commit();
  };
  CHECK_THROWS_AS(write(), IoError);
  CHECK(!std::filesystem::exists(folder / "out.dat"));
}
