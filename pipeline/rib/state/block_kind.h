/// The kinds of blocks that requests begin and end (RISpec 4).
#pragma once

#include <cstddef>

namespace trapeze::rib {

/// RISpec nests them properly; where files do not, BlockEnds closes what is open within.
enum class BlockKind { Frame, World, Attribute, Transform, Motion, Object, Solid };

/// How many BlockKind has; a new kind of block needs one more.
inline constexpr size_t kBlockKinds = 7;

}  // namespace trapeze::rib
