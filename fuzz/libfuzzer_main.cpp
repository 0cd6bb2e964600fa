// The entry point of libFuzzer, which brings main().
#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  retrolux::fuzz::FuzzOne({reinterpret_cast<const char*>(data), size});
  return 0;
}
