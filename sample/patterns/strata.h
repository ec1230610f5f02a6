/// Regions of a pixel, of the shutter and of the lens, jittered places in them, and bounds of what lies
/// there.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"

namespace trapeze {

/// Closed; holds for values bit for bit.
struct TimeSpan {
    float min = 0, max = 0;

    bool operator==(const TimeSpan&) const = default;
};

/// In the unit disk; closed, and holds for values bit for bit.
struct LensBox {
    float min_u = 0, min_v = 0, max_u = 0, max_v = 0;

    bool operator==(const LensBox&) const = default;
};

/// The greatest float below 1.
inline constexpr float kBelowOne = 0x1.fffffep-1f;

inline constexpr float kQuarterPi = 0.785398163f;
/// Sine divided by its angle, and cosine, as polynomials in the angle's square, highest power first; within
/// 1e-7 on [-kQuarterPi, kQuarterPi] [Cephes, sinf.c]. Multiplied and added one by one they round alike
/// everywhere, which the library's functions do not.
inline constexpr float kSine[] = {-1.9515295891e-4f, 8.3321608736e-3f, -1.6666654611e-1f, 1.0f};
inline constexpr float kCosine[] = {2.443315711809948e-5f, -1.388731625493765e-3f, 4.166664568298827e-2f,
                                    -0.5f, 1.0f};

/// A permutation of 0 .. count - 1 that depends on the seed alone: numbers sorted by their hashes.
std::vector<uint32_t> hashed_permutation(size_t count, uint32_t seed);

/// The unit square to the unit disk, areas kept in proportion [Shirley97].
V2f disk_from_square(float u, float v);

/// A jittered place in region `index` of `count` equal ones in [0, 1); jitter 0 to 1. Never 1, whatever
/// rounds.
float place(uint32_t index, float jitter, int count);

/// How the columns of a pixel's regions, or its rows, change places: within blocks of `block`, which is a
/// power of two and divides `count`, by an exclusive or, and the blocks by moving them along, the last ones
/// to the front. `bits`: random; over all of them each region comes to each place alike. For turned().
uint32_t turn_of(uint32_t bits, uint32_t count, uint32_t block);

/// The place of column or row `region` of `count`.
uint32_t turned(uint32_t region, uint32_t turn, uint32_t count);

/// The greatest place of a pixel: the next one's is just above.
float last_place_of(int pixel);

/// A place within a pixel; rounding may not move it into the next one.
float within_pixel(int pixel, float fraction);

/// Bounds place(index, jitter, count) for any jitter.
TimeSpan time_region(uint32_t index, int count);

/// Bounds the lens points of region `index` (rows of nx) of the square's nx * ny.
LensBox lens_region(uint32_t index, int nx, int ny);

}  // namespace trapeze
