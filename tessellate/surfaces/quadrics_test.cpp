/// The seven quadrics against RISpec's formulas, with their derivatives, bounds, edges, poles and variables.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tessellate/dicing_harness.h"
#include "tessellate/surfaces/forms_harness.h"

namespace trapeze {
namespace {

using testing::expect_near;
using testing::kPi;

using Kind = Quadric::Kind;

/// A primitive that lives as long as its surface.
struct MadeQuadric {
    Primitive primitive;
    Diagnostics diagnostics;
    std::unique_ptr<Surface> surface;

    MadeQuadric(Kind kind, std::initializer_list<float> values) {
        primitive.attributes = std::make_shared<Attributes>();
        primitive.shape_keys = {testing::shape_of(testing::quadric(kind, values))};
        primitive.camera_from_object = {M44f()};
        surface = make_surface(primitive, diagnostics);
    }
    struct Point {
        V3f P, dPdu, dPdv;
    };
    Point at(int face, V2f uv) const {
        Point p;
        surface->evaluate(face, {&uv, 1}, 0, nullptr, {&p.P, 1}, {&p.dPdu, 1}, {&p.dPdv, 1});
        return p;
    }
    /// Whole-quadric parameters.
    Point at_quadric(float u, float v) const {
        const V2f n = surface->faces_per_unit(0);
        const int columns = static_cast<int>(n.x), rows = static_cast<int>(n.y);
        const int i = std::min(static_cast<int>(u * n.x), columns - 1);
        const int j = std::min(static_cast<int>(v * n.y), rows - 1);
        Point p = at(j * columns + i, {u * n.x - static_cast<float>(i), v * n.y - static_cast<float>(j)});
        p.dPdu *= n.x, p.dPdv *= n.y;
        return p;
    }
};

/// RISpec's formulas against the surface, over the whole parameter range.
template <class F>
void expect_formula(const MadeQuadric& made, F&& formula) {
    for (float u = 0; u <= 1; u += 0.125f)
        for (float v = 0; v <= 1; v += 0.125f) expect_near(made.at_quadric(u, v).P, formula(u, v), 3e-6f);
}

/// A point at a radius and an angle about the z axis.
V3f turn(float radius, float theta, float z) {
    return {radius * std::cos(theta), radius * std::sin(theta), z};
}

TEST(Quadrics, Sphere) {
    const MadeQuadric made(Kind::Sphere, {2, -1, 1.5f, 270});
    expect_formula(made, [](float u, float v) {
        const float lo = std::asin(-0.5f), hi = std::asin(0.75f), phi = lo + v * (hi - lo);
        return turn(2 * std::cos(phi), u * 1.5f * kPi, 2 * std::sin(phi));
    });
}

TEST(Quadrics, ConeCylinderDiskWithNegativeSweeps) {
    expect_formula(MadeQuadric(Kind::Cone, {3, 2, -100}),
                   [](float u, float v) { return turn(2 * (1 - v), -u * 100 * kPi / 180, 3 * v); });
    expect_formula(MadeQuadric(Kind::Cylinder, {2, -1, 3, 360}),
                   [](float u, float v) { return turn(2, u * 2 * kPi, -1 + 4 * v); });
    expect_formula(MadeQuadric(Kind::Disk, {1, 2, -360}),
                   [](float u, float v) { return turn(2 * (1 - v), -u * 2 * kPi, 1); });
}

TEST(Quadrics, HyperboloidParaboloidTorus) {
    expect_formula(MadeQuadric(Kind::Hyperboloid, {1, 0, -1, 0.5f, 2, 2, 200}), [](float u, float v) {
        const V3f p = V3f(1, 0, -1) + (V3f(0.5f, 2, 2) - V3f(1, 0, -1)) * v;
        const float c = std::cos(u * 200 * kPi / 180), s = std::sin(u * 200 * kPi / 180);
        return V3f(p.x * c - p.y * s, p.x * s + p.y * c, p.z);
    });
    expect_formula(MadeQuadric(Kind::Paraboloid, {2, 0.5f, 3, 360}), [](float u, float v) {
        const float z = 0.5f + 2.5f * v;
        return turn(2 * std::sqrt(z / 3), u * 2 * kPi, z);
    });
    expect_formula(MadeQuadric(Kind::Torus, {2, 0.5f, 30, 300, 90}), [](float u, float v) {
        const float phi = (30 + 270 * v) * kPi / 180;
        return turn(2 + 0.5f * std::cos(phi), u * kPi / 2, 0.5f * std::sin(phi));
    });
}

/// Each kind, whole and in part, with poles and without.
const auto all_quadrics = [](auto&& f) {
    f(MadeQuadric(Kind::Sphere, {2, -2, 2, 360}));
    f(MadeQuadric(Kind::Sphere, {2, -1, 2, -70}));
    f(MadeQuadric(Kind::Cone, {3, 2, 360}));
    f(MadeQuadric(Kind::Cylinder, {2, -1, 3, 100}));
    f(MadeQuadric(Kind::Hyperboloid, {1, 0, -1, 0.5f, 2, 2, 360}));
    f(MadeQuadric(Kind::Hyperboloid, {0, 0, -1, 0.5f, 2, 2, 360}));
    f(MadeQuadric(Kind::Paraboloid, {2, 0, 3, 360}));
    f(MadeQuadric(Kind::Disk, {1, 2, 300}));
    f(MadeQuadric(Kind::Torus, {2, 0.5f, 0, 360, 360}));
    f(MadeQuadric(Kind::Torus, {2, 0.5f, 30, 300, -90}));
};

TEST(Quadrics, DerivativesAreThoseOfPositions) {
    all_quadrics([](const MadeQuadric& made) {
        constexpr float h = 1e-2f;
        for (int face = 0; face < made.surface->face_count(); ++face)
            for (const V2f& uv : {V2f(0.3f, 0.4f), V2f(0.8f, 0.55f)}) {
                const auto p = made.at(face, uv);
                const V3f du = (made.at(face, uv + V2f(h, 0)).P - made.at(face, uv - V2f(h, 0)).P) / (2 * h);
                const V3f dv = (made.at(face, uv + V2f(0, h)).P - made.at(face, uv - V2f(0, h)).P) / (2 * h);
                expect_near(p.dPdu, du, 2e-3f);
                expect_near(p.dPdv, dv, 2e-3f);
            }
    });
}

TEST(Quadrics, BoundsHoldTheSurfaceAndAreTight) {
    all_quadrics([](const MadeQuadric& made) {
        for (int face = 0; face < made.surface->face_count(); ++face)
            for (const V2f& lo : {V2f(0, 0), V2f(0.25f, 0.5f), V2f(0.5f, 0.875f)}) {
                const V2f hi = lo + V2f(0.125f, 0.125f);
                const Box3f box = made.surface->bound(face, lo, hi, 0);
                Box3f sampled;
                for (int j = 0; j <= 10; ++j)
                    for (int i = 0; i <= 10; ++i) {
                        const V3f P = made.at(face, lo + (hi - lo) * V2f(0.1f * i, 0.1f * j)).P;
                        sampled.extendBy(P);
                        EXPECT_TRUE(box.intersects(P)) << P << " outside " << box.min << box.max;
                    }
                EXPECT_LT(box.size().length(), 2.5f * sampled.size().length() + 0.1f);
            }
    });
}

/// Both sides of each edge, and the corners, are where the edge's line and the vertices say.
void expect_sides_on_edges(const Surface& surface, float tolerance) {
    const auto point = [&](int face, V2f uv) {
        V3f P;
        surface.evaluate(face, {&uv, 1}, 0, nullptr, {&P, 1}, {}, {});
        return P;
    };
    for (int face = 0; face < surface.face_count(); ++face) {
        const auto sides = surface.sides(face);
        const V2f from[4] = {{0, 0}, {1, 0}, {0, 1}, {0, 0}}, to[4] = {{1, 0}, {1, 1}, {1, 1}, {0, 1}};
        for (int s = 0; s < 4; ++s) {
            const EdgeLine line = surface.edge(sides[s].edge);
            for (const float t : {0.0f, 0.3f, 1.0f}) {
                const float p = sides[s].begin + (sides[s].end - sides[s].begin) * t;
                expect_near(point(face, from[s] + (to[s] - from[s]) * t),
                            point(line.face, line.from + (line.to - line.from) * p), tolerance);
            }
            for (const auto& [end, t] : {std::pair{line.start, 0.0f}, std::pair{line.finish, 1.0f}}) {
                ASSERT_FALSE(end.on_edge);
                const SurfacePoint vertex = surface.vertex(end.id);
                expect_near(point(vertex.face, vertex.uv),
                            point(line.face, line.from + (line.to - line.from) * t), tolerance);
            }
        }
    }
}

TEST(Quadrics, FacesMeetAtTheirEdges) {
    all_quadrics([](const MadeQuadric& made) { expect_sides_on_edges(*made.surface, 4e-6f); });
}

/// V - E + F, without pole edges, which are points.
int euler_number(const Surface& surface) {
    int edges = 0;
    std::vector<bool> used(surface.vertex_count());
    for (uint32_t e = 0; e < surface.edge_count(); ++e) {
        const EdgeLine line = surface.edge(e);
        used[line.start.id] = used[line.finish.id] = true;
        edges += line.start.id != line.finish.id;
    }
    return static_cast<int>(std::count(used.begin(), used.end(), true)) - edges + surface.face_count();
}

TEST(Quadrics, CloseAsTheyShould) {
    EXPECT_EQ(euler_number(*MadeQuadric(Kind::Sphere, {1, -1, 1, 360}).surface), 2);
    EXPECT_EQ(euler_number(*MadeQuadric(Kind::Sphere, {1, -1, 1, -360}).surface), 2);
    EXPECT_EQ(euler_number(*MadeQuadric(Kind::Sphere, {1, -1, 0.5f, 360}).surface), 1);  // a disk
    EXPECT_EQ(euler_number(*MadeQuadric(Kind::Torus, {2, 1, 0, 360, 360}).surface), 0);
    EXPECT_EQ(euler_number(*MadeQuadric(Kind::Torus, {2, 1, 0, 180, 360}).surface), 0);  // a tube
    EXPECT_EQ(euler_number(*MadeQuadric(Kind::Torus, {2, 1, 0, 180, 90}).surface), 1);
    EXPECT_EQ(euler_number(*MadeQuadric(Kind::Cone, {2, 1, 360}).surface), 1);
    EXPECT_EQ(euler_number(*MadeQuadric(Kind::Cylinder, {2, 0, 1, 360}).surface), 0);
}

TEST(Quadrics, PoleIsOneExactPoint) {
    const MadeQuadric made(Kind::Sphere, {1.7f, -1.7f, 1.7f, 360});
    for (float u = 0; u <= 1; u += 0.1f) {
        const V3f top = made.at_quadric(u, 1).P;
        EXPECT_EQ(top.x, 0);
        EXPECT_EQ(top.y, 0);
        EXPECT_FLOAT_EQ(top.z, 1.7f);
    }
}

TEST(Quadrics, VariablesAreBilinear) {
    MadeQuadric made(Kind::Cylinder, {1, 0, 1, 360});
    ParameterList variables;
    variables.set(testing::parameter("heat", StorageClass::Varying, ValueType::Float, {0, 1, 10, 11}));
    variables.set(testing::parameter("Cs", StorageClass::Constant, ValueType::Color, {0.1f, 0.2f, 0.3f}));
    made.primitive.shape_keys = {
        testing::shape_of(testing::quadric(Kind::Cylinder, {1, 0, 1, 360}), variables)};
    auto attributes = std::make_shared<Attributes>();
    attributes->texture_coordinates = {0, 1, 2, 1, 0, 5, 2, 5};
    made.primitive.attributes = attributes;
    made.surface = make_surface(made.primitive, made.diagnostics);
    ShadingGrid grid;
    grid.shape = {1, 0};
    for (auto* values : {&grid.u, &grid.v, &grid.s, &grid.t}) values->resize(2);
    grid.Cs.resize(2);
    const V2f uv[2] = {{0.5f, 0.25f}, {1, 1}};
    EXPECT_FALSE(made.surface->evaluate_variables(2, uv, nullptr, grid));  // third quarter
    EXPECT_FLOAT_EQ(grid.u[0], 0.625f);
    EXPECT_FLOAT_EQ(grid.v[0], 0.25f);
    EXPECT_FLOAT_EQ(grid.s[0], 1.25f);
    EXPECT_FLOAT_EQ(grid.t[0], 2);
    EXPECT_FLOAT_EQ(grid.Cs.at(1).y, 0.2f);
    ASSERT_NE(grid.find("heat"), nullptr);
    EXPECT_FLOAT_EQ(grid.find("heat")->planes[0][0], 3.125f);
    EXPECT_FLOAT_EQ(grid.find("heat")->planes[0][1], 10.75f);
    EXPECT_EQ(grid.find("Cs"), nullptr);
}

}  // namespace
}  // namespace trapeze
