#include "accel/wide/wide_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "accel/grid_block.h"
#include "accel/hit_policies.h"
#include "accel/slabs.h"
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
            unbounded_.push_back(i);
            continue;
        }
        bounded.push_back(i);
        absolute_max_ = std::max(absolute_max_, extents[i].absolute_max);
        max_slack_ = std::max(max_slack_, wide_grids_[i].slack);
        max_extent_ = std::max(max_extent_, extents[i].largest_micropolygon);
    }
    if (!bounded.empty()) write_nodes(build_wide_top(extents, bounded));
    for (const uint32_t grid : bounded) stats_.tree_leaves += wide_grids_[grid].block_count();
    stats_.tree_nodes = nodes_.size() + bounded.size();
    stats_.tree_bytes =
        sizeof(*this) + wide_grids_.bytes() + keys_.bytes() + nodes_.bytes() + node_motions_.bytes();
}

void WideTree::bound_grids(std::vector<GridExtent>& extents) {
    const size_t count = grids_.grids.size();
    wide_grids_.allocate(count);
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
        const KeyBounds whole = keys.framed(segment + end);
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
                node_motions_[n].low[k][i] = bfloat16_below(box.low_delta[k]);
                node_motions_[n].high[k][i] = bfloat16_above(box.high_delta[k]);
            }
        }
    });
}

namespace {

/// The depths between which a ray is inside a box at its time; all bounds grown by `pad`.
DepthInterval slab_depths(const float* low, const float* high, const float* low_delta,
                          const float* high_delta, size_t stride, float time, const float* origin,
                          const float* inverse, float pad) {
    DepthInterval inside{-HUGE_VALF, HUGE_VALF};
    for (size_t k = 0; k < 3; ++k) {
        const float l = low[k * stride] + (low_delta ? time * low_delta[k * stride] : 0.0f) - pad;
        const float h = high[k * stride] + (high_delta ? time * high_delta[k * stride] : 0.0f) + pad;
        const float a = (l - origin[k]) * inverse[k], b = (h - origin[k]) * inverse[k];
        inside.near = std::max(inside.near, std::min(a, b));
        inside.far = std::min(inside.far, std::max(a, b));
    }
    return inside;
}

/// One over a component of a direction, finite even where that is 0.
float inverse_of(float direction) {
    return 1.0f / (std::abs(direction) < kLeastDirection ? kLeastDirection : direction);
}

/// Tests a ray in any direction against some micropolygons of a grid and shows the policy what it hits.
template <class Policy>
void test_micropolygons(const Grid& grid, uint32_t index, const GridBlock& block, TraceRay& ray,
                        Policy& policy) {
    for (int v = block.v; v < block.v + block.nv; ++v)
        for (int u = block.u; u < block.u + block.nu; ++u) {
            const Quad quad = grid.quad(u, v, ray.axis.time, ray.planes[0], ray.planes[1], ray.planes[2]);
            float z;
            if (!hit_micropolygon(ray.axis, quad, facing_along(grid.facing, ray.sign), &z)) continue;
            const Hit hit{ray.depth_of(z),
                          MicropolygonId{index, static_cast<uint8_t>(u), static_cast<uint8_t>(v)}.packed()};
            if (hit.depth >= ray.t_min && hit.depth <= ray.t_max) policy.consider(hit, grid.opaque, ray);
        }
}

/// A node's WideNodeMotion in floats; not set where nothing moves.
struct NodeDeltas {
    float low[3][WideNode::kChildren], high[3][WideNode::kChildren];

    NodeDeltas(const WideTree& tree, uint32_t node) {
        if (!tree.moves()) return;
        const WideNodeMotion& motion = tree.node_motions()[node];
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < WideNode::kChildren; ++i)
                low[k][i] = from_bfloat16(motion.low[k][i]), high[k][i] = from_bfloat16(motion.high[k][i]);
    }
};

/// One ray in any direction through the tree, nearest children first. Its reach may be any: boxes grow by the
/// ray's own rounding (pad_) when they are tested.
template <class Policy>
class SingleRay {
  public:
    SingleRay(const WideTree& tree, float absolute_max, float extent, TraceRay& ray, Policy& policy)
        : tree_(tree), ray_(ray), policy_(policy), pad_(ray.rounding(absolute_max)), slack_(extent + pad_) {
        for (int k = 0; k < 3; ++k) origin_[k] = ray.origin[k], inverse_[k] = inverse_of(ray.direction[k]);
    }

    void run() {
        for (const uint32_t grid : tree_.unbounded_grids()) {
            const GridShape& shape = tree_.grids().grids[grid].shape;
            test_micropolygons(tree_.grids().grids[grid], grid, {0, 0, shape.nu, shape.nv}, ray_, policy_);
        }
        if (tree_.node_count() > 0) visit(0);
    }

  private:
    struct Child {
        float depth;
        uint32_t link;
    };

    /// A node's children that the ray may hit, from near to far; ends when the nearest hit is in front of the
    /// rest.
    void visit(uint32_t index) {
        const WideNode& node = tree_.nodes()[index];
        const NodeDeltas motion(tree_, index);
        std::array<Child, WideNode::kChildren> met;
        int count = 0;
        for (int i = 0; i < WideNode::kChildren && node.child[i] != kNoLink; ++i) {
            float depth;
            if (slab_depths(&node.low[0][i], &node.high[0][i], tree_.moves() ? &motion.low[0][i] : nullptr,
                            tree_.moves() ? &motion.high[0][i] : nullptr, WideNode::kChildren, ray_.axis.time,
                            origin_, inverse_, pad_)
                    .meets(ray_, slack_, depth))
                met[count++] = {depth, node.child[i]};
        }
        std::sort(met.begin(), met.begin() + count, [](const Child& a, const Child& b) {
            return a.depth < b.depth || (a.depth == b.depth && a.link < b.link);
        });
        for (int i = 0; i < count; ++i) {
            if (met[i].depth > ray_.t_max) return;
            if (met[i].link & kGridLink)
                visit_grid(met[i].link & ~kGridLink);
            else
                visit(met[i].link);
        }
    }

    /// The ray in the grid's frame against its boxes at the ray's time, one after another, then against all
    /// micropolygons in those it meets.
    void visit_grid(uint32_t index) {
        const WideGrid& record = tree_.grid(index);
        const MotionSegment segment = segment_at(ray_.axis.time, record.key_count);
        BoxPlanes boxes;
        tree_.decode(record, segment.index, boxes);
        const FrameAxes axes = record.axes.unpacked();
        constexpr size_t kStride = BoxPlanes::kMost;
        float origin[3], inverse[3];
        for (int k = 0; k < 3; ++k) {
            const float* a = axes.axis[k];
            origin[k] = a[0] * ray_.origin.x + a[1] * ray_.origin.y + a[2] * ray_.origin.z;
            inverse[k] =
                inverse_of(a[0] * ray_.direction.x + a[1] * ray_.direction.y + a[2] * ray_.direction.z);
        }
        for (size_t box = 0; box < static_cast<size_t>(record.box_count()); ++box) {
            const float* at = boxes.values + box;
            float depth;
            if (!slab_depths(at, at + 3 * kStride, record.moves() ? at + 6 * kStride : nullptr,
                             record.moves() ? at + 9 * kStride : nullptr, kStride, segment.local, origin,
                             inverse, pad_)
                     .meets(ray_, slack_, depth))
                continue;
            const int first = static_cast<int>(box) * record.blocks_per_box();
            const int last = std::min(first + record.blocks_per_box(), record.block_count());
            for (int block = first; block < last; ++block) {
                const auto u = static_cast<uint8_t>(block % record.blocks_u() * 4),
                           v = static_cast<uint8_t>(block / record.blocks_u() * 4);
                test_micropolygons(tree_.grids().grids[index], index,
                                   {u, v, static_cast<uint8_t>(std::min(4, record.nu - u)),
                                    static_cast<uint8_t>(std::min(4, record.nv - v))},
                                   ray_, policy_);
            }
        }
    }

    const WideTree& tree_;
    TraceRay& ray_;
    Policy& policy_;
    float pad_, slack_;
    float origin_[3], inverse_[3];
};

}  // namespace

std::optional<Hit> WideTree::closest(const SpaceRay& ray, DepthRange range) const {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    ClosestHit policy;
    SingleRay<ClosestHit>(*this, absolute_max_, max_extent_, trace_ray, policy).run();
    if (!policy.found()) return {};
    return policy.best;
}

bool WideTree::any(const SpaceRay& ray, DepthRange range) const {
    TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
    AnyHit policy;
    SingleRay<AnyHit>(*this, absolute_max_, max_extent_, trace_ray, policy).run();
    return policy.found;
}

}  // namespace trapeze
