/// What rays that go alike may meet, found once for all of them.
#pragma once

#include <cstddef>

#include "accel/wide/wide_tree.h"

namespace trapeze {

/// Grids, and where these are too many, nodes in their place; in parts of as many as nodes have children.
/// What rays find in it is what they find in the tree.
struct GridList {
    static constexpr size_t kPart = WideNode::kChildren, kParts = 16, kMost = kPart * kParts;
    static constexpr size_t kStride = kMost + kPart;  ///< whole vectors are written

    size_t count = 0;  ///< places, some of them empty (kNoLink)
    bool moves = false;
    alignas(64) float planes[6][kStride];
    alignas(64) uint16_t motions[6][kStride];  ///< where the tree moves
    alignas(64) uint32_t links[kStride];
    WideNodeLargest largest[kParts + 1];  ///< of each part

    size_t parts() const { return (count + kPart - 1) / kPart; }
    ChildRows part(size_t n) const {
        return {planes[0] + n * kPart, moves ? motions[0] + n * kPart : nullptr, links + n * kPart, kStride,
                largest[n]};
    }
};

}  // namespace trapeze
