#pragma once

#include "cluster/messenger.h"

namespace catoptric::cluster {

/// A file that is loaded only where a launcher started several processes, since MPI's libraries take longer
/// to load than a small scene to be solved.
inline constexpr const char* mpi_module_name = "catoptric_mpi.so";
/// Its number rises with every change of Messenger: a file of another version is refused, not called wrongly.
inline constexpr const char* mpi_module_symbol = "catoptric_open_mpi_2";

/// What it holds: begins MPI; the caller deletes the result, which ends MPI.
using OpenMessenger = Messenger* (*)();

}  // namespace catoptric::cluster
