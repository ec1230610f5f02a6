/// The fast ray tracer: bundles of rays through a WideTree.
#pragma once

#include "accel/wide/bundle.h"
#include "sample/visibility.h"

namespace trapeze {

/// What a thread needs for bundles of rays.
struct WideScratch {
    RayBundle bundle;
    BundleScratchPointer tracing = make_bundle_scratch();
    std::vector<uint32_t> tests, nodes;  ///< what the rays of a bundle cost
    std::vector<uint32_t> wanted;        ///< samples, in order, where not all of the tile's are
    std::vector<BundleLayer> behind;     ///< of a bundle's rays
};

/// Builds the tree of the method "raytrace" with tree=wide.
std::unique_ptr<Visibility> prepare_wide_raytrace(const VisibilityInput& input);

}  // namespace trapeze
