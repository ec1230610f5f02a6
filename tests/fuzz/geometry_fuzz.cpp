/// From RIB of strangers to grids: primitives with any counts and control points. Input is what stands in a
/// world. Built and replayed as rib_fuzz.cpp is, with tests/fuzz/seeds/geometry as corpus.
#include <algorithm>
#include <cstdint>
#include <string>

#include "tests/fuzz/dice_text.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    constexpr size_t kMostBytes = size_t{1} << 15;
    trapeze::fuzz::dice_world({reinterpret_cast<const char*>(data), std::min(size, kMostBytes)});
    return 0;
}
