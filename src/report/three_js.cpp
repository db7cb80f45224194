#include "report/three_js.h"

// The assembler takes the files in: half a million characters would cost the compiler seconds as text.
#define CATOPTRIC_TAKE_IN(name, file)                                        \
  asm(".pushsection .rodata\n" #name "_begin:\n.incbin \"" file "\"\n" #name \
      "_end:\n.byte 0\n"                                                     \
      ".globl " #name "_begin\n.globl " #name "_end\n.popsection\n")

CATOPTRIC_TAKE_IN(catoptric_three_js, CATOPTRIC_THREE_JS);
CATOPTRIC_TAKE_IN(catoptric_orbit_controls_js, CATOPTRIC_ORBIT_CONTROLS_JS);

extern "C" {
extern const char catoptric_three_js_begin[], catoptric_three_js_end[];
extern const char catoptric_orbit_controls_js_begin[], catoptric_orbit_controls_js_end[];
}

namespace catoptric::report {

std::string_view three_js() { return {catoptric_three_js_begin, catoptric_three_js_end}; }

std::string_view orbit_controls_js() {
  return {catoptric_orbit_controls_js_begin, catoptric_orbit_controls_js_end};
}

std::string_view three_js_licence() {
  return R"(three.js r111 and OrbitControls, threejs.org. Copyright (c) 2010-2019 three.js authors. The MIT License:

Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated
documentation files (the "Software"), to deal in the Software without restriction, including without limitation the
rights to use, copy, modify, merge, publish, distribute, sublicense, and/or sell copies of the Software, and to permit
persons to whom the Software is furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all copies or substantial portions of the
Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED TO THE
WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR
COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR
OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE.)";
}

}  // namespace catoptric::report
