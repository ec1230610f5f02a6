/// Some of a grid's vertices.
#pragma once

#include <bitset>

#include "core/grid.h"

namespace trapeze {

/// Row by row, u fastest, as the grid's own values.
using VertexSet = std::bitset<kMaxGridVertices>;

}  // namespace trapeze
