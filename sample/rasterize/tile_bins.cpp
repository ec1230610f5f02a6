#include "sample/rasterize/tile_bins.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace trapeze {
namespace {

/// At least one tile, for an empty crop, too.
int tile_count(int pixels, int side) {
    return std::max(1, (pixels + side - 1) / side);
}

/// The largest multiple of `side` that is not above a coordinate: tiles are anchored there.
int anchor(int at, int side) {
    return static_cast<int>(std::floor(static_cast<double>(at) / side)) * side;
}

bool is_empty(const RasterBox& box) {
    return !(box.min_x <= box.max_x && box.min_y <= box.max_y);
}

}  // namespace

/// The bins are anchored at multiples of the side, as the picture's tiles are. Rows of bins are filled each
/// by one thread, in the order of the grids: no lock, and the same lists each time.
TileBins::TileBins(const Camera& camera, const Grids& grids, int tile_side)
    : area_{anchor(camera.crop.x0, tile_side), anchor(camera.crop.y0, tile_side), camera.crop.x1,
            camera.crop.y1},
      side_(tile_side),
      columns_(tile_count(area_.width(), side_)),
      rows_(tile_count(area_.height(), side_)),
      boxes_(grids.grids.size()),
      tiles_(static_cast<size_t>(columns_) * rows_) {
    tbb::parallel_for(size_t{0}, boxes_.size(),
                      [&](size_t i) { boxes_[i] = raster_bound(grids.grids[i], camera); });
    tbb::parallel_for(0, rows_, [this](int row) { fill_row(row); });
}

/// Clamped as doubles: a bound beyond the range of int would overflow before it could be clamped.
TileBins::Span TileBins::span(double min, double max, int origin, int side, int count) {
    const auto tile = [&](double at) {
        return static_cast<int>(std::clamp(std::floor((at - origin) / side), 0.0, count - 1.0));
    };
    return {tile(min), tile(max)};
}

/// Rows of tiles are filled apart, each from all boxes: no two threads write to one tile, and grids stay
/// ascending.
void TileBins::fill_row(int row) {
    const size_t first_tile = static_cast<size_t>(row) * columns_;
    for (size_t i = 0; i < boxes_.size(); ++i) {
        const RasterBox& box = boxes_[i];
        if (is_empty(box)) continue;
        const Span at = rows(box.min_y, box.max_y);
        if (row < at.first || row > at.last) continue;
        const Span across = columns(box.min_x, box.max_x);
        for (int column = across.first; column <= across.last; ++column)
            tiles_[first_tile + column].push_back(static_cast<uint32_t>(i));
    }
}

/// In ascending order, and each grid once, however many bins have it.
void TileBins::find(const PixelRect& pixels, std::vector<uint32_t>& found) const {
    found.clear();
    if (pixels.empty()) return;
    // A pixel's samples lie from its coordinate to below the next.
    const Span across = columns(pixels.x0, pixels.x1 - 1), down = rows(pixels.y0, pixels.y1 - 1);
    for (int row = down.first; row <= down.last; ++row)
        for (int column = across.first; column <= across.last; ++column)
            for (const uint32_t grid : tiles_[static_cast<size_t>(row) * columns_ + column])
                if (!pixels_within(boxes_[grid], pixels).empty()) found.push_back(grid);
    // One tile's list is sorted and has no grid twice.
    if (across.first == across.last && down.first == down.last) return;
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
}

size_t TileBins::bytes() const {
    size_t sum = boxes_.capacity() * sizeof(RasterBox) + tiles_.capacity() * sizeof(tiles_[0]);
    for (const auto& tile : tiles_) sum += tile.capacity() * sizeof(uint32_t);
    return sum;
}

}  // namespace trapeze
