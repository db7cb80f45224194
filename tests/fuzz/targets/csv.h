#pragma once

#include <cmath>
#include <string_view>

#include "design/csv_table.h"
#include "design/target.h"
#include "fuzz/support/scene_check.h"

namespace catoptric::fuzz {

inline design::Scene scene_with(const std::string& target) {
  const std::string text =
      "unit = \"m\"\n[source]\nposition = [0, 0, 5]\npower = 1\n[reflector]\npoints = [[0, 10], [5, 10], "
      "[10, 5]]\n"
      "[near_field]\nradius = 5\nsamples = 4\n[target]\n" +
      target;
  return design::written_scene(design::Settings::parse(text, "fuzz/scene.toml", design::scene_keys()));
}

inline void check_table(const design::CsvTable& table) {
  for (const auto& column : table.columns) {
    if (column.size() != table.lines.size()) finding("a column of another length");
    for (const double value : column)
      if (!std::isfinite(value)) finding("a value that is not finite");
  }
}

inline void check_target(const design::Target& target) {
  for (const double value : target.irradiance_w_per_mm2)
    if (!(value >= 0 && value < HUGE_VAL)) finding("an irradiance that is none");
  for (const auto& sample : target.samples)
    if (!sample.point_mm.allFinite()) finding("a sample that is not finite");
}

/// CSV tables: by themselves, and as the targets of scenes. The first byte says which.
inline void try_csv(std::string_view input) {
  if (input.empty()) return;
  static const InputFile file;
  const std::string_view text = input.substr(1);
  accepted([&] {
    const auto in_file = [&] { return "'" + file.with(text.data(), text.size()) + "'\n"; };
    switch (static_cast<unsigned char>(input[0]) % 5) {
      case 0:
        check_table(design::parse_csv_table(text, "t.csv"));
        break;
      case 1:
        check_table(design::parse_csv_table(text, "t.csv", {"move"}));
        break;
      case 2:
        check_target(design::make_target(scene_with("kind = \"csv\"\nfile = " + in_file())));
        break;
      case 3: {
        const design::Scene scene =
            scene_with("kind = \"radial\"\nweight_column = \"weight\"\nfile = " + in_file());
        if (!(scene.target.reach_mm > 0 && scene.target.reach_mm < HUGE_VAL)) finding("a reach that is none");
        for (std::size_t i = 0; i < scene.target.radii_mm.size(); ++i)
          if (!std::isfinite(scene.target.radii_mm[i]) ||
              !std::isfinite(scene.target.irradiances_w_per_mm2[i]))
            finding("a row that is not finite");
        break;
      }
      default: {
        const design::Scene scene = scene_with("intensity_file = " + in_file());
        for (const double value : scene.target.intensities_w_per_sr)
          if (!(value >= 0 && value < HUGE_VAL)) finding("an intensity that is none");
      }
    }
  });
}

}  // namespace catoptric::fuzz
