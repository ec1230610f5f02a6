/// Edges and their tessellation. Every edge (of the surface, or made when a subpatch is split) is cut into
/// dyadic intervals, each with 1 to 16 segments uniform in the edge's parameter: a function of the edge alone
/// [Fisher09; decision 0002; decision 0020]. Subpatches on either side take their border vertices from here.
/// A subpatch's side lies inside one interval, and may be finer than it: its ends snap to the interval's
/// vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "tessellate/measure/line_measure.h"
#include "tessellate/topology/placed_surface.h"

namespace trapeze {

/// A piece [begin, begin + 2^-depth] of an edge's parameter, cut into 1 to 16 equal segments. `begin` is a
/// multiple of 2^-depth: exact in floats. Depths are bounded by EdgeRate::max_depth, far below the 24 bits at
/// which halving stops being exact.
struct EdgeInterval {
    float begin = 0;
    uint8_t depth = 0;
    uint8_t segments = 1;

    float size() const { return 1.0f / static_cast<float>(1u << depth); }
    float end() const { return begin + size(); }
    /// Whether parameters a <= b lie in it, ends included.
    bool contains(float a, float b) const { return a >= begin && b <= end(); }

    /// The number of the interval's vertex nearest to a parameter inside it. Exact: all parameters of sides
    /// are dyadic. Halves go up, seen along the edge from both sides alike.
    int snap(float parameter) const {
        return static_cast<int>((parameter - begin) / size() * static_cast<float>(segments) + 0.5f);
    }
    /// The edge's parameter at vertex 0 .. segments.
    float parameter_of(int vertex) const {
        return begin + size() * (static_cast<float>(vertex) / static_cast<float>(segments));
    }
};

/// Where an edge's vertex is evaluated: a vertex of the surface, or a point of one face. Whoever asks for a
/// vertex of an edge gets the same one, hence the same bits of its position.
struct BorderPoint {
    bool is_vertex = false;
    uint32_t vertex = 0;
    SurfacePoint at;
    int hops = 0;        ///< edges whose ends were followed to get there
    bool moved = false;  ///< not at the parameter asked for: snapped to a vertex
};

/// Pieces of an interval that are measured first.
inline constexpr int kCoarseEdgePieces = 4;

/// The intervals of many edges, numbered from 0. Those of one edge are sorted and cover [0, 1].
class EdgeTessellations {
  public:
    size_t size() const { return records_.size(); }
    /// The intervals of an edge, in the order of its parameter.
    std::span<const EdgeInterval> of(uint32_t edge) const {
        const Record& r = records_[edge];
        return {intervals_.data() + r.first, r.count};
    }
    /// Cuts one more edge, number size(). `rate`: the wished length of segments.
    void add(const PlacedSurface& surface, const EdgeLine& line, const LineMeasure& measure,
             const EdgeRate& rate, EvaluationScratch& scratch);
    /// Adds one more edge that is one interval.
    void add_whole(uint8_t segments);
    /// Adds other edges, numbered on.
    void append(const EdgeTessellations& other);
    /// Leaves the first `count` edges, as if no more had been added.
    void resize(size_t count);
    /// Edge i becomes edge new_number[i].
    void renumber(std::span<const uint32_t> new_number);
    /// Gives back memory that growing has left over; nothing can be added cheaply afterwards.
    void shrink_to_fit();
    size_t bytes() const;

  private:
    struct Record {
        uint32_t first = 0, count = 0;
    };
    std::vector<Record> records_;
    std::vector<EdgeInterval> intervals_;
};

/// All edges that a face's subpatches know: the surface's, numbered as it does, then those made by splits.
/// A view; both parts outlive it.
struct Edges {
    const Surface* surface = nullptr;
    const EdgeTessellations* of_surface = nullptr;
    const std::vector<EdgeLine>* made_lines = nullptr;
    const EdgeTessellations* made = nullptr;

    /// Where an edge of either kind is evaluated.
    EdgeLine line(uint32_t edge) const;
    /// The interval that holds [a, b], or null when the edge is split within it.
    const EdgeInterval* interval(uint32_t edge, float a, float b) const;
    /// The point of vertex `number` of an edge's interval; at the edge's own ends these decide.
    BorderPoint vertex(uint32_t edge, const EdgeInterval& interval, int number) const {
        return vertex(line(edge), interval, number);
    }
    BorderPoint vertex(const EdgeLine& line, const EdgeInterval& interval, int number) const;
    /// Whether an edge of the surface ends in a vertex there, which then decides.
    bool is_vertex(uint32_t edge, float parameter) const;
    /// The point at an edge's end: a vertex of the surface, or the vertex of another edge nearest to where it
    /// ends there.
    BorderPoint end(const EdgeEnd& end) const;
};

/// The face's parameters of vertex `number` of an interval; ends exact, so that neighbouring intervals agree.
inline V2f line_uv(const EdgeLine& line, const EdgeInterval& interval, int number) {
    const V2f a = line.from + (line.to - line.from) * interval.begin;
    const V2f b = line.from + (line.to - line.from) * interval.end();
    if (number == interval.segments) return b;
    return a + (b - a) * (static_cast<float>(number) / static_cast<float>(interval.segments));
}

}  // namespace trapeze
