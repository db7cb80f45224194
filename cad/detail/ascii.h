#pragma once

#include <TCollection_HAsciiString.hxx>
#include <string>

namespace catoptric::cad::detail {

/// Text as OCCT's models of exchange files keep it.
inline Handle(TCollection_HAsciiString) ascii(const std::string& content) {
  return new TCollection_HAsciiString(content.c_str());
}

}  // namespace catoptric::cad::detail
