#pragma once

#include "base/ray.h"
#include "sim/material.h"
#include "sim/near_field.h"
#include "sim/source.h"

namespace catoptric::sim {

/// What the photons live in. Borrowed for the duration of a call.
struct Scene {
  const Source& source;
  const Reflector& reflector;
  Material mirror;
  const NearField& near_field;
};

}  // namespace catoptric::sim
