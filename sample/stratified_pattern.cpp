#include "sample/stratified_pattern.h"

#include <algorithm>

#include "core/random.h"
#include "sample/magic_square.h"

namespace trapeze {
namespace {

/// Which number of an index; part of what is hashed.
enum Dimension : uint32_t { kSubpixelX, kSubpixelY, kLensU, kLensV, kTime, kTimeShift, kShuffle };

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

}  // namespace

StratifiedPattern::StratifiedPattern(const RenderContext& context)
    : camera_(context.camera),
      nx_(std::max(1, context.samples_x)),
      ny_(std::max(1, context.samples_y)),
      seed_(context.seed),
      motion_(context.motion),
      lens_of_(lens_permutation(nx_, ny_, context.seed)),
      time_of_(time_permutation(lens_of_, nx_, ny_, context.seed)) {}

uint32_t StratifiedPattern::time_shift(int px, int py) const {
    // Without defocus there is no correlation with the lens to break.
    if (!camera_.has_lens()) return 0;
    const uint32_t pixel_hash = hash(seed_, static_cast<uint32_t>(px), static_cast<uint32_t>(py));
    return hash(pixel_hash, kTimeShift) % static_cast<uint32_t>(sample_count());
}

TimeSpan StratifiedPattern::time_bounds(int sample, uint32_t shift) const {
    return motion_ ? time_region(time_region_of(sample, shift), sample_count()) : TimeSpan{};
}

LensBox StratifiedPattern::lens_bounds(int sample) const {
    return camera_.has_lens() ? lens_region(lens_of_[sample], nx_, ny_) : LensBox{};
}

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
    const uint32_t shift = time_shift(px, py);
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
            motion_ ? place(time_region_of(static_cast<int>(i), shift), jitter(kTime), sample_count()) : 0.0f;
        tile.rays[at] = camera_.ray(tile.x[at], tile.y[at], on_lens.x, on_lens.y, tile.time[at]);
    }
}

}  // namespace trapeze
