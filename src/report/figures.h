#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/field_grid.h"

/// Figures as gnuplot scripts with their data inside. Every function is pure: plain numbers in, text out, the
/// same text for the same numbers; draw() in gnuplot.h makes the picture. Text may hold anything: it is
/// quoted, never interpreted. Numbers that are not finite leave a gap.
/// All throw InputError when lists that belong together differ in length.
namespace catoptric::report {

struct PlanePoint {
  double x, y;
};

/// What a curve stands for; decides colour and line.
enum class CurveRole { initial, target, obtained, direct, reflected, other };

enum class AxisScale { linear, logarithmic };

/// A line through points in order.
struct Curve {
  std::string label;
  std::vector<double> x, y;
  CurveRole role = CurveRole::other;
};

enum class MarkKind { start, end, minimum };

/// A named point of a landscape.
struct Mark {
  std::string label;
  double x, y;
  MarkKind kind = MarkKind::start;
};

/// From where a surface is looked at.
struct SurfaceView {
  double tilt_deg = 55;  ///< 0 looks down, 90 from the side
  double turn_deg = 35;  ///< about the vertical
};

/// A generatrix in the meridian, with its control polygon.
struct GeneratrixCurve {
  std::string label;
  CurveRole role = CurveRole::other;
  std::vector<double> r, z;                  ///< points along the curve
  std::vector<double> control_r, control_z;  ///< control points, may be empty
};

/// Generatrices, source and near field in the meridian, one length unit on both axes (paper figures 1 and 2,
/// top).
struct GeneratrixFigure {
  std::string title;
  std::string length_unit;
  std::vector<GeneratrixCurve> curves;
  std::optional<PlanePoint> source;
  std::vector<PlanePoint> near_field;  ///< its section with the meridian, two points or more; may be empty
};
std::string generatrix_script(const GeneratrixFigure& figure);

/// Irradiance over the near field (paper figures 1 and 2).
struct IrradianceFigure {
  std::string title;
  std::string length_unit;
  std::string irradiance_name = "irradiance", irradiance_unit = "W/m²";
  GridField field;                        ///< gridded() makes one from samples
  std::optional<double> least, greatest;  ///< of the colour scale; set alike to compare two figures
  std::optional<double> disc_radius;      ///< draws the edge of a disc about (0, 0)
};
std::string irradiance_map_script(const IrradianceFigure& figure);
std::string irradiance_surface_script(const IrradianceFigure& figure, const SurfaceView& view = {});

/// Irradiance along a radius.
struct RadialCurve {
  std::string label;
  std::vector<double> r, irradiance;
  std::vector<double> half_band;  ///< drawn as a band of plus and minus this; may be empty
  CurveRole role = CurveRole::other;
  std::vector<double> band_shift = {};  ///< of the band's middle from the curve; empty: none
  std::string band_label = {};          ///< empty: the band has no entry in the key
};
struct RadialCutFigure {
  std::string title;
  std::string length_unit;
  std::string irradiance_name = "irradiance", irradiance_unit = "W/m²";
  std::vector<RadialCurve> curves;
};
std::string radial_cut_script(const RadialCutFigure& figure);

/// Best objective against evaluations, one point per iterate; a logarithmic axis leaves out values not above
/// 0.
struct ConvergenceFigure {
  std::string title;
  std::string objective_label;  ///< with its unit
  std::vector<Curve> curves;    ///< x evaluations, y objective
  std::string effort_label = "evaluations";
  AxisScale scale = AxisScale::logarithmic;
};
std::string convergence_script(const ConvergenceFigure& figure);

/// Any curves over one variable, with marks: a landscape of one variable is one.
struct LineFigure {
  std::string title;
  std::string x_label, y_label;
  std::vector<Curve> curves;
  std::vector<Mark> marks;
  AxisScale x_scale = AxisScale::linear, y_scale = AxisScale::linear;
};
std::string line_script(const LineFigure& figure);

/// Intensity in planes that hold a luminaire's axis, as a polar diagram: the axis points down.
struct PolarFigure {
  std::string title;
  std::string intensity_label;  ///< with its unit
  std::vector<Curve> curves;    ///< x angle to the axis in degrees, negative on the other side; y intensity
};
std::string polar_script(const PolarFigure& figure);

/// What settings cost and how near the truth they come, on logarithmic axes.
struct TradeFigure {
  std::string title;
  std::string x_label, y_label;
  std::vector<Curve> groups;   ///< settings as points, alike ones under one label
  Curve front;                 ///< those that no other beats, by rising cost
  std::vector<double> levels;  ///< accuracies marked by a line
};
std::string trade_script(const TradeFigure& figure);

/// The objective over two variables, with the paths searches took (paper figures 3 and 4).
struct LandscapeFigure {
  std::string title;
  std::string x_label, y_label, value_label;
  GridField objective;       ///< infinite or NaN where there is no value
  std::vector<Curve> paths;  ///< from start to end
  std::vector<Mark> marks;
  std::optional<double> greatest;  ///< values above are not told apart; the paper's figure 3 shows 0 to 4
  AxisScale scale = AxisScale::linear;
};
std::string landscape_contour_script(const LandscapeFigure& figure);
std::string landscape_surface_script(const LandscapeFigure& figure, const SurfaceView& view = {});

}  // namespace catoptric::report
