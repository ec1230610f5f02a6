#include "tessellate/surfaces/nurbs/trim_cells.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/random.h"
#include "tessellate/surfaces/nurbs/cell_outlines.h"
#include "tessellate/topology/triangulate.h"

namespace trapeze {
namespace {

/// First all loops are added, which finds where they cross the grid's lines and what they do in each cell;
/// then cells are cut one by one. Crossings are vertices of both cells at a line, so that pieces share them.
/// Points are moved a little first, so that no corner of a cell, no line and no meeting of loops needs a
/// special case.
class Cutter {
  public:
    Cutter(int nx, int ny, bool keep_outside)
        : nx_(nx), ny_(ny), keep_outside_(keep_outside), row_crossings_(ny + 1) {}

    void add_loop(std::vector<V2d> loop);
    TrimmedCells cut();

  private:
    using Edge = std::array<int, 3>;  ///< axis of its direction, i, j of its least corner

    int add_point(const V2d& p) {
        out_.points.push_back(p);
        return static_cast<int>(out_.points.size()) - 1;
    }
    bool is_cell(int i, int j) const { return i >= 0 && j >= 0 && i < nx_ && j < ny_; }
    void cross(const V2d& p, const V2d& q, std::vector<std::pair<double, int>>& crossings);
    /// The vertex at a corner of cells, made when it is first asked for.
    int corner(int i, int j);
    /// Whether a corner of cells is on the side that is kept: by counting the crossings to its left on its
    /// line.
    bool corner_kept(int i, int j) const;
    /// Adds the faces of one cell.
    void cut_cell(int i, int j, const CellLoops& loops);
    /// A cell's corners and crossings, anticlockwise from its least corner.
    std::vector<CellBorderNode> border(int i, int j);
    void add_side(std::vector<CellBorderNode>& nodes, const Edge& edge, bool forwards, int from);
    /// Adds a piece of a cell, whole if it is convex and has few corners, else in triangles.
    void emit(int i, int j, const std::vector<int>& outline, const std::vector<std::vector<int>>& holes);
    bool is_convex(const std::vector<int>& polygon) const;
    /// Adds a face, unless it has no area.
    void emit_face(int i, int j, std::vector<int> polygon);

    const int nx_, ny_;
    const bool keep_outside_;
    TrimmedCells out_;
    std::vector<std::vector<double>>
        row_crossings_;  ///< by horizontal grid line: places along x, all of them
    /// Vertices where loops cross an edge of a cell; sorted along it when all loops have been added.
    std::map<Edge, std::vector<int>> edge_crossings_;
    std::map<std::pair<int, int>, CellLoops> cells_;
    std::map<std::pair<int, int>, int> corners_;
    uint32_t points_added_ = 0;  ///< of all loops
};

/// A coordinate moved off the grid's lines, on none of which a point may lie: then every crossing is one of
/// two different sides. Those near a line are moved a little, outwards at the rim.
double off_lines(double x, int n) {
    constexpr double kNear = 1e-6, kMove = 1e-5, kRim = 1e-3;
    if (std::abs(x) < kMove) return -kRim;
    if (std::abs(x - n) < kMove) return n + kRim;
    return std::abs(x - std::round(x)) < kNear ? std::round(x) + kMove : x;
}

/// Moves a point by less than points are off the lines, each by its number: then loops that go through
/// corners of cells, through points of each other or along each other only cross.
V2d jittered(const V2d& p, uint32_t number) {
    constexpr double kMost = 4e-7;
    const auto off = [&](uint32_t axis) {
        return kMost * (2 * static_cast<double>(unit_float(hash(number, axis))) - 1);
    };
    return p + V2d(off(0), off(1));
}

/// Crossings of a segment with the grid's lines, as vertices in the order of the segment. Crossings beyond
/// the rectangle are no vertices; they only count for corner_kept().
void Cutter::cross(const V2d& p, const V2d& q, std::vector<std::pair<double, int>>& crossings) {
    crossings.clear();
    for (int axis = 0; axis < 2; ++axis) {
        const double a = p[axis], b = q[axis];
        const int n = axis == 0 ? nx_ : ny_;
        const int first = std::max(0, static_cast<int>(std::ceil(std::clamp(std::min(a, b), -1.0, n + 1.0))));
        const int last = std::min(n, static_cast<int>(std::floor(std::clamp(std::max(a, b), -1.0, n + 1.0))));
        for (int line = first; line <= last; ++line) {
            const double t = (line - a) / (b - a);
            V2d at = p + (q - p) * t;
            at[axis] = line;
            const double along = at[1 - axis];
            if (axis == 1) row_crossings_[line].push_back(along);
            const int other = axis == 0 ? ny_ : nx_;
            if (!(along >= 0 && along <= other)) continue;
            const int cell = std::min(static_cast<int>(along), other - 1);
            // One vertex for both cells at the line.
            const int vertex = add_point(at);
            edge_crossings_[axis == 0 ? Edge{1, line, cell} : Edge{0, cell, line}].push_back(vertex);
            crossings.push_back({t, vertex});
        }
    }
    std::sort(crossings.begin(), crossings.end());
}

/// Follows the loop once and cuts it into paths at its crossings; a path belongs to the cell in which its
/// first piece lies. The first path is completed when the loop comes round.
void Cutter::add_loop(std::vector<V2d> loop) {
    for (V2d& p : loop) p = jittered({off_lines(p.x, nx_), off_lines(p.y, ny_)}, points_added_++);
    std::vector<int> path, head;  // the head belongs to the path that ends the loop
    bool crossed = false;
    std::vector<std::pair<double, int>> crossings;
    const auto end_path = [&](int vertex) {
        path.push_back(vertex);
        if (!crossed) {
            head = path;
        } else if (path.size() >= 2) {
            const V2d middle = (out_.points[path[0]] + out_.points[path[1]]) * 0.5;
            const int i = static_cast<int>(std::floor(middle.x)), j = static_cast<int>(std::floor(middle.y));
            if (is_cell(i, j)) cells_[{i, j}].paths.push_back(path);
        }
        crossed = true;
        path = {vertex};
    };
    for (size_t n = 0; n < loop.size(); ++n) {
        path.push_back(add_point(loop[n]));
        cross(loop[n], loop[(n + 1) % loop.size()], crossings);
        for (const auto& [t, vertex] : crossings) end_path(vertex);
    }
    if (!crossed) {
        const int i = static_cast<int>(std::floor(loop[0].x)), j = static_cast<int>(std::floor(loop[0].y));
        if (is_cell(i, j) && path.size() >= 3) cells_[{i, j}].closed.push_back(path);
        return;
    }
    // The loop began within a path: its end and its beginning are one.
    path.insert(path.end(), head.begin(), head.end() - 1);
    end_path(head.back());
}

/// Each corner of the cells becomes one point at most, shared by the pieces around it, so that their borders
/// meet.
int Cutter::corner(int i, int j) {
    const auto [entry, is_new] = corners_.try_emplace({i, j}, 0);
    if (is_new) entry->second = add_point(V2d(i, j));
    return entry->second;
}

/// By parity: a corner is inside when an odd number of crossings lies to its left in its row.
bool Cutter::corner_kept(int i, int j) const {
    const std::vector<double>& row = row_crossings_[j];
    const auto before = std::lower_bound(row.begin(), row.end(), static_cast<double>(i)) - row.begin();
    return (before % 2 == 1) != keep_outside_;
}

/// The nodes of one side of a cell from its corner `from` on, without the corner at its end. What is kept
/// along an edge is counted from its least corner, for both cells alike.
void Cutter::add_side(std::vector<CellBorderNode>& nodes, const Edge& edge, bool forwards, int from) {
    // At each crossing the side changes from kept to cut away, or back.
    const bool kept = corner_kept(edge[1], edge[2]);
    const auto found = edge_crossings_.find(edge);
    const int count = found == edge_crossings_.end() ? 0 : static_cast<int>(found->second.size());
    const auto kept_in = [&](int interval) { return kept != (interval % 2 == 1); };
    nodes.push_back({from, kept_in(forwards ? 0 : count)});
    for (int k = 0; k < count; ++k)
        nodes.push_back(
            {found->second[forwards ? k : count - 1 - k], kept_in(forwards ? k + 1 : count - 1 - k)});
}

std::vector<CellBorderNode> Cutter::border(int i, int j) {
    std::vector<CellBorderNode> nodes;
    add_side(nodes, {0, i, j}, true, corner(i, j));
    add_side(nodes, {1, i + 1, j}, true, corner(i + 1, j));
    add_side(nodes, {0, i, j + 1}, false, corner(i + 1, j + 1));
    add_side(nodes, {1, i, j}, false, corner(i, j + 1));
    return nodes;
}

/// Straight corners count as convex; a polygon that winds twice would pass, but outlines do not.
bool Cutter::is_convex(const std::vector<int>& polygon) const {
    for (size_t k = 0; k < polygon.size(); ++k) {
        const V2d &a = out_.points[polygon[k]], &b = out_.points[polygon[(k + 1) % polygon.size()]],
                  &c = out_.points[polygon[(k + 2) % polygon.size()]];
        if ((b - a).cross(c - b) < 0) return false;
    }
    return true;
}

/// Faces without area, of loops that run along a line, are left out here.
void Cutter::emit_face(int i, int j, std::vector<int> polygon) {
    if (!(signed_area(out_.points, polygon) > 0)) return;
    out_.vertices_per_face.push_back(static_cast<int>(polygon.size()));
    out_.vertices.insert(out_.vertices.end(), polygon.begin(), polygon.end());
    out_.cells.push_back({i, j});
}

/// Faces of many corners would be cut at their centre into as many pieces as corners; triangles are fewer.
void Cutter::emit(int i, int j, const std::vector<int>& outline, const std::vector<std::vector<int>>& holes) {
    constexpr size_t kMostCellCorners = 8;
    if (holes.empty() && outline.size() <= kMostCellCorners && is_convex(outline))
        return emit_face(i, j, outline);
    std::vector<int> vertices = outline, sizes{static_cast<int>(outline.size())};
    for (const std::vector<int>& hole : holes) {
        vertices.insert(vertices.end(), hole.begin(), hole.end());
        sizes.push_back(static_cast<int>(hole.size()));
    }
    std::vector<V2d> points;
    for (const int v : vertices) points.push_back(out_.points[v]);
    for (const std::array<int, 3>& t : triangulate(points, sizes))
        emit_face(i, j, {vertices[t[0]], vertices[t[1]], vertices[t[2]]});
}

void Cutter::cut_cell(int i, int j, const CellLoops& loops) {
    for (const CellOutline& outline : outlines_of_cell(border(i, j), loops, out_.points))
        emit(i, j, outline.outer, outline.holes);
}

/// Cells without loops are kept or left out whole, by their corners.
TrimmedCells Cutter::cut() {
    for (std::vector<double>& row : row_crossings_) std::sort(row.begin(), row.end());
    for (auto& [edge, crossings] : edge_crossings_)
        std::sort(crossings.begin(), crossings.end(),
                  [&, axis = edge[0]](int a, int b) { return out_.points[a][axis] < out_.points[b][axis]; });
    for (int j = 0; j < ny_; ++j)
        for (int i = 0; i < nx_; ++i) {
            const auto found = cells_.find({i, j});
            cut_cell(i, j, found == cells_.end() ? CellLoops() : found->second);
        }
    return std::move(out_);
}

}  // namespace

/// Loops of fewer than three points enclose nothing.
TrimmedCells trim_cells(std::vector<std::vector<V2d>> loops, int nx, int ny, bool keep_outside) {
    Cutter cutter(nx, ny, keep_outside);
    for (std::vector<V2d>& loop : loops)
        if (loop.size() >= 3) cutter.add_loop(std::move(loop));
    return cutter.cut();
}

}  // namespace trapeze
