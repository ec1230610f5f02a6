#include "pipeline/frame/tiles/tile_order.h"

#include <algorithm>
#include <cstdint>

namespace trapeze {
namespace {

constexpr uint32_t kCoarsest = 3;  ///< as a power of two

/// The round in which a place along one axis comes, were it alone: 0 for every eighth.
uint32_t round_of(uint32_t place) {
    uint32_t halvings = 0;
    while (halvings < kCoarsest && (place >> halvings) % 2 == 0) ++halvings;
    return kCoarsest - halvings;
}

}  // namespace

int tile_begin(int pixel, int side) {
    const int rest = ((pixel % side) + side) % side;
    return pixel - rest;
}

std::vector<PixelRect> tiles_of(const PixelRect& pixels, int side) {
    std::vector<PixelRect> tiles;
    for (int y = tile_begin(pixels.y0, side); y < pixels.y1; y += side)
        for (int x = tile_begin(pixels.x0, side); x < pixels.x1; x += side) {
            const PixelRect tile = intersection({x, y, x + side, y + side}, pixels);
            if (!tile.empty()) tiles.push_back(tile);
        }
    return tiles;
}

std::vector<PixelRect> coarse_first(std::span<const PixelRect> tiles) {
    struct Place {
        uint32_t round;
        PixelRect tile;
    };
    std::vector<Place> places;
    uint32_t column = 0, row = 0;
    for (const PixelRect& tile : tiles) {
        const bool begins_row = !places.empty() && tile.y0 != places.back().tile.y0;
        column = begins_row || places.empty() ? 0 : column + 1;
        row += begins_row ? 1 : 0;
        places.push_back({std::max(round_of(column), round_of(row)), tile});
    }
    std::ranges::stable_sort(places, {}, &Place::round);
    std::vector<PixelRect> ordered;
    for (const Place& place : places) ordered.push_back(place.tile);
    return ordered;
}

}  // namespace trapeze
