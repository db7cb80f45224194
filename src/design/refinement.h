#pragma once

#include <functional>
#include <string>
#include <vector>

#include "design/scene.h"
#include "optim/outcome.h"

namespace catoptric::design {

/// The same curve after one step of `search.refine`: "degree N" writes it with degree N, "spans N" with N
/// spans, each of its own cut alike.
/// @fails InputError for another word, a degree that is not higher, a number of spans that is no multiple
Profile refined(const Profile& profile, const std::string& step);

/// What one search of a refined design did.
struct RefinementStage {
  std::string step;  ///< of `search.refine`; empty: the search before the first
  std::size_t points, variables;
  long evaluations;  ///< of this stage
  double value;      ///< objective at its end
};

/// All stages of a search.
struct RefinedOutcome {
  optim::Outcome outcome;  ///< counts and history of all stages one after the other; best: of the last
  Scene last;              ///< the scene of the last stage: its profile, its variables
  std::vector<RefinementStage> stages;
};

/// Runs a search, then for each step of `search.refine` refines the best mirror and searches on with all
/// freedom that it gained. What is left of the scene's evaluations and iterations is what later stages may
/// use; first steps are a quarter of those of the stage before. Without steps this is the one search.
/// @in search  as design's: from the scene's variables at their starts
RefinedOutcome search_in_stages(const Scene& scene,
                                const std::function<optim::Outcome(const Scene&)>& search);

}  // namespace catoptric::design
