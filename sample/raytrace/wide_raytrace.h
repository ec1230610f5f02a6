/// The fast ray tracer: bundles of rays through a WideTree.
#pragma once

#include "sample/visibility.h"

namespace trapeze {

/// Of the row "raytrace" with tree=wide.
std::unique_ptr<Visibility> prepare_wide_raytrace(const VisibilityInput& input);

}  // namespace trapeze
