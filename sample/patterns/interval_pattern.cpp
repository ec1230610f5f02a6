#include "sample/patterns/interval_pattern.h"

#include <algorithm>
#include <numeric>

#include "core/random.h"

namespace trapeze {
namespace {

/// Which number of an index; part of what is hashed.
namespace dimension {
enum : uint32_t { kSubpixelX, kSubpixelY, kLensU, kLensV, kTime, kShuffle };
}

/// A permutation from the numbers themselves [Fisher, Yates], by a pixel's hash.
void shuffle(std::vector<uint32_t>& order, uint32_t pixel_hash) {
    std::iota(order.begin(), order.end(), 0u);
    for (auto left = static_cast<uint32_t>(order.size()); left > 1; --left) {
        const uint64_t bits = hash(pixel_hash + left);
        std::swap(order[left - 1], order[bits * left >> 32]);
    }
}

}  // namespace

/// The lens region of a sample is the same in all pixels, in an order that has nothing to do with that of
/// times.
IntervalPattern::IntervalPattern(const RenderContext& context)
    : SamplePattern(context),
      lens_of_(
          hashed_permutation(static_cast<size_t>(sample_count()), hash(context.seed, dimension::kLensU))) {}

void IntervalPattern::make_tile(const PixelRect& pixels, SampleTile& tile) const {
    begin_tile(pixels, tile);
    std::vector<uint32_t> subpixels(static_cast<size_t>(sample_count()));
    for (int py = pixels.y0; py < pixels.y1; ++py)
        for (int px = pixels.x0; px < pixels.x1; ++px)
            make_pixel(px, py, subpixels, tile.first_of_pixel(px, py), tile);
}

/// Only the subpixel regions are shuffled from pixel to pixel; lens and time regions are s's in all of them,
/// and jitter moves samples within.
void IntervalPattern::make_pixel(int px, int py, std::vector<uint32_t>& subpixels, size_t first,
                                 SampleTile& tile) const {
    const uint32_t pixel_hash = hash(seed_, static_cast<uint32_t>(px), static_cast<uint32_t>(py));
    shuffle(subpixels, hash(pixel_hash, dimension::kShuffle));
    const auto nx = static_cast<uint32_t>(nx_);
    for (uint32_t s = 0; s < subpixels.size(); ++s) {
        const uint32_t sample_hash = hash(pixel_hash + s);
        const auto jitter = [sample_hash](uint32_t d) { return unit_float(hash(sample_hash + d)); };
        const size_t at = first + s;
        tile.x[at] = within_pixel(px, place(subpixels[s] % nx, jitter(dimension::kSubpixelX), nx_));
        tile.y[at] = within_pixel(py, place(subpixels[s] / nx, jitter(dimension::kSubpixelY), ny_));
        V2f on_lens(0, 0);
        if (camera_.has_lens())
            on_lens = lens_.from_square(place(lens_of_[s] % nx, jitter(dimension::kLensU), nx_),
                                        place(lens_of_[s] / nx, jitter(dimension::kLensV), ny_));
        tile.lens_u[at] = on_lens.x, tile.lens_v[at] = on_lens.y;
        tile.time[at] = motion_ ? place(s, jitter(dimension::kTime), sample_count()) : 0.0f;
        tile.rays[at] = camera_.ray(tile.x[at], tile.y[at], on_lens.x, on_lens.y, tile.time[at]);
    }
}

/// Without motion all times are 0, and without a lens all lens points: the default spans.
TimeSpan IntervalPattern::time_bounds(int sample) const {
    return motion_ ? time_region(static_cast<uint32_t>(sample), sample_count()) : TimeSpan{};
}

LensBox IntervalPattern::lens_bounds(int sample) const {
    return camera_.has_lens() ? lens_.region(lens_of_[sample], nx_, ny_) : LensBox{};
}

}  // namespace trapeze
