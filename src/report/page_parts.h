#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "design/scene.h"
#include "report/html_report.h"
#include "sim/light_paths.h"

namespace catoptric::report {

/// A figure as it was drawn; no SVG text when it could not be.
struct DrawnFigure {
  std::string name, caption, svg;
};

/// A page with what all of them have alike: title, origin, footer.
Page page_of(const design::Scene& scene, std::string_view command);

/// An area in the square of the scene's unit.
std::string area_text(const design::Scene& scene, double mm2);

/// The figures of these names, in their order; those that there are not are left out.
std::vector<PageFigure> picked(const std::vector<DrawnFigure>& figures,
                               const std::vector<std::string_view>& names);
/// All of them.
std::vector<PageFigure> picked(const std::vector<DrawnFigure>& figures);

/// The mirror: in space, generatrix, measures, control points, mass.
PageSection mirror_section(const design::Scene& scene, const Profile& profile,
                           const design::SourceSpec& source, const std::vector<sim::LightPath>& paths,
                           const std::vector<DrawnFigure>& figures);

/// All that is needed to run it again.
PageSection again_section(const design::Scene& scene, std::string_view command);

}  // namespace catoptric::report
