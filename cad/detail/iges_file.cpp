#include <IFSelect_ReturnStatus.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESControl_Writer.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESData_IGESWriter.hxx>
#include <IGESData_Protocol.hxx>
#include <IGESSelect_WorkLibrary.hxx>
#include <fstream>

#include "cad/detail/ascii.h"
#include "cad/detail/exchange_file.h"
#include "cad/detail/occt_guard.h"
#include "cad/detail/real_format.h"

namespace catoptric::cad::detail {
namespace {

/// "2026-01-31T12:00:00" as IGES writes it: "20260131.120000".
std::string iges_date(const std::string& stamp) {
  return stamp.substr(0, 4) + stamp.substr(5, 2) + stamp.substr(8, 2) + "." + stamp.substr(11, 2) +
         stamp.substr(14, 2) + stamp.substr(17, 2);
}

void label(const Handle(IGESData_IGESModel) & model, const FileLabels& labels) {
  IGESData_GlobalSection global = model->GlobalSection();
  global.SetSendName(ascii(labels.product));
  global.SetReceiveName(ascii(labels.product));
  global.SetFileName(ascii(labels.file_name));
  global.SetSystemId(ascii("catoptric"));
  global.SetInterfaceVersion(ascii("Open CASCADE"));
  global.SetAuthorName(ascii(labels.author));
  global.SetCompanyName(ascii(labels.organization));
  global.SetDate(ascii(iges_date(labels.time_stamp)));
  global.SetLastChangeDate(ascii(iges_date(labels.time_stamp)));
  model->SetGlobalSection(global);
}

}  // namespace

void write_iges(const TopoDS_Shape& shape, const std::filesystem::path& path, const FileLabels& labels,
                LengthUnit unit, IgesMode mode) {
  ExchangeSession session;
  session.set("xstep.cascade.unit", "MM");  // the writer takes numbers for mm whatever is said here
  session.set("write.iges.header.author", labels.author);
  session.set("write.iges.header.company", labels.organization);
  session.set("write.precision.mode", 0);
  guarded("write the IGES file", path.string(), [&] {
    IGESControl_Writer writer(unit_name(unit), mode == IgesMode::brep ? 1 : 0);
    if (!writer.AddShape(shape))
      throw CadError({"the shape does not go into IGES", path.string(), "OpenCASCADE's transfer failed",
                      "try the other mode, or STEP"});
    writer.ComputeModel();
    label(writer.Model(), labels);
    IGESData_IGESWriter printer(writer.Model());
    print_all_digits(printer.FloatWriter());
    printer.SendModel(IGESSelect_WorkLibrary::DefineProtocol());
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    const bool printed = printer.Print(out);
    out.flush();
    if (!printed || !out)
      throw IoError({"cannot write the IGES file", path.string(), "", "check the free space"});
  });
}

TopoDS_Shape read_iges(const std::filesystem::path& path) {
  ExchangeSession session;
  session.set("xstep.cascade.unit", "MM");
  session.set("read.iges.bspline.continuity", 0);  // or curves with kinks are cut up
  return guarded("read the IGES file", path.string(), [&] {
    IGESControl_Reader reader;
    if (reader.ReadFile(path.c_str()) != IFSelect_RetDone || reader.NbRootsForTransfer() < 1)
      throw CadError({"this is no IGES file with geometry", path.string(), "", "check the file"});
    reader.TransferRoots();
    const TopoDS_Shape shape = reader.NbShapes() > 0 ? reader.OneShape() : TopoDS_Shape();
    if (shape.IsNull()) throw CadError({"the IGES file holds no shape", path.string(), "", "check the file"});
    return shape;
  });
}

}  // namespace catoptric::cad::detail
