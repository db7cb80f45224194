#pragma once

#include <cstdint>
#include <string>

#include "design/scene.h"

namespace catoptric::design {

/// Most memory that a run of a scene takes.
struct MemoryNeed {
  std::uint64_t bytes;
  std::string sentence;    ///< how much, and for what
  const char *key, *hint;  ///< what of the scene asks for it, and what would take less
};

/// What `simulate`, `design` and `landscape` of a scene take at most, the program itself included: in each of
/// so many ranks that share it.
/// @error an upper bound where photons meet the near field's plane once each
MemoryNeed memory_need(const Scene& scene, int ranks = 1);

/// Photons that proofs of accuracy can keep in the memory that is free now.
std::uint64_t photons_that_fit();

/// Whether a scene fits into the memory that is free now.
bool fits_memory(const Scene& scene);

/// Refuses a scene that would not fit, before anything is computed: `ranks` share it, of which
/// `ranks_here` share this machine's memory.
/// @fails InputError naming the key to change
void require_memory(const Scene& scene, int ranks = 1, int ranks_here = 1);

}  // namespace catoptric::design
