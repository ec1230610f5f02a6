/// From sums to pixels: which of a tile's are developed when, and who frees the sums.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "composite/film/film.h"
#include "composite/film/tile_sums.h"
#include "composite/filters/exposure.h"

namespace trapeze {
namespace {

/// Adds what a tile's sums have in `pixels`; `first_of(x, y)` is where a pixel's channels go.
template <class FirstOf>
void add_sums(const TileSums& sums, Sum sum, const PixelRect& pixels, const FirstOf& first_of) {
    const size_t channels = sums.channels(sum);
    if (channels == 0) return;
    const PixelRect shared = intersection(sums.pixels(), pixels);
    for (int y = shared.y0; y < shared.y1; ++y)
        for (int x = shared.x0; x < shared.x1; ++x) {
            const float* const source = sums.pixel(sum, x, y);
            float* const target = first_of(x, y);
            for (size_t c = 0; c < channels; ++c) target[c] += source[c];
        }
}

}  // namespace

/// Develops the pixels of a tile that no other tile's samples reach: they need not wait.
void Film::develop_inner(int tile, const TileSums& sums) {
    const PixelRect inner = tiles_.inner_pixels(tile);
    if (inner.empty() || tiles_[tile].finished.load(std::memory_order_relaxed)) return;
    develop(inner, [&sums](const auto& visit) { visit(sums); });
    tiles_[tile].has_inner.store(true, std::memory_order_release);
}

/// Develops the other pixels, of the sums of the tiles around, in the order of tiles.
void Film::develop_rest(int tile) {
    const PixelRect all = tiles_.kept_pixels(tile);
    if (all.empty()) return;
    if (matte_kernel_) rank_mattes(tile, all);
    const auto all_sums = [this, tile](const auto& visit) {
        tiles_.for_each_neighbour(tile, [&](int from) {
            const TileSums* sums = tiles_.reaches(from, tile) ? tiles_[from].sums.get() : nullptr;
            if (sums) visit(*sums);
        });
    };
    if (!tiles_[tile].has_inner.load(std::memory_order_acquire)) return develop(all, all_sums);
    const PixelRect inner = tiles_.inner_pixels(tile);
    for (const PixelRect& strip :
         {PixelRect{all.x0, all.y0, all.x1, inner.y0}, PixelRect{all.x0, inner.y1, all.x1, all.y1},
          PixelRect{all.x0, inner.y0, inner.x0, inner.y1}, PixelRect{inner.x1, inner.y0, all.x1, inner.y1}})
        if (!strip.empty()) develop(strip, all_sums);
}

/// Makes pixels of sums: divides each by the sum of the weights; 0 where that is 0. `for_sums(visit)` calls
/// visit(sums) for each tile's that have a part in them.
template <class ForSums>
void Film::develop(const PixelRect& pixels, const ForSums& for_sums) {
    const auto width = static_cast<size_t>(pixels.width());
    std::vector<float> weights(width * static_cast<size_t>(pixels.height()));
    const auto weight = [&](int x, int y) {
        return &weights[static_cast<size_t>(y - pixels.y0) * width + static_cast<size_t>(x - pixels.x0)];
    };
    const auto channels = static_cast<size_t>(aovs_.channel_count);
    const auto color = [&](int x, int y) { return &image_.rgba[4 * image_.index(x, y)]; };
    const auto aov = [&](int x, int y) { return image_.aovs.data() + channels * image_.index(x, y); };
    for_sums([&](const TileSums& sums) {
        add_sums(sums, Sum::Weight, pixels, weight);
        add_sums(sums, Sum::Color, pixels, color);
        add_sums(sums, Sum::Aov, pixels, aov);
    });
    for (int y = pixels.y0; y < pixels.y1; ++y)
        for (int x = pixels.x0; x < pixels.x1; ++x) {
            const float sum = *weight(x, y);
            const auto divide = [sum](float* values, size_t count) {
                for (size_t c = 0; c < count; ++c) values[c] = sum == 0 ? 0 : values[c] / sum;
            };
            divide(color(x, y), 4);
            if (sum != 0) expose(color(x, y));
            for (const Aov& variable : aovs_.aovs)
                if (variable.is_summed())
                    divide(aov(x, y) + variable.offset, static_cast<size_t>(variable.channels));
        }
}

/// Applies Exposure (RISpec 4.1.2): (colour * gain) ^ (1 / gamma).
void Film::expose(float* rgba) const {
    for (int c = 0; c < 3; ++c) rgba[c] *= gain_;
    apply_gamma(inverse_gamma_, rgba);
}

/// Adds up the coverages of the tiles around, in the order of tiles, and keeps the greatest of each pixel.
void Film::rank_mattes(int tile, const PixelRect& pixels) {
    const auto width = static_cast<size_t>(pixels.width());
    std::vector<MattePixel> sums(width * static_cast<size_t>(pixels.height()));
    const auto sum = [&](int x, int y) -> MattePixel& {
        return sums[static_cast<size_t>(y - pixels.y0) * width + static_cast<size_t>(x - pixels.x0)];
    };
    tiles_.for_each_neighbour(tile, [&](int from) {
        const TileSums* of_tile = tiles_.reaches(from, tile) ? tiles_[from].sums.get() : nullptr;
        if (!of_tile || !of_tile->mattes) return;
        const PixelRect shared = intersection(of_tile->mattes->pixels(), pixels);
        for (int y = shared.y0; y < shared.y1; ++y)
            for (int x = shared.x0; x < shared.x1; ++x) sum(x, y).add(of_tile->mattes->at(x, y));
    });
    float lost = 0;
    for (int y = pixels.y0; y < pixels.y1; ++y)
        for (int x = pixels.x0; x < pixels.x1; ++x)
            lost = std::max(
                lost, trapeze::rank_mattes(sum(x, y), matte_keys_,
                                           image_.mattes.data() + static_cast<size_t>(image_.matte_floats) *
                                                                      image_.index(x, y)));
    float known = matte_loss_.load(std::memory_order_relaxed);
    while (lost > known && !matte_loss_.compare_exchange_weak(known, lost, std::memory_order_relaxed)) {}
}

/// Finishes a tile once all that its pixels wait for is there.
void Film::finish_tile(int tile) {
    develop_rest(tile);
    tiles_[tile].finished.store(true, std::memory_order_release);
    tiles_.for_each_neighbour(tile, [&](int from) {
        if (tiles_.reaches(from, tile)) release(from);
    });
}

/// Counts one reader of a tile's sums less; the last one frees them.
void Film::release(int tile) {
    if (tiles_[tile].readers.fetch_sub(1, std::memory_order_acq_rel) != 1 || !tiles_[tile].sums) return;
    waiting_bytes_.fetch_sub(tiles_[tile].sums->bytes(), std::memory_order_relaxed);
    tiles_[tile].sums.reset();
}

}  // namespace trapeze
