/// Where a Blobby's field is sampled: an octree whose leaves are blocks of 8^3 cells, finer where the screen
/// or the field's features want it. Blocks that share a face differ by two levels at most, so that a cell of
/// either lies against one block along all of an edge.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "tessellate/surfaces/blobby/blobby_field.h"

namespace trapeze {

/// The largest cells that are fine enough anywhere in an object-space box; not larger for a larger box.
using CellSizes = std::function<float(const Box3f& where)>;

/// A place on the grid, in cells of the finest level.
struct GridIndex {
    int i = 0, j = 0, k = 0;

    bool operator==(const GridIndex&) const = default;
    GridIndex operator+(const GridIndex& o) const { return {i + o.i, j + o.j, k + o.k}; }
    GridIndex operator-(const GridIndex& o) const { return {i - o.i, j - o.j, k - o.k}; }
    GridIndex operator*(int s) const { return {i * s, j * s, k * s}; }
};

/// A leaf of the octree: kSide^3 cells, each as long as 2^level of the finest. `at`: its least corner.
struct BlobbyBlock {
    static constexpr int kSide = 8, kSize = kSide * kSide * kSide;

    GridIndex at;
    int level = 0;
    std::vector<int> leaves;  ///< those that bear on it and on the cells round it, ascending
    BlobbyProgram program;    ///< of these alone
};

/// Instructions run over all points, and looked at before: some ten seconds' work.
inline constexpr double kMostBlobbyOperations = 1e9;

/// The octree of one field. find() makes it; then it is read from many threads.
class BlobbyBlocks {
  public:
    /// `cells`: wanted sizes, in object space; cells are `coarser` times as large as they ask for. Both
    /// arguments outlive the blocks.
    BlobbyBlocks(const BlobbyField& field, const CellSizes& cells, float coarser, double most_operations);

    /// False when there would be too many blocks, or too much to compute.
    bool find();

    std::span<const BlobbyBlock> all() const { return blocks_; }
    /// What holds the finest cell whose least corner is given: where nothing bears on the field there is no
    /// block, -1.
    struct Found {
        int level = 0, block = -1;
    };
    /// The block of any cell of the finest level, in constant time a level.
    Found at(const GridIndex& cell) const;
    /// The field in a block or on its border: the same bits for all blocks that meet there, since leaves that
    /// do not reach a point add nothing.
    float value(const BlobbyBlock& block, const V3f& p, std::vector<FieldValue>& scratch) const;

    /// Where a place of the grid is in object space; computed alike for all blocks that share it.
    V3f place(const GridIndex& p) const;
    /// The side of a level's cells, in object space.
    float cell(int level) const { return finest_ * static_cast<float>(1 << level); }

  private:
    /// A node of the octree: eight children in a row, or a block, or neither (-1) where nothing bears on the
    /// field.
    struct Node {
        int first_child = -1, block = -1, level = 0;
    };

    /// The largest cell that is fine enough in a box for features of an extent.
    float wanted(const Box3f& where, float feature) const;
    /// Makes a node a block or divides it; false when there are too many blocks or operations.
    bool refine(int node, const GridIndex& at, const std::vector<int>& candidates,
                const BlobbyProgram& program);
    /// The program for some leaves, to which the grounds are added.
    BlobbyProgram reduced(const BlobbyProgram& program, std::vector<int>& leaves);
    Box3f box_of(const GridIndex& at, int level, float margin) const;

    const BlobbyField& field_;
    const CellSizes& cells_;
    const float coarser_;
    const double most_operations_;
    float finest_ = 1;
    int top_ = 0;  ///< the root's level
    V3f origin_{0, 0, 0};
    std::vector<Box3f> supports_;
    std::vector<float> features_;  ///< the smallest extent of each leaf
    std::vector<Node> nodes_;
    std::vector<BlobbyBlock> blocks_;
    double operations_ = 0;
    float background_ = 0;  ///< the field where nothing bears on it
};

}  // namespace trapeze
