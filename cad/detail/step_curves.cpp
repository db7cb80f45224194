#include <fmt/format.h>
#include <IFSelect_ReturnStatus.hxx>
#include <STEPControl_Reader.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TopExp_Explorer.hxx>

#include "cad/detail/curve_source.h"
#include "cad/detail/exchange_check.h"
#include "cad/detail/occt_guard.h"

namespace catoptric::cad::detail {
namespace {

void add_curve(const std::string& name, const std::vector<CurvePiece>& pieces, CurveSource& source) {
  try {
    SourceCurve curve = joined_curve(pieces);
    curve.description = fmt::format("{}: {}", name, curve.description);
    source.curves.push_back(std::move(curve));
  } catch (const CadError& error) {
    source.refused.push_back({name, error.parts()});
  }
}

/// Pieces of one wire or edge; an unusable one is noted and left out.
std::vector<CurvePiece> pieces_or_refusal(const std::string& name, const TopoDS_Shape& shape,
                                          CurveSource& source) {
  try {
    return pieces_of(shape);
  } catch (const CadError& error) {
    source.refused.push_back({name, error.parts()});
    return {};
  }
}

/// Wires and edges that bound no face; edges that meet end to end are one curve.
void add_free_curves(const TopoDS_Shape& shape, CurveSource& source) {
  int number = 0;
  for (TopExp_Explorer i(shape, TopAbs_WIRE, TopAbs_FACE); i.More(); i.Next()) {
    const std::string name = fmt::format("STEP wire {}", ++number);
    const auto pieces = pieces_or_refusal(name, i.Current(), source);
    if (!pieces.empty()) add_curve(name, pieces, source);
  }
  std::vector<CurvePiece> loose;
  for (TopExp_Explorer i(shape, TopAbs_EDGE, TopAbs_WIRE); i.More(); i.Next())
    for (CurvePiece& piece : pieces_or_refusal("a STEP edge", i.Current(), source))
      loose.push_back(std::move(piece));
  number = 0;
  for (const auto& chain : chains_of(std::move(loose)))
    add_curve(fmt::format("STEP curve {}", ++number), chain, source);
}

std::string unit_words(STEPControl_Reader& reader) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  return lengths.IsEmpty() ? "STEP file" : fmt::format("STEP file in {}", lengths.First().ToCString());
}

}  // namespace

CurveSource read_step_curves(const std::filesystem::path& file) {
  check_step_layout(file);
  ExchangeSession session;
  session.set("xstep.cascade.unit", "MM");
  return guarded("read the STEP file", file.string(), [&] {
    STEPControl_Reader reader;
    // Anything but "done" with roots must not reach TransferRoots: it crashes there.
    if (reader.ReadFile(file.c_str()) != IFSelect_RetDone || reader.NbRootsForTransfer() < 1)
      throw CadError({"this is no STEP file with geometry", file.string(), "", "export it again"});
    CurveSource source;
    source.unit = unit_words(reader);
    reader.TransferRoots();
    const TopoDS_Shape shape = reader.OneShape();
    if (shape.IsNull()) return source;
    add_free_curves(shape, source);
    CurveSource from_faces;
    add_faces_of_revolution(shape, from_faces);
    source.add_meridians(std::move(from_faces));
    return source;
  });
}

}  // namespace catoptric::cad::detail
