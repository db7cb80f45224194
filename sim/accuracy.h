#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/bandwidth_ladder.h"
#include "sim/planner.h"
#include "sim/scene.h"
#include "sim/tracer.h"

namespace catoptric::sim {

/// What is asked for: that the total irradiance at the samples is right within this share of its root mean
/// square, root mean square over the samples, with a probability of 95 %. The truth is the irradiance itself,
/// without any kernel.
struct AccuracyRequest {
  double relative = 0.01;
  ModelRequest model;                        ///< rung and engine that the user insists on; no bandwidth
  PhotonOptions photons;                     ///< sampler, key and first stream; how many is found here
  std::uint64_t most_photons = 100'000'000;  ///< spent before giving up
  bool fresh_photons_only = false;           ///< no tubes: to judge what a search with tubes has found
  /// Called after every stage; false stops with what there is.
  std::function<bool(std::uint64_t photons, double error95_rel)> watch = {};
};

/// One try with so many photons, and what it proved.
struct AccuracyStage {
  std::uint64_t photons = 0;  ///< of all sets
  double error95_rel = 0;
};

/// The field, and what was spent to know it.
struct AccurateField {
  Rung rung = Rung::photons;
  bool proven = false;
  std::string sentence;                   ///< how it ended, in words
  std::optional<std::string> breaks;      ///< why bias was counted as at a jump; of photons and rings
  std::vector<double> direct, reflected;  ///< W/mm^2 at the samples
  std::vector<double> noise;              ///< standard deviation of `reflected`, W/mm^2
  double noise_rel = 0, bias_rel = 0;     ///< root mean squares over that of the total irradiance
  double error95_rel = 0;                 ///< not exceeded with a probability of 95 %
  double kernel_radius_mm = 0;            ///< 0 for tubes
  int order = 0;                          ///< of the kernel's bias: 2 or 4; 0 for tubes
  std::uint64_t sets = 0, photons = 0;    ///< behind `reflected`: independent sets, photons of each
  std::uint64_t spent_photons = 0;        ///< of all stages together
  int rays = 0;                           ///< of tubes
  SetFields by_set;  ///< reflected light by each set, whose mean is `reflected`; one for tubes
  std::vector<AccuracyStage> stages;
  EnergyLedger energy;  ///< of the last stage; empty for tubes
  PhotonCounts counts;
};

/// The kernels that photons may be looked at with, and why their bias is counted as at a jump: nothing where
/// the field is smooth as far as they reach.
struct KernelRange {
  double widest_radius_mm = 0;
  std::optional<std::string> breaks;
};

/// @in    rung rings or photons, valid for the scene
/// @cost  that of find_breaks
KernelRange kernel_range(const Scene& scene, Rung rung);

/// Spends the least that proves the accuracy: ray tubes where they are valid, whose error is bounded without
/// statistics; else sets of photons on the cheapest valid rung, each stage with as many photons as the one
/// before lets expect to suffice, looked at with the bandwidth and order of least error (best_choice).
/// @in    samples on the near field
/// @out   the same bits for any number of threads and ranks, which share the photons; where the accuracy
/// could not be proven, the best field
///        there is, and a sentence that says how far it got
/// @fails InputError for an accuracy that is not above 0, a wanted rung that is not valid, fewer photons
///        allowed than the first look takes (2048)
/// @cost  that of all stages: spent_photons flights, and in each stage a ladder of bandwidths at 128 samples,
///        512 where the field breaks, half of them where the light falls (see ProbePicker).
///        All photons of a stage are in memory, 17 bytes each; of rings 8 bytes a bin
AccurateField reach_accuracy(const Scene& scene, std::span<const FieldSample> samples,
                             const AccuracyRequest& request);

}  // namespace catoptric::sim
