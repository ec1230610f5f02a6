#include "tessellate/blobby_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace trapeze {
namespace {

constexpr int kSide = 8, kSize = kSide * kSide * kSide;  ///< of a block of grid points
constexpr size_t kMostBlocks = 40000;
constexpr double kMostOperations = 1e9;   ///< instructions run over all points
constexpr float kLargestIndex = 1 << 20;  ///< of a grid point along an axis

struct Index {
    int i = 0, j = 0, k = 0;

    bool operator==(const Index&) const = default;
    Index operator+(const Index& o) const { return {i + o.i, j + o.j, k + o.k}; }
    Index operator-(const Index& o) const { return {i - o.i, j - o.j, k - o.k}; }
};

struct IndexHash {
    size_t operator()(const Index& b) const {
        uint64_t h = static_cast<uint32_t>(b.i) * 0x9e3779b97f4a7c15ull;
        h ^= static_cast<uint32_t>(b.j) * 0xc2b2ae3d27d4eb4full + (h >> 29);
        h ^= static_cast<uint32_t>(b.k) * 0x165667b19e3779f9ull + (h >> 31);
        return h ^ (h >> 32);
    }
};

constexpr Index kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// Grid points of a cube, with the leaves that reach there.
struct Block {
    Index at;  ///< in blocks
    std::vector<int> leaves;
    BlobbyProgram program;
    std::vector<float> values;
    std::vector<int> cells;  ///< vertices of the cells whose least corners are its points; -1: none
};

int floor_div(int a) {
    return a >= 0 ? a / kSide : (a - kSide + 1) / kSide;
}

class Net {
  public:
    Net(const BlobbyField& field, float cell) : field_(field), cell_(cell) {}

    /// False when there would be too many.
    bool find_blocks();
    void evaluate();
    BlobbyMesh mesh();

  private:
    V3f place(const Index& p) const {
        return V3f(static_cast<float>(p.i), static_cast<float>(p.j), static_cast<float>(p.k)) * cell_;
    }
    static int within(const Index& p, const Index& block) {
        const Index q{p.i - block.i * kSide, p.j - block.j * kSide, p.k - block.k * kSide};
        return (q.k * kSide + q.j) * kSide + q.i;
    }
    static Index block_of(const Index& p) { return {floor_div(p.i), floor_div(p.j), floor_div(p.k)}; }
    static Index point(const Block& block, int n) {
        return Index{block.at.i * kSide, block.at.j * kSide, block.at.k * kSide} +
               Index{n % kSide, n / kSide % kSide, n / (kSide * kSide)};
    }
    const Block* find(const Index& block) const {
        const auto found = numbers_.find(block);
        return found == numbers_.end() ? nullptr : &blocks_[found->second];
    }
    /// Beyond all leaves the field is constant.
    float value(const Index& p) const {
        const Index b = block_of(p);
        const Block* block = find(b);
        return block ? block->values[within(p, b)] : background_;
    }
    int vertex(const Index& cell) const {
        const Index b = block_of(cell);
        const Block* block = find(b);
        return block && !block->cells.empty() ? block->cells[within(cell, b)] : -1;
    }
    static bool is_inside(float value) { return value > kBlobbyThreshold; }
    bool cell_vertex(const Index& cell, V3f* p) const;
    void number_vertices(BlobbyMesh& mesh);
    void add_quads(BlobbyMesh& mesh) const;

    const BlobbyField& field_;
    const float cell_;
    float background_ = 0;
    std::vector<Block> blocks_;
    std::unordered_map<Index, size_t, IndexHash> numbers_;
};

bool Net::find_blocks() {
    for (size_t leaf = 0; leaf < field_.leaves.size(); ++leaf) {
        const Box3f box = field_.leaves[leaf].support();
        if (box.isEmpty()) continue;
        Index lo, hi;
        const auto index = [&](float x, float margin) {
            return static_cast<int>(
                std::floor(std::clamp(x / cell_, -kLargestIndex, kLargestIndex) + margin));
        };
        lo = block_of({index(box.min.x, -2), index(box.min.y, -2), index(box.min.z, -2)});
        hi = block_of({index(box.max.x, 3), index(box.max.y, 3), index(box.max.z, 3)});
        const double count = (hi.i - lo.i + 1.0) * (hi.j - lo.j + 1.0) * (hi.k - lo.k + 1.0);
        if (!(count <= static_cast<double>(kMostBlocks))) return false;
        for (int k = lo.k; k <= hi.k; ++k)
            for (int j = lo.j; j <= hi.j; ++j)
                for (int i = lo.i; i <= hi.i; ++i) {
                    const Index at{i, j, k};
                    const auto [entry, is_new] = numbers_.try_emplace(at, blocks_.size());
                    if (is_new) blocks_.push_back({at, {}, {}, {}, {}});
                    blocks_[entry->second].leaves.push_back(static_cast<int>(leaf));
                }
        if (blocks_.size() > kMostBlocks) return false;
    }
    double operations =
        static_cast<double>(blocks_.size()) * static_cast<double>(field_.program.instructions.size());
    if (operations > kMostOperations) return false;  // to reduce the programs
    tbb::parallel_for(size_t{0}, blocks_.size(),
                      [&](size_t b) { blocks_[b].program = field_.program.reduced(blocks_[b].leaves); });
    for (const Block& block : blocks_)
        operations += static_cast<double>(block.program.instructions.size()) * kSize;
    return operations <= kMostOperations;
}

void Net::evaluate() {
    std::vector<FieldValue> results;
    background_ = field_.program.reduced({}).at({0, 0, 0}, field_.leaves, results).value;
    tbb::parallel_for(size_t{0}, blocks_.size(), [&](size_t b) {
        Block& block = blocks_[b];
        std::vector<FieldValue> scratch;
        block.values.resize(kSize);
        for (int n = 0; n < kSize; ++n)
            block.values[n] = block.program.at(place(point(block, n)), field_.leaves, scratch).value;
    });
}

/// The mean of the places where the cell's edges meet the surface; false when none does.
bool Net::cell_vertex(const Index& cell, V3f* p) const {
    float values[8];
    int inside = 0;
    for (int c = 0; c < 8; ++c) {
        values[c] = value(cell + Index{c & 1, c >> 1 & 1, c >> 2});
        inside += is_inside(values[c]);
    }
    if (inside == 0 || inside == 8) return false;
    V3f sum(0, 0, 0);
    int count = 0;
    for (int c = 0; c < 8; ++c)
        for (int axis = 0; axis < 3; ++axis) {
            const int other = c | 1 << axis;
            if (other == c || is_inside(values[c]) == is_inside(values[other])) continue;
            const float share = (kBlobbyThreshold - values[c]) / (values[other] - values[c]);
            V3f at(static_cast<float>(c & 1), static_cast<float>(c >> 1 & 1), static_cast<float>(c >> 2));
            at[axis] += std::isfinite(share) ? share : 0.5f;
            sum += at, ++count;
        }
    *p = place(cell) + sum * (cell_ / static_cast<float>(count));
    return true;
}

void Net::number_vertices(BlobbyMesh& mesh) {
    std::vector<std::vector<V3f>> points(blocks_.size()), normals(blocks_.size());
    tbb::parallel_for(size_t{0}, blocks_.size(), [&](size_t b) {
        Block& block = blocks_[b];
        std::vector<FieldValue> scratch;
        for (int n = 0; n < kSize; ++n) {
            V3f p;
            if (!cell_vertex(point(block, n), &p)) continue;
            if (block.cells.empty()) block.cells.assign(kSize, -1);
            block.cells[n] = static_cast<int>(points[b].size());
            p = onto_surface(field_, block.program, p, cell_, scratch);
            const V3f g = block.program.at(p, field_.leaves, scratch).gradient;
            const float length = g.length();
            points[b].push_back(p);
            normals[b].push_back(length > 0 && std::isfinite(length) ? -g / length : V3f(0, 0, 0));
        }
    });
    for (size_t b = 0; b < blocks_.size(); ++b) {
        for (int& n : blocks_[b].cells)
            if (n >= 0) n += static_cast<int>(mesh.points.size());
        mesh.points.insert(mesh.points.end(), points[b].begin(), points[b].end());
        mesh.normals.insert(mesh.normals.end(), normals[b].begin(), normals[b].end());
        mesh.leaf_list_of_point.resize(mesh.points.size(), static_cast<int>(b));
        mesh.leaf_lists.push_back(std::move(blocks_[b].leaves));
    }
}

/// For each edge of the grid that meets the surface, the cells round it, seen from outside.
void Net::add_quads(BlobbyMesh& mesh) const {
    for (const Block& block : blocks_)
        for (int n = 0; n < kSize; ++n) {
            const Index p = point(block, n);
            const bool inside = is_inside(block.values[n]);
            for (int axis = 0; axis < 3; ++axis) {
                if (inside == is_inside(value(p + kAxes[axis]))) continue;
                const Index b = kAxes[(axis + 1) % 3], c = kAxes[(axis + 2) % 3];
                std::array<int, 4> quad{vertex(p - b - c), vertex(p - c), vertex(p), vertex(p - b)};
                if (!inside) std::swap(quad[1], quad[3]);
                mesh.vertices.insert(mesh.vertices.end(), quad.begin(), quad.end());
            }
        }
}

BlobbyMesh Net::mesh() {
    BlobbyMesh mesh;
    mesh.cell = cell_;
    number_vertices(mesh);
    add_quads(mesh);
    return mesh;
}

}  // namespace

V3f onto_surface(const BlobbyField& field, const BlobbyProgram& program, V3f p, float reach,
                 std::vector<FieldValue>& scratch) {
    constexpr int kSteps = 4;
    const V3f from = p;
    for (int step = 0; step < kSteps; ++step) {
        const FieldValue f = program.at(p, field.leaves, scratch);
        const float steepness = f.gradient.dot(f.gradient);
        const V3f move = f.gradient * ((kBlobbyThreshold - f.value) / steepness);
        if (!(steepness > 0) || !((p + move - from).length() <= reach)) break;
        p += move;
    }
    return p;
}

BlobbyMesh blobby_mesh(const BlobbyField& field, float cell) {
    // A coarser grid costs less; one that is larger than all leaves costs almost nothing.
    for (int tries = 0; tries < 64; ++tries, cell *= 1.25f + 0.25f * static_cast<float>(tries)) {
        Net net(field, cell);
        if (!net.find_blocks()) continue;
        net.evaluate();
        return net.mesh();
    }
    return {};
}

}  // namespace trapeze
