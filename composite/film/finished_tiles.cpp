#include "composite/film/finished_tiles.h"

#include <algorithm>
#include <span>
#include <type_traits>
#include <vector>

#include "composite/film/awaited_tiles.h"
#include "composite/film/film.h"

namespace trapeze {
namespace {

/// Deep samples that are read at a time: a pixel's count may be a lie.
constexpr size_t kSamplesAtOnce = 4096;

/// Calls move(first, count) with the floats of each row of a tile's pixels, of `channels` a pixel.
template <class Value, class Image, class Move>
bool for_rows(const PixelRect& pixels, Image& image, Value* values, size_t channels, const Move& move) {
    for (int y = pixels.y0; y < pixels.y1; ++y)
        if (channels > 0 && !move(values + channels * image.index(pixels.x0, y),
                                  channels * static_cast<size_t>(pixels.width())))
            return false;
    return true;
}

/// Calls move(first, count) for all planes of a tile's pixels but deep samples.
template <class AnyImage, class Move>
bool for_planes(const PixelRect& pixels, AnyImage& image, const Move& move) {
    return for_rows(pixels, image, image.rgba.data(), 4, move) &&
           for_rows(pixels, image, image.z.data(), 1, move) &&
           for_rows(pixels, image, image.id.data(), image.id.empty() ? 0 : 1, move) &&
           for_rows(pixels, image, image.aovs.data(), static_cast<size_t>(image.aov_channels), move) &&
           for_rows(pixels, image, image.mattes.data(), static_cast<size_t>(image.matte_floats), move);
}

static_assert(std::is_trivially_copyable_v<DeepSample>);

bool write_deep(const std::vector<DeepSample>& samples, const WriteBytes& write) {
    const auto count = static_cast<uint32_t>(samples.size());
    return write(&count, sizeof count) && (count == 0 || write(samples.data(), count * sizeof(DeepSample)));
}

bool read_deep(std::vector<DeepSample>& samples, const ReadBytes& read) {
    uint32_t count = 0;
    if (!read(&count, sizeof count)) return false;
    samples.clear();
    while (samples.size() < count) {
        const size_t had = samples.size(), more = std::min(kSamplesAtOnce, count - had);
        samples.resize(had + more);
        if (!read(samples.data() + had, more * sizeof(DeepSample))) return false;
    }
    return true;
}

}  // namespace

bool FinishedTilesHeader::fits(const FinishedTilesHeader& o) const {
    return window == o.window && tile_count == o.tile_count && aov_channels == o.aov_channels &&
           matte_floats == o.matte_floats && has_ids == o.has_ids && is_deep == o.is_deep;
}

FinishedTilesHeader Film::finished_tiles_header() const {
    return {image_.window,
            tiles_.count(),
            image_.aov_channels,
            image_.matte_floats,
            image_.id.empty() ? 0 : 1,
            image_.deep.empty() ? 0 : 1,
            0,
            matte_loss_.load(std::memory_order_relaxed)};
}

std::vector<int> Film::finished_tiles() const {
    std::vector<int> finished;
    for (int tile = 0; tile < tiles_.count(); ++tile)
        if (tiles_[tile].finished.load(std::memory_order_acquire)) finished.push_back(tile);
    return finished;
}

PixelRect Film::finished_pixels(int tile) const {
    if (tiles_[tile].finished.load(std::memory_order_acquire)) return tiles_.kept_pixels(tile);
    return tiles_[tile].has_inner.load(std::memory_order_acquire) ? tiles_.inner_pixels(tile) : PixelRect{};
}

size_t Film::picture_tiles() const {
    size_t count = 0;
    for (int tile = 0; tile < tiles_.count(); ++tile)
        if (!tiles_.kept_pixels(tile).empty()) ++count;
    return count;
}

bool Film::write_finished(const WriteBytes& write) const {
    const std::vector<int> finished = finished_tiles();
    // After the tiles: the loss is theirs, and of some that are about to be.
    FinishedTilesHeader header = finished_tiles_header();
    header.finished = static_cast<int32_t>(finished.size());
    if (!write(&header, sizeof header)) return false;
    for (const int32_t tile : finished) {
        const PixelRect pixels = tiles_.kept_pixels(tile);
        const auto write_values = [&](const auto* values, size_t count) {
            return write(values, count * sizeof *values);
        };
        if (!write(&tile, sizeof tile) || !for_planes(pixels, image_, write_values)) return false;
        for (int y = pixels.y0; y < pixels.y1 && !image_.deep.empty(); ++y)
            for (int x = pixels.x0; x < pixels.x1; ++x)
                if (!write_deep(image_.deep[image_.index(x, y)], write)) return false;
    }
    return true;
}

bool Film::read_finished(const ReadBytes& read) {
    FinishedTilesHeader header;
    if (!read(&header, sizeof header) || !header.fits(finished_tiles_header())) return false;
    for (int32_t i = 0; i < header.finished; ++i) {
        int32_t tile = 0;
        if (!read(&tile, sizeof tile) || tile < 0 || tile >= tiles_.count()) return false;
        const PixelRect pixels = tiles_.kept_pixels(tile);
        if (pixels.empty() || tiles_[tile].finished.exchange(true)) return false;
        const auto read_values = [&](auto* values, size_t count) {
            return read(values, count * sizeof *values);
        };
        if (!for_planes(pixels, image_, read_values)) return false;
        for (int y = pixels.y0; y < pixels.y1 && !image_.deep.empty(); ++y)
            for (int x = pixels.x0; x < pixels.x1; ++x)
                if (!read_deep(image_.deep[image_.index(x, y)], read)) return false;
        tiles_[tile].missing = 0;
        tiles_.for_each_neighbour(tile, [&](int from) {
            if (tiles_.reaches(from, tile)) tiles_[from].readers.fetch_sub(1, std::memory_order_relaxed);
        });
    }
    // What only finished pixels would have of a tile need not be sampled.
    for (int tile = 0; tile < tiles_.count(); ++tile)
        if (tiles_[tile].readers.load(std::memory_order_relaxed) == 0) tiles_[tile].added = true;
    matte_loss_ = header.matte_loss;
    took_something_ = std::ranges::any_of(image_.z, [](float depth) { return depth < kInfinity; });
    return true;
}

AwaitedTiles Film::awaited_tiles() const {
    return AwaitedTiles(tiles_);
}

bool Film::awaits(const PixelRect& pixels) const {
    bool any = false;
    tiles_.for_each_in(pixels,
                       [&](int tile) { any = any || !tiles_[tile].added.load(std::memory_order_relaxed); });
    return any;
}

}  // namespace trapeze
