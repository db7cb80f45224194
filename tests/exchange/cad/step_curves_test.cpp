#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRep_Builder.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Wire.hxx>
#include <catch2/catch.hpp>
#include <cmath>
#include <gp_Ax1.hxx>

#include "cad/detail/exchange_file.h"
#include "cad/detail/occt_curve.h"
#include "cad/profile_import.h"
#include "support/cad/sample_profiles.h"
#include "support/temporary_folder.h"

// Free curves in STEP files. OCCT writes them here; what must come back is known beforehand.

using namespace catoptric;
using cad::detail::FileLabels;
using test::TemporaryFolder;

namespace {

cad::ImportedProfile through_step(const TopoDS_Shape& shape, LengthUnit unit,
                                  const cad::ImportOptions& options = {}) {
  const TemporaryFolder folder;
  const FileLabels labels{"curve.step", "curve", "", "", "1970-01-01T00:00:00"};
  cad::detail::write_step(shape, folder / "curve.step", labels, unit, cad::StepSchema::ap214);
  return cad::import_profile(folder / "curve.step", options);
}

bool mentions(const std::vector<std::string>& notes, const std::string& what) {
  for (const std::string& note : notes)
    if (note.find(what) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("A B-spline edge in STEP: the same profile, in any file unit") {
  const Profile profile = test::wavy_profile(4, true);
  const TopoDS_Shape edge = BRepBuilderAPI_MakeEdge(cad::detail::occt_curve(profile)).Edge();
  for (const auto unit : {LengthUnit::millimetre, LengthUnit::inch}) {
    const cad::ImportedProfile found = through_step(edge, unit);
    CHECK(mentions(found.notes, "STEP curve 1: B-spline, degree 4"));
    REQUIRE(found.profile.points().size() == profile.points().size());
    CHECK(found.profile.knots() == profile.knots());
    for (std::size_t i = 0; i < profile.points().size(); ++i) {
      CHECK(std::abs(found.profile.points()[i].r_mm - profile.points()[i].r_mm) <= 3e-14);  // inch and back
      CHECK(std::abs(found.profile.points()[i].z_mm - profile.points()[i].z_mm) <= 3e-14);
      CHECK(found.profile.points()[i].weight == profile.points()[i].weight);
    }
  }
}

TEST_CASE("A wire of arc and line in STEP, tilted, with its axis as a lone line") {
  gp_Trsf tilt;
  tilt.SetRotation(gp_Ax1(gp_Pnt(1., 2., 3.), gp_Dir(1., 1., 0.2)), 0.7);
  const auto at = [&](double r, double z) { return gp_Pnt(r, 0., z).Transformed(tilt); };
  BRepBuilderAPI_MakeWire wire;
  const double s = std::sqrt(0.5);
  wire.Add(
      BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(at(0, 100), at(50 * s, 50 + 50 * s), at(50, 50)).Value())
          .Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(at(50, 50), at(50, 0)).Edge());
  TopoDS_Compound both;
  BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, wire.Wire());
  builder.Add(both, BRepBuilderAPI_MakeEdge(at(0, -20), at(0, 120)).Edge());
  const cad::ImportedProfile found = through_step(both, LengthUnit::millimetre);
  CHECK(mentions(found.notes, "joined 2 pieces: 1 arc, 1 line"));
  CHECK(mentions(found.notes, "axis from the STEP curve"));
  CHECK(found.candidates.size() == 1);
  const double zero = gp_Vec(gp_Pnt(0., 0., 0.), at(0, 0)).Dot(gp_Vec(at(0, 0), at(0, 1)));
  const Profile& profile = found.profile;
  for (int i = 0; i <= 100; ++i) {
    const double u =
        profile.first_parameter() + (profile.last_parameter() - profile.first_parameter()) * i / 100;
    const MeridianPoint p = profile.at(u);
    const double z = p.z_mm - zero;
    CHECK(std::abs(z >= 50 ? std::hypot(p.r_mm, z - 50) - 50 : p.r_mm - 50) < 1e-12);  // ten roundings of 100
  }
}

TEST_CASE("Two edges in STEP are two candidates") {
  TopoDS_Compound both;
  BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, BRepBuilderAPI_MakeEdge(cad::detail::occt_curve(test::paraboloid())).Edge());
  builder.Add(both, BRepBuilderAPI_MakeEdge(cad::detail::occt_curve(test::hemisphere(20))).Edge());
  CHECK_THROWS_WITH(through_step(both, LengthUnit::millimetre), Catch::Contains("several curves"));
  cad::ImportOptions second;
  second.candidate = 1;
  CHECK(through_step(both, LengthUnit::millimetre, second).profile.r_max_mm() == Approx(20).epsilon(1e-12));
}
