#include "sample/patterns/strata.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/portable_math.h"
#include "core/random.h"

namespace trapeze {
namespace {

/// disk_from_square() rounds by less than this.
constexpr double kDiskRounding = 2e-6;

struct StratumSide {
    double min, max;
};

/// The disk's x of a point of the square [-1, 1]^2; y is the same with a and b exchanged.
double disk_x(double a, double b) {
    if (a == 0) return 0;
    if (std::abs(a) > std::abs(b)) return a * portable::cos(M_PI / 4 * (b / a));
    return b * portable::sin(M_PI / 4 * (a / b));
}

/// The range of disk_x over a rectangle. It grows with a. For given a it is even in b; its magnitude is
/// largest at b = 0, falls until |b| = |a|, and rises from there: extremes are at these and at the ends.
StratumSide disk_x_range(StratumSide a, StratumSide b) {
    StratumSide range{2, -2};
    const auto add = [&](double at_a, double at_b) {
        if (at_b < b.min || at_b > b.max) return;
        const double x = disk_x(at_a, at_b);
        range = {std::min(range.min, x), std::max(range.max, x)};
    };
    for (const double at : {a.min, a.max})
        for (const double at_b : {b.min, b.max, 0.0, at, -at}) add(at, at_b);
    return {range.min - kDiskRounding, range.max + kDiskRounding};
}

}  // namespace

/// Sorting by hashes gives each order the same chance, and the same one for a seed on any machine: equal
/// hashes keep their order.
std::vector<uint32_t> hashed_permutation(size_t count, uint32_t seed) {
    std::vector<uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [seed](uint32_t a, uint32_t b) { return hash(seed, a) < hash(seed, b); });
    return order;
}

/// Written out with polynomials, and repeated in vectors by jittered_run.cpp operation by operation. The
/// concentric map: squares about the middle become circles, and equal areas stay equal. Library sines would
/// differ between machines, and from the vectors' by a last bit.
V2f disk_from_square(float u, float v) {
    const float a = 2 * u - 1, b = 2 * v - 1;
    const bool wide = std::abs(a) > std::abs(b);
    const float r = wide ? a : b, other = wide ? b : a;
    const float angle = kQuarterPi * (other / (r == 0 ? 1 : r));  // from the nearer axis
    const float z = angle * angle;
    const float sine = (((kSine[0] * z + kSine[1]) * z + kSine[2]) * z + kSine[3]) * angle;
    const float cosine = (((kCosine[0] * z + kCosine[1]) * z + kCosine[2]) * z + kCosine[3]) * z + kCosine[4];
    const float along = r * cosine, across = r * sine;
    return wide ? V2f(along, across) : V2f(across, along);
}

float place(uint32_t index, float jitter, int count) {
    return std::min((static_cast<float>(index) + jitter) / static_cast<float>(count), kBelowOne);
}

/// Both parts in one word, for runs of pixels look turns up: what is flipped below, how far blocks move
/// above.
uint32_t turn_of(uint32_t bits, uint32_t count, uint32_t block) {
    const uint32_t flip = bits & (block - 1), along = (bits >> 8) % (count / block) * block;
    return flip | along << 16;
}

uint32_t turned(uint32_t region, uint32_t turn, uint32_t count) {
    const uint32_t moved = (region ^ (turn & 0xffffu)) + (turn >> 16);
    return moved < count ? moved : moved - count;
}

/// The largest float below pixel + 1: a jittered place that rounds up to the next pixel is held back to it.
/// Neighbouring floats are neighbouring integers by their bits.
float last_place_of(int pixel) {
    // nextafter(pixel + 1, pixel), which takes a library's call for each pixel.
    if (pixel == -1) return -std::numeric_limits<float>::denorm_min();
    const auto bits = std::bit_cast<uint32_t>(static_cast<float>(pixel + 1));
    return std::bit_cast<float>(pixel < 0 ? bits + 1 : bits - 1);
}

float within_pixel(int pixel, float fraction) {
    return std::min(static_cast<float>(pixel) + fraction, last_place_of(pixel));
}

TimeSpan time_region(uint32_t index, int count) {
    return {place(index, 0, count), place(index, 1, count)};  // every step of place() is monotone
}

/// From exact borders in doubles, grown by what disk_from_square() may round. A box about the region's image,
/// which is curved: it holds all points, and others too.
LensBox lens_region(uint32_t index, int nx, int ny) {
    const auto axis = [](uint32_t at, int count) {
        return StratumSide{2.0 * at / count - 1, 2.0 * (at + 1) / count - 1};
    };
    const StratumSide a = axis(index % static_cast<uint32_t>(nx), nx),
                      b = axis(index / static_cast<uint32_t>(nx), ny);
    const StratumSide u = disk_x_range(a, b), v = disk_x_range(b, a);
    return {static_cast<float>(u.min), static_cast<float>(v.min), static_cast<float>(u.max),
            static_cast<float>(v.max)};
}

}  // namespace trapeze
