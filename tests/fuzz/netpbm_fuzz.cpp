#include "fuzz/targets/netpbm.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  catoptric::fuzz::try_netpbm({reinterpret_cast<const char*>(data), size});
  return 0;
}
