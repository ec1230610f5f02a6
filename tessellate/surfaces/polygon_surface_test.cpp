/// Polygons as faces: areas, shared edges, variables, and input that is broken or has no area.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "tessellate/mesh_harness.h"
#include "tessellate/topology/polygon_faces.h"
#include "tessellate/topology/surface.h"

namespace trapeze {
namespace {

using testing::Cage;
using testing::evaluate;
using testing::Evaluated;
using testing::variables_at;

/// A polygon mesh with the primitive that it refers to.
struct Made {
    Diagnostics diagnostics;
    Primitive primitive;
    std::unique_ptr<Surface> surface;

    Made(PolygonMesh mesh, ParameterList variables)
        : primitive(testing::primitive_of(std::move(mesh), std::move(variables))),
          surface(make_polygon_surface(primitive, diagnostics)) {}
    explicit Made(const Cage& cage) : Made(testing::polygons_of(cage), {{testing::points(cage.P)}}) {}
    const Surface& operator*() const { return *surface; }
};

/// One polygon of several loops.
Made one_polygon(const std::vector<std::vector<V3f>>& loops, ParameterList more = {}) {
    PolygonMesh mesh;
    mesh.loops_per_polygon = {static_cast<int>(loops.size())};
    std::vector<float> P;
    for (const auto& loop : loops) {
        mesh.vertices_per_loop.push_back(static_cast<int>(loop.size()));
        for (const V3f& p : loop) P.insert(P.end(), {p.x, p.y, p.z});
    }
    mesh.vertex_count = static_cast<int>(P.size() / 3);
    mesh.vertices.resize(mesh.vertex_count);
    std::iota(mesh.vertices.begin(), mesh.vertices.end(), 0);
    more.values.push_back(testing::points(P));
    return {mesh, more};
}

/// The sum of dPdu x dPdv over all faces: exact for bilinear faces, by a 2 x 2 Gauss rule.
V3f area_of(const Surface& surface) {
    const float a = 0.5f - 0.5f / std::sqrt(3.0f), b = 1 - a;
    V3f sum(0, 0, 0);
    for (int face = 0; face < surface.face_count(); ++face) {
        const Evaluated e = evaluate(surface, face, {{a, a}, {a, b}, {b, a}, {b, b}});
        for (int i = 0; i < 4; ++i) sum += e.dPdu[i].cross(e.dPdv[i]) * 0.25f;
    }
    return sum;
}

void expect_area(const Made& made, const V3f& area) {
    ASSERT_TRUE(made.surface);
    testing::expect_near(area_of(*made), area, 1e-5f * (1 + area.length()), "area");
    testing::expect_joined(*made, 1e-5f);
    testing::expect_bounded_and_differentiated(*made, 1e-2f);
}

TEST(PolygonSurface, AreasAndOrientation) {
    const Made square = one_polygon({{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}});
    EXPECT_EQ((*square).face_count(), 1);
    expect_area(square, {0, 0, 4});
    const Made turned = one_polygon({{{0, 2, 0}, {2, 2, 0}, {2, 0, 0}, {0, 0, 0}}});
    expect_area(turned, {0, 0, -4});
    const Made triangle = one_polygon({{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}});
    EXPECT_EQ((*triangle).face_count(), 3);
    expect_area(triangle, {0, 0.5f, 0});
    const Made arrow = one_polygon({{{0, 0, 0}, {2, 2, 1}, {0, 1, 0.5f}, {-2, 2, 1}}});
    EXPECT_EQ((*arrow).face_count(), 6);
    expect_area(arrow, {0, -1, 2});
    const Made framed = one_polygon({{{0, 0, 5}, {4, 0, 5}, {4, 4, 5}, {0, 4, 5}},
                                     {{1, 1, 5}, {2, 1, 5}, {2, 2, 5}, {1, 2, 5}},
                                     {{3, 3, 5}, {2.5f, 3, 5}, {2.5f, 2.5f, 5}}});
    expect_area(framed, {0, 0, 16 - 1 - 0.125f});
}

TEST(PolygonSurface, QuadsThatAreNotFlatOrConvexBecomeTriangles) {
    EXPECT_EQ((*one_polygon({{{0, 0, 0}, {2, 0, 0}, {2, 2, 1}, {0, 2, 0}}})).face_count(), 6);
    EXPECT_EQ((*one_polygon({{{0, 0, 0}, {2, 0, 0}, {2, 2, 1e-5f}, {0, 2, 0}}})).face_count(), 1);
    EXPECT_EQ((*one_polygon({{{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {0, 2, 0}}})).face_count(), 6);
}

TEST(PolygonSurface, NeighboursShareEdges) {
    for (const Cage& cage : {testing::cube_cage(), testing::prism_cage(7), testing::octahedron_cage()}) {
        const Made made(cage);
        testing::expect_joined(*made, 1e-6f);
        // A closed mesh: all sides of pieces come in pairs that cover their edges.
        std::vector<float> covered((*made).edge_count());
        for (int face = 0; face < (*made).face_count(); ++face)
            for (const SurfaceSide& side : (*made).sides(face))
                covered[side.edge] += std::abs(side.end - side.begin);
        for (float length : covered) EXPECT_EQ(length, 2);
        testing::expect_near(area_of(*made), {0, 0, 0}, 1e-5f, "closed");
    }
}

TEST(PolygonSurface, DegenerateInput) {
    const V3f a(0, 0, 0), b(1, 0, 0), c(1, 1, 0), d(0, 1, 0);
    // Without area, but kept together: neighbours may share its edges.
    EXPECT_TRUE(one_polygon({{a, b, {2, 0, 0}}}).surface);
    EXPECT_TRUE(one_polygon({{a, a, a, a}}).surface);
    expect_area(one_polygon({{a, b, b, c, c, d}}), {0, 0, 1});
    // The same vertex again and again.
    PolygonMesh again = testing::polygons_of({{0, 0, 0, 1, 0, 0, 1, 1, 0}, {6}, {0, 0, 1, 2, 2, 0}});
    const ParameterList P{{testing::points({0, 0, 0, 1, 0, 0, 1, 1, 0})}};
    expect_area(Made(again, P), {0, 0, 0.5f});
    again.vertices = {0, 1, 0, 1, 0, 1};
    const Made nothing(again, P);
    EXPECT_FALSE(nothing.surface);
    EXPECT_EQ(nothing.diagnostics.count(Severity::Warning), 1u);
    again.vertices = {0, 1, 2, 3, 4, 5};
    const Made outside(again, P);
    EXPECT_FALSE(outside.surface);
    EXPECT_EQ(outside.diagnostics.count(Severity::Error), 1u);
}

TEST(PolygonSurface, VariablesAndDefaults) {
    const std::vector<V3f> loop = {{1, 2, 0}, {3, 2, 0}, {3, 6, 0}, {2, 3, 0}};  // concave: two triangles
    ParameterList more;
    more.values.push_back({"k", {StorageClass::FaceVarying, ValueType::Float, 1}, {1, 3, 3, 2}, {}});
    more.values.push_back({"w", {StorageClass::Varying, ValueType::Float, 1}, {2, 2, 6, 3}, {}});
    more.values.push_back({"Cs", {StorageClass::Uniform, ValueType::Color, 1}, {0.25f, 0.5f, 0.75f}, {}});
    const Made made = one_polygon({loop}, more);
    EXPECT_TRUE((*made).is_faceted());
    const std::vector<V2f> uv = {{0, 0}, {1, 0}, {0.3f, 0.8f}, {1, 1}};
    for (int face = 0; face < 6; ++face) {
        bool has_normals = true;
        const ShadingGrid grid = variables_at(*made, face, uv, &has_normals);
        EXPECT_FALSE(has_normals);
        ASSERT_TRUE(grid.find("k") && grid.find("w"));
        const Evaluated e = evaluate(*made, face, uv);
        for (size_t i = 0; i < uv.size(); ++i) {
            // s, t are x, y; k = x and w = y at the vertices, hence everywhere.
            EXPECT_FLOAT_EQ(grid.s[i], e.P[i].x);
            EXPECT_FLOAT_EQ(grid.t[i], e.P[i].y);
            EXPECT_FLOAT_EQ(grid.find("k")->planes[0][i], e.P[i].x);
            EXPECT_FLOAT_EQ(grid.find("w")->planes[0][i], e.P[i].y);
            EXPECT_EQ(grid.Cs.at(i), V3f(0.25f, 0.5f, 0.75f));
        }
    }
}

TEST(PolygonSurface, NormalsMakeItSmooth) {
    ParameterList more;
    more.values.push_back(
        {"N", {StorageClass::Varying, ValueType::Normal, 1}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, {}});
    const Made made = one_polygon({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, more);
    EXPECT_FALSE((*made).is_faceted());
    bool has_normals = false;
    const ShadingGrid grid = variables_at(*made, 0, {{1, 0}, {0.5f, 0}}, &has_normals);
    EXPECT_TRUE(has_normals);
    EXPECT_EQ(grid.N.at(0), V3f(0, 1, 0));
    EXPECT_EQ(grid.N.at(1), V3f(0.5f, 0.5f, 0));
}

TEST(PolygonSurface, UniformVariablesFollowThePolygon) {
    Cage cage = testing::prism_cage(5);
    PolygonMesh mesh = testing::polygons_of(cage);
    std::vector<float> numbers(cage.sizes.size());
    std::iota(numbers.begin(), numbers.end(), 0.0f);
    ParameterList variables{{testing::points(cage.P)}};
    variables.values.push_back({"number", {StorageClass::Uniform, ValueType::Float, 1}, numbers, {}});
    const Made made(mesh, variables);
    std::vector<int> faces(numbers.size());
    for (int face = 0; face < (*made).face_count(); ++face) {
        bool has_normals;
        const ShadingGrid grid = variables_at(*made, face, {{0, 0}, {1, 1}}, &has_normals);
        ASSERT_TRUE(grid.find("number")->uniform);
        ++faces[static_cast<int>(grid.find("number")->planes[0][0])];
    }
    EXPECT_EQ(faces[0], 9);  // the pentagon: three triangles
    for (size_t i = 1; i < faces.size(); ++i) EXPECT_EQ(faces[i], cage.sizes[i] == 4 ? 1 : 3);
}

/// Twice the area that triangles take at a key.
double covered(const PolygonFaces& faces, const std::vector<float>& key) {
    const auto at = [&](int vertex) {
        const float* p = key.data() + 3 * static_cast<size_t>(vertex);
        return V3d(p[0], p[1], p[2]);
    };
    double sum = 0;
    for (size_t i = 0; i + 2 < faces.vertices.size(); i += 3) {
        const V3d a = at(faces.vertices[i]);
        sum += (at(faces.vertices[i + 1]) - a).cross(at(faces.vertices[i + 2]) - a).length();
    }
    return sum;
}

/// A hole that is a point as the shutter opens, and corners that are on a line then.
TEST(PolygonFaces, AreCutAsFitsAllKeys) {
    struct Moving {
        std::vector<int> loops;
        std::vector<float> open, close;
        double area_at_close;
    };
    const Moving all[] = {
        {{4, 4},
         {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
         {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0, -.8f, -.8f, 0, .8f, -.8f, 0, .8f, .8f, 0, -.8f, .8f, 0},
         4 - 2.56},
        {{5},
         {-1, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0},
         {-1, -1, 0, 1, -1, 0, 1, 1, 0, 0, -.9f, 0, -1, 1, 0},
         4 - 1.9}};
    for (const Moving& moving : all) {
        PolygonMesh mesh;
        mesh.loops_per_polygon = {static_cast<int>(moving.loops.size())};
        mesh.vertices_per_loop = moving.loops;
        mesh.vertex_count = static_cast<int>(moving.open.size() / 3);
        for (int i = 0; i < mesh.vertex_count; ++i) mesh.vertices.push_back(i);
        const std::span<const float> opens_first[] = {moving.open, moving.close},
                                     closes_first[] = {moving.close, moving.open};
        for (const auto& keys : {opens_first, closes_first}) {
            const PolygonFaces faces = make_polygon_faces(mesh, std::span(keys, 2));
            EXPECT_NEAR(covered(faces, moving.open), 2 * 4, 1e-6);
            EXPECT_NEAR(covered(faces, moving.close), 2 * moving.area_at_close, 1e-6);
        }
    }
}

}  // namespace
}  // namespace trapeze
