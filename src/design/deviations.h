#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "design/scene.h"

namespace catoptric::design {

/// A scene and its mirror with one thing wrong.
struct Varied {
  Scene scene;
  Profile profile;
};

/// One way in which a lamp as built may differ from the one designed.
struct Deviation {
  std::string name;                                 ///< "source along the axis"
  std::string key;                                  ///< "source_axial": for files
  std::string unit;                                 ///< of the deviation
  std::string meaning;                              ///< in a sentence
  double first_guess;                               ///< a small one, in its unit
  double least, greatest;                           ///< deviations that make sense
  std::function<std::optional<Varied>(double)> at;  ///< nothing where no mirror or scene is left
};

/// Source shifted along and across the axis, the generatrix displaced along its normal by cosines of 0 to
/// `sensitivity.modes` half waves over its length, all slopes off by an angle, reflectance, power.
/// Across the axis means in the direction of the near field's first axis, so that a cut along it shows most.
std::vector<Deviation> deviations(const Scene& scene, const Profile& profile);

}  // namespace catoptric::design
