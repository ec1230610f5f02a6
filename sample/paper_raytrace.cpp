#include "sample/paper_raytrace.h"

#include <algorithm>

#include "accel/paper_tree.h"
#include "sample/hit_lists.h"
#include "sample/ray_order.h"

namespace trapeze {
namespace {

/// Rays of a beam. 64 to 512 are within 10 % of each other in tests/bench/trace_bench.cpp.
constexpr size_t kGroupSize = 128;

class PaperRayTraced final : public Visibility {
  public:
    PaperRayTraced(const RenderContext& context, const Grids& grids, bool bundles)
        : bundles_(bundles),
          range_{context.camera.near_clip, context.camera.far_clip},
          motion_(context.motion),
          defocus_(context.camera.has_lens()),
          all_opaque_(every_grid_is_opaque(grids)),
          tree_(grids) {}

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        order_rays(samples, motion_, defocus_, scratch);
        SampleStats counted;  // on the stack, so that counting stays in registers
        if (all_opaque_)
            resolve_closest(samples, hits, scratch, counted);
        else
            resolve_layers(samples, hits, scratch, counted);
        stats += counted;
    }

    BuildStats build_stats() const override { return tree_.stats(); }

  private:
    /// Calls trace_one(sample, part of the tree) for all samples in order.
    template <class TraceOne>
    void trace_in_order(const SampleTile& samples, SampleScratch& scratch, SampleStats& stats,
                        TraceOne&& trace_one) const {
        const std::span<const uint32_t> order = scratch.order;
        if (order.empty()) return;
        if (!bundles_) {
            for (const uint32_t sample : order) trace_one(sample, tree_.top());
            return;
        }
        tree_.top().within(Beam(samples.rays, order, range_), scratch.tile_top, &stats.nodes_visited);
        for (size_t first = 0; first < order.size(); first += kGroupSize) {
            const auto group = order.subspan(first, std::min(kGroupSize, order.size() - first));
            scratch.tile_top.within(Beam(samples.rays, group, range_), scratch.group_top,
                                    &stats.nodes_visited);
            for (const uint32_t sample : group) trace_one(sample, scratch.group_top);
        }
    }

    void resolve_closest(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                         SampleStats& stats) const {
        scratch.nearest.resize(samples.size());
        trace_in_order(samples, scratch, stats, [&](uint32_t sample, const TopLevel& part) {
            TraceRay ray = TraceRay::camera(samples.rays[sample], range_);
            ClosestHit policy;
            tree_.trace(part, ray, policy, stats);
            scratch.nearest[sample] = policy.best;
        });
        buffer_of_nearest(scratch, samples.size(), hits);
    }

    void resolve_layers(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                        SampleStats& stats) const {
        scratch.hits.clear();
        scratch.first.resize(samples.size());
        scratch.count.resize(samples.size());
        trace_in_order(samples, scratch, stats, [&](uint32_t sample, const TopLevel& part) {
            TraceRay ray = TraceRay::camera(samples.rays[sample], range_);
            const size_t first = scratch.hits.size();
            HitsUntilOpaque policy{scratch.hits};
            tree_.trace(part, ray, policy, stats);
            policy.finish(first);
            scratch.first[sample] = static_cast<uint32_t>(first);
            scratch.count[sample] = static_cast<uint32_t>(scratch.hits.size() - first);
        });
        buffer_of_lists(scratch, samples.size(), hits);
    }

    bool bundles_;
    DepthRange range_;
    bool motion_, defocus_, all_opaque_;
    PaperTree tree_;
};

}  // namespace

std::unique_ptr<Visibility> prepare_paper_raytrace(const VisibilityInput& input) {
    return std::make_unique<PaperRayTraced>(input.context, input.grids, input.spec.is_on("bundle"));
}

}  // namespace trapeze
