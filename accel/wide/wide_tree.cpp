#include "accel/wide/wide_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "accel/trace_ray.h"
#include "accel/wide/bfloat16.h"
#include "accel/wide/wide_grids.h"
#include "accel/wide/wide_top.h"

namespace trapeze {
namespace {

/// Low planes of children that are not there, and with a minus high ones: boxes inside out, farther than
/// anything.
constexpr float kNowhere = 1e30f;

}  // namespace

WideTree::WideTree(const Grids& grids, const RayReach& reach)
    : grids_(grids),
      reach_(reach),
      rounding_scale_(kTraceRounding * (1 + reach.slope)),  // as TraceRay::rounding()
      rounding_base_(2 * rounding_scale_ * reach.origin + 0x1p-80f) {
    moves_ = grids.max_key_count() > 1;
    std::vector<GridExtent> extents(grids.grids.size());
    bound_grids(extents);
    std::vector<uint32_t> bounded;
    bounded.reserve(extents.size());
    for (uint32_t i = 0; i < extents.size(); ++i) {
        if (!std::isfinite(extents[i].absolute_max)) {
            // These are in no node: every ray is tested against them.
            unbounded_.push_back(i);
            continue;
        }
        bounded.push_back(i);
        absolute_max_ = std::max(absolute_max_, extents[i].absolute_max);
        max_slack_ = std::max(max_slack_, wide_grids_[i].slack());
        max_extent_ = std::max(max_extent_, extents[i].largest_micropolygon);
    }
    if (!bounded.empty()) {
        write_nodes(build_wide_top(extents, bounded));
        find_largest();
    }
    for (const uint32_t grid : bounded) stats_.tree_leaves += wide_grids_[grid].block_count();
    stats_.tree_nodes = nodes_.size() + bounded.size();
    stats_.tree_bytes = sizeof(*this) + wide_grids_.bytes() + keys_.bytes() + nodes_.bytes() +
                        node_motions_.bytes() + node_largest_.bytes();
}

void WideTree::bound_grids(std::vector<GridExtent>& extents) {
    const size_t count = grids_.grids.size();
    wide_grids_.allocate(count);
    // Pairs of bytes, so that 32 bits reach 8 GB. Sizes follow from shapes and numbers of keys: each grid's
    // place is known before any is bounded.
    size_t pairs = 0;
    for (size_t i = 0; i < count; ++i) {
        const Grid& grid = grids_.grids[i];
        WideGrid& record = wide_grids_[i];
        record.nu = grid.shape.nu, record.nv = grid.shape.nv, record.key_count = grid.key_count;
        record.first_pair = static_cast<uint32_t>(pairs);
        pairs += record.keys_bytes() / 2;
    }
    keys_.allocate(2 * pairs);
    constexpr size_t kGrain = 32;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, kGrain), [&](const auto& range) {
        for (size_t i = range.begin(); i != range.end(); ++i) {
            WideGrid& record = wide_grids_[i];
            bound_grid(grids_.grids[i], rounding_scale_, rounding_base_, record,
                       keys_.data() + 2 * size_t{record.first_pair}, extents[i]);
        }
    });
}

void WideTree::decode(const WideGrid& grid, int segment, BoxPlanes& boxes) const {
    const int count = grid.box_count();
    const GridKeys keys(grid, keys_of(grid));
    for (int end = 0; end < (grid.moves() ? 2 : 1); ++end) {
        const uint8_t* codes = keys.box_codes(segment + end);
        const KeyBounds whole = keys.oriented(segment + end);
        for (int k = 0; k < 6; ++k) {
            const CodeScale scale(whole.low[k % 3], whole.high[k % 3]);
            const float* first = boxes.row(static_cast<size_t>(k));
            float* row = boxes.row(static_cast<size_t>(6 * end + k));
            for (int b = 0; b < count; ++b) {
                const float plane = scale.plane(codes[k * count + b]);
                row[b] = end == 0 ? plane : plane - first[b];
            }
        }
    }
}

void WideTree::write_nodes(const std::vector<WideChildren>& wide) {
    nodes_.allocate(wide.size());
    if (moves_) node_motions_.allocate(wide.size());
    tbb::parallel_for(size_t{0}, wide.size(), [&](size_t n) {
        WideNode& node = nodes_[n];
        for (int i = 0; i < WideNode::kChildren; ++i) {
            const bool used = i < wide[n].count;
            node.child[i] = used ? wide[n].child[i].link : kNoLink;
            if (used && (node.child[i] & kGridLink) != 0)
                wide_grids_[node.child[i] & ~kGridLink].leaf =
                    static_cast<uint32_t>(n * WideNode::kChildren) + static_cast<uint32_t>(i);
            const MovingBox box =
                used ? between(wide[n].child[i].box.at[0], wide[n].child[i].box.at[1]) : MovingBox{};
            for (int k = 0; k < 3; ++k) {
                node.low[k][i] = used ? box.low[k] : kNowhere;
                node.high[k][i] = used ? box.high[k] : -kNowhere;
                if (!moves_) continue;
                // Rounded outwards: boxes at close may be larger than they were, never smaller.
                node_motions_[n].low[k][i] = bfloat16_below(box.low_delta[k]);
                node_motions_[n].high[k][i] = bfloat16_above(box.high_delta[k]);
            }
        }
    });
}

void WideTree::find_largest() {
    node_largest_.allocate(nodes_.size());
    // Nodes come before those below them.
    for (size_t n = nodes_.size(); n-- > 0;) {
        WideNodeLargest& largest = node_largest_[n] = {};
        for (int i = 0; i < WideNode::kChildren && nodes_[n].child[i] != kNoLink; ++i) {
            const uint32_t link = nodes_[n].child[i];
            const WideGrid* grid = link & kGridLink ? &wide_grids_[link & ~kGridLink] : nullptr;
            for (int k = 0; k < 3; ++k) {
                largest.extent[k] = std::max(largest.extent[k],
                                             grid ? grid->largest_extent(k) : node_largest_[link].extent[k]);
                float low = nodes_[n].low[k][i], high = nodes_[n].high[k][i];
                // At open and at close: planes are linear between, and no farther out.
                largest.coordinate = std::max({largest.coordinate, std::abs(low), std::abs(high)});
                if (!moves_) continue;
                low += from_bfloat16(node_motions_[n].low[k][i]);
                high += from_bfloat16(node_motions_[n].high[k][i]);
                largest.coordinate = std::max({largest.coordinate, std::abs(low), std::abs(high)});
            }
        }
    }
}

}  // namespace trapeze
