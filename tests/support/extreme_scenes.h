#pragma once

#include <cstdint>
#include <string>

#include "design/judge.h"
#include "design/scene.h"

namespace catoptric::test {

/// A scene of a grid of extremes. Two thirds of its parts are ordinary, for a scene of nothing but extremes
/// tells little of each.
struct ExtremeScene {
  std::string parts;   ///< source, reflector, near field
  std::string budget;  ///< photons and bandwidth
  double scale;        ///< of all lengths
  std::string text() const { return parts + budget; }
};

/// @in number: another number is another scene
ExtremeScene extreme_scene(std::uint64_t number);

/// What is wrong with a result by itself, or nothing.
std::string defect(const design::Scene& scene, const design::Judgement& judgement);

}  // namespace catoptric::test
