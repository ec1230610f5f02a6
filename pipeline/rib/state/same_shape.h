/// Whether shapes are the same in everything.
#pragma once

#include "core/scene/shapes.h"

namespace trapeze::rib {

/// Numbers that are not finite are like nothing, not even themselves.
bool is_same(const Shape& a, const Shape& b);

}  // namespace trapeze::rib
