#include "tessellate/surfaces/nurbs/cell_outlines.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/portable_math.h"

namespace trapeze {
namespace {

/// How many pairs of segments are looked at for crossings, and how many of these are cut: in a cell, whose
/// time grows with their squares.
constexpr size_t kMostPairs = 1 << 22, kMostCrossings = 512;

/// A loop's part between two nodes, crossings or places on the border; or a loop without any.
struct Chain {
    std::vector<int> vertices;  ///< of a closed one each once
    bool closed = false;

    size_t segment_count() const { return vertices.size() - (closed ? 0 : 1); }
    int next(size_t i) const { return vertices[(i + 1) % vertices.size()]; }
};

/// Whether a line that runs to lesser values of an axis from a point meets a segment; points on one side of
/// the line count as being on it.
bool is_met(const V2d& from, int axis, const V2d& a, const V2d& b) {
    const int other = 1 - axis;
    if ((a[other] <= from[other]) == (b[other] <= from[other])) return false;
    const double share = (from[other] - a[other]) / (b[other] - a[other]);
    return a[axis] + share * (b[axis] - a[axis]) < from[axis];
}

/// Whether a point is inside, by the even-odd rule.
bool is_within(const V2d& p, const std::vector<V2d>& points, const std::vector<int>& polygon) {
    bool within = false;
    for (size_t i = 0; i < polygon.size(); ++i)
        within ^= is_met(p, 0, points[polygon[i]], points[polygon[(i + 1) % polygon.size()]]);
    return within;
}

/// Where two segments cross, as a share of the first.
std::optional<double> crossing(const V2d& a, const V2d& b, const V2d& c, const V2d& d) {
    const V2d ab = b - a, cd = d - c;
    const double c_side = ab.cross(c - a), d_side = ab.cross(d - a);
    const double a_side = cd.cross(a - c), b_side = cd.cross(b - c);
    if (!(c_side * d_side < 0) || !(a_side * b_side < 0)) return {};
    return a_side / (a_side - b_side);
}

/// The parts of a cell's loops, cut where they cross, turned so that what is kept is to the left, and joined
/// with the kept border to outlines.
class Arrangement {
  public:
    Arrangement(std::span<const CellBorderNode> border, const CellLoops& loops, std::vector<V2d>& points)
        : border_(border), points_(points) {
        for (const std::vector<int>& path : loops.paths) chains_.push_back({path, false});
        for (const std::vector<int>& loop : loops.closed) chains_.push_back({loop, true});
    }

    std::vector<CellOutline> outlines() {
        cut_at_crossings();
        for (size_t c = 0; c < chains_.size(); ++c)
            if (!keeps_left(c)) turned_.push_back(c);
        for (const size_t c : turned_) std::ranges::reverse(chains_[c].vertices);
        for (size_t k = 0; k < border_.size(); ++k)
            if (border_[k].kept_after)
                chains_.push_back({{border_[k].vertex, border_[(k + 1) % border_.size()].vertex}, false});
        return with_holes(rings());
    }

  private:
    struct Cut {
        size_t segment;
        double share;
        int vertex;
    };
    struct Segment {
        size_t chain, index;
        V2d a, b;
    };

    V2d point(int vertex) const { return points_[static_cast<size_t>(vertex)]; }
    std::vector<Segment> segments() const;
    void cut_at_crossings();
    void cut(const Chain& chain, std::vector<Cut> cuts, std::vector<Chain>& parts) const;
    bool keeps_left(size_t c) const;
    bool border_kept(const V2d& from, int axis) const;
    std::vector<std::vector<int>> rings() const;
    size_t sharpest_left(int before, int at, const std::vector<size_t>& leaving) const;
    std::vector<CellOutline> with_holes(std::vector<std::vector<int>> rings) const;

    std::span<const CellBorderNode> border_;
    std::vector<V2d>& points_;
    std::vector<Chain> chains_;
    std::vector<size_t> turned_;
};

std::vector<Arrangement::Segment> Arrangement::segments() const {
    std::vector<Segment> all;
    for (size_t c = 0; c < chains_.size(); ++c)
        for (size_t i = 0; i < chains_[c].segment_count(); ++i)
            all.push_back({c, i, point(chains_[c].vertices[i]), point(chains_[c].next(i))});
    return all;
}

/// Looks at pairs of segments that overlap along x, of those sorted by where they begin. Where there are too
/// many crossings, no loops are left: the border's kept parts are closed by straight lines.
void Arrangement::cut_at_crossings() {
    std::vector<Segment> all = segments();
    const auto least = [](const Segment& s) { return std::min(s.a.x, s.b.x); };
    std::ranges::sort(all, {}, least);
    const size_t points_before = points_.size();
    std::vector<std::vector<Cut>> cuts(chains_.size());
    size_t pairs = 0;
    for (size_t i = 0; i < all.size() && pairs < kMostPairs; ++i) {
        const Segment& one = all[i];
        for (size_t k = i + 1; k < all.size() && least(all[k]) <= std::max(one.a.x, one.b.x); ++k) {
            const Segment& other = all[k];
            ++pairs;
            const auto share = crossing(one.a, one.b, other.a, other.b);
            if (!share) continue;
            const auto vertex = static_cast<int>(points_.size());
            points_.push_back(one.a + (one.b - one.a) * *share);
            cuts[one.chain].push_back({one.index, *share, vertex});
            cuts[other.chain].push_back({other.index, *crossing(other.a, other.b, one.a, one.b), vertex});
        }
    }
    if (points_.size() == points_before) return;
    if (points_.size() - points_before > kMostCrossings) {
        points_.resize(points_before);
        return chains_.clear();
    }
    std::vector<Chain> parts;
    for (size_t c = 0; c < chains_.size(); ++c) cut(chains_[c], std::move(cuts[c]), parts);
    chains_ = std::move(parts);
}

/// A closed chain's first part begins at its first crossing and its last one ends there.
void Arrangement::cut(const Chain& chain, std::vector<Cut> cuts, std::vector<Chain>& parts) const {
    if (cuts.empty()) return parts.push_back(chain);
    std::ranges::sort(cuts, [](const Cut& a, const Cut& b) {
        return a.segment != b.segment ? a.segment < b.segment : a.share < b.share;
    });
    std::vector<int> part, head;
    size_t next_cut = 0;
    bool is_head = chain.closed;
    for (size_t i = 0; i < chain.vertices.size(); ++i) {
        part.push_back(chain.vertices[i]);
        for (; next_cut < cuts.size() && cuts[next_cut].segment == i; ++next_cut) {
            part.push_back(cuts[next_cut].vertex);
            if (is_head)
                head = part;
            else
                parts.push_back({part, false});
            is_head = false;
            part = {cuts[next_cut].vertex};
        }
    }
    part.insert(part.end(), head.begin(), head.end());
    parts.push_back({std::move(part), false});
}

/// Whether the border that a line to lesser values of an axis ends at is kept there.
bool Arrangement::border_kept(const V2d& from, int axis) const {
    const double least = point(border_[0].vertex)[axis];  // of the least corner
    const int other = 1 - axis;
    for (size_t k = 0; k < border_.size(); ++k) {
        const V2d a = point(border_[k].vertex), b = point(border_[(k + 1) % border_.size()].vertex);
        if (a[axis] == least && b[axis] == least && (a[other] <= from[other]) != (b[other] <= from[other]))
            return border_[k].kept_after;
    }
    return false;
}

/// Whether what is to the left of a chain is kept: by parity from the border on, to the middle of its longest
/// segment, along the axis that it runs across.
bool Arrangement::keeps_left(size_t c) const {
    const Chain& chain = chains_[c];
    size_t longest = 0;
    double length = -1;
    for (size_t i = 0; i < chain.segment_count(); ++i)
        if (const double l = (point(chain.next(i)) - point(chain.vertices[i])).length2(); l > length)
            longest = i, length = l;
    const V2d a = point(chain.vertices[longest]), b = point(chain.next(longest)), middle = (a + b) * 0.5;
    const int axis = std::abs(b.y - a.y) >= std::abs(b.x - a.x) ? 0 : 1;
    bool kept = border_kept(middle, axis);
    for (size_t other = 0; other < chains_.size(); ++other)
        for (size_t i = 0; i < chains_[other].segment_count(); ++i)
            if (other != c || i != longest)
                kept ^=
                    is_met(middle, axis, point(chains_[other].vertices[i]), point(chains_[other].next(i)));
    // To lesser x is to the left of what runs to larger y; to lesser y is to the left of what runs to lesser
    // x.
    return kept == (axis == 0 ? b.y > a.y : b.x < a.x);
}

/// Of chains that leave a node, the one that bounds what is to the left of the way there.
size_t Arrangement::sharpest_left(int before, int at, const std::vector<size_t>& leaving) const {
    constexpr double kTurn = 6.283185307179586;
    const V2d back = point(before) - point(at);
    const auto turn = [&](size_t c) {  // clockwise from the way back
        const V2d way = point(chains_[c].vertices[1]) - point(at);
        const double angle = -portable::atan2(back.cross(way), back.dot(way));
        return angle > 0 ? angle : angle + kTurn;
    };
    return *std::ranges::min_element(leaving, {}, turn);
}

/// Follows chains from node to node, back to where each ring began. A way that ends at a node which nothing
/// leaves is closed by a straight line: rounding has misled.
std::vector<std::vector<int>> Arrangement::rings() const {
    std::vector<std::vector<int>> result;
    std::map<int, std::vector<size_t>> leaving;
    for (size_t c = 0; c < chains_.size(); ++c)
        if (chains_[c].closed)
            result.push_back(chains_[c].vertices);
        else
            leaving[chains_[c].vertices.front()].push_back(c);
    while (!leaving.empty()) {
        const auto [first, from_first] = *leaving.begin();
        const size_t first_chain = from_first.front();
        std::vector<int> ring;
        size_t c = first_chain;
        do {
            const std::vector<int>& way = chains_[c].vertices;
            ring.insert(ring.end(), way.begin(), way.end() - 1);
            const auto from = leaving.find(way.front());
            std::erase(from->second, c);
            if (from->second.empty()) leaving.erase(from);
            const auto found = leaving.find(way.back());
            std::vector<size_t> on;
            if (found != leaving.end()) on = found->second;
            if (way.back() == first) on.push_back(first_chain);
            if (on.empty()) {
                ring.push_back(way.back());
                break;
            }
            c = sharpest_left(way[way.size() - 2], way.back(), on);
        } while (c != first_chain);
        result.push_back(std::move(ring));
    }
    return result;
}

/// Rings that run anticlockwise hold what is kept; the others are holes, each of the least ring around it.
std::vector<CellOutline> Arrangement::with_holes(std::vector<std::vector<int>> rings) const {
    std::vector<CellOutline> outlines;
    std::vector<std::vector<int>> holes;
    for (std::vector<int>& ring : rings)
        if (ring.size() < 3)
            continue;
        else if (signed_area(points_, ring) > 0)
            outlines.push_back({std::move(ring), {}});
        else
            holes.push_back(std::move(ring));
    std::ranges::sort(outlines, {}, [&](const CellOutline& o) { return signed_area(points_, o.outer); });
    for (std::vector<int>& hole : holes) {
        const V2d middle = (point(hole[0]) + point(hole[1])) * 0.5;
        const auto around = std::ranges::find_if(
            outlines, [&](const CellOutline& o) { return is_within(middle, points_, o.outer); });
        if (around != outlines.end()) around->holes.push_back(std::move(hole));
    }
    return outlines;
}

}  // namespace

double signed_area(const std::vector<V2d>& points, const std::vector<int>& polygon) {
    double sum = 0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const V2d &a = points[polygon[i]], &b = points[polygon[(i + 1) % polygon.size()]];
        sum += a.x * b.y - a.y * b.x;
    }
    return sum / 2;
}

std::vector<CellOutline> outlines_of_cell(std::span<const CellBorderNode> border, const CellLoops& loops,
                                          std::vector<V2d>& points) {
    return Arrangement(border, loops, points).outlines();
}

}  // namespace trapeze
