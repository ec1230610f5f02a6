#include "accel/wide/extent_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/wide/extent_tree.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include "core/simd/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

/// A plane of a vector of children at the ray's time, as position_at() has it.
template <class D>
hn::Vec<D> plane_at(D d, const float* at_open, const float* delta, bool moves, float time) {
    const hn::Vec<D> from = hn::Load(d, at_open);
    return moves ? hn::Add(from, hn::Mul(hn::Set(d, time), hn::Load(d, delta))) : from;
}

/// NaNs make no bound: comparisons that are false leave what there was.
uint32_t children_met(const ExtentNode& node, bool moves, const RayInAxes& ray_in_axes, const TraceRay& ray,
                      float* depths) {
    const hn::CappedTag<float, ExtentNode::kChildren> d;
    using V = hn::Vec<decltype(d)>;
    uint32_t met = 0;
    for (size_t i = 0; i < ExtentNode::kChildren; i += hn::Lanes(d)) {
        const V rounding = hn::Add(hn::Mul(hn::Set(d, ray.rounding_scale), hn::Load(d, node.coordinate + i)),
                                   hn::Set(d, ray.rounding_base));
        V near = hn::Set(d, -std::numeric_limits<float>::infinity());
        V far = hn::Set(d, std::numeric_limits<float>::infinity());
        for (int k = 0; k < 3; ++k) {
            const V inverse = hn::Set(d, ray_in_axes.inverse_direction[k]);
            const V origin = hn::Set(d, ray_in_axes.origin[k]);
            const float time = ray.axis.time;
            const V low = plane_at(d, node.low[k] + i, node.low_delta[k] + i, moves, time);
            const V high = plane_at(d, node.high[k] + i, node.high_delta[k] + i, moves, time);
            const V a = hn::Mul(hn::Sub(low, origin), inverse), b = hn::Mul(hn::Sub(high, origin), inverse);
            const V pad = hn::Mul(rounding, hn::Abs(inverse));
            const auto rises = hn::Lt(a, b);
            const V first = hn::Sub(hn::IfThenElse(rises, a, b), pad);
            const V last = hn::Add(hn::IfThenElse(rises, b, a), pad);
            near = hn::IfThenElse(hn::Gt(first, near), first, near);
            far = hn::IfThenElse(hn::Lt(last, far), last, far);
        }
        const V slack = hn::Add(hn::Load(d, node.extent + i), rounding);
        const V depth = hn::Sub(near, slack);
        hn::Store(depth, d, depths + i);
        const auto missed = hn::Or(
            hn::Gt(near, far),
            hn::Or(hn::Lt(hn::Add(far, slack), hn::Set(d, ray.t_min)), hn::Gt(depth, hn::Set(d, ray.t_max))));
        met |= mask_bits(d, hn::Not(missed)) << i;
    }
    return met & ((uint32_t{1} << node.count) - 1);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {
namespace {

HWY_EXPORT(children_met);

void set_box(ExtentNode& node, int i, const EndBoxes& box) {
    for (int k = 0; k < 3; ++k) {
        node.low[k][i] = box.at[0].low[k], node.high[k][i] = box.at[0].high[k];
        node.low_delta[k][i] = box.at[1].low[k] - box.at[0].low[k];
        node.high_delta[k][i] = box.at[1].high[k] - box.at[0].high[k];
    }
}

bool moves(const ExtentNode& node) {
    const auto is_moving = [](const float* deltas) {
        return std::any_of(deltas, deltas + 3 * ExtentNode::kChildren,
                           [](float delta) { return delta != 0; });
    };
    return is_moving(node.low_delta[0]) || is_moving(node.high_delta[0]);
}

}  // namespace

uint32_t children_met(const ExtentNode& node, bool moves, const RayInAxes& ray_in_axes, const TraceRay& ray,
                      float* depths) {
    return HWY_DYNAMIC_DISPATCH(children_met)(node, moves, ray_in_axes, ray, depths);
}

ExtentTree::ExtentTree(std::span<const GridExtent> extents) {
    std::vector<uint32_t> bounded;
    for (uint32_t i = 0; i < extents.size(); ++i) {
        if (!std::isfinite(extents[i].absolute_max)) {
            unbounded_.push_back(i);
            continue;
        }
        bounded.push_back(i);
    }
    if (bounded.empty()) return;
    const std::vector<WideChildren> wide = build_wide_top(extents, bounded);
    nodes_.resize(wide.size());
    // What is below a node comes after it, and is known first.
    for (size_t n = nodes_.size(); n-- > 0;) {
        ExtentNode& node = nodes_[n];
        node.count = static_cast<uint32_t>(wide[n].count);
        for (int i = 0; i < wide[n].count; ++i) {
            const uint32_t link = node.link[i] = wide[n].child[i].link;
            set_box(node, i, wide[n].child[i].box);
            if (link & kGridLink) {
                const GridExtent& extent = extents[link & ~kGridLink];
                node.coordinate[i] = extent.absolute_max, node.extent[i] = extent.largest_micropolygon;
                continue;
            }
            node.coordinate[i] = *std::ranges::max_element(nodes_[link].coordinate);
            node.extent[i] = *std::ranges::max_element(nodes_[link].extent);
        }
        moves_ |= moves(node);
    }
}

/// Record and keys are made for the extent alone, and thrown away. It grows as for a ray without slope from
/// the origin; visit() adds what rounds for the ray at hand.
GridExtent extent_of(const Grid& grid) {
    WideGrid record;
    record.nu = grid.shape.nu, record.nv = grid.shape.nv, record.key_count = grid.key_count;
    record.first_pair = 0;
    std::vector<uint8_t> keys(record.keys_bytes());
    GridExtent extent;
    bound_grid(grid, kTraceRounding, 0x1p-80f, record, keys.data(), extent);
    return extent;
}

/// Boxes are linear over the shutter: those about both at its two ends hold both at all times.
GridExtent united(const GridExtent& a, const GridExtent& b) {
    GridExtent both = a;
    for (int end = 0; end < 2; ++end)
        for (int k = 0; k < 3; ++k) {
            float &low = both.box.at[end].low[k], &high = both.box.at[end].high[k];
            low = std::min(low, b.box.at[end].low[k]), high = std::max(high, b.box.at[end].high[k]);
        }
    both.absolute_max = std::max(a.absolute_max, b.absolute_max);
    both.largest_micropolygon = std::max(a.largest_micropolygon, b.largest_micropolygon);
    return both;
}

}  // namespace trapeze
#endif  // HWY_ONCE
