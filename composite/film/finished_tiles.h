/// The finished tiles of a film as bytes: what a later run needs to go on with the picture.
///
/// A tile is finished when all whose samples reach it have come; its pixels never change again, so that they
/// may be copied while other threads add tiles. Sums that wait are not kept: the tiles around the finished
/// ones are sampled again. The bytes are of this machine's order, and hold no names of anything.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "core/pixel_rect.h"

namespace trapeze {

/// Takes bytes; false: they cannot be kept, and no more are wanted.
using WriteBytes = std::function<bool(const void* bytes, size_t count)>;
/// Gives the next so many bytes; false: there are not so many.
using ReadBytes = std::function<bool(void* bytes, size_t count)>;

/// What finished tiles begin with: pixels of another film do not fit.
struct FinishedTilesHeader {
    PixelRect window;
    int32_t tile_count = 0;
    int32_t aov_channels = 0, matte_floats = 0;
    int32_t has_ids = 0, is_deep = 0;
    int32_t finished = 0;  ///< tiles that follow, each with its number before its pixels
    float matte_loss = 0;

    /// Whether both are of films alike, whatever of them is finished.
    bool fits(const FinishedTilesHeader& other) const;
};

}  // namespace trapeze
