#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/intensity_table.h"
#include "sim/tracer.h"

namespace catoptric::sim {

/// The directions in which a luminaire's intensity is wanted: angles in degrees as in IntensityTable, about
/// axes of the scene.
struct IntensityGrid {
  std::vector<double> gamma_deg;  ///< ascending, 0 to 180
  std::vector<double> c_deg;      ///< {0}: alike all round; else ascending from 0, below 360
  Eigen::Matrix3d frame;          ///< columns: C = 0, C = 90, gamma = 0
};

/// Intensities of a grid, plane by plane, by one set of photons.
struct FarIntensity {
  std::vector<double> w_per_sr;
  double departed_w = 0;  ///< all that left
  FlightTotals totals;
};

/// Even steps from 0 to 180 degrees for gamma, and from 0 to below 360 for C, none wider than asked for.
/// @in    c_step_deg 0: one plane for all
IntensityGrid even_grid(double gamma_step_deg, double c_step_deg, const Eigen::Matrix3d& frame);

/// Intensity of source and mirror from afar, direct light included, the near field left out. Each photon
/// counts at the four directions of the grid about its own, by its place between them, so that the bilinear
/// table holds exactly the light that departed.
/// @out   the same bits for any number of threads
/// @error noise falls like photons^-1/2; a table's node is a mean over its neighbourhood, off by a twelfth of
///        step^2 times the second derivative in each angle
/// @fails as depart()
FarIntensity far_intensity(const Scene& scene, const IntensityGrid& grid, const PhotonOptions& photons);

/// What the width of the steps does to an even table: Richardson's difference between the table and the same
/// with twice the step in gamma, over three.
std::vector<double> step_bias(const IntensityGrid& grid, const std::vector<double>& w_per_sr);

/// Whether source and mirror shine alike round the z axis.
bool shines_round(const Scene& scene);

}  // namespace catoptric::sim
