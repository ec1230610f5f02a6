/// What dispatch calls for single rays and for groups of them. Compiled once a target; the best one that the
/// machine has is chosen at each call.
#include "accel/wide/rays/single_ray.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "accel/grid_block.h"
#include "accel/hit_policies.h"
#include "accel/trace_ray.h"
#include "accel/wide/rays/ray_groups.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/wide/rays/single_ray.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#ifndef TRAPEZE_ACCEL_SINGLE_RAY_ONCE
#define TRAPEZE_ACCEL_SINGLE_RAY_ONCE
namespace trapeze::single_ray_detail {

/// A ray that asks.
struct Query {
    const WideTree& tree;
    TraceRay& ray;
};
/// Some of many rays, which go alike, and where their answers go.
struct GroupQuery {
    const WideTree& tree;
    std::span<const RangedRay> rays;
    std::span<const uint32_t> group;
    InTheWay* met;
};
/// Counting policies: into SingleRayCounts, or nothing (accel/wide/rays/single_ray-inl.h).
struct CountAll {
    SingleRayCounts& counts;
    void node() { ++counts.nodes; }
    void grid() { ++counts.grids; }
    void block(int tests) { ++counts.blocks, counts.tests += static_cast<uint64_t>(tests); }
};

/// A ray with a part that is no number has no bounds, and hits nothing.
inline bool has_numbers(const TraceRay& ray) {
    const AxisRay& a = ray.axis;
    return !std::isnan(a.ux) && !std::isnan(a.uy) && !std::isnan(a.ox) && !std::isnan(a.oy) &&
           !std::isnan(a.oz) && !std::isnan(a.time);
}

inline InTheWay in_the_way_of(const FirstOpaque& met) {
    return met.opaque ? InTheWay::Opaque : met.layers ? InTheWay::Layers : InTheWay::Nothing;
}

}  // namespace trapeze::single_ray_detail
#endif

#include "accel/wide/rays/group_trace-inl.h"
#include "accel/wide/rays/single_ray-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
using namespace single_ray_detail;

template <class Policy, class Counts>
HWY_INLINE Policy traced(const Query& query, Counts counts, Policy policy = {}) {
    if (query.tree.moves())
        SingleRay<true, Policy, Counts>(query.tree, query.ray, policy, counts).run();
    else
        SingleRay<false, Policy, Counts>(query.tree, query.ray, policy, counts).run();
    return policy;
}

ClosestHit trace_closest(const Query& query, const Hit& from, SingleRayCounts* counts) {
    const ClosestHit policy{.from = from};
    return counts ? traced(query, CountAll{*counts}, policy) : traced(query, CountNothing(), policy);
}
void trace_nearest(const Query& query, NearestHits& hits) {
    hits = traced(query, CountNothing(), hits);
}
FirstOpaque trace_opaque(const Query& query, DepthRange sure) {
    return traced(query, CountNothing(), FirstOpaque{.sure = sure});
}
AnyHit trace_any(const Query& query, SingleRayCounts* counts) {
    return counts ? traced<AnyHit>(query, CountAll{*counts}) : traced<AnyHit>(query, CountNothing());
}

/// What is in the way of a group's rays, each of which has `turned` as its form.
template <bool kMotion>
void trace_opaque_of(const WideTree& tree, std::span<TraceRay> turned, FirstOpaque* met) {
    if (turned.size() >= GroupTrace<kMotion>::kFewest && tree.node_count() > 1)
        return GroupTrace<kMotion>(tree, turned, met).run();
    for (size_t i = 0; i < turned.size(); ++i)
        SingleRay<kMotion, FirstOpaque, CountNothing>(tree, turned[i], met[i], CountNothing()).run();
}

void trace_group(const GroupQuery& query) {
    TraceRay turned[RayGroups::kMost];
    FirstOpaque found[RayGroups::kMost];
    size_t count = 0;
    uint32_t number[RayGroups::kMost];
    for (const uint32_t i : query.group) {
        const RangedRay& ray = query.rays[i];
        turned[count] = TraceRay::turned(axis_ray(ray.ray), ray.range);
        if (!has_numbers(turned[count])) continue;
        found[count].sure = ray.sure;
        number[count++] = i;
    }
    if (count == 0) return;
    if (query.tree.moves())
        trace_opaque_of<true>(query.tree, std::span(turned, count), found);
    else
        trace_opaque_of<false>(query.tree, std::span(turned, count), found);
    for (size_t k = 0; k < count; ++k) query.met[number[k]] = in_the_way_of(found[k]);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {
namespace {

using namespace single_ray_detail;

HWY_EXPORT(trace_group);
HWY_EXPORT(trace_closest);
HWY_EXPORT(trace_nearest);
HWY_EXPORT(trace_any);
HWY_EXPORT(trace_opaque);

std::optional<Hit> closest(const WideTree& tree, const SpaceRay& ray, DepthRange range, const Hit& from,
                           SingleRayCounts* counts) {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    if (!has_numbers(trace_ray)) return {};
    const ClosestHit hit = HWY_DYNAMIC_DISPATCH(trace_closest)({tree, trace_ray}, from, counts);
    if (!hit.found()) return {};
    return hit.best;
}

}  // namespace

std::optional<Hit> closest_hit(const WideTree& tree, const SpaceRay& ray, DepthRange range,
                               SingleRayCounts* counts) {
    return closest(tree, ray, range, kFirstHit, counts);
}

std::optional<Hit> closest_hit_from(const WideTree& tree, const SpaceRay& ray, DepthRange range,
                                    const Hit& from) {
    return closest(tree, ray, range, from, nullptr);
}

void nearest_hits(const WideTree& tree, const SpaceRay& ray, DepthRange range, NearestHits& hits) {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    if (has_numbers(trace_ray)) HWY_DYNAMIC_DISPATCH(trace_nearest)({tree, trace_ray}, hits);
}

bool any_hit(const WideTree& tree, const SpaceRay& ray, DepthRange range, SingleRayCounts* counts) {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    if (!has_numbers(trace_ray)) return false;
    return HWY_DYNAMIC_DISPATCH(trace_any)({tree, trace_ray}, counts).found;
}

InTheWay opaque_hit(const WideTree& tree, const SpaceRay& ray, DepthRange range, DepthRange sure) {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    if (!has_numbers(trace_ray)) return InTheWay::Nothing;
    return in_the_way_of(HWY_DYNAMIC_DISPATCH(trace_opaque)({tree, trace_ray}, sure));
}

void opaque_hits(const WideTree& tree, std::span<const RangedRay> rays, std::span<InTheWay> met) {
    std::ranges::fill(met, InTheWay::Nothing);
    RayGroups groups;
    groups.group(rays);
    groups.for_each([&](std::span<const uint32_t> group) {
        HWY_DYNAMIC_DISPATCH(trace_group)({tree, rays, group, met.data()});
    });
}

}  // namespace trapeze
#endif  // HWY_ONCE
