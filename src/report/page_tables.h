#pragma once

#include "design/run.h"
#include "report/table.h"

namespace catoptric::report {

/// A value without the digits that its noise makes meaningless: two of those that the noise has are kept.
double rounded_to_noise(double value, double noise);

/// The same as text: "0.003350 ± 0.000030" where there is noise, else four digits.
std::string measured_text(double value, double noise);

/// Variables and all metrics with noise and bias, for a page; where there is a start, beside it.
Table figures_table(const design::Scene& scene, const design::Judged& found, const design::Judged* start);

/// Where the light went that was sent to the mirror. Without rows for ray tubes, which keep no ledger.
Table energy_table(const design::Scene& scene, const design::Judged& judged);

/// The generatrix' control points.
Table control_point_table(const design::Scene& scene, const Profile& profile);

/// The first and last rows of a long table.
Table shortened(Table table);

}  // namespace catoptric::report
