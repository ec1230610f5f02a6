/// NURBS patches: any knots reproduce the plane, rational ones are round, variables of all classes, bounds;
/// and those that close, by knots or in poles, have no holes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "tessellate/dicing_harness.h"
#include "tessellate/leak_harness.h"
#include "tessellate/surfaces/forms_harness.h"

namespace trapeze {
namespace {

using testing::kPi;
using testing::parameter;

struct Direction {
    int points, order;
    std::vector<float> knots;
    float begin, end;
};

NuPatch patch_of(const Direction& u, const Direction& v) {
    NuPatch p;
    p.nu = u.points, p.u_order = u.order, p.u_knots = u.knots, p.u_begin = u.begin, p.u_end = u.end;
    p.nv = v.points, p.v_order = v.order, p.v_knots = v.knots, p.v_begin = v.begin, p.v_end = v.end;
    return p;
}

struct MadePatch {
    Primitive primitive;
    Diagnostics diagnostics;
    std::shared_ptr<Attributes> attributes = std::make_shared<Attributes>();
    std::unique_ptr<Surface> surface;

    MadePatch(const NuPatch& patch, std::vector<Parameter> variables) {
        ParameterList list;
        for (Parameter& variable : variables) list.set(std::move(variable));
        primitive.attributes = attributes;
        primitive.shape_keys = {testing::shape_of(patch, std::move(list))};
        primitive.camera_from_object = {M44f()};
        surface = make_surface(primitive, diagnostics);
    }
    struct Point {
        V3f P, dPdu, dPdv;
        V2f uv;  ///< the grid's
    };
    Point at(int face, V2f uv) const {
        Point p;
        surface->evaluate(face, {&uv, 1}, 0, nullptr, {&p.P, 1}, {&p.dPdu, 1}, {&p.dPdv, 1});
        const ShadingGrid grid = variables(face, {uv});
        p.uv = {grid.u[0], grid.v[0]};
        const V2f faces = surface->faces_per_unit(face);
        p.dPdu *= faces.x, p.dPdv *= faces.y;
        return p;
    }
    ShadingGrid variables(int face, std::vector<V2f> uv) const {
        ShadingGrid grid;
        grid.shape = {static_cast<uint8_t>(uv.size() - 1), 0};
        for (std::vector<float>* values : {&grid.u, &grid.v, &grid.s, &grid.t}) values->resize(uv.size());
        for (Triples* t : {&grid.N, &grid.Cs, &grid.Os}) t->resize(uv.size());
        surface->evaluate_variables(face, uv, nullptr, grid);
        return grid;
    }
};

Parameter points_of_net(std::vector<float> floats) {
    return parameter("P", StorageClass::Vertex, ValueType::Point, std::move(floats));
}
Parameter weighted(std::vector<float> floats) {
    return parameter("Pw", StorageClass::Vertex, ValueType::HPoint, std::move(floats));
}

/// Control point i of a spline that is the identity: the mean of the knots within its support.
std::vector<double> greville(const Direction& d) {
    std::vector<double> mean;
    for (int i = 0; i < d.points; ++i) {
        double sum = 0;
        for (int k = 1; k < d.order; ++k) sum += static_cast<double>(d.knots[i + k]);
        mean.push_back(sum / (d.order - 1));
    }
    return mean;
}

/// Any knots reproduce linear functions (Marsden's identity): position and derivatives are known.
TEST(NuPatches, EveryKnotVectorReproducesThePlane) {
    const Direction rows[] = {
        {4, 4, {0, 0, 0, 0, 1, 1, 1, 1}, 0, 1},
        {6, 4, {-3, -1, 0, 2, 2.5f, 4, 5, 7, 7.5f, 9}, 2, 5},  // neither clamped nor even
        {7, 4, {0, 0, 0, 0, 1, 1, 3, 4, 4, 4, 4}, 0, 4},       // a double knot
        {5, 2, {0, 0, 1, 2, 2, 3, 3}, 0.5f, 2.75f},            // lines, a part of the range
        {12, 9, {0, 0, 0, 0, 0, 0, 0, 0, 0, .25f, .5f, .75f, 1, 1, 1, 1, 1, 1, 1, 1, 1}, .1f, .9f},
        {32,
         32,
         {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
          1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1},
         0,
         1},
    };
    for (const Direction& u : rows)
        for (const Direction& v : rows) {
            std::vector<float> p;
            const std::vector<double> x = greville(u), y = greville(v);
            for (int j = 0; j < v.points; ++j)
                for (int i = 0; i < u.points; ++i) {
                    p.push_back(static_cast<float>(x[i]));
                    p.push_back(static_cast<float>(y[j]));
                    p.push_back(static_cast<float>(2 * x[i] - 3 * y[j]));
                }
            const MadePatch made(patch_of(u, v), {points_of_net(std::move(p))});
            for (int face = 0; face < made.surface->face_count(); ++face)
                for (const V2f& uv : {V2f(0, 0), V2f(0.3f, 0.7f), V2f(1, 1)}) {
                    const MadePatch::Point at = made.at(face, uv);
                    EXPECT_NEAR(at.P.x, at.uv.x, 1e-5f);
                    EXPECT_NEAR(at.P.y, at.uv.y, 1e-5f);
                    EXPECT_NEAR(at.P.z, 2 * at.P.x - 3 * at.P.y, 3e-5f);
                    EXPECT_NEAR(at.dPdu.x, 1, 1e-4f);
                    EXPECT_NEAR(at.dPdu.y, 0, 1e-4f);
                    EXPECT_NEAR(at.dPdv.y, 1, 1e-4f);
                    EXPECT_NEAR(at.dPdv.z, -3, 3e-4f);
                }
        }
}

/// A full circle of four rational quarters, about z.
const Direction kCircle{9, 3, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, 0, 4};

struct Node {
    float x, y, w;
};

std::vector<Node> circle() {
    const float d = std::sqrt(0.5f);
    return {{1, 0, 1},   {1, 1, d},  {0, 1, 1},  {-1, 1, d}, {-1, 0, 1},
            {-1, -1, d}, {0, -1, 1}, {1, -1, d}, {1, 0, 1}};
}

/// The circle turned about z: radius and height of the profile's points with their weights.
MadePatch revolved(const Direction& profile, const std::vector<Node>& radius_height) {
    std::vector<float> pw;
    for (const Node& p : radius_height)
        for (const Node& c : circle()) {
            const float w = c.w * p.w;
            pw.insert(pw.end(), {c.x * p.x * w, c.y * p.x * w, p.y * w, w});
        }
    return {patch_of(kCircle, profile), {weighted(std::move(pw))}};
}

std::vector<Node> half_circle() {  // of a sphere, from pole to pole
    const float d = std::sqrt(0.5f);
    return {{0, -1, 1}, {1, -1, d}, {1, 0, 1}, {1, 1, d}, {0, 1, 1}};
}
const Direction kHalfCircle{5, 3, {0, 0, 0, 1, 1, 2, 2, 2}, 0, 2};

std::vector<Node> tube() {  // of a torus
    std::vector<Node> nodes = circle();
    for (Node& n : nodes) n.x = 2 + 0.7f * n.x, n.y *= 0.7f;
    return nodes;
}

TEST(NuPatches, RationalSphereIsRound) {
    const MadePatch sphere = revolved(kHalfCircle, half_circle());
    ASSERT_EQ(sphere.surface->face_count(), 8);
    for (int face = 0; face < 8; ++face)
        for (int i = 0; i < 20; ++i) {
            const V2f uv(unit_float(hash(face, i, 1)), unit_float(hash(face, i, 2)));
            const MadePatch::Point p = sphere.at(face, uv);
            EXPECT_NEAR(p.P.length(), 1, 2e-7f);
            EXPECT_NEAR(p.P.dot(p.dPdu), 0, 1e-5f);
            EXPECT_NEAR(p.P.dot(p.dPdv), 0, 1e-5f);
            EXPECT_GT(p.dPdu.cross(p.dPdv).dot(p.P), 0);
            // Central differences, away from the face's ends.
            constexpr float h = 0.01f;
            const V2f middle = V2f(0.1f, 0.1f) + uv * 0.8f;
            const MadePatch::Point at = sphere.at(face, middle);
            const MadePatch::Point left = sphere.at(face, middle - V2f(h, 0)),
                                   right = sphere.at(face, middle + V2f(h, 0)),
                                   below = sphere.at(face, middle - V2f(0, h)),
                                   above = sphere.at(face, middle + V2f(0, h));
            const V3f by_u = (right.P - left.P) / (right.uv.x - left.uv.x);
            const V3f by_v = (above.P - below.P) / (above.uv.y - below.uv.y);
            EXPECT_LT((by_u - at.dPdu).length(), 2e-3f * at.dPdu.length());
            EXPECT_LT((by_v - at.dPdv).length(), 2e-3f * at.dPdv.length());
        }
}

TEST(NuPatches, RangesWithinTheKnotsAreParts) {
    NuPatch whole = patch_of({6, 4, {0, 0, 0, 0, 1, 2, 3, 3, 3, 3}, 0, 3}, {3, 3, {0, 0, 0, 1, 1, 1}, 0, 1});
    NuPatch part = whole;
    part.u_begin = 0.5f, part.u_end = 2.25f, part.v_begin = 0.25f, part.v_end = 0.75f;
    std::vector<float> p;
    for (uint32_t i = 0; i < 54; ++i) p.push_back(unit_float(hash(i, 4)));
    const MadePatch a(whole, {points_of_net(p)}), b(part, {points_of_net(p)});
    ASSERT_EQ(a.surface->face_count(), 3);
    ASSERT_EQ(b.surface->face_count(), 3);
    EXPECT_LT((a.at(0, {0.5f, 0.25f}).P - b.at(0, {0, 0}).P).length(), 1e-6f);
    EXPECT_LT((a.at(1, {0.5f, 0.5f}).P - b.at(1, {0.5f, 0.5f}).P).length(), 1e-6f);
    EXPECT_LT((a.at(2, {0.25f, 0.75f}).P - b.at(2, {1, 1}).P).length(), 1e-6f);
    EXPECT_EQ(b.at(0, {0, 0}).uv, V2f(0.5f, 0.25f));
    EXPECT_EQ(b.at(2, {1, 1}).uv, V2f(2.25f, 0.75f));
}

TEST(NuPatches, VariablesOfEveryClass) {
    // Segments along u: 0..1, an empty one, 1..2.
    const NuPatch patch = patch_of({4, 2, {0, 0, 1, 1, 2, 2}, 0, 2}, {2, 2, {0, 0, 1, 1}, 0, 1});
    const MadePatch made(
        patch,
        {points_of_net(std::vector<float>(24, 1)),
         parameter("c", StorageClass::Constant, ValueType::Float, {9}),
         parameter("m", StorageClass::Uniform, ValueType::Float, {4, 5, 6}),
         parameter("y", StorageClass::Varying, ValueType::Float, {0, 10, 20, 30, 1, 11, 21, 31}),
         parameter("x", StorageClass::Vertex, ValueType::Float, {0, 1, 2, 3, 4, 5, 6, 7}),
         parameter("f", StorageClass::FaceVarying, ValueType::Float, {0, 0, 0, 0, 1, 1, 1, 1, 2, 4, 6, 8})});
    ASSERT_EQ(made.surface->face_count(), 2);
    const ShadingGrid grid = made.variables(1, {{0, 0}, {0.5f, 0.5f}, {1, 1}});
    const auto value = [&](size_t variable, size_t i) {
        const GridVariable& v = grid.variables[variable];
        return v.planes[0][v.uniform ? 0 : i];
    };
    EXPECT_EQ(value(0, 0), 9);
    EXPECT_EQ(value(1, 0), 6);
    EXPECT_FLOAT_EQ(value(2, 0), 20);
    EXPECT_FLOAT_EQ(value(2, 1), 25.5f);
    EXPECT_FLOAT_EQ(value(2, 2), 31);
    EXPECT_FLOAT_EQ(value(3, 1), 4.5f);
    EXPECT_FLOAT_EQ(value(4, 1), 5);
    EXPECT_FLOAT_EQ(grid.u[0], 1);  // the knots'
    EXPECT_FLOAT_EQ(grid.u[2], 2);
    EXPECT_FLOAT_EQ(grid.s[0], 0.5f);  // the unit square's
    EXPECT_FLOAT_EQ(grid.s[2], 1);
}

TEST(NuPatches, BoundsHoldTheSurface) {
    const MadePatch sphere = revolved(kHalfCircle, half_circle());
    for (int face = 0; face < 8; ++face) {
        const V2f lo(0.25f, 0.5f), hi(0.5f, 1);
        const Box3f box = sphere.surface->bound(face, lo, hi, 0);
        ASSERT_FALSE(box.isEmpty());
        EXPECT_LT(box.size().length(), 1.2f);  // of the part, not of the whole
        for (int i = 0; i < 50; ++i) {
            const V2f share(unit_float(hash(face, i, 1)), unit_float(hash(face, i, 2)));
            const V3f p = sphere.at(face, lo + (hi - lo) * share).P;
            for (int k = 0; k < 3; ++k) {
                EXPECT_GE(p[k], box.min[k] - 1e-6f);
                EXPECT_LE(p[k], box.max[k] + 1e-6f);
            }
        }
    }
}

void expect_closed(const testing::LeakCount& count) {
    EXPECT_EQ(count.leaks, 0);
    EXPECT_EQ(count.wrong_sides, 0);
    EXPECT_EQ(count.open_sides, 0u);
    EXPECT_GE(count.hits, count.rays);
}

M44f turned(float angle, const V3f& place) {
    M44f m, move;
    m.rotate(V3f(angle, 0.5f * angle, 0.3f));
    move.setTranslation(place);
    return m * move;
}

TEST(NuPatches, ClosedOnesHaveNoHoles) {
    const std::vector<M44f> places{turned(0.2f, {0.1f, 0.2f, 1.3f}), turned(0.5f, {0.3f, 0.2f, 1.3f})};
    const MadePatch sphere = revolved(kHalfCircle, half_circle());
    testing::TestScene round;
    round.keep_all().add({sphere.primitive.shape_keys}, places);
    expect_closed(testing::count_leaks(
        round, [](uint32_t, float t) { return V3f(0.1f + 0.2f * t, 0.2f, 1.3f); }, 200'000));

    const MadePatch torus = revolved(kCircle, tube());
    testing::TestScene ring;
    ring.keep_all().add(torus.primitive.shape_keys, {places[0]});
    const V3f inside = V3f(0, 2, 0) * places[0];
    expect_closed(testing::count_leaks(
        ring, [&](uint32_t, float) { return inside; }, 200'000));
}

/// Closed by its knots: the last three control points are the first three.
TEST(NuPatches, PeriodicKnotsClose) {
    std::vector<float> p;
    for (int j = 0; j < 7; ++j)
        for (int i = 0; i < 8; ++i) {
            const float a = 2 * kPi * static_cast<float>(i % 5) / 5;
            const float b = 2 * kPi * static_cast<float>(j % 4) / 4;
            const float r = 2 + std::cos(b);
            p.insert(p.end(), {r * std::cos(a), r * std::sin(a), std::sin(b)});
        }
    const Direction u{8, 4, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, 3, 8};
    const Direction v{7, 4, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 3, 7};
    const MadePatch made(patch_of(u, v), {points_of_net(std::move(p))});
    ASSERT_EQ(made.surface->face_count(), 20);
    ASSERT_EQ(made.surface->vertex_count(), 20u);
    testing::TestScene scene;
    scene.keep_all().add(made.primitive.shape_keys, {testing::translation(0, 0, 3)});
    expect_closed(testing::count_leaks(
        scene, [](uint32_t, float) { return V3f(0, 2, 3); }, 200'000));
}

/// Poles at the ends of u.
TEST(NuPatches, PolesAlongUClose) {
    NuPatch patch = patch_of(kHalfCircle, kCircle);
    std::vector<float> pw;
    for (const Node& c : circle())
        for (const Node& p : half_circle()) {
            const float w = c.w * p.w;
            pw.insert(pw.end(), {c.x * p.x * w, c.y * p.x * w, p.y * w, w});
        }
    const MadePatch made(patch, {weighted(std::move(pw))});
    testing::TestScene scene;
    scene.keep_all().add(made.primitive.shape_keys, {testing::translation(0.2f, 0, 1.2f)});
    expect_closed(testing::count_leaks(
        scene, [](uint32_t, float) { return V3f(0.2f, 0, 1.2f); }, 200'000));
}

}  // namespace
}  // namespace trapeze
