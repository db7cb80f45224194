#pragma once

#include <cctype>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "design/metrics.h"
#include "design/run.h"

namespace catoptric::test {

/// What the numbers of a scene of scale 1 are about: how large differences are judged by.
struct Magnitudes {
  double length = 100, irradiance = 1e-6, power = 1;  ///< mm, W/mm^2, W
};

/// The numbers of a result as those of a scene of scale 1 in mm: lengths over the scale, irradiances times
/// its square. What a clock says is not among them.
class ResultNumbers {
 public:
  /// @in unit_mm: of variables that are lengths
  explicit ResultNumbers(const Magnitudes& magnitudes, double scale = 1, double unit_mm = 1)
      : magnitudes_(magnitudes), scale_(scale), unit_mm_(unit_mm) {}

  void number(double value, double magnitude) {
    numbers_.push_back(value);
    sizes_.push_back(magnitude);
  }
  /// What is equal or not: a count, a choice.
  void count(double value) { number(value, 0); }
  /// A share, a weight.
  void plain(double value) { number(value, 1); }
  void length(double value) { number(value / scale_, magnitudes_.length); }
  void power(double value) { number(value, magnitudes_.power); }
  void irradiance(double value) { number(value * scale_ * scale_, magnitudes_.irradiance); }
  void irradiances(const std::vector<double>& values) {
    for (const double each : values) irradiance(each);
  }

  void add(const Profile& profile) {
    for (const ControlPoint& point : profile.points()) {
      length(point.r_mm);
      length(point.z_mm);
      plain(point.weight);
    }
    for (const double knot : profile.knots()) plain(knot);
  }

  /// Lengths are r0, z0, source.x, length; curvatures go the other way.
  void variable(std::string_view name, double value) {
    const bool is_component = name.size() > 1 && std::isdigit(static_cast<unsigned char>(name[1])) != 0;
    if (name.starts_with("kappa"))
      number(value * scale_ / unit_mm_, 1 / magnitudes_.length);
    else if (name == "length" || name == "source.x" || name == "source.y" || name == "source.z" ||
             (is_component && (name[0] == 'r' || name[0] == 'z')))
      length(value * unit_mm_);
    else
      plain(value);
  }

  void metric(design::Metric which, double value) {
    if (which == design::Metric::rmse)
      number(value * scale_ * scale_, to_w_per_m2(magnitudes_.irradiance));
    else
      plain(value);
  }

  void add(const design::Figure& figure, design::Metric which) {
    metric(which, figure.value);
    metric(which, figure.noise);
    metric(which, figure.bias);
    count(figure.half_interval.has_value());
    metric(which, figure.half_interval.value_or(0));
  }

  void add(const design::Judgement& judgement, design::Metric searched) {
    count(static_cast<double>(judgement.rung));
    add(judgement.objective, searched);
    for (const auto& each : judgement.metrics) add(each.figure, each.metric);
    length(judgement.kernel_radius_mm);
    for (const auto* part : {&judgement.direct, &judgement.reflected, &judgement.noise, &judgement.bias,
                             &judgement.half_interval})
      irradiances(*part);
    irradiance(judgement.field_noise_w_per_mm2);
    irradiance(judgement.field_bias_w_per_mm2);
    const sim::EnergyLedger& energy = judgement.energy;
    for (const double each : {energy.emitted_w, energy.missed_w, energy.absorbed_w, energy.received_w,
                              energy.escaped_w, energy.cut_off_w})
      power(each);
    for (const std::uint64_t each :
         {judgement.counts.emitted, judgement.counts.met_mirror, judgement.counts.stored,
          judgement.counts.interactions, judgement.photons, judgement.replicates})
      count(static_cast<double>(each));
    if (judgement.accuracy) add(*judgement.accuracy);
  }

  void add(const design::AccuracyReport& report) {
    count(report.proven);
    for (const double each : {report.noise_rel, report.bias_rel, report.error95_rel}) plain(each);
    for (const sim::AccuracyStage& stage : report.stages) {
      count(static_cast<double>(stage.photons));
      plain(stage.error95_rel);
    }
  }

  void add(const design::Judged& judged, design::Metric searched) {
    add(judged.profile);
    for (std::size_t i = 0; i < judged.variables.size(); ++i) variable(judged.names[i], judged.variables[i]);
    add(judged.judgement, searched);
    for (const auto& state : judged.constraints) plain(state.violation / state.scale);
    for (int i = 0; i < 3; ++i) length(judged.source.position_mm[i]);
    power(judged.source.power_w);
  }

  void add(const design::Target& target) {
    irradiances(target.irradiance_w_per_mm2);
    for (const auto& sample : target.samples)
      for (int i = 0; i < 3; ++i) length(sample.point_mm[i]);
  }

  /// Every step of the search.
  /// @in names of the variables
  void add(const optim::Outcome& outcome, const std::vector<std::string>& names, design::Metric searched) {
    count(static_cast<double>(outcome.ending));
    for (const long each : {outcome.successes, outcome.iterations, outcome.evaluations, outcome.restarts})
      count(static_cast<double>(each));
    for (const optim::Iterate& each : outcome.history) {
      plain(each.step);
      count(static_cast<double>(each.evaluations));
      metric(searched, each.value);
      for (std::size_t i = 0; i < each.x.size() && i < names.size(); ++i) variable(names[i], each.x[i]);
    }
  }

  std::size_t size() const { return numbers_.size(); }

  /// How many numbers of two results are not the same bits.
  static std::size_t differing(const ResultNumbers& a, const ResultNumbers& b) {
    if (a.size() != b.size()) return std::max(a.size(), b.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      count += std::memcmp(&a.numbers_[i], &b.numbers_[i], sizeof(double)) != 0;
    return count;
  }

  /// The greatest difference of two results over what the numbers are about; infinite where counts differ.
  static double distance(const ResultNumbers& a, const ResultNumbers& b) {
    if (a.size() != b.size()) return HUGE_VAL;
    double greatest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (std::memcmp(&a.numbers_[i], &b.numbers_[i], sizeof(double)) == 0) continue;
      const double off = std::abs(a.numbers_[i] - b.numbers_[i]) / a.sizes_[i];
      greatest = std::isnan(off) ? HUGE_VAL : std::max(greatest, off);
    }
    return greatest;
  }

 private:
  Magnitudes magnitudes_;
  double scale_, unit_mm_;
  std::vector<double> numbers_, sizes_;
};

}  // namespace catoptric::test
