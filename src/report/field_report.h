#pragma once

#include <cmath>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "design/judge.h"
#include "report/table.h"

namespace catoptric::report {

/// Where the truth lies with a probability of 95 %: two numbers, not below 0 nor above what the figure can
/// be; null where that is not known.
nlohmann::ordered_json interval_json(const design::Figure& figure, double greatest = HUGE_VAL);

/// What the near field gets, each figure with unit, noise, bias and interval: average, least, greatest, U0,
/// Ud, flux, zones; and how its samples lie.
nlohmann::ordered_json field_json(const design::Scene& scene, const design::Judgement& judgement);

/// The same for a person, one row per figure: value, noise (1 sigma), bias.
Table field_table(const design::Scene& scene, const design::Judgement& judgement);

/// "512, 5.54 mm apart" of the samples that the scene asks for.
std::string samples_text(const design::Scene& scene, std::size_t samples);

}  // namespace catoptric::report
