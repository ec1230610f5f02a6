/// The fast acceleration structure, for rays that go through it in bundles [decision 0006]:
///
///   top level     16-wide nodes of axis-aligned hyper-trapezoids, whose leaves are grids;
///   in a grid     one implicit level: blocks of 4 x 4 micropolygons, the tiles in which vertices are stored,
///                 each with an oriented hyper-trapezoid in the grid's own axes [Hou10 sec. 3.2 and 3.3],
///                 kept in a byte a plane.
///
/// How a grid is kept is in accel/wide/wide_grid.h.
///
/// Nothing is stored for micropolygons. Boxes are linear in time: above grids over the whole shutter (a
/// conservative line where there are several motion segments), inside grids over each segment.
///
/// All boxes are grown once by what rounds away between a vertex and a slab test of a ray within RayReach.
/// A hit's depth lies in its micropolygon's own range of depths, hence in axis-aligned boxes' range of z; the
/// depth at which a ray enters an oriented box may exceed it by the micropolygon's extent (slack).
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "accel/hit_policies.h"
#include "accel/wide/bfloat16.h"
#include "accel/wide/wide_grid.h"
#include "core/grid.h"
#include "core/ray_query.h"
#include "core/stats.h"

namespace trapeze {

/// What the rays of bundles stay within, in camera space; origins are at z = 0. Wider reach, larger boxes.
struct RayReach {
    float slope = 2;   ///< |ux| + |uy|
    float origin = 0;  ///< |ox| + |oy|
};

/// Memory aligned to cache lines, readable 64 bytes past its end (vectors are loaded there). Not initialised;
/// T is never constructed nor destroyed.
template <class T>
class AlignedArray {
  public:
    /// Frees what there was; the new elements hold anything.
    void allocate(size_t count) {
        count_ = count;
        data_.reset(static_cast<T*>(::operator new (count * sizeof(T) + 128, std::align_val_t{64})));
    }
    size_t size() const { return count_; }
    size_t bytes() const { return count_ * sizeof(T); }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    T& operator[](size_t i) { return data_.get()[i]; }
    const T& operator[](size_t i) const { return data_.get()[i]; }

  private:
    struct Free {
        void operator()(T* p) const { ::operator delete (p, std::align_val_t{64}); }
    };
    std::unique_ptr<T, Free> data_;
    size_t count_ = 0;
};

/// Child links of nodes: kGridLink and a grid's index, a node's number, or kNoLink.
inline constexpr uint32_t kGridLink = uint32_t{1} << 31;
inline constexpr uint32_t kNoLink = ~uint32_t{0};

/// 16 children, their boxes plane by plane so that a vector holds a plane of all: axis-aligned in camera
/// space, grown for rays within reach. Children that are there come first.
struct alignas(64) WideNode {
    static constexpr int kChildren = 16;
    float low[3][kChildren], high[3][kChildren];  ///< at time 0; inverted where there is no child
    uint32_t child[kChildren];

    /// Low x, y, z, high x, y, z of all children: the node's first six rows, which lie one after the other.
    const float* row(size_t k) const { return reinterpret_cast<const float*>(this) + k * kChildren; }
};
/// What nodes of moving scenes have besides: how far planes move over the whole shutter, rounded outward to
/// bfloat16 (accel/wide/bfloat16.h).
struct alignas(64) WideNodeMotion {
    uint16_t low[3][WideNode::kChildren], high[3][WideNode::kChildren];

    const uint16_t* row(size_t k) const {
        return reinterpret_cast<const uint16_t*>(this) + k * WideNode::kChildren;
    }
};
/// What tests of single rays need to know of a node and all below it: the largest |coordinate| of boxes, and
/// the largest extent of a micropolygon along each axis of space.
struct WideNodeLargest {
    float coordinate, extent[3];
};

/// Some children, wherever they are kept: a row for each plane, in the order of WideNode.
struct ChildRows {
    const float* planes;
    const uint16_t* motions;  ///< as WideNodeMotion; null where nothing moves
    const uint32_t* links;
    size_t stride;  ///< from row to row
    const WideNodeLargest& largest;

    const float* row(size_t k) const { return planes + k * stride; }
    const uint16_t* motion(size_t k) const { return motions + k * stride; }
};

struct GridExtent;
struct WideChildren;

/// A ray, and the depths that count.
struct RangedRay {
    SpaceRay ray;
    DepthRange range;
    DepthRange sure = kAllDepths;  ///< whether hits outside of it are in the way is not sure
    Hit from = kFirstHit;          ///< closest hits in front of it do not count

    /// Goes on behind a hit: others may be as deep.
    void pass(const Hit& hit) { range.min = hit.depth, from = {hit.depth, hit.id + 1}; }
};

/// What a ray meets: only grids that are not opaque (layers), or one at least that is.
enum class InTheWay : uint8_t { Nothing, Layers, Opaque };

/// The tree. Answers bundles (accel/wide/bundle.h) and single rays in any direction; finds what testing
/// everything finds, bit for bit.
class WideTree final : public RayQuery {
  public:
    /// Grids beyond this many cannot be told apart in the tree's 32-bit micropolygon ids.
    static constexpr size_t kMaxGrids = size_t{1} << 24;

    /// Builds the tree, in parallel and alike for any number of threads. Keeps a reference to the grids, of
    /// which there are at most kMaxGrids, and reads their vertices when it is traced.
    WideTree(const Grids& grids, const RayReach& reach);

    std::optional<Hit> closest(const SpaceRay& ray, DepthRange range) const override;
    bool any(const SpaceRay& ray, DepthRange range) const override;
    /// closest() among the hits that are not in front of another one: that which follows a hit is found from
    /// {its depth, its id + 1} on, with a range that begins at its depth.
    std::optional<Hit> closest_from(const SpaceRay& ray, DepthRange range, const Hit& from) const;
    /// Adds to `hits`, which has none so far, what it wants of the range: what closest_from() finds one by
    /// one.
    void nearest(const SpaceRay& ray, DepthRange range, NearestHits& hits) const;
    /// In one go what any() and, where grids are not all opaque, closest() would be asked for. Whether hits
    /// outside of `sure` count is not sure: all of these are Layers.
    InTheWay in_the_way(const SpaceRay& ray, DepthRange range, DepthRange sure = kAllDepths) const;
    /// The same of many rays: of those that come in the order of their origins the ones that go alike share
    /// most of the work.
    void in_the_way(std::span<const RangedRay> rays, std::span<InTheWay> met) const;

    const Grids& grids() const { return grids_; }
    const RayReach& reach() const { return reach_; }
    BuildStats stats() const { return stats_; }
    bool moves() const { return moves_; }

    /// What bounds of things within some coordinates have to grow by, so that no test of a ray within reach
    /// loses a hit to rounding. As TraceRay::rounding(), for the worst ray within reach.
    float rounding(float absolute_max) const { return rounding_scale_ * absolute_max + rounding_base_; }

    /// The extent along z of the largest micropolygon of all; the largest along any axis.
    float max_slack() const { return max_slack_; }
    float max_extent() const { return max_extent_; }
    /// The largest |coordinate| of all that has bounds.
    float absolute_max() const { return absolute_max_; }
    const WideNode* nodes() const { return nodes_.data(); }
    const WideNodeMotion* node_motions() const { return node_motions_.data(); }
    const WideNodeLargest& node_largest(uint32_t node) const { return node_largest_[node]; }
    size_t node_count() const { return nodes_.size(); }  ///< the root is node 0
    ChildRows children_of(uint32_t node) const {
        return {nodes_[node].row(0), moves_ ? node_motions_[node].row(0) : nullptr, nodes_[node].child,
                WideNode::kChildren, node_largest_[node]};
    }
    /// The record of a grid, by its index in grids().
    const WideGrid& grid(uint32_t index) const { return wide_grids_[index]; }
    /// A grid's bounds and codes of boxes at its keys, as WideGrid tells; read by GridKeys.
    const uint8_t* keys_of(const WideGrid& grid) const { return keys_.data() + 2 * size_t{grid.first_pair}; }
    /// Decodes the boxes of a grid in a segment, one at a time: the meaning of what tracing decodes in
    /// vectors (box_codes-inl.h). Of a still grid rows 6 to 11 are not written.
    void decode(const WideGrid& grid, int segment, BoxPlanes& boxes) const;
    /// A grid's box in camera space over the whole shutter; not of unbounded ones.
    MovingBox grid_box(const WideGrid& grid) const {
        const size_t node = grid.leaf / WideNode::kChildren, child = grid.leaf % WideNode::kChildren;
        MovingBox box{};
        for (int k = 0; k < 3; ++k) {
            box.low[k] = nodes_[node].low[k][child], box.high[k] = nodes_[node].high[k][child];
            if (!moves_) continue;
            box.low_delta[k] = from_bfloat16(node_motions_[node].low[k][child]);
            box.high_delta[k] = from_bfloat16(node_motions_[node].high[k][child]);
        }
        return box;
    }
    /// A grid's box in camera space during one segment, times local to it; the whole shutter's where a grid
    /// has only one segment.
    MovingBox segment_box(const WideGrid& grid, int segment) const {
        if (!grid.has_segments()) return grid_box(grid);
        const GridKeys keys(grid, keys_of(grid));
        return between(keys.aligned(segment), keys.aligned(segment + 1));
    }
    /// A grid's axes and its box along them in a segment; of a still grid the same at both ends.
    void read_segment(const WideGrid& grid, int segment, OrientedSegment& oriented) const {
        const GridKeys keys(grid, keys_of(grid));
        oriented.axes = grid.axes.unpacked();
        oriented.at[0] = keys.oriented(segment);
        oriented.at[1] = grid.moves() ? keys.oriented(segment + 1) : oriented.at[0];
        oriented.box = between(oriented.at[0], oriented.at[1]);
    }
    /// Grids too far out for bounds: every ray must look at them.
    const std::vector<uint32_t>& unbounded_grids() const { return unbounded_; }

  private:
    /// First pass: wide_grids_ and keys_ (but for WideGrid::leaf), in parallel over grids.
    void bound_grids(std::vector<GridExtent>& extents);
    /// Nodes in the form that is traced, and each grid's leaf.
    void write_nodes(const std::vector<WideChildren>& wide);
    /// Last pass, from the leaves to the root.
    void find_largest();

    const Grids& grids_;
    RayReach reach_;
    float rounding_scale_, rounding_base_;
    bool moves_ = false;
    float max_slack_ = 0, max_extent_ = 0, absolute_max_ = 0;
    AlignedArray<WideGrid> wide_grids_;
    AlignedArray<uint8_t> keys_;  ///< WideGrid::keys_bytes() of all grids
    AlignedArray<WideNode> nodes_;
    AlignedArray<WideNodeMotion> node_motions_;
    AlignedArray<WideNodeLargest> node_largest_;
    std::vector<uint32_t> unbounded_;
    BuildStats stats_;
};

}  // namespace trapeze
