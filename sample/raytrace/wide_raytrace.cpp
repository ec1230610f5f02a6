#include "sample/raytrace/wide_raytrace.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "accel/wide/bundle.h"
#include "accel/wide/rays/single_ray.h"
#include "sample/hit_lists.h"
#include "sample/raytrace/sample_order.h"
#include "sample/swept_bound.h"

namespace trapeze {
namespace {

/// The largest coordinate of the image plane, along one axis, that a sample may have.
float plane_reach(float scale, float offset, int pixels) {
    const float border = std::abs(scale) * static_cast<float>(kMostPixelsOutside);
    return std::max(std::abs(offset), std::abs(offset + scale * static_cast<float>(pixels))) + border;
}

/// How far slopes and origins of rays may go, both axes together: the tree's boxes are rounded outwards by
/// what that makes of its compressed numbers.
RayReach reach_of(const Camera& camera) {
    const float plane = plane_reach(camera.plane_scale_x, camera.plane_offset_x, camera.width) +
                        plane_reach(camera.plane_scale_y, camera.plane_offset_y, camera.height);
    const float lens = 2 * camera.lens_radius, lens_slope = lens / camera.focal_distance;
    if (camera.perspective) return {plane + lens_slope, lens};
    return {lens_slope, plane + lens};
}

/// The visibility of a WideTree: orders a tile's rays, traces them bundle by bundle, and makes hit lists.
/// While a bundle is traced the next one's rays are named to it, so that they can be fetched ahead.
class WideRayTraced final : public Visibility {
  public:
    explicit WideRayTraced(const VisibilityInput& input)
        : camera_(input.context.camera),
          lens_(camera_.has_lens()),
          all_opaque_(every_grid_is_opaque(input.grids)),
          tree_(input.grids, reach_of(input.context.camera)),
          motion_(tree_.moves()),
          order_(camera_, input.grids, motion_) {}

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        WideScratch& own = scratch.own.of<WideScratch>();
        const std::span<const uint32_t> all =
            wanted_of(order_.of(samples, scratch.own.of<SampleOrderScratch>()), scratch.window, own.wanted);
        // Where every grid is opaque the hits need no list: they are written to their places.
        std::vector<Hit>& nearest = all_opaque_ ? hits.hits : scratch.nearest;
        if (all_opaque_)
            nearest.resize(samples.size());
        else
            nearest.assign(samples.size(), kBehindAll);
        scratch.found.begin(samples.size(), scratch.window);
        const auto bundle_at = [&](size_t first) {
            first = std::min(first, all.size());
            return all.subspan(first, std::min(RayBundle::kRays, all.size() - first));
        };
        size_t misses = 0;
        for (size_t first = 0; first < all.size(); first += RayBundle::kRays) {
            own.bundle.coming_rays = samples.rays.data();
            own.bundle.coming = bundle_at(first + RayBundle::kRays);
            misses += resolve_bundle(samples, bundle_at(first), nearest, own, scratch, stats);
        }
        if (all_opaque_)
            close_gaps(misses, hits);
        else
            join_layers(hits, scratch);
    }

    BuildStats build_stats() const override { return tree_.stats(); }

    /// One by one. Nodes are those above grids, and grids.
    bool occluded(std::span<const SpaceRay> rays, DepthRange range, std::span<uint8_t> met,
                  SampleStats& stats) const override {
        SingleRayCounts counts;
        for (size_t i = 0; i < rays.size(); ++i) met[i] = any_hit(tree_, rays[i], range, &counts);
        stats.rays += rays.size(), stats.nodes_visited += counts.nodes + counts.grids;
        stats.leaves_visited += counts.blocks, stats.predicate_tests += counts.tests;
        return true;
    }

  private:
    /// Traces up to RayBundle::kRays samples, those that `order` lists: writes the nearest opaque hit of
    /// each, or none, to `nearest` and appends hits of grids that are not opaque to the scratch. Returns how
    /// many samples hit nothing opaque.
    size_t resolve_bundle(const SampleTile& samples, std::span<const uint32_t> order,
                          std::vector<Hit>& nearest, WideScratch& own, SampleScratch& scratch,
                          SampleStats& stats) const {
        RayBundle& rays = own.bundle;
        // Rays start in one point only where they all pass a pinhole.
        const bool origins = lens_ || !camera_.perspective;
        fill_bundle(samples.rays, order, {motion_, origins}, rays);
        rays.tests = rays.nodes = nullptr;
        if (scratch.heat) count_costs(own);
        // Parallel rays meet nowhere: their intervals are as wide everywhere.
        const float meet_at = lens_ ? camera_.focal_distance : HUGE_VALF;
        trace_bundle(tree_, set_bounds(scratch.window, order, own), origins, meet_at, rays, *own.tracing,
                     stats);
        size_t misses = 0;
        for (size_t i = 0; i < order.size(); ++i) {
            const bool missed = rays.id[i] == RayBundle::kNone;
            nearest[order[i]] = {rays.depth[i], missed ? MicropolygonId::kNone : rays.id[i]};
            misses += missed;
        }
        if (!all_opaque_) take_layers(rays, order, scratch.found);
        scratch.own_list_bytes = rays.layers.bytes();
        add_costs(rays, order, scratch);
        return misses;
    }

    /// The samples of which something is wanted, in order.
    std::span<const uint32_t> wanted_of(std::span<const uint32_t> order, const LayerWindow& window,
                                        std::vector<uint32_t>& wanted) const {
        if (all_opaque_ || window.behind.empty()) return order;
        wanted.clear();
        std::copy_if(order.begin(), order.end(), std::back_inserter(wanted),
                     [&](uint32_t sample) { return window.wants(sample); });
        return wanted;
    }

    /// Says which layers of a bundle are wanted; returns the depths at which something may be.
    DepthRange set_bounds(const LayerWindow& window, std::span<const uint32_t> order,
                          WideScratch& own) const {
        DepthRange range{camera_.near_clip, camera_.far_clip};
        LayerBounds& bounds = own.bundle.wanted_layers;
        bounds = {nullptr, all_opaque_ ? 0 : window.most, window.room / 2};
        if (all_opaque_ || window.behind.empty()) return range;
        own.behind.clear();
        float least = kInfinity;
        for (const uint32_t sample : order) {
            const Hit& hit = window.behind[sample];
            own.behind.push_back({hit.depth, static_cast<uint32_t>(hit.id)});
            least = std::min(least, hit.depth);
        }
        bounds.behind = own.behind.data();
        range.min = std::max(range.min, least);
        return range;
    }

    /// Takes the layers of a bundle's rays.
    static void take_layers(const RayBundle& rays, std::span<const uint32_t> order, LooseHits& found) {
        for (size_t i = 0; i < order.size(); ++i)
            if (rays.layers.has_end(i))
                found.cut(order[i], {rays.layers.end(i).depth, rays.layers.end(i).id});
        rays.layers.for_each([&](uint32_t ray, const BundleLayer& layer) {
            found.add(order[ray], {layer.depth, layer.id});
        });
    }

    /// Only when costs are asked for: the traversal then adds to these arrays, by ray of the bundle.
    static void count_costs(WideScratch& own) {
        own.tests.assign(RayBundle::kRoom, 0);
        own.nodes.assign(RayBundle::kRoom, 0);
        own.bundle.tests = own.tests.data(), own.bundle.nodes = own.nodes.data();
    }
    static void add_costs(const RayBundle& rays, std::span<const uint32_t> order, SampleScratch& scratch) {
        if (!scratch.heat) return;
        for (size_t i = 0; i < order.size(); ++i) {
            scratch.heat->tests[order[i]] += rays.tests[i];
            scratch.heat->nodes[order[i]] += rays.nodes[i];
        }
    }

    /// Makes a list of hits from one entry for each sample, of which `misses` hold no hit.
    static void close_gaps(size_t misses, HitBuffer& hits) {
        const size_t sample_count = hits.hits.size();
        hits.first.resize(sample_count + 1);
        if (misses == 0) {
            std::iota(hits.first.begin(), hits.first.end(), 0u);
            return;
        }
        uint32_t next = 0;
        for (size_t s = 0; s < sample_count; ++s) {
            hits.first[s] = next;
            const Hit hit = hits.hits[s];
            hits.hits[next] = hit;
            next += hit.id != MicropolygonId::kNone;
        }
        hits.first[sample_count] = next;
        hits.hits.resize(next);
    }

    /// Makes the list from nearest opaque hits and the hits that are not opaque.
    static void join_layers(HitBuffer& hits, SampleScratch& scratch) {
        for (size_t s = 0; s < scratch.nearest.size(); ++s)
            if (scratch.nearest[s].id != MicropolygonId::kNone)
                scratch.found.add(static_cast<uint32_t>(s), scratch.nearest[s]);
        buffer_of_loose_hits(scratch, scratch.nearest.size(), hits);
    }

    const Camera& camera_;
    bool lens_, all_opaque_;
    WideTree tree_;
    bool motion_;  ///< any grid moves; the samples' times may still be all the same
    SampleOrder order_;
};

}  // namespace

std::unique_ptr<Visibility> prepare_wide_raytrace(const VisibilityInput& input) {
    return std::make_unique<WideRayTraced>(input);
}

}  // namespace trapeze
