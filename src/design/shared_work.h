#pragma once

#include "base/ranks.h"
#include "design/evaluator.h"
#include "design/run.h"
#include "optim/outcome.h"
#include "sim/accuracy.h"

namespace catoptric::design {

/// The ranks that a run's work is shared by; this process alone where there are none.
Ranks& ranks_of(const Scene& scene);
Ranks& ranks_of(const RunControl& control);

/// The scene with its work shared by the control's ranks.
Scene shared(Scene scene, const RunControl& control);

/// The same, and photons in flight are given up once the control says stop.
Scene controlled(Scene scene, const RunControl& control);

/// Whether the user has stopped the run, as rank 0 saw it: the same answer on every rank.
bool stopped_for_all(const RunControl& control);

/// A number that only rank 0 knows, on every rank: a time.
double of_first(Ranks& ranks, double value);

// What ranks send each other.
Bytes as_bytes(const Evaluation& evaluation);
Evaluation evaluation_of(const Bytes& bytes);
Bytes as_bytes(const optim::Outcome& outcome);
optim::Outcome outcome_of(const Bytes& bytes);
Bytes as_bytes(const sim::AccurateField& field);
sim::AccurateField accurate_field_of(const Bytes& bytes);
Bytes as_bytes(const SearchPath& path);
SearchPath search_path_of(const Bytes& bytes);

/// At which level the work of a run is shared, in words for `explain`; empty for a process by itself.
/// @in searched  rung of the search; nothing where there is none
std::string sharing_sentence(const Scene& scene, const std::optional<sim::Rung>& searched,
                             const Ranks& ranks);

/// Whether points that a search may ask for next are evaluated side by side. Ray tubes are too quick for it
/// and a fit asks one point at a time: rank 0 searches alone then.
bool shares_evaluations(const Scene& scene, sim::Rung rung, const Ranks& ranks);

}  // namespace catoptric::design
