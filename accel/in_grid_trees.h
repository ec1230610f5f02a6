/// The trees inside grids [Hou10 sec. 3.3]: parametric midpoint splits, so that the topology follows from a
/// grid's shape and nothing of it is stored. All nodes of a grid have the grid's orientation; their boxes are
/// 16-bit numbers within the grid's own box at each of its keys.
///
/// Inner nodes are numbered in preorder. Inner node i has, for each key, one record: the boxes of its two
/// children, axis by axis as low, low, high, high. A grid of 16 x 16 with two keys takes 63 records of 48
/// bytes, 12 bytes a micropolygon.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "accel/builders/grid_summary.h"
#include "accel/grid_block.h"
#include "accel/ray_tree.h"
#include "accel/slabs.h"
#include "core/grid.h"

namespace trapeze {

namespace in_grid_detail {

inline constexpr int kSides = kMaxGridSide + 1;
using InnerCounts = std::array<uint8_t, kSides * kSides>;

constexpr InnerCounts inner_counts() {
    InnerCounts counts{};
    const auto at = [&](const GridBlock& b) -> uint8_t& { return counts[b.nu * kSides + b.nv]; };
    for (int sum = 2; sum <= 2 * kMaxGridSide; ++sum)  // halves have a smaller nu + nv
        for (int nu = 1; nu < sum; ++nu) {
            const int nv = sum - nu;
            if (nu > kMaxGridSide || nv > kMaxGridSide || is_leaf_block(nu, nv)) continue;
            const GridBlock block{0, 0, static_cast<uint8_t>(nu), static_cast<uint8_t>(nv)};
            const BlockHalves parts = halves(block);
            at(block) = static_cast<uint8_t>(1 + at(parts.low) + at(parts.high));
        }
    return counts;
}

inline constexpr InnerCounts kInnerCounts = inner_counts();

}  // namespace in_grid_detail

/// Inner nodes of the tree of a block; 0 for a leaf.
constexpr uint32_t inner_node_count(const GridBlock& block) {
    return in_grid_detail::kInnerCounts[block.nu * in_grid_detail::kSides + block.nv];
}

class InGridTrees {
  public:
    static constexpr int kRecordSize = 12;         ///< numbers of a key's record
    static constexpr float kQuantumCount = 65535;  ///< steps across the grid's box

    /// Boxes of the grids' trees, and per grid its bound at its own keys into `bounds`.
    InGridTrees(std::span<const Grid> grids, std::span<const GridSummary> summaries,
                std::vector<HyperTrapezoid>& bounds);

    size_t bytes() const {
        return entries_.capacity() * sizeof(Entry) + references_.capacity() * sizeof(Reference) +
               records_.capacity() * sizeof(uint16_t);
    }
    size_t inner_nodes() const { return inner_nodes_; }

  private:
    friend class InGridTree;

    /// The grid's box at a key: its low corner and the length of a quantum.
    struct alignas(16) Reference {
        float low[4] = {}, step[4] = {};
    };
    struct Entry {
        FrameColumns frame;
        float absolute_max = 0, quad_extent = 0;
        uint32_t first_record = 0;     ///< in records_, in units of kRecordSize
        uint32_t first_reference = 0;  ///< in references_
    };

    void build_grid(const Grid& grid, const GridSummary& summary, const Entry& entry, HyperTrapezoid& bound);

    std::vector<Entry> entries_;
    std::vector<Reference> references_;
    std::vector<uint16_t> records_;
    size_t inner_nodes_ = 0;
};

/// One grid's tree, prepared for one ray: transformed into the grid's frame once. A RayTree.
class InGridTree {
  public:
    static constexpr int kStackSize = 12;  ///< 16 x 16 is halved six times

    InGridTree(const InGridTrees& trees, const Grid& grid, uint32_t grid_index, const TraceRay& ray)
        : key_count_(grid.key_count), root_(pack({0, 0, grid.shape.nu, grid.shape.nv}, 0)) {
        const InGridTrees::Entry& entry = trees.entries_[grid_index];
        const MotionSegment segment = segment_at(ray.axis.time, key_count_);
        records_ = trees.records_.data() + size_t{entry.first_record + static_cast<uint32_t>(segment.index)} *
                                               InGridTrees::kRecordSize;
        const float rounding = ray.rounding(entry.absolute_max);
        slack_ = entry.quad_extent + rounding;
        // A slab's plane is low(t) + quantum(t) * step(t), and its depth (plane - origin) / direction: linear
        // in the quanta of both keys.
        const FrameRay local(entry.frame, ray);
        const InGridTrees::Reference& from = trees.references_[entry.first_reference + segment.index];
        const InGridTrees::Reference& to = key_count_ > 1 ? (&from)[1] : from;
        for (int k = 0; k < 4; ++k) {
            const float inverse = local.inverse_direction[k];
            const float low = position_at(from.low[k], to.low[k] - from.low[k], segment.local);
            base_[k] = (low - local.origin[k]) * inverse;
            from_scale_[k] = (1 - segment.local) * from.step[k] * inverse;
            to_scale_[k] = segment.local * to.step[k] * inverse;
            pad_[k] = rounding * std::abs(inverse);
        }
    }

    Visits enter(const TraceRay&) const {
        Visits visits;
        visits.add({-std::numeric_limits<float>::infinity(), root_});
        return visits;
    }
    bool is_leaf(uint32_t node) const {
        const GridBlock block = leaf(node);
        return is_leaf_block(block.nu, block.nv);
    }
    GridBlock leaf(uint32_t node) const {
        const auto nibble = [node](int shift) { return static_cast<uint8_t>(node >> shift & 15); };
        return {nibble(0), nibble(4), static_cast<uint8_t>(nibble(8) + 1),
                static_cast<uint8_t>(nibble(12) + 1)};
    }
    Visits step(const Visit& at, const TraceRay& ray) const;

  private:
    static uint32_t pack(const GridBlock& b, uint32_t inner) {
        return b.u | uint32_t{b.v} << 4 | uint32_t{b.nu - 1u} << 8 | uint32_t{b.nv - 1u} << 12 | inner << 16;
    }

    const uint16_t* records_;
    int key_count_;
    uint32_t root_;
    float slack_;
    alignas(16) float base_[4], from_scale_[4], to_scale_[4], pad_[4];
};

inline Visits InGridTree::step(const Visit& at, const TraceRay& ray) const {
    const uint32_t inner = at.node >> 16;
    const uint16_t* from = records_ + size_t{inner} * key_count_ * InGridTrees::kRecordSize;
    const uint16_t* to = key_count_ > 1 ? from + InGridTrees::kRecordSize : from;
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    float near[2] = {-kInfinite, -kInfinite}, far[2] = {kInfinite, kInfinite};
    for (int k = 0; k < 3; ++k) {
        float t[4];  // low, low, high, high
        for (int i = 0; i < 4; ++i)
            t[i] = (static_cast<float>(from[4 * k + i]) * from_scale_[k] +
                    static_cast<float>(to[4 * k + i]) * to_scale_[k]) +
                   base_[k];
        for (int child = 0; child < 2; ++child) {
            const float low = t[child], high = t[2 + child];
            const float n = (low < high ? low : high) - pad_[k], f = (low < high ? high : low) + pad_[k];
            near[child] = n > near[child] ? n : near[child];
            far[child] = f < far[child] ? f : far[child];
        }
    }
    const BlockHalves parts = halves(leaf(at.node));
    const uint32_t low_inner = inner + 1, high_inner = low_inner + inner_node_count(parts.low);
    Visits visits;
    const auto met = [&](int child) {
        return !(near[child] > far[child]) && !(far[child] + slack_ < ray.t_min) &&
               !(near[child] - slack_ > ray.t_max);
    };
    const Visit low{near[0] - slack_, pack(parts.low, low_inner)};
    const Visit high{near[1] - slack_, pack(parts.high, high_inner)};
    const bool low_is_near = low.depth <= high.depth;
    const Visit& second = low_is_near ? high : low;
    if (met(low_is_near ? 1 : 0)) visits.add(second);
    if (met(low_is_near ? 0 : 1)) visits.add(low_is_near ? low : high);
    return visits;
}

}  // namespace trapeze
