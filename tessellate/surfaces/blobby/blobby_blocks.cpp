#include "tessellate/surfaces/blobby/blobby_blocks.h"

#include <algorithm>
#include <cmath>

#include "core/scene/scene.h"

namespace trapeze {
namespace {

constexpr int kSide = BlobbyBlock::kSide, kCornersOfBlock = (kSide + 1) * (kSide + 1) * (kSide + 1);
/// Bounds on absurd input: a field that wants more is made coarser (see blobby_mesh()).
constexpr size_t kMostBlocks = 200'000;
constexpr float kLeastCell = 1e-5f;  ///< of the diagonal of all leaves
constexpr int kMostLevels = 20;
/// A block's cells may be larger than wanted by this much, so that sizes are met on an average.
constexpr float kCellTolerance = 1.4f;
/// Cells beyond a leaf's end that count as near it: those round an edge that it reaches into, and some for
/// rounding.
constexpr float kMarginCells = 1.5f;

/// Whether closed boxes meet; an empty one meets nothing.
bool overlap(const Box3f& a, const Box3f& b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
}

/// How large the smallest feature is that a leaf makes: its bump's diameter along its own axes, or what its
/// box leaves of that.
float smallest_extent(const BlobbyLeaf& leaf, const Box3f& support) {
    const V3f size = support.size();
    float least = std::min({size.x, size.y, size.z});
    for (int axis = 0; axis < 3; ++axis) {
        const float* row = leaf.object_from_leaf[axis];
        least = std::min(least, 2 * leaf.radius * V3f(row[0], row[1], row[2]).length());
    }
    return least;
}

}  // namespace

/// The finest cell is settled first, since all places of the grid are counted in it; then the root grows by
/// doubling until it holds all bumps.
BlobbyBlocks::BlobbyBlocks(const BlobbyField& field, const CellSizes& cells, float coarser,
                           double most_operations)
    : field_(field), cells_(cells), coarser_(coarser), most_operations_(most_operations) {
    Box3f all;
    float finest = kInfinity;
    for (const BlobbyLeaf& leaf : field.leaves) {
        supports_.push_back(leaf.support());
        const Box3f& support = supports_.back();
        features_.push_back(support.isEmpty() ? kInfinity : smallest_extent(leaf, support));
        if (support.isEmpty()) continue;
        all.extendBy(support);
        finest = std::min(finest, wanted(support, features_.back()));
    }
    if (all.isEmpty()) return;
    const float diagonal = all.size().length();
    finest_ = std::max(finest, kLeastCell * diagonal * coarser);
    const float across = std::max({all.size().x, all.size().y, all.size().z});
    float margin = 0;
    // The least root that holds all supports and a margin, so that nothing acts beyond it.
    for (; top_ < kMostLevels; ++top_) {
        margin = (kMarginCells + 1) * cell(top_);
        if (across + 2 * margin <= kSide * cell(top_)) break;
    }
    origin_ = all.min - V3f(margin);
}

/// Large features are as fine as the screen asks for. Features small on the screen keep their shape roughly,
/// an eighth of their extent, but need no more than a micropolygon; none is so small that it falls between
/// the grid's points. `cells` are three micropolygons.
float BlobbyBlocks::wanted(const Box3f& where, float feature) const {
    const float most = cells_(where);
    return coarser_ * std::min(most, std::max(feature / 8, std::min(most / 3, feature / 6)));
}

/// In doubles from the origin, and never by adding cells up: a corner that several blocks share has one
/// place.
V3f BlobbyBlocks::place(const GridIndex& p) const {
    const double cell = finest_;
    return {static_cast<float>(origin_.x + p.i * cell), static_cast<float>(origin_.y + p.j * cell),
            static_cast<float>(origin_.z + p.k * cell)};
}

Box3f BlobbyBlocks::box_of(const GridIndex& at, int level, float margin) const {
    const int side = kSide << level;
    return {place(at) - V3f(margin), place(at + GridIndex{side, side, side}) + V3f(margin)};
}

/// The background is what the program gives where no bump reaches: without it there would be no telling
/// inside from outside there.
bool BlobbyBlocks::find() {
    std::vector<int> leaves;
    for (size_t leaf = 0; leaf < supports_.size(); ++leaf)
        if (!supports_[leaf].isEmpty()) leaves.push_back(static_cast<int>(leaf));
    if (leaves.empty()) return true;
    if (!std::isfinite(finest_) || !(finest_ > 0)) return false;
    std::vector<FieldValue> results;
    background_ = field_.program.reduced({}).at({0, 0, 0}, field_.leaves, results).value;
    nodes_.push_back({-1, -1, top_});
    return refine(0, {0, 0, 0}, leaves, field_.program);
}

/// Grounds are everywhere.
BlobbyProgram BlobbyBlocks::reduced(const BlobbyProgram& program, std::vector<int>& leaves) {
    leaves.insert(leaves.end(), field_.grounds.begin(), field_.grounds.end());
    std::ranges::sort(leaves);
    operations_ += static_cast<double>(program.instructions.size() + program.operands.size());
    return program.reduced(leaves);
}

/// A block is fine enough for all within half its side, which is what keeps neighbours alike: one that is
/// three levels finer would have come of a parent within that distance. `program` is that of the candidates.
bool BlobbyBlocks::refine(int node, const GridIndex& at, const std::vector<int>& candidates,
                          const BlobbyProgram& program) {
    const int level = nodes_[node].level;
    const Box3f around = box_of(at, level, kSide / 2 * cell(level));
    const Box3f close = box_of(at, level, kMarginCells * cell(level));
    std::vector<int> within, near;
    float feature = kInfinity;
    // `within` are for the children, `near` for a block made here.
    for (const int leaf : candidates) {
        if (!overlap(supports_[leaf], around)) continue;
        within.push_back(leaf);
        feature = std::min(feature, features_[leaf]);
        if (overlap(supports_[leaf], close)) near.push_back(leaf);
    }
    if (near.empty()) return true;
    if (level == 0 || cell(level) <= kCellTolerance * wanted(around, feature)) {
        BlobbyProgram of_block = reduced(program, near);
        operations_ += static_cast<double>(of_block.instructions.size()) * kCornersOfBlock;
        nodes_[node].block = static_cast<int>(blocks_.size());
        blocks_.push_back({at, level, std::move(near), std::move(of_block)});
        return blocks_.size() <= kMostBlocks && operations_ <= most_operations_;
    }
    const int first = static_cast<int>(nodes_.size());
    nodes_[node].first_child = first;
    nodes_.resize(nodes_.size() + 8, Node{-1, -1, level - 1});
    if (nodes_.size() > 16 * kMostBlocks || operations_ > most_operations_) return false;
    std::vector<int> kept = within;
    const BlobbyProgram of_all = reduced(program, kept);
    const int half = kSide << (level - 1);
    for (int c = 0; c < 8; ++c)
        if (!refine(first + c, at + GridIndex{c & 1, c >> 1 & 1, c >> 2} * half, within, of_all))
            return false;
    return true;
}

/// Descends from the root by the bits of the cell's indices.
BlobbyBlocks::Found BlobbyBlocks::at(const GridIndex& cell) const {
    const int size = kSide << top_;
    const auto beyond = [&](int x) { return x < 0 || x >= size; };
    if (nodes_.empty() || beyond(cell.i) || beyond(cell.j) || beyond(cell.k)) return {top_, -1};
    const Node* node = &nodes_[0];
    while (node->first_child >= 0) {
        const int bit = 2 + node->level;  // of half the node's side
        const int child = (cell.i >> bit & 1) | (cell.j >> bit & 1) << 1 | (cell.k >> bit & 1) << 2;
        node = &nodes_[static_cast<size_t>(node->first_child + child)];
    }
    return {node->level, node->block};
}

/// Where there are grounds: only points that a bump reaches have the field's value, for repelling planes act
/// there alone (BlobbyField::grounds).
float BlobbyBlocks::value(const BlobbyBlock& block, const V3f& p, std::vector<FieldValue>& scratch) const {
    const auto reaches = [&](int leaf) {
        return field_.leaves[leaf].ends && field_.leaves[leaf].at(p).value > 0;
    };
    if (!field_.grounds.empty() && std::ranges::none_of(block.leaves, reaches)) return background_;
    return block.program.at(p, field_.leaves, scratch).value;
}

}  // namespace trapeze
