/// For tests: surfaces of every kind whose faces are measured many at once.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/random.h"
#include "tessellate/dicing_harness.h"
#include "tessellate/measure/lattice_measure.h"
#include "tessellate/mesh_harness.h"
#include "tessellate/surfaces/forms_harness.h"

namespace trapeze::testing {

/// Numbers in -1 .. 1, one after the other.
struct Numbers {
    uint32_t n = 0;
    float operator()() { return 2 * unit_float(hash(7, n++)) - 1; }
};

/// Hairs of random places and lengths; one is a point.
inline std::shared_ptr<const Shape> hairs_of(const M44f& basis, int step, const std::vector<int>& counts,
                                             StorageClass width, float length) {
    Curves curves;
    curves.cubic = true;
    curves.basis = basis, curves.step = step;
    curves.vertices_per_curve = counts;
    std::vector<float> P;
    Numbers number;
    for (const int count : counts) {
        const V3f root(1.5f * number(), 1.2f * number(), number());
        const float own = length * std::abs(number());
        for (int i = 0; i < count; ++i) {
            const float along = own * static_cast<float>(i);
            P.insert(P.end(),
                     {root.x + along, root.y + along * 0.4f * number(), root.z + along * 0.4f * number()});
        }
    }
    for (size_t i = 0; i < 3 * static_cast<size_t>(counts[0]); ++i) P[i] = P[i % 3];
    ParameterList variables;
    variables.set(parameter("P", StorageClass::Vertex, ValueType::Point, P));
    std::vector<float> widths(width == StorageClass::Constant ? 1 : P.size() / 3);
    for (float& w : widths) w = 0.02f + 0.01f * number();
    variables.set(parameter(width == StorageClass::Constant ? "constantwidth" : "width", width,
                            ValueType::Float, widths));
    return shape_of(curves, variables);
}

/// Points from less than a pixel to more than a grid.
inline std::shared_ptr<const Shape> dots(int count) {
    std::vector<float> P, widths;
    Numbers number;
    for (int i = 0; i < count; ++i) {
        P.insert(P.end(), {1.5f * number(), 1.2f * number(), number()});
        widths.push_back(0.3f * std::pow(std::abs(number()), 3.0f));
    }
    ParameterList variables;
    variables.set(parameter("P", StorageClass::Vertex, ValueType::Point, P));
    variables.set(parameter("width", StorageClass::Vertex, ValueType::Float, widths));
    return shape_of(trapeze::Points{count}, variables);
}

/// A surface, where it is placed, and how it is measured.
struct Measured {
    TestScene scene;
    RenderContext context;
    std::unique_ptr<Surface> surface;
    std::unique_ptr<PlacedSurface> placed;
    std::unique_ptr<ScreenMetric> metric;
    std::unique_ptr<LineMeasure> measure;
    EdgeRate rate;

    Measured(std::shared_ptr<const Shape> shape, const M44f& place)
        : Measured(std::vector{std::move(shape)}, std::vector{place}, 0) {}

    /// `lens`: the aperture's radius at a focal distance of 4.
    Measured(std::vector<std::shared_ptr<const Shape>> shapes, std::vector<M44f> places, float lens) {
        scene.scene.options.width = 640, scene.scene.options.height = 480;
        scene.add(std::move(shapes), std::move(places));
        context = scene.context();
        if (lens > 0) context.camera.lens_radius = lens, context.camera.focal_distance = 4;
        const Primitive& primitive = scene.scene.primitives[0];
        surface = make_surface(primitive, scene.diagnostics, {&context.camera, nullptr});
        placed = std::make_unique<PlacedSurface>(*surface, primitive, context.motion);
        metric = std::make_unique<ScreenMetric>(context.camera);
        measure =
            std::make_unique<LineMeasure>(*metric, context.camera, *placed, false, rate.pixels_per_segment);
    }
    V3f object_point(int face, V2f uv, int shape_key, EvaluationScratch& scratch) const {
        V3f P;
        surface->evaluate(face, {&uv, 1}, shape_key, scratch.of(*surface), {&P, 1}, {}, {});
        return P;
    }
    /// Keys that lines are measured at.
    int keys() const { return std::max(measure->keys(), 1); }
    /// The block of faces from `first` on, at all of those.
    std::vector<FaceLattices> lattices(int first) const {
        std::vector<FaceLattices> all(static_cast<size_t>(keys()));
        const int count = std::min(surface->face_count() - first, FaceLattices::kFaces);
        for (int key = 0; key < keys(); ++key)
            surface->lattices(first, count, placed->mix_of(key).first, measure->keys() > 0,
                              all[static_cast<size_t>(key)]);
        return all;
    }
};

inline M44f mirrored() {
    M44f m;
    m[0][0] = -1, m[2][1] = 0.3f;
    return m * translation(0.1f, 0, 4);
}

/// A sheet of bumps, n x n quads of which one is cut into two triangles where `triangles`, as wide as 2.4.
inline Cage bumpy(int n, float height, bool triangles) {
    Cage cage = sheet_cage(n, height);
    const float scale = 2.4f / static_cast<float>(n);
    for (size_t i = 0; i < cage.P.size(); ++i) cage.P[i] = i % 3 == 2 ? cage.P[i] : cage.P[i] * scale - 1.2f;
    if (!triangles) return cage;
    Cage cut = cage;
    cut.sizes.clear(), cut.vertices.clear();
    for (size_t f = 0; f < cage.sizes.size(); ++f) {
        const int* const q = cage.vertices.data() + 4 * f;
        cut.sizes.insert(cut.sizes.end(), {3, 3});
        cut.vertices.insert(cut.vertices.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
    }
    return cut;
}

inline std::shared_ptr<const Shape> subdivided(
    const Cage& cage, std::vector<SubdivisionMesh::Tag> tags = {},
    SubdivisionMesh::Scheme scheme = SubdivisionMesh::Scheme::CatmullClark) {
    ParameterList variables;
    variables.set(points(cage.P));
    return shape_of(subdivision_of(cage, std::move(tags), scheme), variables);
}

inline std::shared_ptr<const Shape> polygons(const Cage& cage) {
    ParameterList variables;
    variables.set(points(cage.P));
    return shape_of(polygons_of(cage), variables);
}

inline std::shared_ptr<const Shape> patches(int n, bool bicubic, const M44f& basis, int step) {
    PatchMesh mesh;
    mesh.bicubic = bicubic;
    mesh.nu = mesh.nv = n;
    mesh.u_basis = mesh.v_basis = basis;
    mesh.u_step = mesh.v_step = step;
    ParameterList variables;
    variables.set(points(bumpy(n - 1, 0.1f, false).P));
    return shape_of(mesh, variables);
}

/// Calls f for kinds of which foreshortening is not looked at.
template <class F>
void for_kinds_not_foreshortened(const F& f) {
    const M44f in_front = translation(0, 0, 4);
    f(Measured(hairs_of(kBezier, 3, std::vector<int>(37, 4), StorageClass::Constant, 0.1f), in_front));
    f(Measured(hairs_of(kBezier, 3, std::vector<int>(20, 7), StorageClass::Vertex, 0.05f), mirrored()));
    f(Measured(hairs_of(kBSpline, 1, {9, 4, 5, 9, 12, 7, 4, 6, 23, 8, 8, 8, 8, 5, 5, 4, 9, 30},
                        StorageClass::Vertex, 0.05f),
               in_front));
    f(Measured(dots(75), in_front));
    f(Measured(dots(75), mirrored()));
    const M44f nearer = translation(0.2f, 0.1f, 3);
    f(Measured({hairs_of(kBezier, 3, std::vector<int>(37, 4), StorageClass::Constant, 0.1f)},
               {in_front, nearer}, 0));
    f(Measured({dots(40)}, {in_front, nearer, in_front}, 0.1f));
    // Through the eye's plane, and many times as long as a grid.
    f(Measured(hairs_of(kBezier, 3, std::vector<int>(37, 4), StorageClass::Constant, 2),
               translation(0, 0, 0.5f)));
}

inline M44f tilted(float angle, float depth) {
    M44f m;
    m.rotate(V3f(angle, 0.2f, 0));
    return m * translation(0, 0, depth);
}

/// Calls f for each kind of meshes, still and moving, seen edge-on and in and out of focus.
template <class F>
void for_meshes(const F& f) {
    const auto still = [&](std::shared_ptr<const Shape> shape, const M44f& place) {
        f(Measured(std::move(shape), place));
    };
    still(subdivided(bumpy(40, 0.1f, false)), tilted(0.3f, 4));
    still(subdivided(bumpy(24, 0.02f, false), {{"interpolateboundary", {}, {}, {}}}), tilted(1.5f, 4));
    still(subdivided(bumpy(24, 0.1f, false), {{"crease", {30, 31, 32, 33}, {3}, {}}}), tilted(0.8f, 3));
    still(subdivided(bumpy(20, 0.1f, false), {{"hole", {0, 1, 2, 3, 40, 200}, {}, {}}}), tilted(0.8f, 3));
    still(subdivided(bumpy(12, 0.1f, true)), tilted(0.3f, 4));
    still(subdivided(bumpy(20, 0.1f, false), {}, SubdivisionMesh::Scheme::Bilinear), tilted(0.3f, 4));
    still(subdivided(prism_cage(7)), tilted(0.3f, 6));
    still(polygons(bumpy(9, 0, false)), tilted(0.3f, 4));
    still(polygons(bumpy(40, 0.1f, false)), tilted(1.2f, 4));
    still(polygons(bumpy(24, 0.1f, true)), tilted(0.3f, 4));
    still(polygons(prism_cage(5)), tilted(0.3f, 60));
    still(patches(43, true, kBSpline, 1), tilted(0.3f, 4));
    still(patches(43, true, kBezier, 3), tilted(1.5f, 4));
    still(patches(30, true, kCatmullRom, 1), tilted(0.8f, 2));
    still(patches(30, false, kBezier, 3), tilted(1.2f, 4));
    // Tiny: no face asks for more than one segment. Through the eye.
    still(subdivided(bumpy(20, 0.1f, false)), tilted(0.3f, 300));
    still(polygons(bumpy(9, 0.1f, false)), tilted(1.5f, 0.3f));
    const auto moving = [&](std::vector<std::shared_ptr<const Shape>> shapes, std::vector<M44f> places,
                            float lens) { f(Measured(std::move(shapes), std::move(places), lens)); };
    moving({subdivided(bumpy(30, 0.1f, false))}, {tilted(0.3f, 4)}, 0.3f);
    moving({subdivided(bumpy(30, 0.1f, false))}, {tilted(0.3f, 4), tilted(0.6f, 5)}, 0);
    moving({polygons(bumpy(24, 0.1f, true))}, {tilted(1.4f, 4), tilted(1.5f, 4), tilted(1.7f, 4)}, 0.1f);
    moving({patches(31, true, kBSpline, 1), patches(31, true, kBezier, 1)}, {tilted(0.3f, 4)}, 0);
    moving({subdivided(bumpy(30, 0.1f, false)), subdivided(bumpy(30, 0.02f, false)),
            subdivided(bumpy(30, 0, false))},
           {tilted(0.3f, 4), tilted(1.2f, 4)}, 0);
}

template <class F>
void for_kinds(const F& f) {
    for_kinds_not_foreshortened(f);
    for_meshes(f);
}

}  // namespace trapeze::testing
