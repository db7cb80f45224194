#include "fuzz/targets/eulumdat.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  catoptric::fuzz::try_eulumdat({reinterpret_cast<const char*>(data), size});
  return 0;
}
