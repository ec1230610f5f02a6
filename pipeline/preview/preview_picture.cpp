#include "pipeline/preview/preview_picture.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/samples.h"

namespace trapeze {
namespace {

/// The column or row of tiles that a pixel is in; windows may begin left of and above the picture.
int tile_at(int pixel) {
    return pixel >= 0 ? pixel / kTileSide : -((kTileSide - 1 - pixel) / kTileSide);
}

}  // namespace

PreviewPicture::PreviewPicture(PreviewFacts facts) : facts_(std::move(facts)) {
    const PixelRect& window = facts_.window;
    if (window.empty()) return;
    first_column_ = tile_at(window.x0), first_row_ = tile_at(window.y0);
    columns_ = tile_at(window.x1 - 1) + 1 - first_column_;
    tiles_.resize(static_cast<size_t>(columns_) *
                  static_cast<size_t>(tile_at(window.y1 - 1) + 1 - first_row_));
    const size_t count = static_cast<size_t>(window.width()) * static_cast<size_t>(window.height());
    channels_.assign(facts_.channels.size(),
                     std::vector<float>(count, std::numeric_limits<float>::quiet_NaN()));
}

size_t PreviewPicture::bytes() const {
    return channels_.empty() ? 0 : channels_.size() * channels_.front().size() * sizeof(float);
}

PixelRect PreviewPicture::square(size_t tile) const {
    const int x = (first_column_ + static_cast<int>(tile) % columns_) * kTileSide,
              y = (first_row_ + static_cast<int>(tile) / columns_) * kTileSide;
    return {x, y, x + kTileSide, y + kTileSide};
}

PreviewPicture::Tile& PreviewPicture::tile_of(const PixelRect& pixels) {
    const int column = tile_at(pixels.x0) - first_column_, row = tile_at(pixels.y0) - first_row_;
    return tiles_[static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column)];
}

/// Copies pixels; false where all of them had these bits.
bool PreviewPicture::copy(const PixelRect& pixels, const PixelSource& source) {
    bool changed = false;
    for (size_t c = 0; c < channels_.size(); ++c) {
        const auto [first, stride] = source.channels[c];
        for (int y = pixels.y0; y < pixels.y1; ++y) {
            const size_t from =
                static_cast<size_t>(y - source.window.y0) * static_cast<size_t>(source.window.width()) +
                static_cast<size_t>(pixels.x0 - source.window.x0);
            float* const to = &channels_[c][index(pixels.x0, y)];
            for (size_t x = 0; x < static_cast<size_t>(pixels.width()); ++x) {
                const float* const value = first + stride * (from + x);
                changed = changed || std::memcmp(to + x, value, sizeof(float)) != 0;
                to[x] = *value;
            }
        }
    }
    return changed;
}

void PreviewPicture::put(const PixelRect& finished, const PixelSource& source) {
    const PixelRect pixels = intersection(finished, facts_.window);
    if (pixels.empty()) return;
    const std::lock_guard lock(mutex_);
    copy(pixels, source);
    Tile& tile = tile_of(pixels);
    tile.pixels = pixels;
    tile.version = ++version_;
}

void PreviewPicture::finish(const PixelSource& source) {
    const std::lock_guard lock(mutex_);
    for (size_t t = 0; t < tiles_.size(); ++t) {
        const PixelRect pixels = intersection(square(t), facts_.window);
        if (!copy(pixels, source) && tiles_[t].pixels == pixels) continue;
        tiles_[t] = {pixels, ++version_};
    }
    finished_ = closed_ = true;
}

void PreviewPicture::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
}

bool PreviewPicture::is_finished() const {
    const std::lock_guard lock(mutex_);
    return finished_;
}

bool PreviewPicture::is_closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
}

uint64_t PreviewPicture::version() const {
    const std::lock_guard lock(mutex_);
    return version_;
}

PreviewPicture::Changes PreviewPicture::changes_after(uint64_t version) const {
    std::vector<Tile> changed;
    {
        const std::lock_guard lock(mutex_);
        for (const Tile& tile : tiles_)
            if (tile.version > version) changed.push_back(tile);
    }
    std::ranges::sort(changed, {}, &Tile::version);
    Changes changes;
    for (const Tile& tile : changed) {
        changes.pixels.push_back(tile.pixels);
        changes.versions.push_back(tile.version);
    }
    return changes;
}

std::vector<float> PreviewPicture::values(const PixelRect& pixels, std::span<const int> channels) const {
    std::vector<float> values;
    values.reserve(channels.size() * static_cast<size_t>(pixels.width()) *
                   static_cast<size_t>(pixels.height()));
    const std::lock_guard lock(mutex_);
    for (const int c : channels)
        for (int y = pixels.y0; y < pixels.y1; ++y) {
            const float* const row = &channels_[static_cast<size_t>(c)][index(pixels.x0, y)];
            values.insert(values.end(), row, row + pixels.width());
        }
    return values;
}

}  // namespace trapeze
