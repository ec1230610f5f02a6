/// One ray after another through a binary tree: the method of [Hou10], through its hyper-trapezoids in the
/// order of section 3.4, and trees of other papers, through which rays go in the same way.
///
/// With bundles, rays that follow each other first look together, as a beam, for what they may meet of the
/// levels above grids, and then traverse that part only. It takes most of the steps above grids away and
/// changes no hit. The nodes that a beam looks at count as visited. Without bundles it is the papers' own
/// form: every ray from the root [decision 0001].
#pragma once

#include "sample/visibility.h"

namespace trapeze {

/// Builds the tree of the method "raytrace" that its option "tree" names: any but the wide one, for which it
/// is the paper's.
std::unique_ptr<Visibility> prepare_binary_raytrace(const VisibilityInput& input);

}  // namespace trapeze
