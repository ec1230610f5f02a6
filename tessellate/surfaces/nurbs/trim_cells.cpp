#include "tessellate/surfaces/nurbs/trim_cells.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tessellate/topology/triangulate.h"

namespace trapeze {
namespace {

/// A loop's part within a cell, from one crossing of the cell's border to another.
struct Path {
    std::vector<int> vertices;  ///< both crossings included
};

/// What loops do in one cell.
struct CellPaths {
    std::vector<Path> paths;
    std::vector<std::vector<int>> closed;  ///< loops that never leave the cell
};

/// The area of a polygon of point numbers, positive when it runs anticlockwise.
double signed_area(const std::vector<V2d>& points, const std::vector<int>& polygon) {
    double sum = 0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const V2d &a = points[polygon[i]], &b = points[polygon[(i + 1) % polygon.size()]];
        sum += a.x * b.y - a.y * b.x;
    }
    return sum / 2;
}

/// Whether a point is inside, by the even-odd rule.
bool is_within(const V2d& p, const std::vector<V2d>& points, const std::vector<int>& polygon) {
    bool within = false;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const V2d &a = points[polygon[i]], &b = points[polygon[(i + 1) % polygon.size()]];
        if ((a.y <= p.y) != (b.y <= p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
            within = !within;
    }
    return within;
}

/// First all loops are added, which finds where they cross the grid's lines and what they do in each cell;
/// then cells are cut one by one. Crossings are vertices of both cells at a line, so that pieces share them.
/// Points are moved off the grid's lines first, so that no corner of a cell and no line needs a special case.
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
    /// Adds the faces of one cell; `paths` is null where no loop comes.
    void cut_cell(int i, int j, const CellPaths* paths);
    struct BorderNode {
        int vertex = 0;
        bool kept_after = false;  ///< the border from here to the next node
    };
    /// A cell's corners and crossings, anticlockwise from its least corner.
    std::vector<BorderNode> border(int i, int j);
    void add_side(std::vector<BorderNode>& nodes, const Edge& edge, bool forwards, int from);
    std::vector<std::vector<int>> outlines(const std::vector<BorderNode>& nodes,
                                           const std::vector<Path>& paths) const;
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
    std::map<std::pair<int, int>, CellPaths> cells_;
    std::map<std::pair<int, int>, int> corners_;
};

/// A coordinate moved off the grid's lines, on none of which a point may lie: then every crossing is one of
/// two different sides. Those near a line are moved a little, outwards at the rim.
double off_lines(double x, int n) {
    constexpr double kNear = 1e-6, kMove = 1e-5, kRim = 1e-3;
    if (std::abs(x) < kMove) return -kRim;
    if (std::abs(x - n) < kMove) return n + kRim;
    return std::abs(x - std::round(x)) < kNear ? std::round(x) + kMove : x;
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
    for (V2d& p : loop) p = {off_lines(p.x, nx_), off_lines(p.y, ny_)};
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
            if (is_cell(i, j)) cells_[{i, j}].paths.push_back({path});
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
void Cutter::add_side(std::vector<BorderNode>& nodes, const Edge& edge, bool forwards, int from) {
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

std::vector<Cutter::BorderNode> Cutter::border(int i, int j) {
    std::vector<BorderNode> nodes;
    add_side(nodes, {0, i, j}, true, corner(i, j));
    add_side(nodes, {1, i + 1, j}, true, corner(i + 1, j));
    add_side(nodes, {0, i, j + 1}, false, corner(i + 1, j + 1));
    add_side(nodes, {1, i, j}, false, corner(i, j + 1));
    return nodes;
}

/// The outlines of what is kept of a cell: along the kept border, then along the loop that ends it to where
/// the kept border begins again. A run of border whose loop leads elsewhere is closed by a straight line.
std::vector<std::vector<int>> Cutter::outlines(const std::vector<BorderNode>& nodes,
                                               const std::vector<Path>& paths) const {
    const size_t n = nodes.size();
    std::vector<std::vector<int>> result;
    std::map<int, size_t> run_starts;  // by vertex
    for (size_t k = 0; k < n; ++k)
        if (nodes[k].kept_after && !nodes[(k + n - 1) % n].kept_after) run_starts[nodes[k].vertex] = k;
    if (run_starts.empty()) {
        if (n > 0 && nodes[0].kept_after) {
            result.emplace_back();
            for (const BorderNode& node : nodes) result.back().push_back(node.vertex);
        }
        return result;
    }
    std::map<int, std::pair<const Path*, bool>> path_at;  // by end; whether it begins there
    for (const Path& path : paths) {
        path_at[path.vertices.front()] = {&path, true};
        path_at[path.vertices.back()] = {&path, false};
    }
    // Each kept run of border belongs to one outline; one after another is followed around.
    while (!run_starts.empty()) {
        const int first = run_starts.begin()->first;
        std::vector<int> outline;
        for (auto run = run_starts.begin(); run != run_starts.end();) {
            size_t k = run->second;
            run_starts.erase(run);
            for (; nodes[k].kept_after; k = (k + 1) % n) outline.push_back(nodes[k].vertex);
            const int end = nodes[k].vertex;
            outline.push_back(end);
            const auto path = path_at.find(end);
            if (path == path_at.end()) break;
            const std::vector<int>& v = path->second.first->vertices;
            const bool forwards = path->second.second;
            const int other = forwards ? v.back() : v.front();
            const auto next = run_starts.find(other);
            if (other != first && next == run_starts.end()) break;
            for (size_t p = 1; p + 1 < v.size(); ++p)
                outline.push_back(forwards ? v[p] : v[v.size() - 1 - p]);
            if (other == first) break;
            run = next;
        }
        result.push_back(std::move(outline));
    }
    return result;
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
    if (outline.size() < 3) return;
    if (holes.empty() && outline.size() <= kMostCellCorners && is_convex(outline))
        return emit_face(i, j, outline);
    std::vector<int> vertices = outline, sizes{static_cast<int>(outline.size())};
    for (const std::vector<int>& hole : holes) {
        vertices.insert(vertices.end(), hole.begin(), hole.end());
        sizes.push_back(static_cast<int>(hole.size()));
    }
    std::vector<V2d> points;
    for (const int v : vertices) points.push_back(out_.points[v]);
    // Triangles run the way of the outline; faces run anticlockwise.
    const bool turned = signed_area(out_.points, outline) < 0;
    for (const std::array<int, 3>& t : triangulate(points, sizes)) {
        std::vector<int> triangle{vertices[t[0]], vertices[t[1]], vertices[t[2]]};
        if (turned) std::swap(triangle[1], triangle[2]);
        emit_face(i, j, std::move(triangle));
    }
}

void Cutter::cut_cell(int i, int j, const CellPaths* paths) {
    static const CellPaths kNone;
    const CellPaths& in_cell = paths ? *paths : kNone;
    const std::vector<BorderNode> nodes = border(i, j);
    const std::vector<std::vector<int>> pieces = outlines(nodes, in_cell.paths);
    // A loop that stays within the cell is a hole of the piece that holds it, or else a piece of its own.
    std::vector<std::vector<std::vector<int>>> holes(pieces.size());
    for (const std::vector<int>& loop : in_cell.closed) {
        const auto holds = [&](const std::vector<int>& piece) {
            return is_within(out_.points[loop[0]], out_.points, piece);
        };
        const auto piece = std::ranges::find_if(pieces, holds);
        if (piece == pieces.end())
            emit(i, j, loop, {});
        else
            holes[piece - pieces.begin()].push_back(loop);
    }
    for (size_t k = 0; k < pieces.size(); ++k) emit(i, j, pieces[k], holes[k]);
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
            cut_cell(i, j, found == cells_.end() ? nullptr : &found->second);
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
