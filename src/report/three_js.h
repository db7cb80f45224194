#pragma once

#include <string_view>

namespace catoptric::report {

/// The library that draws in three dimensions, and its mouse: three.js r111 with its OrbitControls (MIT
/// licence), as Debian's package libjs-three has them, read into the program when it was built.
std::string_view three_js();
std::string_view orbit_controls_js();

/// Its licence, which goes with every copy.
std::string_view three_js_licence();

}  // namespace catoptric::report
