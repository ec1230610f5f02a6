#include "tessellate/surfaces/blobby/blobby_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace trapeze {
namespace {

constexpr int kSize = BlobbyBlock::kSize;
constexpr GridIndex kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// Exactly on the threshold counts as outside, for all blocks alike.
bool is_inside(float value) {
    return value > kBlobbyThreshold;
}

/// A cell of the octree, as a key of maps: the number of its block, and its own in the block, x fastest.
struct CellName {
    int block = -1, cell = 0;

    bool operator==(const CellName&) const = default;
};

/// Where the surface meets an edge of the grid, and the cells round the edge, seen from outside.
struct Crossing {
    std::array<CellName, 4> cells;
    V3f point;
};

/// The values at all corners of a block's cells.
class BlockCorners {
  public:
    BlockCorners(const BlobbyBlocks& blocks, const BlobbyBlock& block, std::vector<FieldValue>& scratch) {
        size_t n = 0;
        for (int k = 0; k <= BlobbyBlock::kSide; ++k)
            for (int j = 0; j <= BlobbyBlock::kSide; ++j)
                for (int i = 0; i <= BlobbyBlock::kSide; ++i) {
                    const GridIndex p = block.at + GridIndex{i, j, k} * (1 << block.level);
                    values_[n++] = blocks.value(block, blocks.place(p), scratch);
                }
    }
    float at(const GridIndex& p) const {
        return values_[(p.k * (BlobbyBlock::kSide + 1) + p.j) * (BlobbyBlock::kSide + 1) + p.i];
    }

  private:
    std::array<float, (BlobbyBlock::kSide + 1) * (BlobbyBlock::kSide + 1) * (BlobbyBlock::kSide + 1)> values_;
};

/// Makes the mesh of blocks: crossings block by block in parallel, then polygons in one order, then vertices
/// moved onto the surface in parallel.
class Net {
  public:
    Net(const BlobbyField& field, const BlobbyBlocks& blocks) : field_(field), blocks_(blocks) {}

    BlobbyMesh mesh();

  private:
    /// The crossings of which a block makes polygons, in the order of its edges.
    std::vector<Crossing> crossings(int block) const;
    bool cells_round(int block, const GridIndex& edge, int axis, std::array<CellName, 4>& cells) const;
    /// Where the surface meets an edge of the grid between an inner and an outer corner.
    V3f meeting_point(const BlobbyBlock& block, const GridIndex& from, const GridIndex& to, float at_from,
                      float at_to, std::vector<FieldValue>& scratch) const;
    void add_polygons(const std::vector<std::vector<Crossing>>& crossings, BlobbyMesh& mesh) const;
    /// Moves vertices onto the surface, by a cell at most, and gives them normals by the field's gradient.
    void move_onto_surface(BlobbyMesh& mesh) const;

    const BlobbyField& field_;
    const BlobbyBlocks& blocks_;
};

/// The cells round an edge, which starts at `edge` and is as long as the block's cells. False when the edge
/// is not to be made a polygon of here: it is if none of the cells is finer, and this block is the first
/// among those of its level.
bool Net::cells_round(int block, const GridIndex& edge, int axis, std::array<CellName, 4>& cells) const {
    const int level = blocks_.all()[block].level;
    const GridIndex b = kAxes[(axis + 1) % 3], c = kAxes[(axis + 2) % 3];
    // The finest cells at the edge's begin, anticlockwise about the axis: each lies in one of the four
    // blocks.
    const GridIndex finest[4] = {edge - b - c, edge - c, edge, edge - b};
    int first = -1;
    for (int n = 0; n < 4; ++n) {
        const BlobbyBlocks::Found found = blocks_.at(finest[n]);
        if (found.level < level || found.block < 0) return false;
        if (found.level == level && first < 0) first = found.block;
        const GridIndex q = finest[n] - blocks_.all()[found.block].at;
        cells[n] = {found.block,
                    ((q.k >> found.level) * BlobbyBlock::kSide + (q.j >> found.level)) * BlobbyBlock::kSide +
                        (q.i >> found.level)};
    }
    return first == block;
}

/// Linear between the two corners: the vertex is moved onto the surface later, and only has to begin near it.
V3f Net::meeting_point(const BlobbyBlock& block, const GridIndex& from, const GridIndex& to, float at_from,
                       float at_to, std::vector<FieldValue>& scratch) const {
    const V3f begin = blocks_.place(from), end = blocks_.place(to);
    float share = (kBlobbyThreshold - at_from) / (at_to - at_from);
    if (!field_.grounds.empty()) {
        // Close to the ground the field is anything but linear.
        constexpr int kHalvings = 12;
        float lo = 0, hi = 1;
        for (int k = 0; k < kHalvings; ++k) {
            share = (lo + hi) / 2;
            const float value = blocks_.value(block, begin + (end - begin) * share, scratch);
            (is_inside(value) == is_inside(at_from) ? lo : hi) = share;
        }
    }
    return begin + (end - begin) * (std::isfinite(share) ? share : 0.5f);
}

/// Edges along x, then y, then z, each once: those on a block's border are looked at by all blocks that share
/// them, and taken by one (cells_round()).
std::vector<Crossing> Net::crossings(int number) const {
    const BlobbyBlock& block = blocks_.all()[number];
    std::vector<FieldValue> scratch;
    std::vector<Crossing> found;
    const BlockCorners corners(blocks_, block, scratch);
    for (int axis = 0; axis < 3; ++axis) {
        const GridIndex along = kAxes[axis];
        for (int k = 0; k + along.k <= BlobbyBlock::kSide; ++k)
            for (int j = 0; j + along.j <= BlobbyBlock::kSide; ++j)
                for (int i = 0; i + along.i <= BlobbyBlock::kSide; ++i) {
                    const GridIndex p{i, j, k};
                    const float at_from = corners.at(p), at_to = corners.at(p + along);
                    if (is_inside(at_from) == is_inside(at_to)) continue;
                    const int size = 1 << block.level;
                    const GridIndex from = block.at + p * size;
                    Crossing crossing;
                    if (!cells_round(number, from, axis, crossing.cells)) continue;
                    if (!is_inside(at_from)) std::swap(crossing.cells[1], crossing.cells[3]);
                    crossing.point = meeting_point(block, from, from + along * size, at_from, at_to, scratch);
                    found.push_back(crossing);
                }
    }
    return found;
}

/// Makes polygons of crossings. A cell's vertex is the mean of the places where the surface meets the cell's
/// edges.
void Net::add_polygons(const std::vector<std::vector<Crossing>>& crossings, BlobbyMesh& mesh) const {
    std::vector<std::vector<int>> vertices(blocks_.all().size());
    std::vector<int> counts;
    const auto vertex_of = [&](const CellName& name, const V3f& p) {
        std::vector<int>& of_block = vertices[name.block];
        if (of_block.empty()) of_block.assign(kSize, -1);
        int& vertex = of_block[name.cell];
        if (vertex < 0) {
            vertex = static_cast<int>(mesh.points.size());
            mesh.points.push_back({0, 0, 0});
            mesh.leaf_list_of_point.push_back(name.block);
            counts.push_back(0);
        }
        mesh.points[vertex] += p, ++counts[vertex];
        return vertex;
    };
    for (const std::vector<Crossing>& of_block : crossings)
        for (const Crossing& crossing : of_block) {
            int size = 0;
            for (int n = 0; n < 4; ++n) {
                if (crossing.cells[n] == crossing.cells[(n + 3) % 4]) continue;  // a large cell on two sides
                mesh.vertices.push_back(vertex_of(crossing.cells[n], crossing.point));
                ++size;
            }
            mesh.sizes.push_back(size);
        }
    for (size_t v = 0; v < counts.size(); ++v) mesh.points[v] /= static_cast<float>(counts[v]);
}

/// Each vertex by its own block's program, which has the leaves that reach it.
void Net::move_onto_surface(BlobbyMesh& mesh) const {
    mesh.normals.resize(mesh.points.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, mesh.points.size(), 256), [&](const auto& range) {
        std::vector<FieldValue> scratch;
        for (size_t v = range.begin(); v < range.end(); ++v) {
            const BlobbyBlock& block = blocks_.all()[mesh.leaf_list_of_point[v]];
            V3f& p = mesh.points[v];
            p = onto_surface(field_, block.program, p, blocks_.cell(block.level), scratch);
            const V3f g = block.program.at(p, field_.leaves, scratch).gradient;
            const float length = g.length();
            mesh.normals[v] = length > 0 && std::isfinite(length) ? -g / length : V3f(0, 0, 0);
        }
    });
}

BlobbyMesh Net::mesh() {
    BlobbyMesh mesh;
    std::vector<std::vector<Crossing>> found(blocks_.all().size());
    tbb::parallel_for(size_t{0}, found.size(), [&](size_t b) { found[b] = crossings(static_cast<int>(b)); });
    add_polygons(found, mesh);
    move_onto_surface(mesh);
    for (const BlobbyBlock& block : blocks_.all()) {
        mesh.leaf_lists.push_back(block.leaves);
        mesh.list_cells.push_back(blocks_.cell(block.level));
    }
    return mesh;
}

}  // namespace

/// Never past `reach`: a step through a thin wall would tangle the mesh.
V3f onto_surface(const BlobbyField& field, const BlobbyProgram& program, V3f p, float reach,
                 std::vector<FieldValue>& scratch) {
    // Newton's steps along the gradient; one that does not come nearer is halved.
    constexpr int kSteps = 8, kHalvings = 6;
    const V3f from = p;
    FieldValue f = program.at(p, field.leaves, scratch);
    for (int step = 0; step < kSteps; ++step) {
        const float away = kBlobbyThreshold - f.value, steepness = f.gradient.dot(f.gradient);
        if (!(steepness > 0) || std::abs(away) < 1e-6f) break;
        V3f move = f.gradient * (away / steepness);
        bool is_nearer = false;
        for (int half = 0; half < kHalvings && !is_nearer; ++half, move *= 0.5f) {
            if (!((p + move - from).length() <= reach)) continue;
            const FieldValue there = program.at(p + move, field.leaves, scratch);
            if (!(std::abs(kBlobbyThreshold - there.value) < std::abs(away))) continue;
            p += move, f = there, is_nearer = true;
        }
        if (!is_nearer) break;
    }
    return p;
}

/// The grid is made coarser, in steps that grow, until it costs no more than it may; where that is by much,
/// the user is told (blobby_surface.cpp).
BlobbyMesh blobby_mesh(const BlobbyField& field, const CellSizes& cells, double most_operations) {
    // A coarser grid costs less; one that is larger than all leaves costs almost nothing.
    float coarser = 1;
    for (int tries = 0; tries < 64; ++tries, coarser *= 1.25f + 0.25f * static_cast<float>(tries)) {
        BlobbyBlocks blocks(field, cells, coarser, most_operations);
        if (!blocks.find()) continue;
        BlobbyMesh mesh = Net(field, blocks).mesh();
        mesh.coarser = coarser;
        return mesh;
    }
    return {};
}

}  // namespace trapeze
