#pragma once

#include <Standard_Handle.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Shape.hxx>
#include <optional>
#include <string>

#include "base/profile.h"
#include "cad/detail/exchange_file.h"

namespace catoptric::cad::detail {

/// Names of faces in files that have names for them.
inline constexpr const char* optical_surface_name = "optical surface";
inline constexpr const char* body_face_name = "body";

/// OCCT's document of a part with names, colours and material; closed when it is left.
class PartDocument {
 public:
  PartDocument();
  ~PartDocument();
  PartDocument(const PartDocument&) = delete;
  PartDocument& operator=(const PartDocument&) = delete;

  const Handle(TDocStd_Document) & get() const { return document_; }

 private:
  Handle(TDocStd_Document) document_;
};

/// Puts the part into the document under the labels' product name: its optical surface named and in light
/// blue, its other faces named and in grey, with the material if there is one.
/// @fails CadError when the part has no face with the profile's generatrix
void put_part(const PartDocument& document, const TopoDS_Shape& shape, const Profile& profile,
              const FileLabels& labels);

/// What of a part that was put into a document is not in another one, in words, or nothing.
/// @error colours within half a step of 8 bits; the density relative 1e-12
std::optional<std::string> difference(const PartDocument& document, const TopoDS_Shape& written,
                                      const Profile& profile, const FileLabels& labels);

}  // namespace catoptric::cad::detail
