#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepLib.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <Geom_OffsetCurve.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <catch2/catch.hpp>

#include "base/tolerance.h"
#include "base/units.h"
#include "cad/detail/comparison.h"
#include "cad/detail/exchange_file.h"
#include "cad/detail/occt_curve.h"
#include "cad/detail/shape.h"
#include "support/cad/sample_profiles.h"
#include "support/temporary_folder.h"

// The comparison after writing must fail when something was lost: here things are lost on purpose.

using namespace catoptric;
using namespace catoptric::cad::detail;
using test::TemporaryFolder;

namespace {

const FileLabels labels{"mirror.step", "reflector", "", "", "1970-01-01T00:00:00"};

/// The paraboloid with a wall whose outer side is an offset curve, which STEP cannot hold.
TopoDS_Shape solid_on_offset_curve(const Profile& profile, double thickness_mm) {
  const Handle(Geom_BSplineCurve) inner = occt_cad_curve(profile);
  const Handle(Geom_OffsetCurve) outer = new Geom_OffsetCurve(inner, thickness_mm, gp::DY());
  BRepBuilderAPI_Sewing sewing(1e-6);
  for (const Handle(Geom_Curve) & curve : {Handle(Geom_Curve)(inner), Handle(Geom_Curve)(outer)})
    sewing.Add(
        BRepBuilderAPI_MakeFace(new Geom_SurfaceOfRevolution(curve, gp::OZ()), 0., 2 * pi, 0., 1., 1e-7)
            .Face());
  const TopoDS_Edge rim = BRepBuilderAPI_MakeEdge(inner->EndPoint(), outer->Value(1.)).Edge();
  sewing.Add(BRepPrimAPI_MakeRevol(rim, gp::OZ()).Shape());
  sewing.Perform();
  TopoDS_Solid solid = BRepBuilderAPI_MakeSolid(TopoDS::Shell(sewing.SewedShape())).Solid();
  BRepLib::OrientClosedSolid(solid);
  return solid;
}

TopoDS_Shape through_step(const TopoDS_Shape& shape) {
  const TemporaryFolder folder;
  write_step(shape, folder / "mirror.step", labels, LengthUnit::millimetre, cad::StepSchema::ap214);
  return read_step(folder / "mirror.step");
}

/// The paraboloid with one number changed.
Profile twin(double r_shift, double z_shift, double weight_factor) {
  return Profile::bezier({{0, 100, 1}, {50 + r_shift, 100 + z_shift, weight_factor}, {100, 50, 1}});
}

}  // namespace

TEST_CASE("What went through STEP unharmed compares equal") {
  const Profile profile = test::paraboloid();
  for (const auto& wall : {std::optional<cad::Wall>(), std::optional(cad::Wall{2})}) {
    const TopoDS_Shape shape = make_shape(profile, wall);
    const Comparison comparison = compare(through_step(shape), shape, profile);
    INFO(comparison.loss.value_or(""));
    CHECK(!comparison.loss);
    CHECK(comparison.largest_deviation_mm == 0);
  }
}

TEST_CASE("A solid on an offset curve loses a face in STEP, and the comparison says so") {
  const Profile profile = test::paraboloid();
  const TopoDS_Shape shape = solid_on_offset_curve(profile, 2);
  REQUIRE(measure(shape).is_valid);
  REQUIRE(measure(shape).face_count == 3);
  const Comparison comparison = compare(through_step(shape), shape, profile);
  REQUIRE(comparison.loss);
  CHECK(comparison.loss->find("faces") != std::string::npos);
}

TEST_CASE("A profile that differs by little more than the tolerance does not pass for the other") {
  const Profile profile = test::paraboloid();
  const TopoDS_Shape shape = optical_face(profile), reread = through_step(shape);
  const double tolerance_mm = Tolerance::for_scale(profile.diagonal_mm()).exchange_mm;
  CHECK(compare(reread, shape, twin(2 * tolerance_mm, 0, 1)).loss);
  CHECK(compare(reread, shape, twin(0, -2 * tolerance_mm, 1)).loss);
  CHECK(compare(reread, shape, twin(0, 0, 1 + 3e-12)).loss);  // weights are compared to 1e-12
  CHECK(!compare(reread, shape, twin(0.5 * tolerance_mm, 0, 1)).loss);
}

TEST_CASE("Another degree, number of poles or knot does not pass") {
  const Profile profile = test::wavy_profile(3, true);
  const TopoDS_Shape shape = optical_face(profile), reread = through_step(shape);
  CHECK(compare(reread, shape, test::wavy_profile(4, true)).loss);
  CHECK(compare(reread, shape, test::wavy_profile(3, false)).loss);
  std::vector<double> knots = profile.knots();
  knots[4] += 1e-9;
  const Profile moved_knot(3, knots, profile.points());
  REQUIRE(compare(reread, shape, moved_knot).loss);
  CHECK(compare(reread, shape, moved_knot).loss->find("knot") != std::string::npos);
}

TEST_CASE("A mirror that was moved, tilted or scaled does not pass") {
  const Profile profile = test::paraboloid();
  const TopoDS_Shape shape = optical_face(profile);
  gp_Trsf moved, tilted, larger;
  moved.SetTranslation(gp_Vec(0., 1e-6, 0.));
  tilted.SetRotation(gp::OX(), 1e-6);
  larger.SetScale(gp_Pnt(0., 0., 0.), 1 + 1e-8);
  for (const gp_Trsf& change : {moved, tilted, larger})
    CHECK(compare(BRepBuilderAPI_Transform(shape, change, true).Shape(), shape, profile).loss);
}

TEST_CASE("A solid that came back as its faces does not pass for the solid") {
  const Profile profile = test::paraboloid();
  const TopoDS_Shape shape = walled_solid(profile, {2});
  const TemporaryFolder folder;
  write_iges(shape, folder / "mirror.igs", labels, LengthUnit::millimetre, cad::IgesMode::faces);
  const TopoDS_Shape faces = read_iges(folder / "mirror.igs");
  CHECK(compare(faces, shape, profile, Keeps::everything).loss);
  CHECK(!compare(faces, shape, profile, Keeps::faces).loss);
  CHECK(compare(optical_face(profile), shape, profile, Keeps::faces).loss);  // the outer side is missing
}
