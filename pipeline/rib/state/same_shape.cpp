/// Compares shapes whole, cheap differences first: an archive's shapes are compared each time that it is
/// read.
#include "pipeline/rib/state/same_shape.h"

#include <algorithm>

namespace trapeze::rib {
namespace {

template <class T, class Same>
bool all_same(const std::vector<T>& a, const std::vector<T>& b, const Same& same) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

bool is_same_tag(const SubdivisionMesh::Tag& a, const SubdivisionMesh::Tag& b) {
    return a.name == b.name && a.ints == b.ints && a.floats == b.floats && a.strings == b.strings;
}

bool is_same_curve(const TrimCurve& a, const TrimCurve& b) {
    return a.order == b.order && a.knots == b.knots && a.begin == b.begin && a.end == b.end &&
           a.points == b.points;
}

/// Unlike can_deform(), values count too: bases, trims, sharpness.
struct SameTopology {
    bool operator()(const PolygonMesh& a, const PolygonMesh& b) const {
        return a.vertex_count == b.vertex_count && a.loops_per_polygon == b.loops_per_polygon &&
               a.vertices_per_loop == b.vertices_per_loop && a.vertices == b.vertices;
    }
    bool operator()(const SubdivisionMesh& a, const SubdivisionMesh& b) const {
        return a.scheme == b.scheme && a.vertex_count == b.vertex_count &&
               a.vertices_per_face == b.vertices_per_face && a.vertices == b.vertices &&
               all_same(a.tags, b.tags, is_same_tag);
    }
    bool operator()(const Quadric& a, const Quadric& b) const {
        return a.kind == b.kind && a.value_count == b.value_count && a.values == b.values;
    }
    bool operator()(const PatchMesh& a, const PatchMesh& b) const {
        return a.bicubic == b.bicubic && a.nu == b.nu && a.nv == b.nv && a.u_wraps == b.u_wraps &&
               a.v_wraps == b.v_wraps && a.u_step == b.u_step && a.v_step == b.v_step &&
               a.u_basis == b.u_basis && a.v_basis == b.v_basis;
    }
    bool operator()(const NuPatch& a, const NuPatch& b) const {
        const auto same_loops = [](const std::vector<TrimCurve>& x, const std::vector<TrimCurve>& y) {
            return all_same(x, y, is_same_curve);
        };
        return a.nu == b.nu && a.nv == b.nv && a.u_order == b.u_order && a.v_order == b.v_order &&
               a.u_begin == b.u_begin && a.u_end == b.u_end && a.v_begin == b.v_begin && a.v_end == b.v_end &&
               a.trim_outside == b.trim_outside && a.u_knots == b.u_knots && a.v_knots == b.v_knots &&
               all_same(a.trim_loops, b.trim_loops, same_loops);
    }
    bool operator()(const Curves& a, const Curves& b) const {
        return a.cubic == b.cubic && a.periodic == b.periodic && a.step == b.step && a.basis == b.basis &&
               a.vertices_per_curve == b.vertices_per_curve;
    }
    bool operator()(const Points& a, const Points& b) const { return a.count == b.count; }
    bool operator()(const Blobby& a, const Blobby& b) const {
        return a.leaf_count == b.leaf_count && a.code == b.code && a.floats == b.floats &&
               a.strings == b.strings;
    }
    template <class A, class B>
    bool operator()(const A&, const B&) const {
        return false;
    }
};

/// The order counts too: an archive writes its variables alike each time.
bool is_same_variable(const Parameter& a, const Parameter& b) {
    return a.name == b.name && a.declaration == b.declaration && a.floats == b.floats &&
           a.strings == b.strings;
}

}  // namespace

/// Topologies come first: where shapes differ they mostly do, and they are shorter than points.
bool is_same(const Shape& a, const Shape& b) {
    return std::visit(SameTopology{}, a.topology, b.topology) &&
           all_same(a.variables.values, b.variables.values, is_same_variable);
}

}  // namespace trapeze::rib
