/// Poses of a primitive in a motion block. What deforms is each number that can be mixed: points, variables,
/// a quadric's sizes, a blobby's floats. What tells the form must be the same in all poses.
#include "pipeline/rib/state/deforming_shape.h"

#include <algorithm>

#include "pipeline/rib/state/moving_transform.h"

namespace trapeze::rib {
namespace {

/// Declared alike and as long: values can be mixed one by one.
bool same_form(const Parameter& a, const Parameter& b) {
    return a.declaration == b.declaration && a.floats.size() == b.floats.size();
}

/// With as many on both sides and no name twice, each of a having its like in b is enough.
bool same_variables(const Shape& a, const Shape& b) {
    if (a.variables.values.size() != b.variables.values.size()) return false;
    return std::all_of(a.variables.values.begin(), a.variables.values.end(), [&](const Parameter& x) {
        const Parameter* y = b.variables.find(x.name);  // they may stand in another order
        return y && same_form(x, *y);
    });
}

/// Visits pairs of topologies; those of two different kinds end in the last overload.
struct SameForm {
    bool operator()(const PolygonMesh& a, const PolygonMesh& b) const {
        return a.loops_per_polygon == b.loops_per_polygon && a.vertices_per_loop == b.vertices_per_loop &&
               a.vertices == b.vertices && a.vertex_count == b.vertex_count;
    }
    bool operator()(const SubdivisionMesh& a, const SubdivisionMesh& b) const {
        return a.scheme == b.scheme && a.vertices_per_face == b.vertices_per_face &&
               a.vertices == b.vertices && a.vertex_count == b.vertex_count && a.tags.size() == b.tags.size();
    }
    bool operator()(const Quadric& a, const Quadric& b) const {
        return a.kind == b.kind && a.value_count == b.value_count;
    }
    bool operator()(const PatchMesh& a, const PatchMesh& b) const {
        return a.bicubic == b.bicubic && a.nu == b.nu && a.nv == b.nv && a.u_wraps == b.u_wraps &&
               a.v_wraps == b.v_wraps && a.u_step == b.u_step && a.v_step == b.v_step;
    }
    /// Trim curves may differ: those of the first pose are kept.
    bool operator()(const NuPatch& a, const NuPatch& b) const {
        return a.nu == b.nu && a.nv == b.nv && a.u_order == b.u_order && a.v_order == b.v_order &&
               a.u_knots == b.u_knots && a.v_knots == b.v_knots && a.u_begin == b.u_begin &&
               a.u_end == b.u_end && a.v_begin == b.v_begin && a.v_end == b.v_end;
    }
    bool operator()(const Points& a, const Points& b) const { return a.count == b.count; }
    /// The program is the form; floats of its leaves move.
    bool operator()(const Blobby& a, const Blobby& b) const {
        return a.leaf_count == b.leaf_count && a.code == b.code && a.floats.size() == b.floats.size() &&
               a.strings == b.strings;
    }
    bool operator()(const Curves& a, const Curves& b) const {
        return a.cubic == b.cubic && a.periodic == b.periodic && a.step == b.step && a.basis == b.basis &&
               a.vertices_per_curve == b.vertices_per_curve;
    }
    template <class A, class B>
    bool operator()(const A&, const B&) const {
        return false;
    }
};

/// Everything that is a number, interpolated. Variables are found by name, as the two may have them in
/// another order.
ShapePointer between(const Shape& a, const Shape& b, float t) {
    auto shape = std::make_shared<Shape>(a);
    if (auto* quadric = std::get_if<Quadric>(&shape->topology)) {
        const auto& end = std::get<Quadric>(b.topology);
        for (int i = 0; i < quadric->value_count; ++i)
            quadric->values[i] += t * (end.values[i] - quadric->values[i]);
    }
    if (auto* blobby = std::get_if<Blobby>(&shape->topology)) {
        const auto& end = std::get<Blobby>(b.topology);
        for (size_t i = 0; i < blobby->floats.size(); ++i)
            blobby->floats[i] += t * (end.floats[i] - blobby->floats[i]);
    }
    for (Parameter& variable : shape->variables.values) {
        const std::vector<float>& end = b.variables.find(variable.name)->floats;
        for (size_t k = 0; k < end.size(); ++k) variable.floats[k] += t * (end[k] - variable.floats[k]);
    }
    return shape;
}

/// The pose at a time of the scene, mixed linearly (RISpec 6). One that was given is shared and not copied.
ShapePointer shape_at(const std::vector<ShapePointer>& shapes, const std::vector<float>& times, float time) {
    if (shapes.size() == 1 || time <= times.front()) return shapes.front();
    if (time >= times.back()) return shapes.back();
    const size_t next = std::upper_bound(times.begin(), times.end(), time) - times.begin();
    const float t = (time - times[next - 1]) / (times[next] - times[next - 1]);
    if (t == 0) return shapes[next - 1];
    return between(*shapes[next - 1], *shapes[next], t);
}

}  // namespace

/// A single key stands for the whole shutter, and is taken as it opens.
float key_time(float open, float close, int key, int keys) {
    return keys == 1 ? open
                     : open + (close - open) * (static_cast<float>(key) / static_cast<float>(keys - 1));
}

/// Order of variables does not matter; exporters write them as they come.
bool can_deform(const std::vector<ShapePointer>& shapes) {
    const Shape& first = *shapes.front();
    return std::all_of(shapes.begin(), shapes.end(), [&](const ShapePointer& shape) {
        return std::visit(SameForm{}, first.topology, shape->topology) && same_variables(first, *shape);
    });
}

/// Positions have to be their own; all else may be the first one's.
bool give_missing_variables(std::vector<ShapePointer>& shapes) {
    bool given = false;
    const std::vector<Parameter>& first = shapes.front()->variables.values;
    for (size_t i = 1; i < shapes.size(); ++i) {
        std::shared_ptr<Shape> whole;
        for (const Parameter& value : first) {
            if (value.name == "P" || value.name == "Pw" || shapes[i]->variables.find(value.name)) continue;
            if (!whole) whole = std::make_shared<Shape>(*shapes[i]);
            whole->variables.set(value);
        }
        if (!whole) continue;
        shapes[i] = std::move(whole);
        given = true;
    }
    return given;
}

/// A shape of another class or length for its colours is given those of the pose before the shutter opens, or
/// none: the later poses have to be of one form.
bool use_colors_at_open(std::vector<ShapePointer>& shapes, const std::vector<float>& times, float open) {
    const size_t after = std::upper_bound(times.begin(), times.end(), open) - times.begin();
    const ShapePointer at_open = shapes[after > 0 ? after - 1 : 0];
    bool moves = false;
    for (const char* name : {"Cs", "Os"}) {
        const Parameter* const own = at_open->variables.find(name);
        for (ShapePointer& shape : shapes) {
            const Parameter* const other = shape->variables.find(name);
            if (!own && !other) continue;
            moves = moves || !own || !other || own->floats != other->floats;
            if (own && other && same_form(*own, *other)) continue;
            auto same_colors = std::make_shared<Shape>(*shape);
            std::erase_if(same_colors->variables.values, [&](const Parameter& p) { return p.name == name; });
            if (own) same_colors->variables.set(*own);
            shape = std::move(same_colors);
        }
    }
    return moves;
}

/// Poses at times outside of the shutter count where they bound a motion within. Keys at even times suit all
/// later stages: a ray's segment is found by one multiplication.
std::vector<ShapePointer> shapes_at_keys(const std::vector<ShapePointer>& shapes,
                                         const std::vector<float>& times, float open, float close, int keys) {
    std::vector<ShapePointer> resolved;
    for (int k = 0; k < keys; ++k)
        resolved.push_back(shape_at(shapes, times, key_time(open, close, k, keys)));
    return resolved;
}

}  // namespace trapeze::rib
