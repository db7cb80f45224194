#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/profile.h"
#include "design/scene.h"
#include "design/tailoring_task.h"

namespace catoptric::design {

/// A mirror for a wanted light, as for a point source; nothing where there is none.
using MirrorMaker = std::function<std::optional<Profile>(const WantedLight& wanted)>;

/// A mirror that was made for the real source by deceiving the point source's balance.
struct Compensated {
  Profile profile;
  double first_error_rel;  ///< of the point source's mirror under the real source
  double error_rel;        ///< of this one; relative root mean square over the near field's area
  double noise_rel;        ///< of these errors, by the spread of the photon sets
  double limit_rel;        ///< what images of the least size leave at best, wherever they are put
  int mirrors;             ///< made and lit on the way
  std::optional<std::string> objection;  ///< why they were lit as if nothing stood between them and a bare
                                         ///< plane; nothing where they were not
};

/// Where the source is no point, asks the point source's balance for a sharpened light, by a model in which
/// all images of the source are alike, and corrects it by what the real source then gives, until that comes
/// no nearer to the target. Of several sharpenings the best is taken.
///
/// Each mirror is lit by the real source, with photons folded about the axis and the same random numbers for
/// all mirrors; where a real near field beside the axis would shade them unevenly, on a bare plane.
/// @in    a source that is symmetric about the axis; image_mm: radius of the source's image on the near field
/// @cost  26 mirrors of some 0.15 s
/// @from  the feedback design of Fournier, Cassarly & Rolland 2009, "Designing freeform reflectors for
///        extended sources"
Compensated compensate(const Scene& scene, const TailoringTask& task, const Profile& first, double image_mm,
                       const MirrorMaker& make);

/// Radii of the source's images on the near field: the smallest and the largest that points of the mirror
/// throw there.
struct ImageRange {
  double least_mm, most_mm;
};
ImageRange source_images(const AxialLayout& layout, double source_radius_mm, const Profile& profile);

}  // namespace catoptric::design
