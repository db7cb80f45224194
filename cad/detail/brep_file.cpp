#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <fstream>

#include "cad/detail/exchange_file.h"
#include "cad/detail/occt_guard.h"

namespace catoptric::cad::detail {

void write_brep(const TopoDS_Shape& shape, const std::filesystem::path& path) {
  ExchangeSession session;
  guarded("write the BREP file", path.string(), [&] {
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    BRepTools::Write(shape, out);
    out.flush();
    if (!out) throw IoError({"cannot write the BREP file", path.string(), "", "check the free space"});
  });
}

TopoDS_Shape read_brep(const std::filesystem::path& path) {
  ExchangeSession session;
  return guarded("read the BREP file", path.string(), [&] {
    TopoDS_Shape shape;
    if (!BRepTools::Read(shape, path.c_str(), BRep_Builder()) || shape.IsNull())
      throw CadError({"this is no BREP file with a shape", path.string(), "", "check the file"});
    return shape;
  });
}

}  // namespace catoptric::cad::detail
