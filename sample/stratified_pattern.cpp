#include "sample/stratified_pattern.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/random.h"
#include "sample/magic_square.h"

namespace trapeze {
namespace {

constexpr float kBelowOne = 0x1.fffffep-1f;

/// Which number of an index; part of what is hashed.
enum Dimension : uint32_t { kSubpixelX, kSubpixelY, kLensU, kLensV, kTime, kTimeShift, kShuffle };

/// A permutation of 0 .. count - 1 by sorting hashes.
std::vector<uint32_t> hashed_permutation(size_t count, uint32_t seed) {
    std::vector<uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [seed](uint32_t a, uint32_t b) { return hash(seed, a) < hash(seed, b); });
    return order;
}

/// Subpixel region -> lens region.
std::vector<uint32_t> lens_permutation(int nx, int ny, uint32_t seed) {
    if (nx == ny && nx >= 3) return magic_square(nx);
    return hashed_permutation(static_cast<size_t>(nx) * ny, hash(seed, kLensU));
}

/// Subpixel region -> time region: the lens permutation with its rows and columns shuffled.
std::vector<uint32_t> time_permutation(const std::vector<uint32_t>& lens_of, int nx, int ny, uint32_t seed) {
    const std::vector<uint32_t> columns = hashed_permutation(nx, hash(seed, kShuffle, 0));
    const std::vector<uint32_t> rows = hashed_permutation(ny, hash(seed, kShuffle, 1));
    std::vector<uint32_t> time_of(lens_of.size());
    for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x)
            time_of[static_cast<size_t>(y) * nx + x] =
                lens_of[static_cast<size_t>(rows[y]) * nx + columns[x]];
    return time_of;
}

/// The unit square to the unit disk, areas kept in proportion [Shirley97].
V2f disk_from_square(float u, float v) {
    const float a = 2 * u - 1, b = 2 * v - 1;
    if (a == 0 && b == 0) return {0, 0};
    constexpr auto kQuarterPi = static_cast<float>(M_PI / 4);
    const bool wide = std::abs(a) > std::abs(b);
    const float r = wide ? a : b;
    const float angle = wide ? kQuarterPi * (b / a) : 2 * kQuarterPi - kQuarterPi * (a / b);
    return {r * std::cos(angle), r * std::sin(angle)};
}

/// A jittered place in region `index` of `count` in [0, 1).
float place(uint32_t index, float jitter, int count) {
    return std::min((static_cast<float>(index) + jitter) / static_cast<float>(count), kBelowOne);
}

/// A place within a pixel; rounding may not move it into the next one.
float within_pixel(int pixel, float fraction) {
    const auto low = static_cast<float>(pixel), high = static_cast<float>(pixel + 1);
    return std::min(low + fraction, std::nextafter(high, low));
}

}  // namespace

StratifiedPattern::StratifiedPattern(const RenderContext& context)
    : camera_(context.camera),
      nx_(std::max(1, context.samples_x)),
      ny_(std::max(1, context.samples_y)),
      seed_(context.seed),
      motion_(context.motion),
      lens_of_(lens_permutation(nx_, ny_, context.seed)),
      time_of_(time_permutation(lens_of_, nx_, ny_, context.seed)) {}

void StratifiedPattern::make_tile(const PixelRect& pixels, SampleTile& tile) const {
    tile.pixels = pixels;
    tile.samples_per_pixel = nx_ * ny_;
    tile.resize(static_cast<size_t>(pixels.width()) * pixels.height() * tile.samples_per_pixel);
    for (int py = pixels.y0; py < pixels.y1; ++py)
        for (int px = pixels.x0; px < pixels.x1; ++px) make_pixel(px, py, tile.first_of_pixel(px, py), tile);
}

void StratifiedPattern::make_pixel(int px, int py, size_t first, SampleTile& tile) const {
    const auto count = static_cast<uint32_t>(nx_ * ny_);
    const uint32_t pixel_hash = hash(seed_, static_cast<uint32_t>(px), static_cast<uint32_t>(py));
    const bool lens = camera_.has_lens();
    // Without defocus there is no correlation with the lens to break.
    const uint32_t time_shift = lens ? hash(pixel_hash, kTimeShift) % count : 0;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t sample_hash = hash(pixel_hash + i);
        const auto jitter = [sample_hash](Dimension d) { return unit_float(hash(sample_hash + d)); };
        const size_t at = first + i;
        const uint32_t column = i % static_cast<uint32_t>(nx_), row = i / static_cast<uint32_t>(nx_);
        tile.x[at] = within_pixel(px, place(column, jitter(kSubpixelX), nx_));
        tile.y[at] = within_pixel(py, place(row, jitter(kSubpixelY), ny_));
        V2f on_lens(0, 0);
        if (lens) {
            const uint32_t region = lens_of_[i];
            on_lens = disk_from_square(place(region % static_cast<uint32_t>(nx_), jitter(kLensU), nx_),
                                       place(region / static_cast<uint32_t>(nx_), jitter(kLensV), ny_));
        }
        tile.lens_u[at] = on_lens.x, tile.lens_v[at] = on_lens.y;
        tile.time[at] =
            motion_ ? place((time_of_[i] + time_shift) % count, jitter(kTime), static_cast<int>(count))
                    : 0.0f;
        tile.rays[at] = camera_.ray(tile.x[at], tile.y[at], on_lens.x, on_lens.y, tile.time[at]);
    }
}

}  // namespace trapeze
