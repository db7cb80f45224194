#pragma once

#include <optional>
#include <string>
#include <vector>

#include "design/run.h"
#include "design/scene.h"

namespace catoptric::design {

/// One way to compute the scene's light.
struct TradeSetting {
  sim::Rung rung = sim::Rung::photons;
  ModelSpec model;  ///< engine, photons, sampler, bandwidth and kernel; radius 0: pointwise
  int threads = 0;  ///< 0: one per core
  std::optional<double> accuracy_rel;  ///< set: what that accuracy spends; the model's numbers do not count
};

/// What it costs and how far off it is. Errors are root mean squares over the samples, relative to the
/// field's root mean square.
struct TradeRow {
  TradeSetting setting;
  double seconds = 0;  ///< of one evaluation: median over the repetitions
  double least_seconds = 0;
  double error_rel = 0;           ///< root mean square over the seeds
  double greatest_error_rel = 0;  ///< of any seed
  int seeds = 0;                  ///< 1 where nothing is random
  std::uint64_t photons = 0;      ///< of one evaluation
  bool on_front = false;          ///< no other setting is both faster and nearer the truth
};

/// The cheapest setting that kept an accuracy with every seed; nothing when none did.
struct TradeChoice {
  double accuracy_rel = 0;
  std::optional<std::size_t> row;
};

struct Tradeoff {
  std::string reference;  ///< what is taken for the truth
  double reference_error_rel = 0;
  double rms_w_per_m2 = 0;  ///< of the field, so that errors can be read in W/m^2
  std::vector<TradeRow> rows;
  std::vector<TradeChoice> choices;  ///< for 10 %, 1 % and 0.1 %
  std::string sentence;
  std::vector<std::string> left_out;  ///< settings not run, and why
  std::string machine;
  double seconds = 0;
};

/// Measures time against error on this scene over rung, engine, sampler, photons, neighbours, kernel, threads
/// and the accuracy key. The truth is the closed form where there is one, else ray tubes with their bound,
/// else the highest rung run until its own error is far below what is measured.
/// @out   by rank 0; the control's ranks share the truth, whose times are not measured
/// @fails InputError as a simulation of the scene
Tradeoff run_tradeoff(const Scene& scene, const RunControl& control);

/// The settings that a scene allows: from the ladder's rungs those that are valid, each with its knobs turned
/// about the scene's own values.
std::vector<TradeSetting> trade_settings(const Scene& scene, const Profile& profile);

/// A setting in a few words: "photons, meridian, sobol, 100000 photons, kernel radius 0.5 cm".
std::string words(const Scene& scene, const TradeSetting& setting);

/// Marks the rows that no other beats in time and error.
void mark_front(std::vector<TradeRow>& rows);

/// The cheapest row whose error stayed below each accuracy with every seed.
std::vector<TradeChoice> choose(const std::vector<TradeRow>& rows, double reference_error_rel,
                                const std::vector<double>& accuracies_rel);

}  // namespace catoptric::design
