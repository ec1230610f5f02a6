#include "accel/paper/in_grid_trees.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace trapeze {
namespace {

/// Bounds of all nodes of one grid's tree over the poses that are added: one pose for a key's boxes, all of
/// them for whole-motion bounds. Coordinates are those of the vertices given; nothing is grown for rounding
/// here.
class PoseBounds {
  public:
    PoseBounds(const ParametricSplits& splits, int vertices_u) : splits_(splits), row_(vertices_u) {}

    /// Adds a pose. The bounds of the children of inner nodes go to pairs(), by number of the parent; that
    /// of the whole grid is returned.
    Box3f add(const VerticesInAxes& vertices, const GridBlock& all) {
        vertices_ = &vertices;
        return bound(all, 0);
    }
    const std::array<Box3f, 2>& pair(uint32_t inner) const { return pairs_[inner]; }

  private:
    /// The box of a block in the last pose; adds the boxes below inner node number `inner` to their pairs.
    Box3f bound(const GridBlock& block, uint32_t inner) {
        if (splits_.is_leaf(block)) return leaf_bound(block);
        const BlockHalves parts = halves(block);
        const Box3f low = bound(parts.low, inner + 1);
        const Box3f high = bound(parts.high, inner + 1 + splits_.inner_nodes(parts.low));
        pairs_[inner][0].extendBy(low);
        pairs_[inner][1].extendBy(high);
        Box3f both = low;
        both.extendBy(high);
        return both;
    }
    Box3f leaf_bound(const GridBlock& block) const {
        Box3f box;
        for (int j = block.v; j <= block.v + block.nv; ++j)
            for (int i = block.u; i <= block.u + block.nu; ++i) {
                const int at = j * row_ + i;
                box.extendBy(V3f(vertices_->c[0][at], vertices_->c[1][at], vertices_->c[2][at]));
            }
        return box;
    }

    const ParametricSplits& splits_;
    int row_;
    const VerticesInAxes* vertices_ = nullptr;
    /// Low and high child of each inner node; a grid has at most 255 (16 x 16, single micropolygons as
    /// leaves).
    std::array<std::array<Box3f, 2>, 256> pairs_;
};

/// Quanta from `low` at or below (above) a coordinate, and one further, for the rounding of the traversal.
/// What rounds here is within the growth of the reference box, whose first and last quantum the true box does
/// not reach.
uint16_t quantum_below(float value, float low, float step) {
    const double quanta = std::floor((static_cast<double>(value) - low) / step) - 1;
    return static_cast<uint16_t>(std::clamp(quanta, 0.0, double{InGridTrees::kQuantumCount}));
}
uint16_t quantum_above(float value, float low, float step) {
    const double quanta = std::ceil((static_cast<double>(value) - low) / step) + 1;
    return static_cast<uint16_t>(std::clamp(quanta, 0.0, double{InGridTrees::kQuantumCount}));
}

/// The box of what has no bound: a point; its nodes are infinite by their rounding.
Box3f point_box() {
    return {V3f(0), V3f(0)};
}

}  // namespace

ParametricSplits::ParametricSplits(int leaf_below) : leaf_below_(leaf_below) {
    for (int sum = 2; sum <= 2 * kMaxGridSide; ++sum)  // halves have a smaller nu + nv
        for (int nu = std::max(1, sum - kMaxGridSide); nu < std::min(sum, kSides); ++nu) {
            const GridBlock block{0, 0, static_cast<uint8_t>(nu), static_cast<uint8_t>(sum - nu)};
            if (is_leaf(block)) continue;
            const BlockHalves parts = halves(block);
            inner_nodes_[nu * kSides + sum - nu] =
                static_cast<uint8_t>(1 + inner_nodes(parts.low) + inner_nodes(parts.high));
        }
}

InGridTrees::InGridTrees(std::span<const Grid> grids, std::span<const GridSummary> summaries,
                         const PaperTreeOptions& options, std::vector<HyperTrapezoid>& bounds)
    : splits_(options.leaf),
      whole_motion_(options.bounds == PaperTreeOptions::Bounds::WholeMotion),
      entries_(grids.size()) {
    uint32_t records = 0, references = 0;
    for (size_t i = 0; i < grids.size(); ++i) {
        // Sizes follow from shapes, so that all places are known before any grid is bounded.
        const uint32_t inner = splits_.inner_nodes({0, 0, grids[i].shape.nu, grids[i].shape.nv});
        entries_[i] = {AxesColumns(summaries[i].axes), summaries[i].absolute_max, summaries[i].quad_extent,
                       records, references};
        records += inner * box_keys(grids[i]);
        references += box_keys(grids[i]);
        inner_nodes_ += inner;
    }
    records_.resize(size_t{records} * kRecordSize);
    references_.resize(references);
    bounds.resize(grids.size());
    tbb::parallel_for(size_t{0}, grids.size(),
                      [&](size_t i) { build_grid(grids[i], summaries[i], entries_[i], bounds[i]); });
}

void InGridTrees::build_grid(const Grid& grid, const GridSummary& summary, const Entry& entry,
                             HyperTrapezoid& bound) {
    const GridShape& shape = grid.shape;
    const GridBlock all{0, 0, shape.nu, shape.nv};
    const uint32_t inner = splits_.inner_nodes(all);
    const int keys = box_keys(grid), poses = grid.key_count / keys;  // poses in a box: one or all
    const bool boundable = std::isfinite(summary.absolute_max);
    bound.axes = summary.axes;
    bound.keys.clear();
    VerticesInAxes vertices;
    for (int key = 0; key < keys; ++key) {
        PoseBounds bounds(splits_, shape.vertices_u());
        Box3f root;
        for (int pose = key * poses; pose < (key + 1) * poses; ++pose) {
            vertices_in_axes(grid, pose, summary.axes, vertices);
            root.extendBy(bounds.add(vertices, all));
        }
        bound.keys.push_back(boundable ? grown_for_axes(root, summary.absolute_max) : point_box());
        if (!boundable) continue;  // quanta and steps stay 0

        const Box3f& outer = bound.keys.back();
        Reference& reference = references_[entry.first_reference + key];
        for (int k = 0; k < 3; ++k) {
            reference.low[k] = outer.min[k];
            // Four quanta are left over, so that codes rounded outwards, one further than needed, still fit.
            reference.step[k] = (outer.max[k] - outer.min[k]) * (1.0f / (kQuantumCount - 4));
        }
        for (uint32_t node = 0; node < inner; ++node) {
            uint16_t* record =
                records_.data() + (size_t{entry.first_record} + node * keys + key) * kRecordSize;
            for (int k = 0; k < 3; ++k)
                for (int child = 0; child < 2; ++child) {
                    const Box3f& box = bounds.pair(node)[child];
                    record[4 * k + child] = quantum_below(box.min[k], reference.low[k], reference.step[k]);
                    record[4 * k + 2 + child] =
                        quantum_above(box.max[k], reference.low[k], reference.step[k]);
                }
        }
    }
}

InGridTree::InGridTree(const InGridTrees& trees, const Grid& grid, uint32_t grid_index, const TraceRay& ray,
                       const RayInAxes* along_axes)
    : splits_(trees.splits_),
      key_count_(trees.box_keys(grid)),
      root_(pack({0, 0, grid.shape.nu, grid.shape.nv}, 0)) {
    const InGridTrees::Entry& entry = trees.entries_[grid_index];
    const MotionSegment segment = segment_at(ray.axis.time, key_count_);
    // The first record of the key before the ray's time; the next key's lies kRecordSize behind it in each
    // node.
    records_ = trees.records_.data() +
               size_t{entry.first_record + static_cast<uint32_t>(segment.index)} * InGridTrees::kRecordSize;
    const float rounding = ray.rounding(entry.absolute_max);
    slack_ = entry.quad_extent + rounding;
    // A slab's plane is low(t) + quantum(t) * step(t), and its depth (plane - origin) / direction: linear
    // in the quanta of both keys.
    const RayInAxes local = along_axes ? *along_axes : RayInAxes(entry.axes, ray);
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

Visits InGridTree::step(const Visit& at, const TraceRay& ray) const {
    // A visit's name holds its block and its number (see pack()): nothing is looked up.
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
    // Children are numbered in preorder: the low one next, the high one after all inner nodes of the low one.
    const BlockHalves parts = halves(leaf(at.node));
    const uint32_t low_inner = inner + 1, high_inner = low_inner + splits_.inner_nodes(parts.low);
    std::array<Visit, 2> children{Visit{0, pack(parts.low, low_inner)},
                                  Visit{0, pack(parts.high, high_inner)}};
    const bool met_low = DepthInterval{near[0], far[0]}.meets(ray, slack_, children[0].depth);
    const bool met_high = DepthInterval{near[1], far[1]}.meets(ray, slack_, children[1].depth);
    return Visits::two(children, met_low, met_high);
}

}  // namespace trapeze
