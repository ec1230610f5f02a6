#include "pipeline/frame/regions.h"

#include <algorithm>
#include <numeric>

#include "core/samples.h"
#include "pipeline/frame/tiles/tile_order.h"

namespace trapeze {
namespace {

/// The part of a region in a rectangle: the subpatches that it may see, and the memory for these.
Region part_of(const Region& whole, const PixelRect& pixels, std::span<const SubpatchInfo> subpatches,
               const RegionLimits& limits) {
    Region part{pixels, {}};
    size_t micropolygons = 0;
    int most_keys = 1;
    for (const uint32_t index : whole.subpatches) {
        const PixelRect seen = intersection(subpatches[index].bound, pixels);
        if (seen.empty() || (limits.awaited && !limits.awaited->meet(seen))) continue;
        part.subpatches.push_back(index);
        part.estimated_bytes += estimated_bytes(subpatches[index], limits);
        micropolygons += static_cast<size_t>(subpatches[index].shape.micropolygon_count());
        most_keys = std::max<int>(most_keys, subpatches[index].key_count);
    }
    part.estimated_bytes += limits.build.bytes_of_all(micropolygons, most_keys);
    return part;
}

/// The two halves of a rectangle at a tile border near its middle; equal halves when it is a single tile.
std::pair<PixelRect, PixelRect> halves(const PixelRect& r) {
    PixelRect low = r, high = r;
    const bool across = r.width() >= r.height();
    const int middle =
        across ? tile_begin(r.x0 + r.width() / 2, kTileSide) : tile_begin(r.y0 + r.height() / 2, kTileSide);
    if (across)
        low.x1 = high.x0 = middle;
    else
        low.y1 = high.y0 = middle;
    if (low.empty()) {
        // The middle's tile begins before the rectangle does: try the next border.
        const int next = middle + kTileSide;
        if (across)
            low.x1 = high.x0 = next;
        else
            low.y1 = high.y0 = next;
    }
    return {low, high};
}

bool can_split(const PixelRect& r) {
    const auto [low, high] = halves(r);
    return !low.empty() && !high.empty();
}

}  // namespace

size_t estimated_bytes(const SubpatchInfo& subpatch, const RegionLimits& limits) {
    const size_t of_method =
        limits.build.bytes(static_cast<size_t>(subpatch.shape.micropolygon_count()), subpatch.key_count);
    if (!limits.with_grids) return of_method;
    Grid grid;
    grid.shape = subpatch.shape;
    grid.key_count = subpatch.key_count;
    grid.opaque = false;
    grid.aov_channels = static_cast<uint8_t>(limits.aov_channels);
    return grid.bytes() + 2 * 64 /* alignment of its two arrays */ + of_method;
}

std::vector<Region> split_into_regions(const PixelRect& pixels, std::span<const SubpatchInfo> subpatches,
                                       const RegionLimits& limits) {
    Region whole;
    whole.pixels = limits.awaited ? limits.awaited->bound(pixels) : pixels;
    if (limits.awaited && whole.pixels.empty()) return {};
    whole.subpatches.resize(subpatches.size());
    std::iota(whole.subpatches.begin(), whole.subpatches.end(), 0u);
    std::vector<Region> regions{part_of(whole, whole.pixels, subpatches, limits)};
    // The heaviest region that must be split, else (while there are too few) the largest.
    for (;;) {
        const bool too_few = static_cast<int>(regions.size()) < limits.at_least;
        size_t chosen = regions.size();
        for (size_t i = 0; i < regions.size(); ++i) {
            if (!can_split(regions[i].pixels)) continue;
            if (!too_few && regions[i].estimated_bytes <= limits.bytes) continue;
            if (chosen == regions.size() || regions[i].estimated_bytes > regions[chosen].estimated_bytes)
                chosen = i;
        }
        if (chosen == regions.size()) break;
        const auto [low, high] = halves(regions[chosen].pixels);
        Region second = part_of(regions[chosen], high, subpatches, limits);
        regions[chosen] = part_of(regions[chosen], low, subpatches, limits);
        regions.insert(regions.begin() + static_cast<std::ptrdiff_t>(chosen) + 1, std::move(second));
    }
    if (limits.awaited) {
        for (Region& region : regions) region.pixels = limits.awaited->bound(region.pixels);
        std::erase_if(regions, [](const Region& region) { return region.pixels.empty(); });
    }
    return regions;
}

}  // namespace trapeze
