#pragma once

#include <optional>
#include <string>

namespace catoptric::photometry {

/// Size of what shines; all zero is a point.
struct LuminousOpening {
  double along_c0_mm = 0;   ///< extent in the plane C0-C180; a round one's diameter
  double along_c90_mm = 0;  ///< extent in the plane C90-C270
  double height_mm = 0;
  bool is_round = false;  ///< seen from the first axis

  bool is_point() const { return along_c0_mm == 0 && along_c90_mm == 0 && height_mm == 0; }
  bool operator==(const LuminousOpening&) const = default;
};

/// What a photometric file says beside intensities. Empty texts are written as "not stated".
struct Luminaire {
  std::string test;        ///< number of the report
  std::string laboratory;  ///< who measured, or which program simulated
  std::string issue_date;  ///< as 2026-05-17
  std::string manufacturer;
  std::string catalog;  ///< catalogue number
  std::string name;     ///< description of the luminaire
  std::string lamp;     ///< description of the lamp
  int lamp_count = 1;
  std::optional<double> lamp_flux_lm;  ///< of all lamps together; none: absolute photometry
  double input_w = 0;
  LuminousOpening opening;
};

}  // namespace catoptric::photometry
