#include "composite/film/awaited_tiles.h"

#include "composite/film/film_tiles.h"

namespace trapeze {

AwaitedTiles::AwaitedTiles(const FilmTiles& tiles) {
    if (tiles.count() == 0) return;
    const PixelRect first = tiles.square(0), last = tiles.square(tiles.count() - 1);
    pixels_ = {first.x0, first.y0, last.x1, last.y1};
    columns_ = static_cast<size_t>(pixels_.width() / kTileSide);
    const size_t rows = static_cast<size_t>(pixels_.height() / kTileSide), stride = columns_ + 1;
    sums_.assign(stride * (rows + 1), 0);
    for (size_t row = 0; row < rows; ++row)
        for (size_t column = 0, in_row = 0; column < columns_; ++column) {
            const auto tile = static_cast<int>(row * columns_ + column);
            if (!tiles[tile].added.load(std::memory_order_relaxed)) ++in_row;
            const size_t above = row * stride + column + 1;
            sums_[above + stride] = sums_[above] + static_cast<uint32_t>(in_row);
        }
}

PixelRect AwaitedTiles::tiles_in(const PixelRect& pixels) const {
    const PixelRect part = intersection(pixels, pixels_);
    if (part.empty()) return {};
    const auto column = [this](int x) { return (x - pixels_.x0) / kTileSide; };
    const auto row = [this](int y) { return (y - pixels_.y0) / kTileSide; };
    return {column(part.x0), row(part.y0), column(part.x1 - 1) + 1, row(part.y1 - 1) + 1};
}

uint32_t AwaitedTiles::count_in(const PixelRect& t) const {
    if (t.empty()) return 0;
    return sum(t.x1, t.y1) - sum(t.x0, t.y1) - sum(t.x1, t.y0) + sum(t.x0, t.y0);
}

bool AwaitedTiles::meet(const PixelRect& pixels) const {
    return count_in(tiles_in(pixels)) > 0;
}

PixelRect AwaitedTiles::bound(const PixelRect& pixels) const {
    PixelRect tiles = tiles_in(pixels);
    if (count_in(tiles) == 0) return {};
    while (count_in({tiles.x0, tiles.y0, tiles.x0 + 1, tiles.y1}) == 0) ++tiles.x0;
    while (count_in({tiles.x1 - 1, tiles.y0, tiles.x1, tiles.y1}) == 0) --tiles.x1;
    while (count_in({tiles.x0, tiles.y0, tiles.x1, tiles.y0 + 1}) == 0) ++tiles.y0;
    while (count_in({tiles.x0, tiles.y1 - 1, tiles.x1, tiles.y1}) == 0) --tiles.y1;
    return intersection({pixels_.x0 + tiles.x0 * kTileSide, pixels_.y0 + tiles.y0 * kTileSide,
                         pixels_.x0 + tiles.x1 * kTileSide, pixels_.y0 + tiles.y1 * kTileSide},
                        pixels);
}

}  // namespace trapeze
