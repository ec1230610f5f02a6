/// For tests: meshes, and what holds for every surface made of faces that share edges.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tessellate/topology/surface.h"

namespace trapeze::testing {

/// A mesh as requests give it: positions, corners of each face, vertices of all corners.
struct Cage {
    std::vector<float> P;
    std::vector<int> sizes, vertices;
    int vertex_count() const { return static_cast<int>(P.size() / 3); }
};

/// Corners at +-1; (1 - 0) x (2 - 1) of each face points outside.
inline Cage cube_cage() {
    Cage cage;
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) cage.P.push_back((i >> k & 1) ? 1.0f : -1.0f);
    cage.sizes.assign(6, 4);
    cage.vertices = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    return cage;
}

inline Cage octahedron_cage() {
    Cage cage;
    cage.P = {1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
    cage.sizes.assign(8, 3);
    cage.vertices = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 1, 0, 5, 2, 1, 5, 3, 2, 5, 0, 3, 5};
    return cage;
}

/// A closed prism over a regular n-gon, one end of which is a fan of triangles: faces of n, 4 and 3 corners,
/// vertices of valence 3, 4 and n.
inline Cage prism_cage(int n) {
    Cage cage;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < n; ++i) {
            const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(n);
            cage.P.insert(cage.P.end(), {std::cos(angle), std::sin(angle), j == 0 ? -1.0f : 1.0f});
        }
    cage.P.insert(cage.P.end(), {0, 0, 1.4f});
    cage.sizes.push_back(n);
    for (int i = n; i-- > 0;) cage.vertices.push_back(i);
    for (int i = 0; i < n; ++i) {
        const int next = (i + 1) % n;
        cage.sizes.push_back(4);
        cage.vertices.insert(cage.vertices.end(), {i, next, n + next, n + i});
        cage.sizes.push_back(3);
        cage.vertices.insert(cage.vertices.end(), {n + i, n + next, 2 * n});
    }
    return cage;
}

/// An open sheet of n x n quads over [0, n] x [0, n], with bumps of a height.
inline Cage sheet_cage(int n, float height) {
    Cage cage;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            cage.P.insert(cage.P.end(),
                          {static_cast<float>(i), static_cast<float>(j),
                           height * std::sin(1.7f * static_cast<float>(i) + static_cast<float>(i * j % 5))});
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i;
            cage.sizes.push_back(4);
            cage.vertices.insert(cage.vertices.end(), {a, a + 1, a + n + 2, a + n + 1});
        }
    return cage;
}

/// Faces of random vertices, mostly without sense; some name a vertex twice.
inline Cage random_cage(std::mt19937& random, bool triangles) {
    Cage cage;
    const int vertices = 4 + static_cast<int>(random() % 6);
    for (int i = 0; i < 3 * vertices; ++i) cage.P.push_back(static_cast<float>(random() % 100));
    std::vector<int> order(vertices);
    for (int i = 0; i < vertices; ++i) order[i] = i;
    for (int f = 1 + static_cast<int>(random() % 7); f-- > 0;) {
        std::shuffle(order.begin(), order.end(), random);
        const int size = triangles ? 3 : 3 + static_cast<int>(random() % (vertices - 3));
        cage.sizes.push_back(size);
        cage.vertices.insert(cage.vertices.end(), order.begin(), order.begin() + size);
        if (random() % 4 == 0) cage.vertices.back() = cage.vertices.end()[-2];
    }
    return cage;
}

inline Parameter points(const std::vector<float>& P) {
    return {"P", {StorageClass::Vertex, ValueType::Point, 1}, P, {}};
}

/// A primitive that stays where it is.
inline Primitive primitive_of(Topology topology, ParameterList variables) {
    Primitive primitive;
    primitive.attributes = std::make_shared<const Attributes>();
    primitive.shape_keys = {std::make_shared<const Shape>(Shape{std::move(topology), std::move(variables)})};
    primitive.camera_from_object = {M44f()};
    return primitive;
}

inline SubdivisionMesh subdivision_of(
    const Cage& cage, std::vector<SubdivisionMesh::Tag> tags = {},
    SubdivisionMesh::Scheme scheme = SubdivisionMesh::Scheme::CatmullClark) {
    SubdivisionMesh mesh;
    mesh.scheme = scheme;
    mesh.vertices_per_face = cage.sizes;
    mesh.vertices = cage.vertices;
    mesh.vertex_count = cage.vertex_count();
    mesh.tags = std::move(tags);
    return mesh;
}

inline PolygonMesh polygons_of(const Cage& cage) {
    PolygonMesh mesh;
    mesh.loops_per_polygon.assign(cage.sizes.size(), 1);
    mesh.vertices_per_loop = cage.sizes;
    mesh.vertices = cage.vertices;
    mesh.vertex_count = cage.vertex_count();
    return mesh;
}

struct Evaluated {
    std::vector<V3f> P, dPdu, dPdv;
};

/// Positions and derivatives at points of a face.
inline Evaluated evaluate(const Surface& surface, int face, const std::vector<V2f>& uv, int key = 0) {
    Evaluated result;
    for (auto* values : {&result.P, &result.dPdu, &result.dPdv}) values->resize(uv.size());
    const auto scratch = surface.make_scratch();
    surface.evaluate(face, uv, key, scratch.get(), result.P, result.dPdu, result.dPdv);
    return result;
}

/// One point: of a face, of an edge at a parameter, or at an edge's end.
inline V3f position(const Surface& surface, const SurfacePoint& at) {
    return evaluate(surface, at.face, {at.uv}).P[0];
}

inline V3f position(const Surface& surface, uint32_t edge, float parameter) {
    const EdgeLine line = surface.edge(edge);
    return position(surface, {line.face, line.from + (line.to - line.from) * parameter});
}

inline V3f position(const Surface& surface, const EdgeEnd& end) {
    return end.on_edge ? position(surface, end.id, end.parameter) : position(surface, surface.vertex(end.id));
}

/// All variables at points of a face, as one row of a grid.
inline ShadingGrid variables_at(const Surface& surface, int face, const std::vector<V2f>& uv,
                                bool* has_normals) {
    ShadingGrid grid;
    for (auto* plane : {&grid.u, &grid.v, &grid.s, &grid.t}) plane->resize(uv.size());
    for (auto* triples : {&grid.N, &grid.Cs, &grid.Os}) triples->fill(uv.size(), V3f(1));
    grid.shape.nu = static_cast<int>(uv.size()) - 1, grid.shape.nv = 0;
    const auto scratch = surface.make_scratch();
    *has_normals = surface.evaluate_variables(face, uv, scratch.get(), grid);
    return grid;
}

inline void expect_near(const V3f& a, const V3f& b, float tolerance, const std::string& what) {
    EXPECT_LE((a - b).length(), tolerance) << what << ": " << a << " and " << b;
}

/// Sides lie on their edges, edges end where they say.
inline void expect_joined(const Surface& surface, float tolerance) {
    for (uint32_t e = 0; e < surface.edge_count(); ++e) {
        const EdgeLine line = surface.edge(e);
        if (surface.is_hole(line.face)) continue;
        const std::string name = "edge " + std::to_string(e);
        expect_near(position(surface, {line.face, line.from}), position(surface, line.start), tolerance,
                    name);
        expect_near(position(surface, {line.face, line.to}), position(surface, line.finish), tolerance, name);
    }
    for (int face = 0; face < surface.face_count(); ++face) {
        if (surface.is_hole(face)) continue;
        const std::array<SurfaceSide, 4> sides = surface.sides(face);
        for (int s = 0; s < 4; ++s)
            for (float x : {0.0f, 0.25f, 0.7f, 1.0f}) {
                const V2f at = s == kBottom  ? V2f(x, 0)
                               : s == kRight ? V2f(1, x)
                               : s == kTop   ? V2f(x, 1)
                                             : V2f(0, x);
                const float t = sides[s].begin + (sides[s].end - sides[s].begin) * x;
                ASSERT_LT(sides[s].edge, surface.edge_count());
                expect_near(position(surface, {face, at}), position(surface, sides[s].edge, t), tolerance,
                            "face " + std::to_string(face) + " side " + std::to_string(s));
            }
    }
}

/// Bounds hold, derivatives agree with differences.
inline void expect_bounded_and_differentiated(const Surface& surface, float tolerance) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int face = 0; face < surface.face_count(); ++face) {
        if (surface.is_hole(face)) continue;
        for (int round = 0; round < 8; ++round) {
            V2f lo(unit(random), unit(random)), hi(unit(random), unit(random));
            for (int k = 0; k < 2; ++k)
                if (lo[k] > hi[k]) std::swap(lo[k], hi[k]);
            if (round == 0) lo = {0, 0}, hi = {1, 1};
            const Box3f box = surface.bound(face, lo, hi, 0);
            std::vector<V2f> uv = {lo, hi};
            for (int i = 0; i < 50; ++i)
                uv.emplace_back(lo.x + (hi.x - lo.x) * unit(random), lo.y + (hi.y - lo.y) * unit(random));
            for (const V3f& p : evaluate(surface, face, uv).P)
                ASSERT_TRUE(box.intersects(p)) << "face " << face << " " << p;
        }
        constexpr float kStep = 1.0f / 256;
        const V2f at(0.1f + 0.8f * unit(random), 0.1f + 0.8f * unit(random));
        const Evaluated e =
            evaluate(surface, face,
                     {at - V2f(kStep, 0), at + V2f(kStep, 0), at - V2f(0, kStep), at + V2f(0, kStep), at});
        const std::string name = "face " + std::to_string(face);
        expect_near((e.P[1] - e.P[0]) / (2 * kStep), e.dPdu[4], tolerance, name + " dPdu");
        expect_near((e.P[3] - e.P[2]) / (2 * kStep), e.dPdv[4], tolerance, name + " dPdv");
    }
}

}  // namespace trapeze::testing
