#include "rayfiles/ray_file.h"

#include <sys/stat.h>

#include <catch2/catch.hpp>

#include "base/errors.h"
#include "support/ray_bytes.h"
#include "support/temporary_folder.h"

using namespace catoptric;
using namespace catoptric::rayfiles;
using namespace catoptric::test;

namespace {

/// A file with the content, opened; the file is gone with the folder.
std::shared_ptr<const RayFile> opened(const TemporaryFolder& folder, const std::string& content,
                                      std::optional<LightQuantity> wanted = {}) {
  write_whole(folder / "rays", content);
  return RayFile::open(folder / "rays", wanted);
}

}  // namespace

TEST_CASE("a TM-25 file is opened by its content, and its rays are read") {
  const TemporaryFolder folder;
  const auto file = opened(folder, tm25_file(3, three_rays()));
  const RaySetHeader& header = file->header();
  CHECK(header.format == "IES TM-25-13");
  CHECK(header.title == "LED \xC2\xB5");
  CHECK(header.quantity == LightQuantity::radiant);
  CHECK(header.total_flux == 3.0);
  CHECK(header.count == 3);
  CHECK(header.millimetres_per_unit == 1);
  CHECK(header.wavelength_nm == 550.0);
  CHECK(header.notes.empty());
  const SourceRay ray = file->ray(1);
  CHECK(ray.position_mm == Vector3(4, 5, 6));
  CHECK((ray.direction - Vector3(0.6, 0, -0.8)).norm() < 1e-7);  // floats
  CHECK(std::abs(ray.direction.norm() - 1) < 1e-15);
  CHECK(ray.flux == 2);
  CHECK(file->flux(2) == 0);
  CHECK(file->stored(2, 1) == 8.0f);
}

TEST_CASE("Zemax files are read in all units, in watts and in lumens") {
  const TemporaryFolder folder;
  const double millimetres[] = {1000, 25.4, 10, 304.8, 1};
  for (const std::uint32_t unit : {0, 1, 2, 3, 4})
    for (const std::uint32_t flux : {0, 1}) {
      const auto file = opened(folder, zemax_file(3, unit, 0, flux, three_rays()));
      INFO(unit << " " << flux);
      CHECK(file->header().format == "Zemax binary");
      CHECK(file->header().quantity == (flux == 0 ? LightQuantity::radiant : LightQuantity::luminous));
      CHECK(file->header().total_flux == 3.0);
      CHECK(*file->header().wavelength_nm == Approx(550));
      CHECK((file->ray(1).position_mm - millimetres[unit] * Vector3(4, 5, 6)).norm() <
            1e-12 * millimetres[unit]);
      CHECK(file->ray(1).flux == 2);
    }
}

TEST_CASE("rays of the spectral Zemax format have eight numbers") {
  const TemporaryFolder folder;
  const auto file =
      opened(folder, zemax_file(2, 4, 2, 0, {1, 2, 3, 0, 0, 1, 5, 0.5f, 4, 5, 6, 1, 0, 0, 7, 0.6f}));
  CHECK(file->ray(1).position_mm == Vector3(4, 5, 6));
  CHECK(file->ray(1).flux == 7);
  CHECK(file->stored(1, 7) == 0.6f);
  CHECK(!file->header().wavelength_nm);
}

TEST_CASE("of a TM-25 file with both fluxes the wanted one is read") {
  const TemporaryFolder folder;
  std::string content = tm25_file(2, {0, 0, 0, 0, 0, 1, 5, 500, 0, 0, 0, 0, 0, 1, 6, 600});
  content = with_f32(with_u32(content, 256 + 16, 1), 12, 1100.0f);
  const auto radiant = opened(folder, content);
  CHECK(radiant->header().quantity == LightQuantity::radiant);
  CHECK(radiant->header().total_flux == 3.0);
  CHECK(radiant->flux(1) == 6);
  CHECK(radiant->header().notes.size() == 1);
  const auto luminous = opened(folder, content, LightQuantity::luminous);
  CHECK(luminous->header().quantity == LightQuantity::luminous);
  CHECK(luminous->header().total_flux == 1100.0);
  CHECK(luminous->flux(1) == 600);
  CHECK_THROWS_WITH(opened(folder, tm25_file(3, three_rays()), LightQuantity::luminous),
                    Catch::Contains("no luminous flux"));
  CHECK_THROWS_WITH(opened(folder, zemax_file(3, 4, 0, 1, three_rays()), LightQuantity::radiant),
                    Catch::Contains("no radiant flux"));
}

TEST_CASE("a total flux that is absent is none") {
  const TemporaryFolder folder;
  CHECK(!opened(folder, with_u32(tm25_file(3, three_rays()), 16, signalling_nan))->header().total_flux);
  CHECK(!opened(folder, with_u32(zemax_file(3, 4, 0, 0, three_rays()), 112, signalling_nan))
             ->header()
             .total_flux);
}

TEST_CASE("a file with fewer rays than it says is refused, one with more bytes noted") {
  const TemporaryFolder folder;
  for (const std::string& whole : {tm25_file(3, three_rays()), zemax_file(3, 4, 0, 0, three_rays())}) {
    for (std::size_t less = 1; less <= 84; ++less)
      CHECK_THROWS_WITH(
          opened(folder, whole.substr(0, whole.size() - less)),
          Catch::Contains("the header says 3 rays, the file holds " + std::to_string((84 - less) / 28)));
    CHECK(opened(folder, whole + "abc")->header().notes.at(0) == "3 bytes behind the last ray are ignored");
  }
}

TEST_CASE("a number of rays whose bytes overflow is refused") {
  const TemporaryFolder folder;
  for (const std::uint64_t count : {std::uint64_t{1} << 62, ~std::uint64_t{0}, ~std::uint64_t{0} / 28 + 2})
    CHECK_THROWS_WITH(opened(folder, tm25_file(count, three_rays())), Catch::Contains("the file holds 3"));
  CHECK_THROWS_WITH(opened(folder, tm25_file(0, three_rays())), Catch::Contains("there are no rays"));
}

TEST_CASE("a ray file cut at any byte of its header, or of another format, is refused with file and hint") {
  const TemporaryFolder folder;
  const std::string zemax = zemax_file(3, 4, 0, 0, three_rays());
  for (std::size_t size = 0; size < 208; ++size)
    CHECK_THROWS_AS(opened(folder, zemax.substr(0, size)), InputError);
  const std::string tm25 = tm25_file(3, three_rays());
  for (const std::size_t size : {1, 3, 4, 5, 100, 255, 256, 287, 288, 4288, 36287, 36288})
    CHECK_THROWS_AS(opened(folder, tm25.substr(0, size)), InputError);
  CHECK_THROWS_WITH(opened(folder, "3 4\n1 2 3 0 0 1 1\n"), Catch::Contains("looks like text"));
  CHECK_THROWS_WITH(opened(folder, "LTRF" + std::string(60, '\1')), Catch::Contains("LightTools"));
  CHECK_THROWS_WITH(opened(folder, std::string(300, '\1')), Catch::Contains("begin with \"TM25\""));
  CHECK_THROWS_WITH(opened(folder, ""), Catch::Contains("empty") && Catch::Contains("rays"));
}

TEST_CASE("what is no ordinary file is refused") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(RayFile::open(folder / "none"), Catch::Contains("cannot be opened"));
  CHECK_THROWS_WITH(RayFile::open(folder.path()), Catch::Contains("not a file"));
  const auto pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(RayFile::open(pipe), Catch::Contains("not a file"));
  CHECK_THROWS_WITH(RayFile::open(std::string("a\0b", 3)), Catch::Contains("NUL"));
}

TEST_CASE("a file that is cut or written to while it is open is told") {
  const TemporaryFolder folder;
  const std::string content = tm25_file(3, three_rays());
  const auto file = opened(folder, content);
  CHECK_NOTHROW(file->require_unchanged());
  std::filesystem::last_write_time(folder / "rays",
                                   std::filesystem::file_time_type::clock::now() + std::chrono::hours(1));
  CHECK_THROWS_WITH(file->require_unchanged(), Catch::Contains("it was written to"));
  std::filesystem::resize_file(folder / "rays", content.size() - 1);
  CHECK_THROWS_WITH(file->require_unchanged(),
                    Catch::Contains("has changed") && Catch::Contains(" bytes and has "));
}

TEST_CASE("the place of a ray is file, number, byte and name") {
  const TemporaryFolder folder;
  const auto file = opened(folder, tm25_file(3, three_rays()));
  CHECK(file->place(2, RayField::flux) == (folder / "rays").string() + ", ray 2 (the first is 0), byte " +
                                              std::to_string(36288 + 56 + 24) + ", phi");
  CHECK_THAT(file->place(0, RayField::direction), Catch::EndsWith("byte 36300, kx to kz"));
}

TEST_CASE("a file of a thousand million rays opens without being read") {
  const TemporaryFolder folder;
  constexpr std::uint64_t count = 1'000'000'000;
  write_whole(folder / "rays", tm25_file(count, {}));
  std::filesystem::resize_file(folder / "rays", 36288 + 28 * count);  // a hole, which takes no room
  const auto file = RayFile::open(folder / "rays");
  CHECK(file->count() == count);
  CHECK(file->ray(count - 1).flux == 0);
  CHECK_THAT(file->place(count - 1, RayField::flux), Catch::EndsWith("byte 28000036284, phi"));
}
