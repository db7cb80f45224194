#pragma once

#include "optim/outcome.h"

namespace catoptric::optim {

/// Puts a search behind those before it, as if all had been one: counts are added, its history's numbers go
/// on where theirs ended. Values are each stage's own; ending, best and value are the last stage's.
void append(Outcome& all, Outcome stage);

}  // namespace catoptric::optim
