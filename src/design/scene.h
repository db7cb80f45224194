#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/profile.h"
#include "base/units.h"
#include "cad/engines.h"
#include "cad/export.h"
#include "design/candidate.h"
#include "design/constraints.h"
#include "design/curvature_profile.h"
#include "design/free_profile.h"
#include "design/settings.h"
#include "design/surroundings_settings.h"
#include "design/tailored_curve.h"
#include "optim/problem.h"
#include "sim/near_field.h"
#include "sim/planner.h"
#include "sim/simulation.h"

namespace catoptric::design {

struct Picture;

/// uniform and ring are zones: one, and two.
enum class TargetKind { none, paraboloid, reflector, csv, zones, gaussian, radial, image };

/// Where the desired irradiance comes from.
struct TargetSpec {
  TargetKind kind;
  double focal_length_mm = 0;
  double rim_radius_mm = 0;
  std::optional<Profile> reference;
  std::filesystem::path file;
  std::string column, weight_column;
  std::vector<double> radii_mm, irradiances_w_per_mm2;  ///< zones: outer radii; radial: the table
  std::vector<double> table_weights;                    ///< radial: of the table's radii; empty: all alike
  std::vector<double> zone_weights;  ///< zones, and one for what lies beyond; empty: all alike
  double peak_w_per_mm2 = 0, sigma_mm = 0;
  double reach_mm = 0;  ///< zones, gaussian, radial: nothing is wanted beyond
  std::vector<double> angles_rad, intensities_w_per_sr;  ///< wanted from afar; empty: nothing
  double resolution_rad = 0;                             ///< of angles there
  bool free_intensity = false;                           ///< of these only the shape is wanted
  std::shared_ptr<const Picture> picture;                ///< image
  std::vector<std::string> notes;                        ///< what is worth telling, in sentences
  bool free_scale = false;  ///< only the shape is wanted: its level is the program's to choose
};

/// How the near field's samples lie: even by area, or on the measuring grid of EN 12464-1.
enum class SampleGrid { area, en12464 };

enum class Engine { meridian, occt, mesh };
std::string_view name(Engine engine);

/// How the light is computed.
struct ModelSpec {
  std::optional<sim::Rung> rung;  ///< nothing: the planner's choice
  Engine engine;
  bool engine_asked_for;  ///< by name, not left to the program
  cad::MeshOptions mesh;  ///< of engine mesh
  sim::PhotonOptions photons;
  sim::EstimateOptions estimate;
  std::uint64_t replicates;
  std::uint64_t most_photons;  ///< that proving an accuracy may spend
};

enum class Metric {
  rmse,
  relative_rmse,
  enclosed_flux,
  uniformity,
  efficiency,
  intensity_rmse,
  diversity,
  relative_intensity_rmse
};
std::string_view name(Metric metric);

/// What a search may move of the shape: named components, all of the profile, or its curvature.
enum class Freedom { listed, profile, curvature };

struct SearchSpec {
  std::string method;
  Metric metric;
  double acceleration, reduction, smallest_step;
  long most_evaluations, most_iterations;
  int population;                  ///< 0: what suits the method
  long restarts;                   ///< from elsewhere in the box, after the first search
  std::optional<double> reach;     ///< in the metric's unit
  std::vector<double> kernels_mm;  ///< radii of kernels to search with before the model's own
  Freedom free = Freedom::listed;
  FreeProfileOptions free_profile = {};
  CurvatureProfileOptions curvature = {};
  std::vector<std::string> refine = {};  ///< steps of refined()
};

struct LandscapeSpec {
  std::vector<std::string> variables;
  std::vector<double> lower, upper;
  std::vector<int> steps;
  std::optional<double> greatest;                ///< drawn surfaces are cut off there
  bool paths = false;                            ///< the search's path is drawn
  std::vector<std::vector<double>> starts = {};  ///< more starts, in the landscape's variables
};

/// How far `tradeoff` goes.
struct TradeoffSpec {
  double seconds;              ///< longest evaluation tried
  int seeds;                   ///< independent repetitions with random numbers
  std::uint64_t most_photons;  ///< of one evaluation
  double reference_accuracy_rel;
};

/// What a mirror made by `start = "tailored"` is like.
struct TailoredSpec {
  std::optional<RayMap> map;  ///< nothing: the better one
  std::optional<double> vertex_mm;
  double rim_angle_rad;
  int degree;
  std::size_t points;
};

/// What `sensitivity` asks.
struct SensitivitySpec {
  double allowed_rel;  ///< change of the field that a tolerance may cost
  int modes;           ///< greatest number of half waves of a profile error
};

/// A scene, checked, in mm, W and rad; variables keep the scene's unit, which is what people read and write.
/// How the luminaire's intensity is tabulated, and what its photometric files say beside it.
struct IntensitySpec {
  double gamma_step_deg = 1, c_step_deg = 15;
  std::string luminaire, manufacturer, lamp, issue_date;
  double input_w = 0;
};

/// What `rays` writes.
struct RayOutputSpec {
  bool is_zemax;        ///< else IES TM-25-13
  std::uint64_t count;  ///< that the source sends out
  bool of_luminaire;    ///< else of the source alone
};

struct Scene {
  Settings settings;  ///< every key with its value, defaults included: what scene.toml holds
  std::string title;
  LengthUnit unit;
  std::uint64_t seed;
  int threads;
  std::optional<double> accuracy_rel;  ///< asked of every reported field; nothing: photons as the model says
  SourceSpec source;
  Profile profile;                         ///< as written, before the variables' start values
  std::optional<double> opening_mm;        ///< radius to be cut from every mirror; Profile has none of it yet
  std::vector<std::string> profile_notes;  ///< where an imported generatrix came from
  sim::Material mirror;
  double sheet_mm = 1;              ///< that the mirror is made of; for its mass alone
  double density_kg_per_m3 = 2700;  ///< likewise
  sim::NearField near_field;
  std::size_t samples;
  std::shared_ptr<const sim::Surroundings> surroundings;  ///< null: nothing stands about
  std::vector<FieldSpec> fields;                          ///< of the surroundings
  SampleGrid grid;
  TargetSpec target;
  TailoredSpec tailored;
  ModelSpec model;
  SearchSpec search;
  Constraints constraints;
  std::vector<optim::Variable> variables;  ///< lengths in the scene's unit
  std::optional<LandscapeSpec> landscape;
  TradeoffSpec tradeoff;
  SensitivitySpec sensitivity;
  IntensitySpec intensity;
  RayOutputSpec rays;
  cad::ExportOptions export_options;

  /// A mirror of this shape in the scene as it is written.
  Candidate with(const Profile& shape) const { return {shape, source, mirror}; }
  double to_scene_unit(double mm) const { return mm / millimetres_per(unit); }
};

/// Reads a scene file and applies the overrides.
/// @fails InputError naming file, line, key, rule and remedy; CadError when a profile file cannot be used
Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides = {});

/// A scene from its settings; with start = "tailored" the mirror is tailored.
Scene make_scene(Settings settings);

/// A scene as it is written: checked and complete, but no mirror is tailored yet.
/// @cost  some 0.1 ms, unless files must be read
Scene written_scene(Settings settings);

/// The scene as TOML with every default written out; reading it again gives the same scene bit for bit.
std::string scene_text(const Scene& scene);

}  // namespace catoptric::design
