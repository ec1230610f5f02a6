#include "tessellate/topology/triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace trapeze {
namespace {

/// Twice the area of a triangle, positive when it runs counterclockwise. Exact but for the last rounding when
/// the coordinates were floats of like size.
double area2(const V2d& a, const V2d& b, const V2d& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// In the closed triangle, which runs counterclockwise.
bool in_triangle(const V2d& a, const V2d& b, const V2d& c, const V2d& p) {
    return area2(a, b, p) >= 0 && area2(b, c, p) >= 0 && area2(c, a, p) >= 0;
}

/// In the open triangle.
bool inside_triangle(const V2d& a, const V2d& b, const V2d& c, const V2d& p) {
    return area2(a, b, p) > 0 && area2(b, c, p) > 0 && area2(c, a, p) > 0;
}

/// A corner of the ring that is being clipped. Bridges visit points twice. Nodes are linked both ways, so
/// that an ear is cut off by relinking its neighbours.
struct RingNode {
    int point = 0;
    int previous = 0, next = 0;
    bool clipped = false;
};

/// Nodes by place, to find those near an ear.
class RingNodeGrid {
  public:
    RingNodeGrid(const std::vector<RingNode>& nodes, std::span<const V2d> points);
    /// Whether `f` holds for a node in the box or near it.
    template <class F>
    bool any(const V2d& lo, const V2d& hi, F&& f) const {
        for (int y = row(lo.y); y <= row(hi.y); ++y)
            for (int x = column(lo.x); x <= column(hi.x); ++x)
                for (int i = first_[y * side_ + x]; i < first_[y * side_ + x + 1]; ++i)
                    if (f(nodes_[i])) return true;
        return false;
    }

  private:
    int clamped(double cell) const {
        return cell > 0 ? static_cast<int>(std::min<double>(cell, side_ - 1)) : 0;
    }
    int column(double x) const { return clamped((x - origin_.x) * cells_per_unit_.x); }
    int row(double y) const { return clamped((y - origin_.y) * cells_per_unit_.y); }

    int side_ = 1;
    V2d origin_{0, 0}, cells_per_unit_{0, 0};
    std::vector<int> first_, nodes_;
};

/// About two nodes a cell, sorted into cells by counting: looking for points in an ear is then about
/// constant, and the whole not quadratic.
RingNodeGrid::RingNodeGrid(const std::vector<RingNode>& nodes, std::span<const V2d> points) {
    Imath::Box2d box;
    for (const RingNode& node : nodes) box.extendBy(points[node.point]);
    side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(nodes.size()) / 2)), 1, 1024);
    origin_ = box.min;
    const V2d size = box.size();
    for (int k = 0; k < 2; ++k) cells_per_unit_[k] = size[k] > 0 ? side_ / size[k] : 0;
    first_.assign(static_cast<size_t>(side_) * side_ + 1, 0);
    const auto cell = [&](const RingNode& n) {
        return row(points[n.point].y) * side_ + column(points[n.point].x);
    };
    for (const RingNode& node : nodes) ++first_[cell(node) + 1];
    for (size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    nodes_.resize(nodes.size());
    std::vector<int> at(first_.begin(), first_.end() - 1);
    for (size_t i = 0; i < nodes.size(); ++i) nodes_[at[cell(nodes[i])]++] = static_cast<int>(i);
}

/// How much is asked of an ear, from the best on.
enum class Ear : uint8_t { Clean, WithoutArea, Convex, Any };

/// Joins loops into one ring of nodes, then cuts ears off it until nothing is left. The ring runs
/// counterclockwise.
class Triangulator {
  public:
    Triangulator(std::span<const V2d> points, std::span<const int> loop_sizes);
    std::vector<std::array<int, 3>> run();

  private:
    const V2d& at(int node) const { return points_[nodes_[node].point]; }
    double corner_area(int node) const {
        return area2(at(nodes_[node].previous), at(node), at(nodes_[node].next));
    }
    /// Adds a loop's nodes as a ring that runs as wanted; its first node.
    int make_ring(int first_point, int size, bool counterclockwise);
    int bridge_end(int hole) const;
    /// The ring's node to bridge to: the candidate, or of the nodes in the triangle before it the one at the
    /// least angle to the ray, which nothing can hide.
    int nearest_in_sight(int hole, int candidate, double x) const;
    bool goes_inside(int node, const V2d& to) const;
    void join(int ring_node, int hole_node);
    /// Whether a corner may be cut off, by what is asked of ears.
    bool is_ear(int node, Ear want, const RingNodeGrid& grid) const;
    /// The best ear from a node on; some node in any case.
    int find_ear(int start, int size, const RingNodeGrid& grid) const;

    std::span<const V2d> points_;
    std::vector<RingNode> nodes_;
    int ring_ = -1;  ///< a node of the ring
    int ring_size_ = 0;
    bool reversed_ = false;  ///< the outline was clockwise
};

/// Twice the signed area of a loop.
double loop_area(std::span<const V2d> loop) {
    double sum = 0;
    for (size_t i = 1; i + 1 < loop.size(); ++i) sum += area2(loop[0], loop[i], loop[i + 1]);
    return sum;
}

Triangulator::Triangulator(std::span<const V2d> points, std::span<const int> loop_sizes) : points_(points) {
    if (loop_sizes.empty() || loop_sizes[0] < 3) return;
    nodes_.reserve(points.size() + 2 * loop_sizes.size());
    reversed_ = loop_area(points.first(loop_sizes[0])) < 0;
    ring_ = make_ring(0, loop_sizes[0], true);
    ring_size_ = loop_sizes[0];

    struct Hole {
        int leftmost;
        int size;
    };
    std::vector<Hole> holes;
    int first = loop_sizes[0];
    for (int size : loop_sizes.subspan(1)) {
        if (size >= 1) {
            const int start = make_ring(first, size, false);
            int leftmost = start;
            for (int i = start; i < start + size; ++i) {
                const V2d &a = at(i), &b = at(leftmost);
                if (a.x < b.x || (a.x == b.x && a.y < b.y)) leftmost = i;
            }
            holes.push_back({leftmost, size});
        }
        first += size;
    }
    // Holes are joined from the left on: bridges lead to the left, where they meet only the outline and holes
    // that are part of it by then.
    std::stable_sort(holes.begin(), holes.end(),
                     [&](const Hole& a, const Hole& b) { return at(a.leftmost).x < at(b.leftmost).x; });
    for (const Hole& hole : holes) {
        const int end = bridge_end(hole.leftmost);
        if (end < 0) continue;
        join(end, hole.leftmost);
        ring_size_ += hole.size + 2;
    }
}

int Triangulator::make_ring(int first_point, int size, bool counterclockwise) {
    const bool reverse = (loop_area(points_.subspan(first_point, size)) >= 0) != counterclockwise;
    const int start = static_cast<int>(nodes_.size());
    for (int i = 0; i < size; ++i) {
        const int point = first_point + (reverse ? size - 1 - i : i);
        nodes_.push_back({point, start + (i + size - 1) % size, start + (i + 1) % size, false});
    }
    return start;
}

/// The ring's node that a hole's leftmost point sees: on the ray to the left lies an edge; its left end is in
/// sight, or else one of the nodes between.
int Triangulator::bridge_end(int hole) const {
    const V2d h = at(hole);
    double x = -std::numeric_limits<double>::infinity();
    int candidate = -1;
    int node = ring_;
    for (int i = 0; i < ring_size_; ++i, node = nodes_[node].next) {
        const V2d &a = at(node), &b = at(nodes_[node].next);
        if (!(a.y >= h.y && h.y >= b.y && a.y != b.y))
            continue;  // the interior is right of edges that go down
        const double cut = a.x + (h.y - a.y) * (b.x - a.x) / (b.y - a.y);
        if (!(cut <= h.x && cut > x)) continue;
        x = cut;
        candidate = a.x < b.x ? node : nodes_[node].next;
        if (h.y == a.y && cut == a.x) candidate = node;
        if (h.y == b.y && cut == b.x) candidate = nodes_[node].next;
    }
    return candidate < 0 ? -1 : nearest_in_sight(hole, candidate, x);
}

int Triangulator::nearest_in_sight(int hole, int candidate, double x) const {
    const V2d h = at(hole), cut(x, h.y), far = at(candidate);
    const bool up = far.y >= h.y;
    int best = candidate;
    double best_slope = std::numeric_limits<double>::infinity();
    if (far.x != h.x) best_slope = std::abs(far.y - h.y) / std::abs(h.x - far.x);
    // A ring point may occur several times: one whose corner opens towards the hole is wanted.
    bool best_opens = goes_inside(candidate, h);
    int node = ring_;
    for (int i = 0; i < ring_size_; ++i, node = nodes_[node].next) {
        const V2d p = at(node);
        if (node == candidate || !(p.x <= h.x) || !goes_inside(node, h)) continue;
        if (p == h) return node;
        if (p != far && !(up ? in_triangle(cut, h, far, p) : in_triangle(h, cut, far, p))) continue;
        const double slope =
            p.x != h.x ? std::abs(p.y - h.y) / (h.x - p.x) : std::numeric_limits<double>::infinity();
        const bool nearer = slope < best_slope || (slope == best_slope && p.x > at(best).x);
        if (!nearer && best_opens) continue;
        best = node, best_slope = slope, best_opens = true;
    }
    return best;
}

/// Whether the way to a point starts inside the polygon.
bool Triangulator::goes_inside(int node, const V2d& to) const {
    const V2d &a = at(nodes_[node].previous), &b = at(node), &c = at(nodes_[node].next);
    const bool left_of_next = area2(b, c, to) >= 0, left_of_previous = area2(a, b, to) >= 0;
    return area2(a, b, c) >= 0 ? left_of_next && left_of_previous : left_of_next || left_of_previous;
}

/// Joins a hole to the ring by a bridge, whose ends are doubled: ring -> hole, all around, -> ring.
void Triangulator::join(int ring_node, int hole_node) {
    const int ring_copy = static_cast<int>(nodes_.size()), hole_copy = ring_copy + 1;
    const int after = nodes_[ring_node].next, before = nodes_[hole_node].previous;
    nodes_.push_back({nodes_[ring_node].point, hole_copy, after, false});
    nodes_.push_back({nodes_[hole_node].point, before, ring_copy, false});
    nodes_[ring_node].next = hole_node;
    nodes_[hole_node].previous = ring_node;
    nodes_[before].next = hole_copy;
    nodes_[after].previous = ring_copy;
}

bool Triangulator::is_ear(int node, Ear want, const RingNodeGrid& grid) const {
    if (want == Ear::Any) return true;
    const double area = corner_area(node);
    if (want == Ear::WithoutArea) return area == 0;
    if (!(area > 0)) return false;
    const V2d &a = at(nodes_[node].previous), &b = at(node), &c = at(nodes_[node].next);
    const V2d lo(std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}));
    const V2d hi(std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}));
    return !grid.any(lo, hi, [&](int other) {
        if (nodes_[other].clipped || other == node) return false;
        const V2d& p = at(other);
        if (want == Ear::Convex) return inside_triangle(a, b, c, p);
        // Of what reaches into the triangle, something is not convex. What starts at the ends of the cut
        // cannot cross it.
        return p != a && p != c && in_triangle(a, b, c, p) && !(corner_area(other) > 0);
    });
}

/// What is asked for falls step by step: rounding and loops that cross may leave no proper ear, and there
/// must be one triangle less each time.
int Triangulator::find_ear(int start, int size, const RingNodeGrid& grid) const {
    for (const Ear want : {Ear::Clean, Ear::WithoutArea, Ear::Convex, Ear::Any}) {
        int node = start;
        for (int i = 0; i < size; ++i, node = nodes_[node].next)
            if (is_ear(node, want, grid)) return node;
    }
    return start;
}

std::vector<std::array<int, 3>> Triangulator::run() {
    std::vector<std::array<int, 3>> triangles;
    if (ring_ < 0) return triangles;
    const RingNodeGrid grid(nodes_, points_);
    triangles.reserve(ring_size_ - 2);
    int start = ring_;
    for (int size = ring_size_; size >= 3; --size) {
        const int ear = find_ear(start, size, grid);
        const int before = nodes_[ear].previous, after = nodes_[ear].next;
        std::array<int, 3> triangle = {nodes_[before].point, nodes_[ear].point, nodes_[after].point};
        if (reversed_) std::swap(triangle[1], triangle[2]);
        triangles.push_back(triangle);
        nodes_[before].next = after;
        nodes_[after].previous = before;
        nodes_[ear].clipped = true;
        start = nodes_[after].next;  // not always the same corner: fans of slivers
    }
    return triangles;
}

}  // namespace

std::vector<std::array<int, 3>> triangulate(std::span<const V2d> points, std::span<const int> loop_sizes) {
    return Triangulator(points, loop_sizes).run();
}

}  // namespace trapeze
