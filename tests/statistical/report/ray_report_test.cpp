#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "base/units.h"
#include "design/stage.h"
#include "rayfiles/ray_file.h"
#include "report/ray_report.h"
#include "sim/frame.h"
#include "sim/light_rays.h"
#include "support/statistics.h"
#include "support/temporary_folder.h"

/// Ray files that are written: the law of the rays in them, and the light that they bring as a source.

using namespace catoptric;
using namespace catoptric::design;

namespace {

/// A small mirror with a lamp that is neither on its axis nor along it.
Scene scene(const std::string& source, const std::string& more = "") {
  return make_scene(Settings::parse(
      "unit = \"cm\"\nreflector.points = [[0.5, 10], [5, 10], [10, 5]]\nreflector.reflectance = 0.8\n"
      "near_field.radius = 5\n" +
          source + more,
      "test.toml", scene_keys()));
}
const std::string disc =
    "[source]\nkind = \"disc\"\nradius = 2\nposition = [1, 0.5, 5]\naxis = [0.3, 0.1, 1]\nflux = 700.1\n";
const std::string plain = "[model]\nsampler = \"random\"\n[rays]\ncount = 400000\n";

/// Which of so many even steps a number in [0, 1) lies in.
std::size_t step_of(double share, int steps) {
  return static_cast<std::size_t>(std::clamp(static_cast<int>(share * steps), 0, steps - 1));
}
double turns(double y, double x) { return std::atan2(y, x) / (2 * pi) + 0.5; }

/// Rays of a Lambertian disc by place and direction, into boxes that get alike many.
std::vector<double> counts_of_disc(const rayfiles::RaySet& rays, double radius_mm,
                                   const Eigen::Matrix3d& frame) {
  std::vector<double> counts(256, 0);
  for (std::uint64_t i = 0; i < rays.count(); ++i) {
    const rayfiles::SourceRay ray = rays.ray(i);
    const Vector3 at = frame * ray.position_mm / radius_mm, to = frame * ray.direction;
    const std::array<double, 4> shares{at.head<2>().squaredNorm(), turns(at.y(), at.x()), to.z() * to.z(),
                                       turns(to.y(), to.x())};
    std::size_t box = 0;
    for (const double share : shares) box = 4 * box + step_of(share, 4);
    ++counts[box];
  }
  return counts;
}

/// Rays that leave, by their direction.
std::vector<double> departures(const Scene& lamp, std::uint64_t count, std::uint64_t seed) {
  constexpr int bands = 20, sectors = 6;
  std::vector<double> counts(bands * sectors, 0);
  const Stage stage(lamp, lamp.with(lamp.profile));
  sim::luminaire_rays(stage.scene, {count, sim::Sampler::random, seed}, [&](std::span<const Ray> rays) {
    for (const Ray& ray : rays)
      ++counts[step_of(0.5 + 0.5 * ray.direction.z(), bands) * sectors +
               step_of(turns(ray.direction.y(), ray.direction.x()), sectors)];
  });
  return counts;
}

/// p-value of two sets of counts having one law, where the second set was picked from a sample.
/// @in    picked: of the second set for each of the sample
double two_sample_p(const std::vector<double>& a, const std::vector<double>& b, double picked) {
  double sum = 0;
  std::size_t boxes = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] + b[i] < 40) continue;
    sum += (a[i] - b[i]) * (a[i] - b[i]) / (0.5 * (a[i] + b[i]) * (2 + picked));
    ++boxes;
  }
  return test::chi_square_tail(sum, boxes);
}

std::string with_file_at(std::string source_text, const std::filesystem::path& folder) {
  const std::string key = "file = \"";
  return source_text.insert(source_text.find(key) + key.size(), folder.string() + "/");
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

}  // namespace

TEST_CASE("rays of a tilted disc follow Lambert's law in its own frame") {
  const test::TemporaryFolder folder;
  for (const std::string format : {"tm25", "zemax"}) {
    CAPTURE(format);
    const Scene lamp = scene(disc, plain + "format = \"" + format + "\"\n");
    const auto [files, written] = report::write_rays(lamp, {}, folder.path());
    const auto rays = rayfiles::RayFile::open(folder / (format == "tm25" ? "source.tm25ray" : "source.dat"));
    REQUIRE(rays->count() == 400'000);
    CHECK(rays->header().quantity == LightQuantity::luminous);
    for (std::uint64_t i = 0; i < 1000; ++i) {
      CHECK(std::abs(rays->ray(i).position_mm.z()) < 1e-5);
      CHECK(rays->ray(i).direction.z() > -1e-6);
    }
    CHECK(test::plausible(test::chi_square_even_p(counts_of_disc(*rays, 20, Eigen::Matrix3d::Identity()))));
    // The twin has forgotten that the disc leans.
    CHECK(test::rejected(test::chi_square_even_p(counts_of_disc(*rays, 20, own_frame(lamp.source).axes))));
  }
}

TEST_CASE("a file of rays brings the light of the source that it was written from") {
  const test::TemporaryFolder folder;
  const std::string group =
      "source.position = [0.5, 0, 5]\n[sources.chip]\nkind = \"rectangle\"\nwidth = 2\nheight = 1\n"
      "along = [1, 1, 0]\naxis = [0, 0.2, 1]\npower = 3\n[sources.glow]\nkind = \"point\"\nexponent = 2\n"
      "position = [0, 1, 0.5]\naxis = [1, 0, 1]\npower = 1\n";
  for (const std::string& source : {disc, group}) {
    CAPTURE(source);
    const Scene lamp = scene(source, plain);
    const auto [files, written] = report::write_rays(lamp, {}, folder.path());
    CHECK(written.file_flux == Approx(lamp.source.power_w).epsilon(6e-8));  // a float's rounding, rays alike
    const std::string text = with_file_at(test::read_whole(folder / "source.toml"), folder.path());
    const Scene again = scene(text);
    CHECK(again.source.power_w == lamp.source.power_w);
    CHECK(again.source.quantity == lamp.source.quantity);
    constexpr std::uint64_t photons = 100'000;
    const double picked = static_cast<double>(photons) / 400'000;
    const std::vector<double> wanted = departures(lamp, photons, 11);
    CHECK(test::plausible(two_sample_p(wanted, departures(again, photons, 12), picked)));
    const std::string aside = replaced(text, "position = [", "position = [0.3, 0, 0]  # [");
    CHECK(test::rejected(two_sample_p(wanted, departures(scene(aside), photons, 12), picked)));
  }
}

TEST_CASE("each part of a file is a fair sample of all of it, Sobol points or not") {
  const test::TemporaryFolder folder;
  const Scene lamp = scene(disc, "[rays]\ncount = 262144\n");  // Sobol, as photons are
  report::write_rays(lamp, {}, folder.path());
  const auto rays = rayfiles::RayFile::open(folder / "source.tm25ray");
  // Eight neighbours in every sixty-four, as sets of photons take them.
  std::vector<double> part(16, 0), all(16, 0);
  for (std::uint64_t i = 0; i < rays->count(); ++i) {
    const Vector3 to = rays->ray(i).direction;
    const std::size_t band = step_of(to.z() * to.z(), 16);
    ++all[band];
    if (i % 64 < 8) ++part[band];
  }
  for (const double count : all) CHECK(std::abs(count - 16384) <= 40);  // evener than chance: sigma is 124
  CHECK(test::plausible(test::chi_square_even_p(part)));
}

TEST_CASE("a luminaire's rays carry what the mirror leaves of the light, from where they left it") {
  const test::TemporaryFolder folder;
  const Scene lamp = scene(disc, "[rays]\ncount = 20000\nof = \"luminaire\"\n");
  const auto [files, written] = report::write_rays(lamp, {}, folder.path());
  const auto rays = rayfiles::RayFile::open(folder / "luminaire.tm25ray");
  CHECK(rays->count() == written.output.rays);
  CHECK(written.output.emitted == 20000);
  const double left = written.file_flux / lamp.source.power_w;
  CHECK(left == Approx(static_cast<double>(rays->count()) / 20000).epsilon(1e-7));
  CHECK(left > 0.8);
  CHECK(left < 0.95);
  const Vector3 axis = lamp.source.axis.normalized();
  int from_source = 0, from_mirror = 0;
  for (std::uint64_t i = 0; i < rays->count(); ++i) {
    const Vector3 at = rays->ray(i).position_mm;
    if (std::abs((at - lamp.source.position_mm).dot(axis)) < 1e-4)
      ++from_source;
    else
      from_mirror += at.z() >= lamp.profile.z_min_mm() - 1e-3 && at.z() <= lamp.profile.z_max_mm() + 1e-3;
  }
  CHECK(from_source > 300);
  CHECK(from_source + from_mirror == static_cast<int>(rays->count()));
  const Scene again = scene(with_file_at(test::read_whole(folder / "source.toml"), folder.path()));
  CHECK(again.source.power_w == Approx(written.file_flux).epsilon(1e-7));
  CHECK(again.source.position_mm == Vector3::Zero());
}

TEST_CASE("a Zemax file of more rays than one can hold is refused before any is drawn") {
  const test::TemporaryFolder folder;
  CHECK_THROWS_WITH(
      report::write_rays(scene(disc, "[rays]\ncount = 4200000000\nformat = \"zemax\"\n"), {}, folder.path()),
      Catch::Contains("rays.count") && Catch::Contains("tm25"));
  CHECK_FALSE(std::filesystem::exists(folder / "source.dat"));
}
