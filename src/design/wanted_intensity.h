#pragma once

#include <string>
#include <vector>

#include "base/intensity_table.h"
#include "design/settings.h"

namespace catoptric::design {

/// Intensity wanted by the angle to the beam's direction, linear in between.
struct WantedIntensity {
  std::vector<double> angles_rad;  ///< rising; 85 degrees at most
  std::vector<double> w_per_sr;    ///< or cd
};

/// The table of `target.intensity_file`: a CSV table, or by its ending .ies or .ldt a photometric file, of
/// which the mean over C counts, since a mirror of revolution makes no other.
/// @in    settings completed; the file is set. notes: what is worth telling is added, in sentences
/// @fails InputError for a file that cannot be read or holds no such angle; cd in a scene of W unless only
/// the
///        shape is wanted
WantedIntensity read_wanted_intensity(const Settings& settings, std::vector<std::string>& notes);

/// Mean over C at each of the table's gamma, exact for its interpolant.
std::vector<double> means_over_c(const IntensityTable& table);

/// How far a table is from alike in all planes between two angles to its axis: the root mean square over
/// solid angle of what differs from the mean over C, relative to the table's own.
/// @error a Gauss sum of seven points between the table's gammas: exact for the table, 1e-9 for the sine
double c_asymmetry_rel(const IntensityTable& table, double from_deg, double to_deg);

}  // namespace catoptric::design
