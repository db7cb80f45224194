#include "cad/profile_import.h"

#include <fmt/format.h>

#include <gp_Ax1.hxx>
#include <gp_Lin.hxx>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "cad/detail/curve_source.h"
#include "cad/detail/exchange_check.h"
#include "cad/detail/import_here.h"
#include "cad/detail/isolated.h"
#include "cad/detail/meridian_frame.h"
#include "cad/detail/occt_curve.h"
#include "cad/detail/occt_guard.h"
#include "cad/detail/profile_packet.h"

namespace catoptric::cad {
namespace {

using detail::CurveSource;
using detail::SourceCurve;

std::string listing(const std::vector<std::string>& items) {
  constexpr std::size_t most = 40;
  std::string text;
  for (std::size_t i = 0; i < std::min(items.size(), most); ++i)
    text += fmt::format("{}[{}] {}", i ? "; " : "", i, items[i]);
  if (items.size() > most) text += fmt::format("; and {} more", items.size() - most);
  return text;
}

std::string words(const gp_Ax1& axis) {
  const gp_Pnt p = axis.Location();
  const gp_Dir d = axis.Direction();
  return fmt::format("({:.9g}, {:.9g}, {:.9g}) mm, direction ({:.9g}, {:.9g}, {:.9g})", p.X(), p.Y(), p.Z(),
                     d.X(), d.Y(), d.Z());
}

/// The lone straight line beside other curves: an axis.
const SourceCurve* lone_line(const CurveSource& source) {
  const auto is_line = [](const SourceCurve& curve) { return curve.is_line; };
  const auto count = std::count_if(source.curves.begin(), source.curves.end(), is_line);
  if (count != 1 || source.curves.size() < 2) return nullptr;
  return &*std::find_if(source.curves.begin(), source.curves.end(), is_line);
}

gp_Ax1 axis_along(const SourceCurve& line) {
  return {line.curve->StartPoint(), gp_Dir(gp_Vec(line.curve->StartPoint(), line.curve->EndPoint()))};
}

/// The curves that may be the profile.
std::vector<const SourceCurve*> candidates_of(const CurveSource& source) {
  const SourceCurve* axis = lone_line(source);
  std::vector<const SourceCurve*> candidates;
  for (const SourceCurve& curve : source.curves)
    if (&curve != axis) candidates.push_back(&curve);
  return candidates;
}

[[noreturn]] void refuse_empty(const CurveSource& source, const std::filesystem::path& file) {
  const std::string hint =
      "export the profile as a curve (IGES 126), or the mirror as a surface of revolution";
  if (source.refused.size() == 1) {
    const ErrorParts& parts = source.refused.front().parts;
    throw CadError({source.refused.front().name + ": " + parts.what, file.string(), parts.why,
                    parts.hint.empty() ? hint : parts.hint});
  }
  std::string why = "it has no free curve and no face of revolution";
  if (!source.refused.empty()) why = "none can be used";
  for (const detail::Refusal& each : source.refused) why += "; " + each.text();
  throw CadError({"there is no curve that could be a profile", file.string(), why, hint});
}

const SourceCurve& choose(const std::vector<const SourceCurve*>& candidates,
                          const std::vector<std::string>& descriptions, const CurveSource& source,
                          const std::filesystem::path& file, const ImportOptions& options) {
  if (candidates.empty()) refuse_empty(source, file);
  if (options.candidate) {
    if (*options.candidate >= candidates.size())
      throw CadError({fmt::format("there is no curve {}", *options.candidate), file.string(),
                      "the file offers " + listing(descriptions), "choose one of these numbers"});
    return *candidates[*options.candidate];
  }
  if (candidates.size() > 1)
    throw CadError({"several curves could be the profile", file.string(), listing(descriptions),
                    "choose one by its number, or export only the profile"});
  return *candidates.front();
}

struct ChosenAxis {
  gp_Ax1 axis;
  std::string note;
};

gp_Ax1 axis_from_user(const Axis& said) {
  const double length = said.direction.norm();
  constexpr double least_length = 1e-100;  // squares of shorter ones lose digits, of longer ones overflow
  if (!said.origin_mm.allFinite() || !(length >= least_length && length <= 1 / least_length))
    throw CadError({"the axis that was given is none", "",
                    "it needs a finite origin and a direction that is not zero",
                    "write for example 0 0 0  0 0 1"});
  const Vector3 unit = said.direction / length;
  return {gp_Pnt(said.origin_mm.x(), said.origin_mm.y(), said.origin_mm.z()),
          gp_Dir(unit.x(), unit.y(), unit.z())};
}

/// The common axis of all faces of revolution, if there is one.
std::optional<gp_Ax1> common_face_axis(const CurveSource& source) {
  if (source.face_axes.empty()) return std::nullopt;
  const gp_Ax1& first = source.face_axes.front();
  for (const gp_Ax1& axis : source.face_axes) {
    const double reach = 1 + std::abs(axis.Location().Distance(first.Location()));
    if (!axis.IsParallel(first, detail::import_rel) ||
        gp_Lin(first).Distance(axis.Location()) > detail::import_rel * reach)
      return std::nullopt;
  }
  return first;
}

ChosenAxis find_axis(const SourceCurve& curve, const CurveSource& source, const ImportOptions& options,
                     const std::filesystem::path& file) {
  if (options.axis) {
    const gp_Ax1 axis = axis_from_user(*options.axis);
    return {axis, "axis as given: " + words(axis)};
  }
  if (curve.axis) {
    const gp_Ax1 axis = detail::from_origin(*curve.axis);
    return {axis, "axis of the face: " + words(axis)};
  }
  if (const SourceCurve* line = lone_line(source)) {
    const gp_Ax1 axis = detail::from_origin(axis_along(*line));
    if (detail::see_from_axis(curve.curve, axis).meridian)
      return {axis, fmt::format("axis from the {}: {}", line->description, words(axis))};
  }
  if (const auto common = common_face_axis(source)) {
    const gp_Ax1 axis = detail::from_origin(*common);
    if (detail::see_from_axis(curve.curve, axis).meridian)
      return {axis, "axis of the file's faces of revolution: " + words(axis)};
  }
  const auto principal = detail::nearest_principal_axis(curve.curve);
  if (!principal)
    throw CadError({"no axis is found for the profile", file.string(),
                    "neither a lone line nor a coordinate axis lies in a plane with the curve",
                    "give the axis yourself, or draw it as a line (IGES 110) in the file"});
  std::string note =
      fmt::format("axis: the file's {} axis, the nearest to an end of the curve", principal->name);
  if (!principal->rivals.empty())
    note += fmt::format(" ({} would do too; give the axis if that was meant)", principal->rivals);
  return {principal->axis, note};
}

Profile to_profile(const Handle(Geom_BSplineCurve) & curve, const std::filesystem::path& file) {
  try {
    return detail::profile_of(curve);
  } catch (const InputError& error) {
    const ErrorParts& parts = error.parts();
    throw CadError({"the curve is no profile of a mirror", file.string(),
                    parts.what + (parts.why.empty() ? "" : ", but " + parts.why),
                    parts.hint.empty() ? "change the curve in the CAD program" : parts.hint});
  }
}

std::vector<std::string> notes_on(const CurveSource& source, const SourceCurve& curve, const ChosenAxis& axis,
                                  const detail::MeridianCurve& meridian) {
  std::vector<std::string> notes{source.unit, "profile: " + curve.description};
  notes.insert(notes.end(), curve.notes.begin(), curve.notes.end());
  notes.push_back(axis.note);
  const gp_Pnt origin = axis.axis.Location();
  notes.push_back(
      fmt::format("z = 0 at ({:.9g}, {:.9g}, {:.9g}) mm of the file", origin.X(), origin.Y(), origin.Z()));
  if (meridian.turned_round) notes.push_back("the curve ran from the rim inwards and was turned round");
  notes.push_back(fmt::format("points moved onto the meridian plane and the axis by at most {:.2g} mm",
                              meridian.moved_mm));
  for (const detail::Refusal& each : source.refused) notes.push_back("not used: " + each.text());
  return notes;
}

}  // namespace

ImportedProfile detail::import_here(const std::filesystem::path& file, ExchangeKind kind,
                                    const ImportOptions& options) {
  const CurveSource source = kind == ExchangeKind::step ? read_step_curves(file) : read_iges_curves(file);
  return guarded("find the profile", file.string(), [&] {
    const std::vector<const SourceCurve*> candidates = candidates_of(source);
    std::vector<std::string> descriptions;
    for (const SourceCurve* candidate : candidates) descriptions.push_back(candidate->description);
    const SourceCurve& curve = choose(candidates, descriptions, source, file, options);
    const ChosenAxis axis = find_axis(curve, source, options, file);
    const MeridianView view = see_from_axis(curve.curve, axis.axis);
    if (!view.meridian)
      throw CadError({"the curve is no meridian", file.string(), view.fault + "; " + axis.note,
                      "give another axis, or draw the profile on one side of its axis"});
    return ImportedProfile{to_profile(view.meridian->curve, file),
                           notes_on(source, curve, axis, *view.meridian), std::move(descriptions)};
  });
}

ImportedProfile import_profile(const std::filesystem::path& file, const ImportOptions& options) {
  const detail::ExchangeKind kind = detail::kind_of_file(file);
  return detail::unpack_profile(
      detail::run_isolated(file.string(),
                           detail::limits_for_file(file, options.time_limit, (std::size_t{1} << 30), 32),
                           [&] { return detail::pack_profile(detail::import_here(file, kind, options)); }),
      file);
}

}  // namespace catoptric::cad
