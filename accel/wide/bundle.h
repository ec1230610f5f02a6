/// Bundles of camera rays that go through a WideTree together [decision 0006]: up to 1024
/// of them, in packets of as many rays as a vector has lanes.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "accel/wide/layer_lists.h"
#include "accel/wide/wide_tree.h"
#include "core/ray_blur.h"
#include "core/rays.h"
#include "core/stats.h"

namespace trapeze {

/// Rays of samples (camera space, origins at z = 0, time in [0, 1]) in an order in which neighbours look
/// alike, and what they see. The order changes times, never hits.
struct RayBundle {
    /// The most rays of a bundle. 512, 2048 and 4096 were measured to be within 5 %
    /// [decision 0006].
    static constexpr size_t kRays = 1024;
    static constexpr size_t kRoom = kRays + 16;  ///< whole vectors can be read

    /// The id of a ray that has hit nothing.
    static constexpr uint32_t kNone = ~uint32_t{0};

    size_t count = 0;
    /// Camera-space rays: origin (ox, oy, 0), direction (ux, uy, 1).
    alignas(64) float ox[kRoom], oy[kRoom], ux[kRoom], uy[kRoom], time[kRoom];
    alignas(64) float depth[kRoom];  ///< of the nearest opaque hit; or less, where layers end before it
    alignas(64) uint32_t id[kRoom];  ///< MicropolygonId::packed() of it (grids are fewer than 2^24), or kNone

    LayerBounds wanted_layers;  ///< which hits on grids that are not opaque are looked for
    LayerLists layers;          ///< these hits; some lie behind the nearest opaque one

    /// Rays that will be wanted next, and which of them: fetched on the way. May be empty.
    const AxisRay* coming_rays = nullptr;
    std::span<const uint32_t> coming;

    /// Arrays of one number a ray, or null: the tests and the nodes that each ray costs are added to them.
    uint32_t *tests = nullptr, *nodes = nullptr;
};

/// The working memory of tracing, one per thread and reused. Only the tree's own files look inside
/// (accel/wide/bundle_scratch.h).
struct BundleScratch;
struct DeleteBundleScratch {
    void operator()(BundleScratch* scratch) const;
};
using BundleScratchPointer = std::unique_ptr<BundleScratch, DeleteBundleScratch>;
/// Allocates working memory, about 120 KB; nothing in it needs to be set.
BundleScratchPointer make_bundle_scratch();

/// Copies rays[order[0]], rays[order[1]] and so on into the bundle; at most RayBundle::kRays. Without a lens
/// origins are not read and become 0, without motion times.
void fill_bundle(std::span<const AxisRay> rays, std::span<const uint32_t> order, RayBlur blur,
                 RayBundle& bundle);

/// Traces a bundle: sets depth, id and layers of its rays to what they see within a range of camera-space
/// depths, the same hits bit for bit as by testing everything. A ray whose layers have an end has no opaque
/// hit behind it: its id is kNone then. The bounds of the rays are taken as intervals
/// in (x, y) at depth z = d * z + o * (1 - z / focal_distance): rays of one lens that meet at the focal
/// distance have intervals as narrow as can be; any others are right, too. Without `lens` all origins are 0.
/// The rays must be within the tree's reach (RayReach), by which its boxes are grown.
void trace_bundle(const WideTree& tree, DepthRange range, bool lens, float focal_distance, RayBundle& rays,
                  BundleScratch& scratch, SampleStats& stats);

}  // namespace trapeze
