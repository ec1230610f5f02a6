#include "tessellate/topology/curve_topology.h"

namespace trapeze {

/// Sums of counts, so that each curve's first vertex, value and face is found by its number.
CurveTopology::CurveTopology(const Curves& curves, int segments_per_face, bool joins)
    : curves_(curves), joins_(joins) {
    const size_t count = curves.vertices_per_curve.size();
    for (std::vector<int>* first : {&first_vertex_, &first_varying_, &first_face_}) first->reserve(count + 1);
    int vertex = 0, varying = 0, face = 0;
    for (const int vertices : curves.vertices_per_curve) {
        first_vertex_.push_back(vertex);
        first_varying_.push_back(varying);
        first_face_.push_back(face);
        vertex += vertices;
        varying += curves.varying(vertices);
        face += (curves.segments(vertices) + segments_per_face - 1) / segments_per_face;
    }
    first_vertex_.push_back(vertex);
    first_varying_.push_back(varying);
    first_face_.push_back(face);
    curve_of_face_.resize(face);
    for (size_t c = 0; c < count; ++c)
        for (int f = first_face_[c]; f < first_face_[c + 1]; ++f) curve_of_face_[f] = static_cast<int>(c);
}

/// Segments are dealt out evenly in whole numbers; 64 bits, for the product of faces and segments may not fit
/// 32.
CurveTopology::Strip CurveTopology::strip(int face) const {
    Strip strip;
    strip.curve = curve_of_face_[face];
    strip.all = curves_.segments(vertices_of(strip.curve));
    const int64_t first_face = first_face_[strip.curve], faces = first_face_[strip.curve + 1] - first_face;
    strip.first = static_cast<int>((face - first_face) * strip.all / faces);
    strip.count = static_cast<int>((face - first_face + 1) * strip.all / faces) - strip.first;
    return strip;
}

uint32_t CurveTopology::joint_after(int face) const {
    if (!joins_) return faces() + static_cast<uint32_t>(face);
    const int curve = curve_of_face_[face];
    if (face + 1 < first_face_[curve + 1]) return static_cast<uint32_t>(face + 1);
    return curves_.periodic ? static_cast<uint32_t>(first_face_[curve])
                            : faces() + static_cast<uint32_t>(curve);
}

/// The top is the bottom edge of the face that follows, or an end's own.
std::array<SurfaceSide, 4> CurveTopology::sides(int face) const {
    const uint32_t f = static_cast<uint32_t>(face), next = joint_after(face);
    const uint32_t top = next < faces() ? 3 * next + 2 : 2 * faces() + next;
    return {SurfaceSide{3 * f + 2}, SurfaceSide{3 * f + 1}, SurfaceSide{top}, SurfaceSide{3 * f}};
}

/// Edges across a curve belong to the face that begins there: its v = 0.
EdgeLine CurveTopology::edge(uint32_t edge) const {
    EdgeLine line;
    uint32_t from, to;  // vertices
    if (edge >= 3 * faces()) {
        const uint32_t end = edge - 3 * faces();
        line.face = face_at_end(end);
        line.from = {0, 1}, line.to = {1, 1};
        from = 2 * (faces() + end), to = from + 1;
    } else {
        line.face = static_cast<int>(edge / 3);
        // 0: the side u = 0, 1: the side u = 1, 2: across the curve at v = 0.
        const uint32_t kind = edge % 3;
        const float u = static_cast<float>(kind);
        line.from = kind == 2 ? V2f(0, 0) : V2f(u, 0);
        line.to = kind == 2 ? V2f(1, 0) : V2f(u, 1);
        from = kind == 2 ? edge / 3 * 2 : edge / 3 * 2 + kind;
        to = kind == 2 ? from + 1 : 2 * joint_after(line.face) + kind;
    }
    line.start = {false, from, 0}, line.finish = {false, to, 0};
    return line;
}

bool CurveTopology::stands_alone(int face) const {
    if (!joins_) return true;
    const int curve = curve_of_face_[face];
    return !curves_.periodic && first_face_[curve + 1] - first_face_[curve] == 1;
}

/// Each joint has two vertices, at the two sides of the ribbon.
SurfacePoint CurveTopology::vertex(uint32_t vertex) const {
    const uint32_t joint = vertex / 2;
    const float u = static_cast<float>(vertex % 2);
    if (joint < faces()) return {static_cast<int>(joint), {u, 0}};
    return {face_at_end(joint - faces()), {u, 1}};
}

}  // namespace trapeze
