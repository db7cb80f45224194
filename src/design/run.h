#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/ranks.h"
#include "design/judge.h"
#include "design/refinement.h"
#include "design/scene.h"
#include "design/target.h"
#include "optim/outcome.h"
#include "optim/search_tape.h"

namespace catoptric::design {

/// How far a run is, for whoever watches.
struct Progress {
  std::string phase;  ///< "search", "verify", ...
  double share = 0;   ///< done, in [0, 1]; an estimate in a search
  double best = 0;    ///< best objective so far; NaN when there is none
  long evaluations = 0;
  std::string note = {};  ///< what else there is to tell
  long iterations = 0;    ///< of a search that goes step by step
};

/// What a caller may do to a run: stop it, watch it, keep what its search was told, and give it ranks to
/// share its work with. All may be left empty.
struct RunControl {
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const Progress&)> watch = {};
  optim::SearchTape* tape = nullptr;  ///< of design; goes on where a tape with answers was broken off
  Ranks* ranks = nullptr;             ///< all of them call with the same; watched and broken off on rank 0
  /// Set while the evaluations of a search are shared: where it stops for all ranks at once.
  std::atomic<bool>* stopped_together = nullptr;
  bool stopped() const { return stop && stop->load(std::memory_order_relaxed); }
  void tell(const Progress& progress) const {
    if (watch) watch(progress);
  }
};

/// A mirror with its variables and its verdict.
struct Judged {
  Profile profile;
  std::vector<double> variables;  ///< lengths in the scene's unit
  Judgement judgement;
  std::vector<ConstraintState> constraints;  ///< how it stands to the scene's
  SourceSpec source;                         ///< that it was judged with
  std::vector<std::string> names;            ///< of the variables; more than the scene's after a refinement
};

/// What `design` found.
struct DesignResult {
  Target target;
  sim::Plan plan;  ///< what the search computed the light with, and why
  optim::Outcome search;
  Judged start, best;
  std::uint64_t photons = 0;                 ///< emitted in all
  double search_seconds = 0;                 ///< of the search alone
  double seconds = 0;                        ///< verdicts included, files not
  std::vector<RefinementStage> stages = {};  ///< of a refined search; one when there was no refinement
};

/// What `simulate` will compute the light with: the scene's rung, or where an accuracy is asked for the
/// cheapest that is valid with a bandwidth of the program's choice.
sim::Plan simulation_plan(const Scene& scene, const Candidate& candidate);

/// Searches the scene's variables and judges start and best on fresh streams. When the user stops it, photons
/// in flight are given up, and start and best so far are judged with fewer photons, for the user waits.
/// @fails InputError when there is nothing to search or to aim at, the scene would not fit into memory, or
///        the control's tape is another search's
DesignResult run_design(const Scene& scene, const RunControl& control);

/// What `simulate` found: the scene as it stands, its variables at their start.
struct SimulationResult {
  Target target;
  sim::Plan plan;
  Judged mirror;
  std::uint64_t photons = 0;
  double seconds = 0;
};
SimulationResult run_simulation(const Scene& scene, const RunControl& control);

/// The way of a search over a landscape.
struct SearchPath {
  std::string name;                         ///< a letter for each start, or that of the run that took it
  std::string label;                        ///< for a legend
  std::vector<std::vector<double>> points;  ///< in the landscape's variables: the start, then what was better
  std::vector<double> values = {};  ///< objective at each, as the search had it; NaN where constraints are
                                    ///< broken; empty where it is not known
  std::string ending = {};          ///< how the search ended, in words
};

/// The objective over one or two variables, row by row: the second variable runs fastest.
struct Landscape {
  std::vector<std::string> names;
  std::vector<std::vector<double>> axes;  ///< values of each variable
  std::vector<double> objective;          ///< NaN where no mirror can be built or constraints are broken
  std::vector<SearchPath> paths;          ///< where the scene asks for them
  double seconds = 0;
};
Landscape run_landscape(const Scene& scene, const RunControl& control);

/// The scene's profile with its variables at their start values.
Profile start_profile(const Scene& scene);

/// The same with the source and the mirror's surface.
Candidate start_candidate(const Scene& scene);

/// What the scene's variables move.
SceneFamily family_of(const Scene& scene);

}  // namespace catoptric::design
