/// Parts of a shared frame in which a method keeps to the memory that the frame's grids leave: what takes
/// more than that takes longer instead, as in a render [Hou10 sec. 4; Zhou09].
#pragma once

#include <memory>
#include <vector>

#include "pipeline/compare/shared_frame.h"
#include "sample/build_memory.h"

namespace trapeze {

/// Pixels, and the grids that their samples may see.
struct FramePart {
    PixelRect pixels;
    /// Records alone, in the order of the frame's; or the frame's own. They are there as long as the frame
    /// is.
    std::shared_ptr<const Grids> grids;
    size_t build_bytes = 0;  ///< that preparing a method for these may take
};

/// The whole frame where the method fits; else parts that each fit, but for single tiles that do not.
std::vector<FramePart> parts_of(const SharedFrame& frame, const BuildMemory& memory);

}  // namespace trapeze
