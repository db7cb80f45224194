#include <deque>
#include <string>

#include "base/tolerance.h"
#include "design/keys.h"
#include "sim/emission.h"
#include "sim/source.h"

namespace catoptric::design {
namespace {

/// Below these, products of light underflow and lose digits without a word.
constexpr double least_power_w = 1e-30, least_level = 1e-30;
constexpr double near = nearest, far = farthest;

/// The rows of a source once more, for one among several.
std::vector<Key> with_named_sources(const std::vector<Key>& keys) {
  static std::deque<std::string> texts;  // rows keep views of them
  constexpr std::string_view of_one = "source.";
  std::vector<Key> all, named;
  for (const Key& key : keys) {
    const bool of_source = key.path.starts_with(of_one);
    if (!of_source) all.insert(all.end(), named.begin(), named.end());
    if (!of_source) named.clear();
    all.push_back(key);
    if (!of_source) continue;
    Key one = key;
    one.path = texts.emplace_back("sources.*." + std::string(key.path.substr(of_one.size())));
    one.standard = {};
    one.meaning = texts.emplace_back("of one among several sources, as " + std::string(key.path));
    named.push_back(one);
  }
  return all;
}

// A table reads as rows.
// clang-format off

const std::vector<Key>& scene_table() {
  using enum KeyType;
  using Q = Quantity;
  static const std::vector<Key> table = with_named_sources({
      {.path = "title", .type = text, .standard = "\"\"", .meaning = "what the scene is, shown in reports"},
      {.path = "unit", .type = choice, .choices = {"mm", "cm", "m", "in"}, .standard = "\"mm\"", .meaning = "unit of every length in the scene and in what is written for it"},
      {.path = "seed", .type = integer, .least = 0, .greatest = 9e15, .standard = "1", .meaning = "key of all random numbers"},
      {.path = "threads", .type = integer, .least = 0, .greatest = 1024, .standard = "0", .meaning = "threads to use; 0: one per core. Results do not depend on it"},

      {.path = "accuracy", .type = number, .least = 0, .greatest = 1, .least_excluded = true, .meaning = "relative root mean square error allowed in every reported field, with 95 % probability; the program then finds rung, photons and bandwidth itself and says what it spent"},

      {.path = "start", .type = choice, .choices = {"profile", "tailored"}, .standard = "\"profile\"", .meaning = "where a mirror begins: as written, or tailored to the target by flux balance and ray directions, with no search of light. Listed variables are tailored from their starts; without reflector.points the whole mirror comes from source, target and package"},
      {.path = "tailored.map", .type = choice, .choices = {"auto", "diverging", "crossing"}, .standard = "\"auto\"", .meaning = "whether each half's light stays on its side of the axis or crosses it; auto takes what comes nearer to the target"},
      {.path = "tailored.vertex", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "distance of the mirror's apex from the source; the largest that constraints.rim_radius_max, height_max and envelope_radius allow when left out"},
      {.path = "tailored.rim_angle", .type = number, .least = 1, .greatest = 179, .standard = "90.0", .meaning = "target.scale = \"free\": how much of the source's light the mirror takes, as the rim's angle at the source from the apex, degrees"},
      {.path = "tailored.degree", .type = integer, .least = 2, .greatest = 9, .standard = "3", .meaning = "degree of a generatrix made from nothing"},
      {.path = "tailored.points", .type = integer, .least = 3, .greatest = 64, .standard = "10", .meaning = "its control points"},

      {.path = "source.kind", .type = choice, .choices = {"point", "disc", "rectangle", "sphere", "cylinder", "intensity", "rays", "several"}, .standard = "\"point\"", .meaning = "a point; or a surface that radiates by Lambert's law: one side of a flat disc or rectangle, a sphere, the side of a cylinder; or a point with the intensities of a photometric file; or the rays of a ray file; or several, named by sources.NAME"},
      {.path = "source.position", .type = numbers, .quantity = Q::length, .least = -far, .greatest = far, .count = 3, .standard = "[0.0, 0.0, 0.0]", .meaning = "x, y, z of the source, of a disc's centre"},
      {.path = "source.power", .type = number, .quantity = Q::power_w, .least = least_power_w, .greatest = 1e12, .meaning = "radiant power of the source"},
      {.path = "source.flux", .type = number, .quantity = Q::flux_lm, .least = least_power_w, .greatest = 1e12, .meaning = "luminous flux of the source, instead of its power: then all of the scene is in lm, lx and cd"},
      {.path = "source.exponent", .type = number, .least = 0, .greatest = sim::greatest_exponent, .meaning = "point: its intensity goes like this power of the cosine to its axis, with nothing behind; 0, when left out: alike in all directions"},
      {.path = "source.axis", .type = numbers, .least = -far, .greatest = far, .count = 3, .meaning = "direction in which the source is brightest, of a disc the side that radiates; [0, 0, 1] when left out"},
      {.path = "source.radius", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "disc, sphere, cylinder: its radius"},
      {.path = "source.length", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "cylinder: its length"},
      {.path = "source.width", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "rectangle: its width"},
      {.path = "source.height", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "rectangle: its height"},
      {.path = "source.along", .type = numbers, .least = -far, .greatest = far, .count = 3, .meaning = "rectangle: direction of its width; intensity: direction of C = 0; rays: direction of the file's x; taken across the axis, [1, 0, 0] when left out"},
      {.path = "source.file", .type = text, .meaning = "intensity: IES LM-63 (.ies) or EULUMDAT (.ldt) file, with source.axis the direction of gamma = 0; rays: IES TM-25 or Zemax binary ray file, with source.axis the direction of its z and source.position its origin. Its shape counts, and its light too when neither source.power nor source.flux is given"},

      {.path = "reflector.name", .type = text, .standard = "\"reflector\"", .meaning = "name of the part in exchange files"},
      {.path = "reflector.degree", .type = integer, .least = 1, .greatest = 9, .meaning = "degree of the generatrix"},
      {.path = "reflector.points", .type = points, .quantity = Q::length, .least = -far, .greatest = far, .meaning = "control points [r, z] from the apex to the rim"},
      {.path = "reflector.weights", .type = numbers, .least = least_weight, .greatest = greatest_weight, .meaning = "weights of the control points; all 1 when left out"},
      {.path = "reflector.knots", .type = numbers, .least = -far, .greatest = far, .meaning = "knots, each repeated by its multiplicity; equal clamped spans when left out"},
      {.path = "reflector.profile", .type = text, .meaning = "IGES or STEP file to take the generatrix from, instead of points"},
      {.path = "reflector.profile_index", .type = integer, .least = 0, .greatest = 1e6, .meaning = "which of the file's curves, as `catoptric profile` numbers them"},
      {.path = "reflector.profile_axis", .type = numbers, .least = -far, .greatest = far, .count = 6, .meaning = "axis of revolution in the file: a point in mm and a direction"},
      {.path = "reflector.profile_apex", .type = number, .quantity = Q::length, .least = -far, .greatest = far, .meaning = "z that the file's generatrix begins at; as it lies in the file when left out"},
      {.path = "reflector.profile_upside_down", .type = boolean, .meaning = "true turns the file's generatrix over, when its axis points the other way"},
      {.path = "reflector.reflectance", .type = number, .least = 0, .greatest = 1, .meaning = "share of the light that the mirror reflects about the mirrored direction, the same at all angles; 1 when left out"},
      {.path = "reflector.roughness", .type = number, .least = 0, .greatest = 1, .meaning = "how far that light spreads: alpha of GGX microfacets, the tangent within which half of their area is tilted; 0, when left out: not at all. Brushed metal has 0.1 to 0.3"},
      {.path = "reflector.diffuse", .type = number, .least = 0, .greatest = 1, .meaning = "share of the light that the mirror reflects besides, by Lambert's law; 0 when left out"},
      {.path = "reflector.angles", .type = numbers, .least = 0, .greatest = 90, .meaning = "angles of incidence from the normal, degrees, rising, of a reflectance that goes with the angle"},
      {.path = "reflector.reflectances", .type = numbers, .least = 0, .greatest = 1, .meaning = "reflectance at each of reflector.angles, linear in between, level before and after; instead of reflector.reflectance"},
      {.path = "reflector.index", .type = number, .least = 1e-3, .greatest = 1e3, .meaning = "refractive index n of a bare metal, whose reflectance by angle is Fresnel's, unpolarised; instead of reflector.reflectance"},
      {.path = "reflector.extinction", .type = number, .least = 0, .greatest = 1e3, .meaning = "its extinction coefficient k"},
      {.path = "reflector.transmittance", .type = number, .least = 0, .greatest = 1, .standard = "0.0", .meaning = "share of the light that passes straight through; the rest is absorbed"},
      {.path = "reflector.opening", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "radius of a round opening about the axis, for the lamp: of every mirror of the scene only what lies farther out is there, in simulation, search and files alike; variables are still those of the whole mirror"},
      {.path = "reflector.wall", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "wall thickness of the exported solid; left out: the open optical surface"},
      {.path = "reflector.wall_side", .type = choice, .choices = {"outside", "inside"}, .meaning = "side of the optical surface on which the wall stands"},
      {.path = "reflector.sheet", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "thickness of the sheet that the mirror is made of, for its mass in reports; reflector.wall, or else 1 mm, when left out"},
      {.path = "reflector.flange", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "width of a flat flange across the axis, outward from the rim of the optical surface; it needs a wall"},
      {.path = "reflector.flange_thickness", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "its thickness along the axis; the wall's when left out"},
      {.path = "reflector.material", .type = text, .meaning = "what a walled mirror is made of, in STEP files of AP242"},
      {.path = "reflector.density", .type = number, .least = 1e-3, .greatest = 1e6, .meaning = "density of what the mirror is made of, kg/m^3: `export` states the mass of a walled part of a named material; reports that of a sheet, of aluminium when left out (2700)"},

      {.path = "near_field.shape", .type = choice, .choices = {"disc", "rectangle"}, .standard = "\"disc\"", .meaning = "shape of the surface that is to be lit"},
      {.path = "near_field.center", .type = numbers, .quantity = Q::length, .least = -far, .greatest = far, .count = 3, .standard = "[0.0, 0.0, 0.0]", .meaning = "its centre"},
      {.path = "near_field.normal", .type = numbers, .least = -far, .greatest = far, .count = 3, .standard = "[0.0, 0.0, 1.0]", .meaning = "direction of the side that is to be lit"},
      {.path = "near_field.along", .type = numbers, .least = -far, .greatest = far, .count = 3, .meaning = "direction of a rectangle's width"},
      {.path = "near_field.radius", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "radius of a disc"},
      {.path = "near_field.width", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "width of a rectangle"},
      {.path = "near_field.height", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "height of a rectangle"},
      {.path = "near_field.samples", .type = integer, .least = 1, .greatest = 1e6, .standard = "512", .meaning = "points where the irradiance is asked for, uniform by area; with a grid of its own their number follows"},
      {.path = "near_field.grid", .type = choice, .choices = {"area", "en12464"}, .standard = "\"area\"", .meaning = "how they lie: even by area, or on the measuring grid of EN 12464-1 for a rectangle: spacing p = 0.2 * 5^(log10 d) m at most, d the longer side in m, the shorter one where the sides' ratio is 2 or more, p 10 m at most; near_field.samples is then left out"},
      {.path = "near_field.real", .type = boolean, .standard = "false", .meaning = "true: an object that stops light; false: an invisible register"},
      {.path = "near_field.reflectance", .type = number, .least = 0, .greatest = 1, .meaning = "share of the light that a real near field reflects, diffusely"},
      {.path = "near_field.specular", .type = number, .least = 0, .greatest = 1, .meaning = "share of the light that a real near field mirrors besides; 0 when left out"},
      {.path = "near_field.roughness", .type = number, .least = 0, .greatest = 1, .meaning = "how far that light spreads, as reflector.roughness"},
      {.path = "near_field.transmittance", .type = number, .least = 0, .greatest = 1, .meaning = "share of the light that passes straight through a real near field"},

      {.path = "fields.*.shape", .type = choice, .choices = {"disc", "rectangle", "cylinder", "file"}, .meaning = "a further surface where irradiance is asked for; rectangle when left out"},
      {.path = "fields.*.center", .type = numbers, .quantity = Q::length, .least = -far, .greatest = far, .count = 3, .meaning = "its centre, of a file where its origin comes to lie; [0, 0, 0] when left out"},
      {.path = "fields.*.file", .type = text, .meaning = "all faces of an IGES or STEP file, in its own unit of length; z is the mirror's axis"},
      {.path = "fields.*.chord_error", .type = number, .least = 1e-6, .greatest = 0.1, .meaning = "of the triangles that stand for a file's curved faces, over its size; 0.001 when left out"},
      {.path = "fields.*.normal", .type = numbers, .least = -far, .greatest = far, .count = 3, .meaning = "direction of the side that is to be lit, of a cylinder its axis; [0, 0, 1] when left out"},
      {.path = "fields.*.along", .type = numbers, .least = -far, .greatest = far, .count = 3, .meaning = "direction of a rectangle's width"},
      {.path = "fields.*.radius", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "radius of a disc or a cylinder"},
      {.path = "fields.*.width", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "width of a rectangle"},
      {.path = "fields.*.height", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "height of a rectangle"},
      {.path = "fields.*.length", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "length of a cylinder"},
      {.path = "fields.*.lit", .type = choice, .choices = {"inside", "outside", "front", "back"}, .meaning = "side that is to be lit, of a cylinder (inside when left out) or of a file's faces (front, where the normals of a solid look out, when left out)"},
      {.path = "fields.*.samples", .type = integer, .least = 1, .greatest = 1e6, .meaning = "points where the irradiance is asked for, uniform by area; 256 when left out"},
      {.path = "fields.*.kernel_radius", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "bandwidth there; a tenth of its smaller half size when left out (of a file it must be given)"},
      {.path = "fields.*.real", .type = boolean, .meaning = "true: an object that stops light; false, when left out: an invisible register"},
      {.path = "fields.*.reflectance", .type = number, .least = 0, .greatest = 1, .meaning = "share of the light that a real one reflects, diffusely"},
      {.path = "fields.*.transmittance", .type = number, .least = 0, .greatest = 1, .meaning = "share of the light that passes straight through a real one"},
      {.path = "fields.*.irradiance", .type = number, .quantity = Q::irradiance, .least = 0, .greatest = 1e15, .meaning = "irradiance wanted all over it; when left out it is reported and does not count"},
      {.path = "fields.*.weight", .type = number, .least = 0, .greatest = 1e12, .meaning = "how much its area counts beside the near field's; 1 when left out"},

      {.path = "objects.*.kind", .type = choice, .choices = {"disc", "rectangle", "cylinder", "sphere", "file", "pane", "dome"}, .meaning = "a thing that light meets: a sheet (disc or flat ring, rectangle, side of a cylinder, sphere or cap of one, all faces of an IGES or STEP file), or a body of glass (pane: flat, dome: between concentric spheres)"},
      {.path = "objects.*.center", .type = numbers, .quantity = Q::length, .least = -far, .greatest = far, .count = 3, .meaning = "its centre, of a dome its spheres', of a file where its origin lies; [0, 0, 0] when left out"},
      {.path = "objects.*.file", .type = text, .meaning = "IGES or STEP file, in its own unit of length; z is the mirror's axis"},
      {.path = "objects.*.chord_error", .type = number, .least = 1e-6, .greatest = 0.1, .meaning = "of the triangles that stand for a file's curved faces, over its size; 0.001 when left out"},
      {.path = "objects.*.normal", .type = numbers, .least = -far, .greatest = far, .count = 3, .meaning = "direction that it faces, of a cylinder its axis, of a cap or dome from the centre to its middle; [0, 0, 1] when left out"},
      {.path = "objects.*.along", .type = numbers, .least = -far, .greatest = far, .count = 3, .meaning = "direction of a rectangle's width"},
      {.path = "objects.*.radius", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "its radius, of a dome the outer"},
      {.path = "objects.*.inner_radius", .type = number, .quantity = Q::length, .least = 0, .greatest = far, .meaning = "radius of a disc's hole"},
      {.path = "objects.*.width", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "width of a rectangle or a rectangular pane"},
      {.path = "objects.*.height", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "its height"},
      {.path = "objects.*.length", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "length of a cylinder"},
      {.path = "objects.*.half_angle", .type = number, .least = 0, .greatest = 180, .least_excluded = true, .meaning = "of a cap or dome, from its normal, degrees; all of the sphere when left out"},
      {.path = "objects.*.thickness", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "of a pane, about its centre, or a dome, inwards"},
      {.path = "objects.*.reflectance", .type = number, .least = 0, .greatest = 1, .meaning = "share of the light that a sheet reflects like a mirror"},
      {.path = "objects.*.roughness", .type = number, .least = 0, .greatest = 1, .meaning = "of that mirror, as reflector.roughness; 0, smooth, when left out"},
      {.path = "objects.*.diffuse", .type = number, .least = 0, .greatest = 1, .meaning = "share of the light that a sheet reflects by Lambert's law"},
      {.path = "objects.*.transmittance", .type = number, .least = 0, .greatest = 1, .meaning = "share of the light that passes straight through a sheet; the rest is absorbed"},
      {.path = "objects.*.index", .type = number, .least = 1, .greatest = 10, .meaning = "refractive index of a pane's or dome's glass; its edges are black"},
      {.path = "objects.*.absorption", .type = number, .least = 0, .greatest = 1e15, .meaning = "light falls like exp(-absorption * way) in glass, per unit of the scene's length"},
      {.path = "objects.*.belongs", .type = choice, .choices = {"luminaire", "room"}, .meaning = "what it is part of: intensities are those of the luminaire, without the room"},

      {.path = "target.kind", .type = choice, .choices = {"none", "paraboloid", "reflector", "csv", "uniform", "ring", "zones", "gaussian", "radial", "image"}, .standard = "\"none\"", .meaning = "where the desired irradiance comes from: eq. 12 and 13 of the paper, the light of a reference reflector, a table of points, a grey picture, or a function of the distance from the axis: even on a disc or a ring, level in zones, a Gaussian, or a table along the radius"},
      {.path = "target.focal_length", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "paraboloid: distance a from vertex to focus; the focus is the source"},
      {.path = "target.rim_radius", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "paraboloid: radius of its rim, beyond which eq. 12 gives no light; 2 a when left out"},
      {.path = "target.degree", .type = integer, .least = 1, .greatest = 9, .meaning = "reference reflector: degree"},
      {.path = "target.points", .type = points, .quantity = Q::length, .least = -far, .greatest = far, .meaning = "reference reflector: control points"},
      {.path = "target.weights", .type = numbers, .least = least_weight, .greatest = greatest_weight, .meaning = "reference reflector: weights"},
      {.path = "target.knots", .type = numbers, .least = -far, .greatest = far, .meaning = "reference reflector: knots"},
      {.path = "target.file", .type = text, .meaning = "csv: table with columns x, y, z in the scene's unit and the irradiance (W/m^2, lx); its points replace the near field's samples. radial: table with columns radius and irradiance, linear in between, 0 beyond. image: grey picture, PNG, PGM or PFM, centred on the near field with its rows along the first axis (a rectangle's width) and the first row at the greatest second coordinate; bilinear between its pixels' centres, 0 beyond its edge"},
      {.path = "target.column", .type = text, .meaning = "csv, radial: name of the column that holds the irradiance"},
      {.path = "target.radius", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "uniform: radius of the lit disc; gaussian: where it is cut off, 3 sigma when left out. Nothing is wanted beyond"},
      {.path = "target.irradiance", .type = number, .quantity = Q::irradiance, .least = least_level, .greatest = 1e15, .meaning = "uniform, ring: irradiance wanted there, direct light included"},
      {.path = "target.inner_radius", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "ring: radius of its hole"},
      {.path = "target.outer_radius", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "ring: radius at which it ends"},
      {.path = "target.background", .type = number, .quantity = Q::irradiance, .least = 0, .greatest = 1e15, .meaning = "ring: irradiance wanted in its hole; 0 when left out"},
      {.path = "target.radii", .type = numbers, .quantity = Q::length, .least = near, .greatest = far, .meaning = "zones: their outer radii, rising"},
      {.path = "target.irradiances", .type = numbers, .quantity = Q::irradiance, .least = 0, .greatest = 1e15, .meaning = "zones: irradiance wanted in each"},
      {.path = "target.peak", .type = number, .quantity = Q::irradiance, .least = least_level, .greatest = 1e15, .meaning = "gaussian: irradiance wanted on the axis; image: of white, of a PFM that of its greatest value (its values are W/m^2 or lx when left out)"},
      {.path = "target.width", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "image: its width on the near field, from edge to edge; follows from height and the number of pixels when left out"},
      {.path = "target.height", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "image: its height, likewise"},
      {.path = "target.transfer", .type = choice, .choices = {"linear", "srgb", "gamma"}, .meaning = "image, PNG and PGM: how grey, 0 to 1, stands for irradiance: in proportion, by sRGB's curve, or to the power target.gamma; when left out as the file says (sRGB and gAMA chunks of a PNG), and linear where it does not say"},
      {.path = "target.gamma", .type = number, .least = 0.1, .greatest = 10, .meaning = "image: irradiance goes like grey to this power"},
      {.path = "target.sigma", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "gaussian: radius at which it has fallen to exp(-1/2)"},
      {.path = "target.fwhm", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "gaussian: its full width at half maximum, instead of sigma"},
      {.path = "target.scale", .type = choice, .choices = {"absolute", "free"}, .meaning = "free: only the target's shape is wanted, and its level is the program's to choose; absolute when left out"},
      {.path = "target.zone_weights", .type = numbers, .least = 0, .greatest = 1e12, .meaning = "uniform, ring, zones: how much a sample counts in each zone from the axis outwards, and beyond the last; all 1 when left out"},
      {.path = "target.level", .type = number, .least = least_level, .greatest = 1e15, .meaning = "factor on the target's irradiance; what target.scale = \"free\" found"},
      {.path = "target.intensity_file", .type = text, .meaning = "besides any kind: table of what is wanted from afar, of source and mirror without the near field: columns angle (degrees, from the direction in which light leaves for the near field, against its normal; 85 at most) and intensity (W/sr, or cd with source.flux), linear in between; directions beyond the last angle do not count. Or an IES or EULUMDAT file (.ies, .ldt), of which the mean over C counts"},
      {.path = "target.intensity_scale", .type = choice, .choices = {"absolute", "free"}, .meaning = "free: only that table's shape is wanted, so that cd will do in a scene of W; absolute when left out"},
      {.path = "target.intensity_level", .type = number, .least = least_level, .greatest = 1e15, .meaning = "factor on that table's intensities; 1 when left out"},
      {.path = "target.intensity_resolution", .type = number, .least = 1e-6, .greatest = 20, .meaning = "radius of the kernel that intensities are seen through, degrees at the axis; 2 when left out"},
      {.path = "target.weight_column", .type = text, .meaning = "csv, radial: name of the column that says how much a point counts; all 1 when left out"},

      {.path = "model.rung", .type = choice, .choices = {"auto", "tubes", "rings", "photons"}, .standard = "\"auto\"", .meaning = "how light is computed: ray tubes without noise, photons folded about the axis, or photons in space; auto takes the first of these that is valid. The verdict on a design is by photons in any case"},
      {.path = "model.engine", .type = choice, .choices = {"auto", "meridian", "occt", "mesh"}, .standard = "\"auto\"", .meaning = "how rays meet the mirror: meridian, exact and fast; occt, the slow reference; mesh, triangles refined by Newton"},
      {.path = "model.chord_error", .type = number, .least = 1e-6, .greatest = 0.05, .standard = "0.0001", .meaning = "engine mesh: greatest distance of a triangle from the mirror, over the mirror's diagonal"},
      {.path = "model.newton_tolerance", .type = number, .least = 0, .greatest = 1, .least_excluded = true, .standard = "1e-14", .meaning = "engine mesh: how near a refined hit comes to the mirror, over its diagonal; from chord_error on nothing is refined"},
      {.path = "model.photons", .type = integer, .least = 0, .greatest = sim::most_photons, .standard = "100000", .meaning = "photons emitted for one evaluation; Sobol points are evenest at a power of two"},
      {.path = "model.neighbours", .type = integer, .least = 1, .greatest = 1e9, .meaning = "photons in one estimate (the paper's N); not together with kernel_radius"},
      {.path = "model.kernel_radius", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "fixed radius of the kernel; a tenth of the near field's half-width when both are left out"},
      {.path = "model.kernel", .type = choice, .choices = {"silverman", "epanechnikov", "cone", "gaussian", "constant"}, .standard = "\"silverman\"", .meaning = "weight of a photon by its distance"},
      {.path = "model.sampler", .type = choice, .choices = {"random", "sobol"}, .standard = "\"sobol\"", .meaning = "independent random photons, or Owen-scrambled Sobol points"},
      {.path = "model.replicates", .type = integer, .least = 2, .greatest = 1000, .standard = "8", .meaning = "independent repetitions behind every reported figure, which give its noise"},
      {.path = "model.most_photons", .type = integer, .least = 10000, .greatest = 1e12, .standard = "100000000", .meaning = "photons that proving an accuracy may spend; at worst all are in memory at once, some 36 bytes each"},
      {.path = "model.interactions", .type = integer, .least = 1, .greatest = 1e6, .standard = "1000", .meaning = "a photon is stopped after so many meetings with surfaces"},

      {.path = "search.method", .type = choice, .choices = {"hooke-jeeves", "levenberg-marquardt", "nelder-mead", "compass", "cma-es", "differential-evolution", "self-adaptive-de", "particle-swarm", "simulated-annealing", "genetic", "none"}, .standard = "\"hooke-jeeves\"", .meaning = "how better mirrors are looked for: the first four go downhill from the start, the others look over the whole box, and with none the mirror is judged as it starts; levenberg-marquardt needs ray tubes"},
      {.path = "search.metric", .type = choice, .choices = {"rmse", "relative-rmse", "enclosed-flux", "uniformity", "efficiency", "intensity-rmse", "diversity", "relative-intensity-rmse"}, .standard = "\"rmse\"", .meaning = "what is made small: eq. 7 in W/m^2, or the same divided by the target's root mean square; or made large: the share of the source's power within the target's reach, least over mean (uniformity) or over greatest irradiance (diversity) where it is lit, or the share of the power that falls there; intensity-rmse is small where the intensity from afar is that of target.intensity_file, W/sr, relative-intensity-rmse is over that table's root mean square"},
      {.path = "search.acceleration", .type = number, .least = 0, .greatest = 1000, .standard = "1.0", .meaning = "hooke-jeeves: factor alpha of the pattern step"},
      {.path = "search.reduction", .type = number, .least = 0, .greatest = 0.99, .least_excluded = true, .standard = "0.5", .meaning = "hooke-jeeves: the step is multiplied by it after a failed iteration"},
      {.path = "search.smallest_step", .type = number, .least = 0, .greatest = 1, .least_excluded = true, .standard = "0.001", .meaning = "hooke-jeeves ends when the step is below this share of the first"},
      {.path = "search.most_evaluations", .type = integer, .least = 1, .greatest = 1e9, .standard = "2000", .meaning = "the search ends after so many evaluations"},
      {.path = "search.most_iterations", .type = integer, .least = 1, .greatest = 1e9, .standard = "1000", .meaning = "hooke-jeeves and levenberg-marquardt end after so many iterations"},
      {.path = "search.reach", .type = number, .least = 0, .meaning = "the search ends when the metric is at or below"},
      {.path = "search.restarts", .type = integer, .least = 0, .greatest = 1e6, .standard = "0", .meaning = "further searches from points all over the box, within the same most_evaluations"},
      {.path = "search.population", .type = integer, .least = 0, .greatest = 1e6, .standard = "0", .meaning = "design vectors in one generation; 0: what suits the method"},
      {.path = "search.free", .type = choice, .choices = {"listed", "profile", "curvature"}, .standard = "\"listed\"", .meaning = "what a search moves of the mirror's shape: the variables listed under [variables]; all of the generatrix, less what leaves its shape as it is (weights as logarithms, logw1); or its curvature at equal arc lengths. With the last two, listed variables give their start, with profile their step and bounds too"},
      {.path = "search.hold_vertex", .type = boolean, .standard = "false", .meaning = "search.free profile and curvature: true holds the vertex' z0"},
      {.path = "search.curvature_stations", .type = integer, .least = 2, .greatest = 64, .standard = "8", .meaning = "search.free curvature: how many curvatures there are, vertex and rim among them"},
      {.path = "search.refine", .type = texts, .standard = "[]", .meaning = "search.free profile: steps that give the best mirror more freedom without changing it, each with a search of its own: degree N, spans N"},
      {.path = "search.kernels", .type = numbers, .quantity = Q::length, .least = near, .greatest = far, .meaning = "radii of kernels, widest first, to search with before model.kernel_radius: each search begins where the last one ended"},

      {.path = "constraints.rim_radius_min", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "least radius of the rim, where the generatrix ends"},
      {.path = "constraints.rim_radius_max", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "greatest radius of the rim"},
      {.path = "constraints.height_max", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "greatest extent along the axis"},
      {.path = "constraints.opening_min", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "radius about the axis that stays free, for the lamp and its neck"},
      {.path = "constraints.envelope_radius", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "greatest radius of any part"},
      {.path = "constraints.envelope_z", .type = numbers, .quantity = Q::length, .least = -far, .greatest = far, .count = 2, .meaning = "least and greatest z of any part"},
      {.path = "constraints.curvature_radius_min", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "least radius of curvature of the generatrix; a corner has none"},
      {.path = "constraints.draft_angle_min", .type = number, .least = 0, .greatest = 90, .meaning = "least angle between wall and axis, in degrees: the part leaves a mould along the axis"},
      {.path = "constraints.wall", .type = number, .quantity = Q::length, .least = near, .greatest = far, .meaning = "a wall of this thickness, on the side of reflector.wall_side, must not fold"},
      {.path = "constraints.no_folds", .type = boolean, .meaning = "true: the generatrix does not cross itself, and from apex to rim first reflections land ever farther out or ever farther in"},

      {.path = "variables.*.start", .type = number, .least = -far, .greatest = far, .meaning = "first value; the scene's own when left out. Variables are r0, z0, w0, r1, ... of the reflector, and source.x, source.y, source.z, source.power (or source.flux), source.exponent, reflector.reflectance"},
      {.path = "variables.*.step", .type = number, .least = 0, .greatest = far, .least_excluded = true, .meaning = "first step"},
      {.path = "variables.*.lower", .type = number, .least = -far, .greatest = far, .meaning = "least value allowed"},
      {.path = "variables.*.upper", .type = number, .least = -far, .greatest = far, .meaning = "greatest value allowed"},

      {.path = "landscape.variables", .type = texts, .meaning = "one or two variables over which the objective is drawn"},
      {.path = "landscape.lower", .type = numbers, .least = -far, .greatest = far, .meaning = "least value of each"},
      {.path = "landscape.upper", .type = numbers, .least = -far, .greatest = far, .meaning = "greatest value of each"},
      {.path = "landscape.steps", .type = numbers, .least = 2, .greatest = 10000, .meaning = "how many values of each"},
      {.path = "landscape.greatest", .type = number, .least = 0, .least_excluded = true, .meaning = "objective above which the drawn surface is cut off; the table keeps all"},
      {.path = "landscape.paths", .type = boolean, .standard = "false", .meaning = "true: the scene's search is run from its start, and its path drawn over the contours"},
      {.path = "landscape.starts", .type = points, .standard = "[]", .meaning = "further starts of such searches: values of the landscape's two variables"},

      {.path = "tradeoff.seconds", .type = number, .least = 0, .greatest = 1e6, .least_excluded = true, .standard = "1.0", .meaning = "settings whose evaluation takes longer are left out, s"},
      {.path = "tradeoff.seeds", .type = integer, .least = 1, .greatest = 1000, .standard = "3", .meaning = "independent repetitions of every setting that uses random numbers"},
      {.path = "tradeoff.most_photons", .type = integer, .least = 1000, .greatest = 1e9, .standard = "1000000", .meaning = "photons of the dearest settings; a reference by photons may take 50 times as many"},
      {.path = "tradeoff.reference_accuracy", .type = number, .least = 0, .greatest = 1, .least_excluded = true, .standard = "0.0002", .meaning = "relative error aimed at in a reference without closed form"},

      {.path = "sensitivity.allowed", .type = number, .least = 1e-6, .greatest = 1, .standard = "0.02", .meaning = "change of the field that each tolerance of the maker's table may cost: root mean square over the samples, relative to the field's own"},
      {.path = "sensitivity.modes", .type = integer, .least = 0, .greatest = 12, .standard = "4", .meaning = "profile errors are cosines over the generatrix' length, of 0 to so many half waves"},

      {.path = "intensity.gamma_step", .type = number, .least = 0.01, .greatest = 30, .standard = "1.0", .meaning = "command intensity: step of the angle to the luminaire's axis, degrees"},
      {.path = "intensity.c_step", .type = number, .least = 0.1, .greatest = 90, .standard = "15.0", .meaning = "step of the angle about it, degrees; of no use where the light is alike all round"},
      {.path = "intensity.luminaire", .type = text, .standard = "\"\"", .meaning = "the luminaire's name in photometric files; the scene's title when empty"},
      {.path = "intensity.manufacturer", .type = text, .standard = "\"\"", .meaning = "who makes it, in photometric files"},
      {.path = "intensity.lamp", .type = text, .standard = "\"\"", .meaning = "its lamp, in photometric files"},
      {.path = "intensity.issue_date", .type = text, .standard = "\"\"", .meaning = "date of issue in photometric files, as 2026-05-17; not stated when empty, so that a run gives the same files on any day"},
      {.path = "intensity.input_power", .type = number, .least = 0, .greatest = 1e9, .standard = "0.0", .meaning = "electric power it takes, W, in photometric files; 0: not stated"},

      {.path = "rays.format", .type = choice, .choices = {"tm25", "zemax"}, .standard = "\"tm25\"", .meaning = "command rays: IES TM-25-13 (.tm25ray) or Zemax binary (.dat)"},
      {.path = "rays.count", .type = integer, .least = 1, .greatest = sim::most_photons, .standard = "1000000", .meaning = "rays that the source sends out; Zemax files hold 4,000,000,000"},
      {.path = "rays.of", .type = choice, .choices = {"source", "luminaire"}, .standard = "\"source\"", .meaning = "source: all of its rays, with nothing about it, in its own frame (origin source.position, z along source.axis, x along source.along); luminaire: those that leave source and mirror, from where they last left one of them, in the scene's frame"},

      {.path = "export.unit", .type = choice, .choices = {"mm", "cm", "m", "in"}, .standard = "\"mm\"", .meaning = "unit of length inside exchange files"},
      {.path = "export.step_schema", .type = choice, .choices = {"ap203", "ap214", "ap242"}, .standard = "\"ap214\"", .meaning = "STEP application protocol"},
      {.path = "export.iges_mode", .type = choice, .choices = {"faces", "brep"}, .standard = "\"faces\"", .meaning = "IGES entities: trimmed surfaces (144) or boundary representation (186)"},
      {.path = "export.dxf_curves", .type = choice, .choices = {"auto", "splines", "polylines"}, .standard = "\"auto\"", .meaning = "curves of a DXF section: exact splines, or polylines within the chord tolerance; auto: splines without weights up to degree 3, which all readers of DXF read right, else polylines"},
  });
  return table;
}

const std::vector<Key>& study_table() {
  using enum KeyType;
  static const std::vector<Key> table{

      {.path = "title", .type = text, .meaning = "what the study shows"},
      {.path = "command", .type = choice, .choices = {"design", "simulate"}, .meaning = "what is done with each run's scene"},
      {.path = "scene", .type = text, .meaning = "the scene that runs vary, relative to the study's folder"},
      {.path = "runs.name", .type = text, .meaning = "the run's name; also its folder"},
      {.path = "runs.scene", .type = text, .meaning = "a scene of the run's own"},
      {.path = "runs.set", .type = text, .meaning = "table of scene keys and the values they take in this run"},
      {.path = "runs.reference", .type = text, .meaning = "table of figures from elsewhere, printed beside ours under the same names"},
  };
  return table;
}

// clang-format on

}  // namespace

std::span<const Key> scene_keys() { return scene_table(); }
std::span<const Key> study_keys() { return study_table(); }

}  // namespace catoptric::design
