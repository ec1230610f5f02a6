#include "pipeline/compare/sample_groups.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "pipeline/frame/tiles/tile_order.h"

namespace trapeze {
namespace {

constexpr size_t kNone = ~size_t{0};

}  // namespace

SampleGroups::SampleGroups(const PixelRect& pixels, int tile_side, int samples_per_pixel, size_t byte_limit)
    : tiles_(tiles_of(pixels, tile_side)), made_group_(kNone) {
    const size_t tile_bytes =
        static_cast<size_t>(tile_side) * tile_side * samples_per_pixel * kBytesPerSample;
    const size_t most_tiles = std::max<size_t>(1, byte_limit / tile_bytes);
    // Groups of about one size: a small last one would keep the threads badly busy.
    groups_ = (tiles_.size() + most_tiles - 1) / most_tiles;
    if (groups_ > 0) tiles_per_group_ = (tiles_.size() + groups_ - 1) / groups_;
}

std::span<const SampleTile> SampleGroups::make(size_t group, const SamplePattern& pattern) {
    const size_t first = std::min(tiles_.size(), group * tiles_per_group_);
    const size_t count = std::min(tiles_per_group_, tiles_.size() - first);
    if (group != made_group_) {
        if (made_.size() < count) made_.resize(count);
        tbb::parallel_for(size_t{0}, count,
                          [&](size_t i) { pattern.make_tile(tiles_[first + i], made_[i]); });
        made_group_ = group;
    }
    return {made_.data(), count};
}

}  // namespace trapeze
