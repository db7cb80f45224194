#pragma once

#include <Interface_FloatWriter.hxx>

namespace catoptric::cad::detail {

/// Has a STEP or IGES printer write 17 digits, which is every bit of a double; its own formats keep 10 to 13.
/// Outside 1e-99..1e99 (nothing of a mirror but noise) fewer, since the printer's buffer ends after 23
/// characters. Suppressing zeros is no option: OCCT 7.6 garbles numbers printed so.
inline void print_all_digits(Interface_FloatWriter& writer) {
  writer.SetFormat("%.14E");
  writer.SetFormatForRange("%.16E", 1e-99, 1e99);
}

}  // namespace catoptric::cad::detail
