/// Curves as ribbons: centre lines by their bases, directions across, joints without gaps, bounds, variables.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/random.h"
#include "tessellate/dicing_harness.h"
#include "tessellate/surfaces/forms_harness.h"

namespace trapeze {
namespace {

using testing::expect_near;
using testing::kBezier;
using testing::kBSpline;
using testing::kCatmullRom;
using testing::parameter;

/// Curves of so many control points each; linear(): lines.
Curves cubic(std::vector<int> counts, const M44f& basis, int step, bool periodic = false) {
    Curves curves;
    curves.cubic = true;
    curves.periodic = periodic;
    curves.vertices_per_curve = std::move(counts);
    curves.basis = basis, curves.step = step;
    return curves;
}

Curves linear(std::vector<int> counts, bool periodic = false) {
    Curves curves;
    curves.periodic = periodic;
    curves.vertices_per_curve = std::move(counts);
    return curves;
}

Parameter points(std::vector<float> floats) {
    return parameter("P", StorageClass::Vertex, ValueType::Point, std::move(floats));
}

std::vector<float> random_points(int count, uint32_t seed) {
    std::vector<float> values;
    for (int i = 0; i < 3 * count; ++i)
        values.push_back(2 * unit_float(hash(seed, static_cast<uint32_t>(i))) - 1);
    return values;
}

struct MadeCurves {
    Primitive primitive;
    Diagnostics diagnostics;
    std::shared_ptr<Attributes> attributes = std::make_shared<Attributes>();
    std::unique_ptr<Surface> surface;

    MadeCurves(const Curves& curves, std::vector<Parameter> variables,
               std::vector<M44f> camera_from_object = {testing::translation(0, 0, 6)},
               const Camera* camera = nullptr) {
        ParameterList list;
        for (Parameter& variable : variables) list.set(std::move(variable));
        primitive.attributes = attributes;
        primitive.shape_keys = {testing::shape_of(curves, std::move(list))};
        primitive.camera_from_object = camera_from_object;
        surface = make_surface(primitive, diagnostics, {camera, nullptr});
    }
    struct Point {
        V3f P, dPdu, dPdv;
    };
    Point at(int face, V2f uv, int key = 0) const {
        Point p;
        surface->evaluate(face, {&uv, 1}, key, nullptr, {&p.P, 1}, {&p.dPdu, 1}, {&p.dPdv, 1});
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

/// Control point i of packed floats.
V3f control(const std::vector<float>& p, int i) {
    return {p[3 * i], p[3 * i + 1], p[3 * i + 2]};
}

/// RISpec's [t^3 t^2 t 1] * basis * points.
V3f on_curve(const M44f& basis, const std::vector<float>& p, int first, float t) {
    V3f sum(0, 0, 0);
    const float powers[4] = {t * t * t, t * t, t, 1};
    for (int i = 0; i < 4; ++i)
        for (int r = 0; r < 4; ++r) sum += control(p, first + i) * (powers[r] * basis[r][i]);
    return sum;
}

TEST(Curves, CentreLinesAreThoseOfTheirBasis) {
    struct {
        M44f basis;
        int step, points, segments, faces;
    } const rows[] = {{kBezier, 3, 10, 3, 3}, {kBSpline, 1, 10, 7, 2}, {kCatmullRom, 1, 4, 1, 1}};
    for (const auto& row : rows) {
        const std::vector<float> p = random_points(row.points, 5);
        const MadeCurves made(cubic({row.points}, row.basis, row.step), {points(p)});
        ASSERT_EQ(made.surface->face_count(), row.faces);
        for (int s = 0; s < row.segments; ++s)
            for (const float t : {0.01f, 0.3f, 0.75f}) {
                const float along = (static_cast<float>(s) + t) / static_cast<float>(row.segments);
                // The face whose v range holds it, by the grid's own v.
                for (int f = 0; f < row.faces; ++f) {
                    const ShadingGrid g = made.variables(f, {{0.5f, 0}, {0.5f, 1}});
                    if (along < g.v[0] || along > g.v[1]) continue;
                    const float v = (along - g.v[0]) / (g.v[1] - g.v[0]);
                    const MadeCurves::Point point = made.at(f, {0.5f, v});
                    expect_near(point.P, on_curve(row.basis, p, s * row.step, t), 2e-5f);
                    const float h = 1e-3f;
                    const V3f by_t = (on_curve(row.basis, p, s * row.step, t + h) -
                                      on_curve(row.basis, p, s * row.step, t - h)) *
                                     (static_cast<float>(row.segments) / (2 * h));
                    expect_near(point.dPdv * made.surface->faces_per_unit(f).y, by_t, 5e-3f * by_t.length());
                }
            }
    }
}

TEST(Curves, RibbonsWithoutNormalsFaceTheCamera) {
    Camera orthographic;
    orthographic.perspective = false;
    M44f mirrored = testing::translation(0.5f, 1, 7);
    mirrored[0][0] = -2;  // mirrored and stretched
    for (const Camera* camera :
         {static_cast<const Camera*>(nullptr), const_cast<const Camera*>(&orthographic)})
        for (const M44f& place : {testing::translation(1, 2, 6), mirrored}) {
            const MadeCurves made(cubic({4}, kBezier, 3),
                                  {points({-1, 0, 0, 0, 1, 0.5f, 1, -1, 0, 2, 1, 1}),
                                   parameter("width", StorageClass::Varying, ValueType::Float, {0.2f, 0.6f})},
                                  {place}, camera);
            for (const float v : {0.0f, 0.25f, 0.5f, 1.0f}) {
                const MadeCurves::Point p = made.at(0, {0.5f, v});
                EXPECT_NEAR(p.dPdu.length(), 0.2f + 0.4f * v, 1e-6f);  // in object space
                V3f across, along, centre;
                place.multDirMatrix(p.dPdu, across);
                place.multDirMatrix(p.dPdv, along);
                place.multVecMatrix(p.P, centre);
                const V3f ray = camera ? V3f(0, 0, 1) : centre;
                EXPECT_NEAR(across.dot(ray) / (across.length() * ray.length()), 0, 1e-6f);
                if (v == 0.25f) continue;
                // The tangent apart from the width's change along it.
                EXPECT_NEAR(across.dot(along) / (across.length() * along.length()), 0, 1e-5f);
                const float towards_viewer = -across.cross(along).dot(ray);
                EXPECT_GT(towards_viewer * static_cast<float>(M44d(place).determinant()), 0);
            }
            expect_near(made.at(0, {1, 0.5f}).P - made.at(0, {0, 0.5f}).P, made.at(0, {0.5f, 0.5f}).dPdu,
                        1e-6f);
        }
}

TEST(Curves, EveryMotionKeyFacesTheCameraByItself) {
    M44f turned;
    turned.rotate(V3f(0, 1.2f, 0));
    const std::vector<M44f> keys{testing::translation(0, 0, 6), turned * testing::translation(2, 0, 6),
                                 testing::translation(4, 0, 6)};
    const MadeCurves made(linear({2}), {points({0, -1, 0, 0, 1, 0})}, keys);
    ASSERT_TRUE(made.surface->has_motion_keys());
    for (int key = 0; key < 3; ++key) {
        V3f across, centre;
        const MadeCurves::Point p = made.at(0, {0.5f, 0.5f}, key);
        keys[key].multDirMatrix(p.dPdu, across);
        keys[key].multVecMatrix(p.P, centre);
        EXPECT_NEAR(across.length(), 1, 1e-5f);  // the default width
        // Ends have directions of their own: between them to the first order.
        EXPECT_NEAR(across.dot(centre) / centre.length(), 0, 1e-5f);
    }
}

TEST(Curves, RibbonsLieAcrossTheirNormals) {
    const MadeCurves made(cubic({4}, kBezier, 3),
                          {points({0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}),
                           parameter("N", StorageClass::Varying, ValueType::Normal, {0, 0, 1, 0, 1, 1}),
                           parameter("constantwidth", StorageClass::Constant, ValueType::Float, {0.5f})});
    const MadeCurves::Point start = made.at(0, {0.5f, 0}), end = made.at(0, {0.5f, 1});
    expect_near(start.dPdu, V3f(0, -0.5f, 0), 1e-6f);
    expect_near(start.dPdu.cross(start.dPdv).normalized(), V3f(0, 0, 1), 1e-6f);
    expect_near(end.dPdu.cross(end.dPdv).normalized(), V3f(0, 1, 1).normalized(), 1e-6f);
    const ShadingGrid grid = made.variables(0, {{0, 0}, {0, 1}});
    expect_near(grid.N.at(1), V3f(0, 1, 1), 1e-6f);
}

TEST(Curves, VariablesOfEveryClass) {
    const MadeCurves made(
        cubic({4, 7}, kBezier, 3),
        {points(random_points(11, 3)), parameter("c", StorageClass::Constant, ValueType::Float, {9}),
         parameter("u", StorageClass::Uniform, ValueType::Float, {4, 5}),
         parameter("y", StorageClass::Varying, ValueType::Float, {0, 1, 10, 20, 40}),
         parameter("x", StorageClass::Vertex, ValueType::Float, {0, 0, 0, 0, 0, 0, 0, 8, 8, 8, 8})});
    ASSERT_EQ(made.surface->face_count(), 3);
    const ShadingGrid grid = made.variables(2, {{0, 0}, {0.5f, 0.5f}, {1, 1}});
    const auto value = [&](size_t variable, size_t i) {
        const GridVariable& v = grid.variables[variable];
        return v.planes[0][v.uniform ? 0 : i];
    };
    EXPECT_EQ(value(0, 0), 9);
    EXPECT_EQ(value(1, 0), 5);
    EXPECT_FLOAT_EQ(value(2, 0), 20);
    EXPECT_FLOAT_EQ(value(2, 1), 30);
    EXPECT_FLOAT_EQ(value(2, 2), 40);
    EXPECT_FLOAT_EQ(value(3, 1), 8);
    EXPECT_FLOAT_EQ(grid.v[1], 0.75f);
    EXPECT_FLOAT_EQ(grid.t[1], 0.75f);
    EXPECT_FLOAT_EQ(grid.u[2], 1);
}

/// Along the sides of a ribbon, the mitre is as wide as the lines.
TEST(Curves, LinesMeetInAMitre) {
    Camera orthographic;
    orthographic.perspective = false;
    const MadeCurves made(linear({3}), {points({0, 0, 0, 1, 0, 0, 1, 1, 0})}, {testing::translation(0, 0, 6)},
                          &orthographic);
    ASSERT_EQ(made.surface->face_count(), 2);
    for (const float u : {0.0f, 1.0f}) {
        const V3f joint = made.at(0, {u, 1}).P;
        expect_near(joint, made.at(1, {u, 0}).P, 1e-6f);
        EXPECT_NEAR(std::abs(joint.y), 0.5f, 1e-6f);      // half the width from the first line
        EXPECT_NEAR(std::abs(joint.x - 1), 0.5f, 1e-6f);  // and from the second
    }
}

TEST(Curves, BoundsHoldTheCurves) {
    const MadeCurves made(cubic({12}, kBSpline, 1, true),
                          {points(random_points(12, 8)),
                           parameter("width", StorageClass::Vertex, ValueType::Float,
                                     {.1f, .2f, .5f, .1f, .1f, .1f, .9f, .1f, .1f, .1f, .1f, 0})});
    ASSERT_EQ(made.surface->face_count(), 3);
    for (int face = 0; face < 3; ++face)
        for (const V2f& range : {V2f(0, 1), V2f(0.25f, 0.5f), V2f(0.5f, 0.75f)}) {
            const Box3f box = made.surface->bound(face, {0, range.x}, {1, range.y}, 0);
            for (int i = 0; i <= 20; ++i) {
                const float v = range.x + (range.y - range.x) * static_cast<float>(i) / 20;
                for (const float u : {0.0f, 1.0f}) {
                    const V3f p = made.at(face, {u, v}).P;
                    for (int k = 0; k < 3; ++k) {
                        EXPECT_GE(p[k], box.min[k] - 1e-5f);
                        EXPECT_LE(p[k], box.max[k] + 1e-5f);
                    }
                }
            }
        }
}

TEST(Curves, PointsInOnePlaceAndLinesOfSightAreSurvived) {
    const MadeCurves cubics(cubic({4, 4}, kBezier, 3), {points({0, 0, 0,  0, 0, 0, 0, 0, 0, 0, 0, 0,  //
                                                                0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 2})});
    const MadeCurves lines(linear({3, 3}), {points({0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0})});
    for (const MadeCurves* made : {&cubics, &lines})
        for (int face = 0; face < made->surface->face_count(); ++face)
            for (const float v : {0.0f, 0.5f, 1.0f}) {
                const MadeCurves::Point p = made->at(face, {0, v});
                EXPECT_TRUE(std::isfinite(p.P.length()) && std::isfinite(p.dPdu.length()));
                EXPECT_LE(p.dPdu.length(), 2.001f);
            }
}

/// Sides across a ribbon, by the bits of their ends, come twice but at the ends of curves.
size_t open_ends(const std::vector<Grid>& grids) {
    std::map<std::array<float, 6>, int> sides;
    for (const Grid& grid : grids)
        for (const int j : {0, static_cast<int>(grid.shape.nv)})
            for (int i = 0; i < grid.shape.nu; ++i) {
                const V3f a = grid.vertex_at_key(i, j, 0, 1), b = grid.vertex_at_key(i + 1, j, 0, 1);
                if (a != b) ++sides[{a.x, a.y, a.z, b.x, b.y, b.z}];
            }
    return static_cast<size_t>(std::ranges::count_if(sides, [](const auto& s) { return s.second % 2; }));
}

TEST(Curves, JointsHaveNoGaps) {
    for (const bool periodic : {false, true})
        for (const bool smooth : {false, true})
            for (const float width : {0.02f, 0.3f}) {
                testing::TestScene scene;
                ParameterList list;
                list.set(points(random_points(12, 21)));
                list.set(parameter("constantwidth", StorageClass::Constant, ValueType::Float, {width}));
                const Curves curves = smooth ? cubic({12}, kCatmullRom, 1, periodic) : linear({12}, periodic);
                scene.keep_all().add(testing::shape_of(curves, std::move(list)));
                const testing::DicedScene diced(scene);
                const size_t open = open_ends(diced.grids);
                if (periodic)
                    EXPECT_EQ(open, 0u);
                else if (width < 0.1f)
                    EXPECT_EQ(open, 2u);
                else
                    EXPECT_TRUE(open > 2 && open < 32) << open;
            }
}

/// Attribute "dice" "minlength": micropolygons of so many pixels along the curve at the least.
TEST(Curves, MicropolygonsHaveTheirLeastLength) {
    const auto count = [](float least) {
        testing::TestScene scene;
        scene.attributes->dice.min_length = least;
        ParameterList list;
        list.set(points({-1, 0, 0, -0.3f, 0, 0, 0.3f, 0, 0, 1, 0, 0}));
        list.set(parameter("constantwidth", StorageClass::Constant, ValueType::Float, {0.01f}));
        scene.keep_all().add(testing::shape_of(cubic({4}, kBezier, 3), std::move(list)));
        int micropolygons = 0;
        for (const Grid& grid : testing::DicedScene(scene).grids)
            micropolygons += grid.shape.micropolygon_count();
        return micropolygons;
    };
    const int fine = count(0), same = count(0.5f), coarse = count(4);
    EXPECT_EQ(same, fine);
    EXPECT_GT(fine, 12);
    EXPECT_NEAR(coarse, fine / 4.0, fine / 8.0);
}

TEST(Curves, ThinHairsAreOneMicropolygonWide) {
    testing::TestScene scene;
    ParameterList list;
    list.set(points({-1, -1, 0, -0.5f, 0, 0, 0.5f, 0, 0, 1, 1, 0}));
    list.set(parameter("constantwidth", StorageClass::Constant, ValueType::Float, {0.02f}));
    scene.keep_all().add(testing::shape_of(cubic({4}, kBezier, 3), std::move(list)));
    const testing::DicedScene diced(scene);
    ASSERT_GT(diced.grids.size(), 0u);
    for (const Grid& grid : diced.grids) EXPECT_EQ(grid.shape.nu, 1);
}

}  // namespace
}  // namespace trapeze
