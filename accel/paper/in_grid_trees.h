/// The trees inside grids [Hou10 sec. 3.3]: parametric midpoint splits, so that the topology follows from a
/// grid's shape and nothing of it is stored. All nodes of a grid have the grid's orientation; their boxes are
/// 16-bit numbers within the grid's own box at each of its keys.
///
/// Inner nodes are numbered in preorder. Inner node i has, for each key, one record: the boxes of its two
/// children, axis by axis as low, low, high, high. A grid of 16 x 16 with two keys and leaves of fewer than
/// eight takes 63 records of 48 bytes, 12 bytes a micropolygon.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "accel/builders/grid_summary.h"
#include "accel/builders/paper_options.h"
#include "accel/grid_block.h"
#include "accel/ray_tree.h"
#include "accel/slabs.h"
#include "core/grid.h"

namespace trapeze {

/// Where the splits of blocks end: at fewer than a number of micropolygons [Hou10 sec. 3.3].
class ParametricSplits {
  public:
    /// `leaf_below`: 2 to kMostSplitFrom.
    explicit ParametricSplits(int leaf_below);

    bool is_leaf(const GridBlock& block) const { return block.count() < leaf_below_; }
    /// Inner nodes of the tree of a block, from a table by shape; 0 for a leaf.
    uint32_t inner_nodes(const GridBlock& block) const { return inner_nodes_[block.nu * kSides + block.nv]; }

  private:
    static constexpr int kSides = kMaxGridSide + 1;
    int leaf_below_;
    std::array<uint8_t, kSides * kSides> inner_nodes_{};
};

/// The trees of all grids of a frame (or region), in four arrays. Grids without a bound have records of
/// zeros, which their infinite rounding makes infinite boxes.
class InGridTrees {
  public:
    static constexpr int kRecordSize = 12;         ///< numbers of a key's record
    static constexpr float kQuantumCount = 65535;  ///< steps across the grid's box

    /// Builds the trees, in parallel over grids, and writes each grid's whole bound, at the keys of its
    /// boxes, to `bounds`, of which there are then as many as grids. `summaries`: of the grids, in their
    /// order.
    InGridTrees(std::span<const Grid> grids, std::span<const GridSummary> summaries,
                const PaperTreeOptions& options, std::vector<HyperTrapezoid>& bounds);

    /// Memory held, for BuildStats.
    size_t bytes() const {
        return entries_.capacity() * sizeof(Entry) + references_.capacity() * sizeof(Reference) +
               records_.capacity() * sizeof(uint16_t);
    }
    size_t inner_nodes() const { return inner_nodes_; }

  private:
    friend class InGridTree;

    /// A grid's box at a key, which quanta count from: its low corner and the length of a quantum, in the
    /// grid's axes, lane 3 unused.
    struct alignas(16) Reference {
        float low[4] = {}, step[4] = {};
    };
    /// One grid: the axes that all of its nodes share, and where its records are.
    struct Entry {
        AxesColumns axes;
        float absolute_max = 0, quad_extent = 0;
        uint32_t first_record = 0;     ///< in records_, in units of kRecordSize
        uint32_t first_reference = 0;  ///< in references_
    };

    /// Keys at which a grid has boxes: its own motion keys, or one for bounds of the whole motion.
    int box_keys(const Grid& grid) const { return whole_motion_ ? 1 : grid.key_count; }
    /// Fills in the records and references of one grid, whose places are in `entry`.
    void build_grid(const Grid& grid, const GridSummary& summary, const Entry& entry, HyperTrapezoid& bound);

    ParametricSplits splits_;
    bool whole_motion_;
    std::vector<Entry> entries_;
    std::vector<Reference> references_;
    std::vector<uint16_t> records_;
    size_t inner_nodes_ = 0;
};

/// One grid's tree, prepared for one ray: the ray is transformed into the grid's axes once, and quanta turn
/// into depths by one multiplication and addition each. A RayTree whose leaves are blocks.
class InGridTree {
  public:
    static constexpr int kStackSize = 12;  ///< 16 x 16 is halved seven times when leaves are smallest

    /// `along_axes`: the ray as the boxes of an axis-aligned tree see it; null of an oriented one.
    InGridTree(const InGridTrees& trees, const Grid& grid, uint32_t grid_index, const TraceRay& ray,
               const RayInAxes* along_axes);

    /// The root is always visited: the level above has tested its box.
    Visits enter(const TraceRay&) const {
        return Visits::one({-std::numeric_limits<float>::infinity(), root_}, true);
    }
    bool is_leaf(uint32_t node) const { return splits_.is_leaf(leaf(node)); }
    /// The block of a node, of inner ones too.
    GridBlock leaf(uint32_t node) const {
        const auto nibble = [node](int shift) { return static_cast<uint8_t>(node >> shift & 15); };
        return {nibble(0), nibble(4), static_cast<uint8_t>(nibble(8) + 1),
                static_cast<uint8_t>(nibble(12) + 1)};
    }
    /// The halves of an inner node's block that the ray may hit.
    Visits step(const Visit& at, const TraceRay& ray) const;

  private:
    /// The name of a node: 4 bits each of u, v, nu - 1, nv - 1, then its number among inner nodes (of leaves,
    /// the number that an inner node there would have).
    static uint32_t pack(const GridBlock& b, uint32_t inner) {
        return b.u | uint32_t{b.v} << 4 | uint32_t{b.nu - 1u} << 8 | uint32_t{b.nv - 1u} << 12 | inner << 16;
    }

    const ParametricSplits& splits_;
    const uint16_t* records_;
    int key_count_;
    uint32_t root_;
    float slack_;
    /// The depth of a plane along axis k is quantum * from_scale_ + next key's quantum * to_scale_ + base_;
    /// pad_ is the rounding as a depth.
    alignas(16) float base_[4], from_scale_[4], to_scale_[4], pad_[4];
};

}  // namespace trapeze
