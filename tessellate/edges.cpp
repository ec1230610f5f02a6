#include "tessellate/edges.h"

#include <algorithm>

namespace trapeze {
namespace {

/// Pieces of an interval that are measured first, and where these want more segments than that.
constexpr int kCoarsePieces = kCoarseEdgePieces, kFinePieces = 8;

/// Cuts one edge into intervals, halving as long as the measure wants.
class EdgeCutter {
  public:
    EdgeCutter(const PlacedSurface& surface, const EdgeLine& line, const LineMeasure& measure,
               const EdgeRate& rate, EvaluationScratch& scratch, std::vector<EdgeInterval>& out)
        : surface_(surface),
          line_(line),
          measure_(measure),
          rate_(rate),
          scratch_(scratch),
          out_(out),
          limit_(out.size() + rate.max_intervals) {}

    /// Adds the intervals of a piece of the edge, in order.
    void cut(EdgeInterval interval) {
        const float rate = rate_.pixels_per_segment;
        RateEstimate estimate = estimate_of(interval);
        const bool may_split = interval.depth < rate_.max_depth && out_.size() < limit_;
        if (may_split && estimate.wants_split(rate)) {
            ++interval.depth;
            cut(interval);
            interval.begin = interval.end();
            cut(interval);
            return;
        }
        interval.segments = static_cast<uint8_t>(estimate.clamped_segments(rate_));
        out_.push_back(interval);
    }

  private:
    /// How many segments a piece of the edge wants: by its lengths, and where these might be less by
    /// foreshortening, looked at more closely.
    RateEstimate estimate_of(const EdgeInterval& interval) {
        const float rate = rate_.pixels_per_segment;
        int pieces = kCoarsePieces;
        std::span<const V3f> P = points(interval, pieces, 1);
        RateEstimate estimate = measure_.of(P);
        if (estimate.segments(rate) > kCoarsePieces) {
            pieces = kFinePieces;
            P = refined(interval);
            estimate = measure_.of(P);
        }
        if (!measure_.may_want_less(estimate)) return estimate;
        if (measure_.keys() > 1) P = points(interval, pieces, measure_.keys());
        return measure_.foreshortened(P, points(interval, pieces, measure_.keys(), true));
    }

    /// Points of the line at its first `keys` keys, P[key * (pieces + 1) + i], or of one beside it on the
    /// same face.
    std::span<const V3f> points(const EdgeInterval& interval, int pieces, int keys, bool beside = false) {
        std::array<V2f, kFinePieces + 1> uv;
        EdgeInterval pieces_of = interval;
        pieces_of.segments = static_cast<uint8_t>(pieces);
        for (int i = 0; i <= pieces; ++i) uv[i] = line_uv(line_, pieces_of, i);
        if (beside) {
            const int across = line_.from.x == line_.to.x ? 0 : 1;
            constexpr float kInside = FaceLattices::kBeside;
            for (int i = 0; i <= pieces; ++i) uv[i][across] += uv[i][across] < 0.5f ? kInside : -kInside;
        }
        const size_t n = pieces + 1;
        const std::span<V3f> P{(beside ? beside_ : P_).data(), n * keys};
        surface_.positions(line_.face, {uv.data(), n}, keys, scratch_, P);
        return P;
    }

    /// The points of kFinePieces, of which those of kCoarsePieces are there, at the first key.
    std::span<const V3f> refined(EdgeInterval interval) {
        static_assert(kFinePieces == 2 * kCoarsePieces);
        std::array<V2f, kCoarsePieces> uv;
        std::array<V3f, kCoarsePieces> between;
        interval.segments = kFinePieces;
        for (int i = 0; i < kCoarsePieces; ++i) uv[i] = line_uv(line_, interval, 2 * i + 1);
        surface_.positions(line_.face, uv, 1, scratch_, between);
        for (int i = kCoarsePieces; i > 0; --i) P_[2 * i] = P_[i], P_[2 * i - 1] = between[i - 1];
        return {P_.data(), kFinePieces + 1};
    }

    const PlacedSurface& surface_;
    const EdgeLine& line_;
    const LineMeasure& measure_;
    const EdgeRate& rate_;
    EvaluationScratch& scratch_;
    std::vector<EdgeInterval>& out_;
    const size_t limit_;
    std::array<V3f, (kFinePieces + 1) * LineMeasure::kMostKeys> P_, beside_;
};

}  // namespace

/// The edge's intervals stand one after another, in the order in which halving reaches them: that of the
/// parameter.
void EdgeTessellations::add(const PlacedSurface& surface, const EdgeLine& line, const LineMeasure& measure,
                            const EdgeRate& rate, EvaluationScratch& scratch) {
    const size_t first = intervals_.size();
    EdgeCutter(surface, line, measure, rate, scratch, intervals_).cut({});
    records_.push_back({static_cast<uint32_t>(first), static_cast<uint32_t>(intervals_.size() - first)});
}

void EdgeTessellations::add_whole(uint8_t segments) {
    records_.push_back({static_cast<uint32_t>(intervals_.size()), 1});
    intervals_.push_back({0, 0, segments});
}

/// Records name places in the list of intervals, and move on by what is there already.
void EdgeTessellations::append(const EdgeTessellations& other) {
    const uint32_t offset = static_cast<uint32_t>(intervals_.size());
    intervals_.insert(intervals_.end(), other.intervals_.begin(), other.intervals_.end());
    for (Record r : other.records_) records_.push_back({r.first + offset, r.count});
}

void EdgeTessellations::resize(size_t count) {
    if (count < records_.size()) intervals_.resize(records_[count].first);
    records_.resize(count);
}

/// Edges are numbered as they are met while surfaces are split in parallel; the order that is kept does not
/// depend on that.
void EdgeTessellations::renumber(std::span<const uint32_t> new_number) {
    std::vector<Record> old = std::move(records_);
    records_.assign(old.size(), {});
    for (size_t i = 0; i < old.size(); ++i) records_[new_number[i]] = old[i];
}

void EdgeTessellations::shrink_to_fit() {
    records_.shrink_to_fit();
    intervals_.shrink_to_fit();
}

size_t EdgeTessellations::bytes() const {
    return records_.capacity() * sizeof(Record) + intervals_.capacity() * sizeof(EdgeInterval);
}

/// Below the surface's own count a number is one of its edges, from there on one that splitting has made.
EdgeLine Edges::line(uint32_t edge) const {
    const size_t surface_edges = of_surface->size();
    return edge < surface_edges ? surface->edge(edge) : (*made_lines)[edge - surface_edges];
}

/// A binary search: intervals are sorted and cover all of the edge. The parameters are dyadic, so that
/// comparisons with the ends are exact.
const EdgeInterval* Edges::interval(uint32_t edge, float a, float b) const {
    const size_t surface_edges = of_surface->size();
    const std::span<const EdgeInterval> all =
        edge < surface_edges ? of_surface->of(edge) : made->of(static_cast<uint32_t>(edge - surface_edges));
    if (a > b) std::swap(a, b);
    // The last interval that begins at or before a.
    const auto after = std::upper_bound(all.begin(), all.end(), a,
                                        [](float p, const EdgeInterval& i) { return p < i.begin; });
    const EdgeInterval& holds_a = *(after == all.begin() ? after : after - 1);
    return b <= holds_a.end() ? &holds_a : nullptr;
}

/// At the edge's own ends the point is another's to give: a vertex of the surface, or a point within another
/// edge, followed until a vertex decides. Each edge on the way counts as a hop.
BorderPoint Edges::vertex(const EdgeLine& l, const EdgeInterval& interval, int number) const {
    BorderPoint point;
    if (number == 0 && interval.begin == 0)
        point = end(l.start);
    else if (number == interval.segments && interval.end() == 1)
        point = end(l.finish);
    else
        return {false, 0, {l.face, line_uv(l, interval, number)}, 0, false};
    ++point.hops;
    return point;
}

/// False for made edges, whose ends lie on sides.
bool Edges::is_vertex(uint32_t edge, float parameter) const {
    if (edge >= of_surface->size() || (parameter != 0 && parameter != 1)) return false;
    const EdgeLine l = surface->edge(edge);
    return !(parameter == 0 ? l.start : l.finish).on_edge;
}

/// Where an edge ends within another, it takes that one's nearest vertex, and so may end a little beside
/// where it was cut: `moved` tells the splitter to bound it there.
BorderPoint Edges::end(const EdgeEnd& at) const {
    if (!at.on_edge) return {true, at.id, surface->vertex(at.id), 0, false};
    const EdgeInterval& holds = *interval(at.id, at.parameter, at.parameter);
    const int number = holds.snap(at.parameter);
    BorderPoint point = vertex(at.id, holds, number);
    point.moved |= holds.parameter_of(number) != at.parameter;
    return point;
}

}  // namespace trapeze
