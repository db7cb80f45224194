#include "report/ray_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <nlohmann/json.hpp>

#include "rayfiles/ray_check.h"
#include "rayfiles/ray_file.h"
#include "rayfiles/ray_file_writer.h"
#include "report/result_json.h"
#include "report/run_folder.h"
#include "report/text.h"

namespace catoptric::report {
namespace {

using Json = nlohmann::ordered_json;

std::string ray_file_name(const design::Scene& scene) {
  return std::string(scene.rays.of_luminaire ? "luminaire" : "source") +
         (scene.rays.is_zemax ? ".dat" : ".tm25ray");
}

std::string light_of(const design::Scene& scene) {
  const std::string title = scene.title.empty() ? "" : scene.title + ": ";
  return title + (scene.rays.of_luminaire ? "source and mirror" : "the source alone");
}

rayfiles::RayFileHeader ray_header(const design::Scene& scene) {
  const bool luminous = scene.source.quantity == LightQuantity::luminous;
  if (scene.rays.is_zemax) {
    rayfiles::ZemaxHeader header;
    header.description = light_of(scene);
    header.flux = luminous ? rayfiles::ZemaxFlux::lumens : rayfiles::ZemaxFlux::watts;
    return header;
  }
  rayfiles::Tm25Header header;
  header.date = scene.intensity.issue_date;
  header.has_radiant_flux = !luminous;
  header.has_luminous_flux = luminous;
  header.text(rayfiles::Tm25Text::light_source) = light_of(scene);
  header.text(rayfiles::Tm25Text::manufacturer) = scene.intensity.manufacturer;
  header.text(rayfiles::Tm25Text::ray_file_creator) =
      fmt::format("catoptric {}, seed {}", version(), scene.seed);
  return header;
}

std::array<float, 7> row_of(const Ray& ray, double flux) {
  const auto real = [](double value) { return static_cast<float>(value); };
  return {real(ray.origin_mm.x()),
          real(ray.origin_mm.y()),
          real(ray.origin_mm.z()),
          real(ray.direction.x()),
          real(ray.direction.y()),
          real(ray.direction.z()),
          real(flux)};
}

std::string numbers_text(const Vector3& v) { return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z()); }

/// The keys of the light that left, in the scene's unit; a luminaire's light is what is left of the source's.
std::string source_text(const design::Scene& scene, const design::RayOutput& output,
                        const std::string& file_name) {
  const double flux =
      output.rays == output.emitted ? output.source_flux : output.ray_flux * static_cast<double>(output.rays);
  return fmt::format(
      "# The light of {} as a source of rays; the file's path is relative to the scene it stands in.\n"
      "[source]\nkind = \"rays\"\nfile = \"{}\"\n{} = {}\nposition = {}\naxis = {}\nalong = {}\n",
      clean_line(light_of(scene)), file_name, output.quantity == LightQuantity::luminous ? "flux" : "power",
      flux, numbers_text(output.frame.origin_mm / millimetres_per(scene.unit)),
      numbers_text(output.frame.axes.col(2)), numbers_text(output.frame.axes.col(0)));
}

Json vector_json(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

Json ray_json(const design::Scene& scene, const WrittenRays& rays, const std::string& file_name) {
  const std::string unit(flux_unit(rays.output.quantity));
  return {{"title", scene.title},
          {"command", "rays"},
          {"of", scene.rays.of_luminaire ? "luminaire" : "source"},
          {"file", file_name},
          {"emitted", rays.output.emitted},
          {"rays", rays.output.rays},
          {"source_flux", {{"value", rays.output.source_flux}, {"unit", unit}}},
          {"file_flux", {{"value", rays.file_flux}, {"unit", unit}}},
          {"ray_flux", {{"value", rays.output.ray_flux}, {"unit", unit}}},
          {"frame",
           {{"unit", "mm"},
            {"origin", vector_json(rays.output.frame.origin_mm)},
            {"x", vector_json(rays.output.frame.axes.col(0))},
            {"z", vector_json(rays.output.frame.axes.col(2))}}},
          {"extent", {{"value", rays.extent_mm}, {"unit", "mm"}}},
          {"mean_direction", vector_json(rays.mean_direction)},
          {"seconds", rays.seconds},
          {"seed", scene.seed},
          {"version", version()}};
}

}  // namespace

std::uint64_t room_for_rays(const design::Scene& scene) {
  constexpr std::uint64_t header = 100'000, bytes_of_a_ray = 28;
  return header + bytes_of_a_ray * scene.rays.count;
}

std::pair<WrittenFiles, WrittenRays> write_rays(const design::Scene& scene, const design::RunControl& control,
                                                const std::filesystem::path& path) {
  const auto begin = std::chrono::steady_clock::now();
  RunFolder folder(path);
  folder.text("scene.toml", design::scene_text(scene));
  const std::string name = ray_file_name(scene);
  WrittenRays written;
  folder.made(name, [&](const std::filesystem::path& file) {
    rayfiles::RayFileWriter writer(file, ray_header(scene));
    const double flux = start_candidate(scene).source.power_w / static_cast<double>(scene.rays.count);
    written.output = run_rays(scene, control, [&](std::span<const Ray> rays) {
      for (const Ray& ray : rays) writer.add(row_of(ray, flux));
    });
    writer.commit();
  });
  const rayfiles::RayCheck check = check_rays(*rayfiles::RayFile::open(path / name));
  require_sound(check);
  written.file_flux = check.statistics.total_flux;
  written.extent_mm = check.statistics.sphere.centre_mm.norm() + check.statistics.sphere.radius_mm;
  written.mean_direction = check.statistics.mean_direction;
  folder.text("source.toml", source_text(scene, written.output, name));
  written.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  folder.text("rays.json", json_text(ray_json(scene, written, name)));
  return {folder.take(), written};
}

Table ray_table(const WrittenRays& rays) {
  const std::string unit(flux_unit(rays.output.quantity));
  Table table{{{"figure", ""}, {"unit", ""}, {"value", ""}}, {}};
  table.rows = {{"rays that the source sent out", "", static_cast<double>(rays.output.emitted)},
                {"rays in the file", "", static_cast<double>(rays.output.rays)},
                {"source", unit, rays.output.source_flux},
                {"in the file", unit, rays.file_flux},
                {"each ray", unit, rays.output.ray_flux},
                {"starting points within", "mm", rays.extent_mm}};
  return table;
}

}  // namespace catoptric::report
