/// Bundles of camera rays that go through a WideTree together.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "accel/wide/wide_tree.h"
#include "core/rays.h"
#include "core/stats.h"

namespace trapeze {

/// Rays (origins at z = 0), in an order in which neighbours look alike, and what they see.
struct RayBundle {
    static constexpr size_t kRays = 1024;
    static constexpr size_t kRoom = kRays + 16;  ///< whole vectors can be read

    /// What a ray that has hit nothing has.
    static constexpr uint32_t kNone = ~uint32_t{0};

    size_t count = 0;
    alignas(64) float ox[kRoom], oy[kRoom], ux[kRoom], uy[kRoom], time[kRoom];
    alignas(64) float depth[kRoom];  ///< of the nearest opaque hit
    alignas(64) uint32_t id[kRoom];  ///< MicropolygonId::packed() of it (grids are fewer than 2^24), or kNone

    /// A hit on a grid that is not opaque; some lie behind the nearest opaque hit.
    struct Layer {
        uint32_t ray;
        float depth;
        uint32_t id;
    };
    std::vector<Layer> layers;  ///< in no order

    /// Rays that will be wanted next, and which of them: fetched on the way. May be empty.
    const AxisRay* coming_rays = nullptr;
    std::span<const uint32_t> coming;

    /// When set, what each ray costs is added.
    uint32_t *tests = nullptr, *nodes = nullptr;
};

/// What tracing needs besides; one per thread, reused.
struct BundleScratch;
struct DeleteBundleScratch {
    void operator()(BundleScratch* scratch) const;
};
using BundleScratchPointer = std::unique_ptr<BundleScratch, DeleteBundleScratch>;
BundleScratchPointer make_bundle_scratch();

/// Takes rays[order[0]], rays[order[1]] and so on into the bundle; at most RayBundle::kRays. Without `lens`
/// or `motion` origins or times are not read.
void fill_bundle(std::span<const AxisRay> rays, std::span<const uint32_t> order, bool lens, bool motion,
                 RayBundle& bundle);

/// Sets what the rays see within some depths. The bounds of the rays are taken as intervals in
/// (x, y) at depth z = d * z + o * (1 - z / focal_distance): rays of one lens that meet at the focal distance
/// have intervals as narrow as can be; any others are right, too. Without `lens` all origins are 0. The rays
/// are within the tree's reach.
void trace_bundle(const WideTree& tree, DepthRange range, bool lens, float focal_distance, RayBundle& rays,
                  BundleScratch& scratch, SampleStats& stats);

}  // namespace trapeze
