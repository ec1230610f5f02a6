/// Finds the grids that a bundle may meet: takes it through the nodes above grids in groups of packets, each
/// group as one, by the intervals that hold its rays. Where grids are smaller than what the bundle sees, a
/// group meets far fewer of them than the whole bundle would. Compiled once a target.
#if defined(TRAPEZE_ACCEL_CANDIDATES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TRAPEZE_ACCEL_CANDIDATES_INL_H_
#undef TRAPEZE_ACCEL_CANDIDATES_INL_H_
#else
#define TRAPEZE_ACCEL_CANDIDATES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "accel/wide/bfloat16-inl.h"
#include "accel/wide/bundle_state-inl.h"
#include "accel/wide/ray_intervals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sets the intervals of groups to hold those of their packets. Rows come in pairs, low then high.
template <bool kMotion, bool kLens>
void join_packets(BundleState& t) {
    const F32 d;
    const RayIntervals& of = t.scratch.intervals;
    for (size_t g = 0; g < t.groups(); ++g) {
        const size_t begin = g * t.group_packets, end = std::min(begin + t.group_packets, t.packets);
        const auto join = [&](int row) HWY_ATTR {
            // Past the last packet its intervals are repeated.
            VF low = hn::Load(d, of.row[row] + begin), high = hn::Load(d, of.row[row + 1] + begin);
            for (size_t p = begin + kLanes; p < end; p += kLanes) {
                low = hn::Min(low, hn::Load(d, of.row[row] + p));
                high = hn::Max(high, hn::Load(d, of.row[row + 1] + p));
            }
            t.scratch.groups[row][g] = least(low), t.scratch.groups[row + 1][g] = largest(high);
        };
        join(RayIntervals::kDxMin), join(RayIntervals::kDyMin);
        if constexpr (kLens) join(RayIntervals::kOxMin), join(RayIntervals::kOyMin);
        if constexpr (kMotion) join(RayIntervals::kTimeMin);
    }
}

/// Boxes of a node's children from number `first` on, one a lane, at time 0, and how far their planes move
/// over the shutter. Lanes without a child have boxes that nothing meets.
template <bool kMotion>
struct ChildLanes {
    VF low[3], high[3], low_delta[3], high_delta[3];

    HWY_INLINE ChildLanes(const WideTree& tree, uint32_t node, size_t first) {
        const F32 d;
        const WideNode& at = tree.nodes()[node];
        for (int k = 0; k < 3; ++k) {
            low[k] = hn::Load(d, at.low[k] + first), high[k] = hn::Load(d, at.high[k] + first);
            if constexpr (kMotion) {
                const WideNodeMotion& motion = tree.node_motions()[node];
                low_delta[k] = from_bfloat16(d, motion.low[k] + first);
                high_delta[k] = from_bfloat16(d, motion.high[k] + first);
            }
        }
    }
};

/// Which of a node's children (as many as there are lanes) which groups may meet.
struct ChildrenMet {
    uint32_t any = 0;                            ///< a bit a child
    uint32_t by[BundleScratch::kGroups];         ///< the same for each group
    HWY_ALIGN float depth[WideNode::kChildren];  ///< least one of each child's box
};

/// Tests groups (a bit a group) against a node's children by intervals.
template <bool kMotion, bool kLens>
HWY_INLINE void meet_children(BundleState& t, const ChildLanes<kMotion>& child, uint32_t groups,
                              ChildrenMet& met) {
    const F32 d;
    const VF nearest = hn::Set(d, t.nearest_depth), focal = hn::Set(d, t.inverse_focal);
    VF depth = hn::Set(d, HUGE_VALF);
    met.any = 0;
    for (uint32_t left = groups; left != 0; left &= left - 1) {
        const auto g = static_cast<size_t>(std::countr_zero(left));
        const auto q = IntervalLanes::of<kMotion, kLens>(
            [&](int row) HWY_ATTR { return hn::Set(d, t.scratch.groups[row][g]); });
        VF low[3], high[3];
        for (int k = 0; k < 3; ++k) {
            low[k] = child.low[k], high[k] = child.high[k];
            if constexpr (kMotion) {
                low[k] = lowest(low[k], child.low_delta[k], q.time);
                high[k] = highest(high[k], child.high_delta[k], q.time);
            }
        }
        met.by[g] = mask_bits(meets<kLens>(d, q, low, high, nearest, focal));
        met.any |= met.by[g];
        // A hit lies within its micropolygon's range of z, hence within the box's: low z is a bound that
        // needs no slack.
        depth = hn::Min(depth, low[2]);
    }
    hn::Store(depth, d, met.depth);
}

/// Lists the grids that groups of the bundle may meet in scratch.candidates, each with a lower bound of its
/// depths; in no order. A node is stepped through once for all groups that meet it.
template <bool kMotion, bool kLens>
void collect_candidates(BundleState& t) {
    auto& stack = t.scratch.stack;
    t.scratch.candidates.clear();
    if (t.tree.node_count() == 0) return;
    join_packets<kMotion, kLens>(t);
    stack.assign(1, {0, (1u << t.groups()) - 1});
    while (!stack.empty()) {
        const BundleScratch::Link at = stack.back();
        stack.pop_back();
        t.stats.nodes_visited += static_cast<uint64_t>(std::popcount(at.groups));
        for (size_t i = 0; i < WideNode::kChildren; i += kLanes) {
            ChildrenMet met;
            meet_children<kMotion, kLens>(t, ChildLanes<kMotion>(t.tree, at.node, i), at.groups, met);
            for (; met.any != 0; met.any &= met.any - 1) {
                const int lane = std::countr_zero(met.any);
                // Turns a bit a child for each group into a bit a group for this child.
                uint32_t groups = 0;
                for (uint32_t left = at.groups; left != 0; left &= left - 1) {
                    const int g = std::countr_zero(left);
                    groups |= (met.by[g] >> lane & 1) << g;
                }
                const uint32_t link = t.tree.nodes()[at.node].child[i + static_cast<size_t>(lane)];
                if (link & kGridLink)
                    t.scratch.candidates.push_back(candidate_of(met.depth[lane], link & ~kGridLink, groups));
                else
                    stack.push_back({link, groups});
            }
        }
    }
}

/// Puts candidates into the order of their depths, nearly, by one counting sort: in 256 steps between the
/// least and the most, in equal parts of a binary order of magnitude. What a ray meets a little too late
/// costs less than comparisons that cannot be predicted do. Candidates of one step keep the order that the
/// tree gave them.
inline void order_candidates(BundleState& t) {
    constexpr int kStepBits = 8;
    std::vector<uint64_t>& all = t.scratch.candidates;
    std::vector<uint64_t>& ordered = t.scratch.ordered;
    if (all.size() < 2) return;
    // Compares depths, which are the upper bits.
    const auto [first, last] = std::minmax_element(all.begin(), all.end());
    const uint64_t least = *first >> 32, range = (*last >> 32) - least;
    const int shift = std::max(0, static_cast<int>(std::bit_width(range)) - kStepBits);
    std::array<uint32_t, (1 << kStepBits) + 1> starts{};
    const auto step = [&](uint64_t candidate) { return ((candidate >> 32) - least) >> shift; };
    for (const uint64_t candidate : all) ++starts[step(candidate) + 1];
    for (size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
    ordered.resize(all.size());
    for (const uint64_t candidate : all) ordered[starts[step(candidate)]++] = candidate;
    all.swap(ordered);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
