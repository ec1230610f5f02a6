/// The samples of a picture ahead of their resolution, so that a clock need not run while they are made: all
/// at once where they fit a memory limit, else in groups of tiles.
#pragma once

#include <span>
#include <vector>

#include "sample/patterns/sample_pattern.h"

namespace trapeze {

/// Bytes that one sample takes in a SampleTile: x, y, lens_u, lens_v, time and its ray.
inline constexpr size_t kBytesPerSample = 5 * sizeof(float) + sizeof(AxisRay);

/// The samples of some pixels, a group of tiles at a time.
class SampleGroups {
  public:
    SampleGroups(const PixelRect& pixels, int tile_side, int samples_per_pixel, size_t byte_limit);

    size_t count() const { return groups_; }
    /// The samples of a group's tiles, made in parallel unless they are the last that were asked for. Stays
    /// valid until the next call. The pattern is the same in all calls.
    std::span<const SampleTile> make(size_t group, const SamplePattern& pattern);

  private:
    std::vector<PixelRect> tiles_;
    size_t tiles_per_group_ = 1, groups_ = 0;
    size_t made_group_;
    std::vector<SampleTile> made_;
};

}  // namespace trapeze
