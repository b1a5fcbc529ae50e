// One fuzzer of libFuzzer; the build names its target.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "fuzz/targets.h"

extern "C" int LLVMFuzzerInitialize(int*, char***);
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size);

// Help is printed where it is asked for: to nobody.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  if (!std::freopen("/dev/null", "w", stdout)) std::abort();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  static const hemibake::FuzzTarget* const target = hemibake::find_fuzz_target(HEMIBAKE_FUZZ_TARGET);
  if (!target) std::abort();
  hemibake::run_fuzz_target(*target, {reinterpret_cast<const char*>(bytes), size});
  return 0;
}
