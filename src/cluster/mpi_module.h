#pragma once

#include "cluster/messenger.h"

namespace catoptric::cluster {

/// A file that is loaded only where a launcher started several processes, since MPI's libraries take longer
/// to load than a small scene to be solved.
inline constexpr const char* mpi_module_name = "catoptric_mpi.so";
inline constexpr const char* mpi_module_symbol = "catoptric_open_mpi";

/// What it holds: begins MPI; the caller deletes the result, which ends MPI.
using OpenMessenger = Messenger* (*)();

}  // namespace catoptric::cluster
