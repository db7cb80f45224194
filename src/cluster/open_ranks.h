#pragma once

#include <memory>

#include "cluster/shared_ranks.h"

namespace catoptric::cluster {

/// How many processes a launcher (mpirun, srun) started for this run, by the variables that it sets; 1
/// without.
int launched_processes();

/// The processes of this run: through MPI where a launcher started several, else this one by itself, for
/// which nothing of MPI is loaded.
/// @fails UsageError where several were started and this build has no MPI
std::unique_ptr<SharedRanks> open_ranks();

}  // namespace catoptric::cluster
