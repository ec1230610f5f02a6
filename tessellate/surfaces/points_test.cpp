/// Points: disks that face the picture and cover the area of their circles at every size, and the other
/// types.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tessellate/dicing_harness.h"

namespace trapeze {
namespace {

using testing::parameter;
constexpr double kHalfTurnOfDiscs = std::numbers::pi;

Parameter places(std::vector<float> floats) {
    return parameter("P", StorageClass::Vertex, ValueType::Point, std::move(floats));
}

/// Points of one shape key; the first variable is P.
Primitive primitive_of(std::vector<Parameter> variables, std::vector<M44f> camera_from_object) {
    Points points;
    points.count = static_cast<int>(variables[0].floats.size() / 3);
    ParameterList list;
    for (Parameter& variable : variables) list.set(std::move(variable));
    Primitive primitive;
    primitive.attributes = std::make_shared<Attributes>();
    primitive.shape_keys = {testing::shape_of(points, std::move(list))};
    primitive.camera_from_object = camera_from_object;
    return primitive;
}

TEST(Points, AreDisksParallelToThePicture) {
    M44f place;
    place.rotate(V3f(0.4f, 0.9f, -0.2f));
    place = place * testing::translation(1, 2, 6);
    M44f mirrored = place;
    for (int k = 0; k < 3; ++k) mirrored[0][k] *= -1;
    for (const M44f& m : {place, mirrored}) {
        const Primitive primitive =
            primitive_of({places({0, 0, 0, 1, 2, 3}),
                          parameter("width", StorageClass::Varying, ValueType::Float, {1, 0.5f})},
                         {m});
        Diagnostics diagnostics;
        const auto surface = make_surface(primitive, diagnostics);
        ASSERT_EQ(surface->face_count(), 2);
        for (int face = 0; face < 2; ++face) {
            const float radius = face == 0 ? 0.5f : 0.25f;
            V3f centre;
            m.multVecMatrix(face == 0 ? V3f(0, 0, 0) : V3f(1, 2, 3), centre);
            for (const float u : {0.0f, 0.2f, 0.5f, 0.9f, 1.0f})
                for (const float v : {0.0f, 0.4f, 0.5f, 1.0f}) {
                    const V2f uv(u, v);
                    V3f P, du, dv, at, by_u, by_v;
                    surface->evaluate(face, {&uv, 1}, 0, nullptr, {&P, 1}, {&du, 1}, {&dv, 1});
                    m.multVecMatrix(P, at), m.multDirMatrix(du, by_u), m.multDirMatrix(dv, by_v);
                    // Squares about the middle become circles.
                    const float ring = 2 * std::max(std::abs(u - 0.5f), std::abs(v - 0.5f));
                    EXPECT_NEAR((at - centre).length(), radius * ring, 2e-6f);
                    EXPECT_NEAR(at.z, centre.z, 2e-6f);
                    // The map keeps areas: pi r^2 for the unit square; the viewer's side is outside.
                    const float area = by_u.cross(by_v).z;
                    const float sign = M44d(m).determinant() < 0 ? -1.0f : 1.0f;
                    EXPECT_NEAR(-sign * area, static_cast<float>(kHalfTurnOfDiscs) * radius * radius, 1e-5f);
                }
        }
    }
}

TEST(Points, DerivativesAreThoseOfTheDisk) {
    const Primitive primitive = primitive_of({places({0, 0, 0})}, {testing::translation(0, 0, 5)});
    Diagnostics diagnostics;
    const auto surface = make_surface(primitive, diagnostics);
    for (const V2f& uv : {V2f(0.9f, 0.3f), V2f(0.2f, 0.4f), V2f(0.4f, 0.8f), V2f(0.6f, 0.1f)}) {
        constexpr float h = 1e-3f;
        const V2f around[5] = {uv, uv - V2f(h, 0), uv + V2f(h, 0), uv - V2f(0, h), uv + V2f(0, h)};
        V3f P[5], du[5], dv[5];
        surface->evaluate(0, around, 0, nullptr, P, du, dv);
        EXPECT_LT(((P[2] - P[1]) / (2 * h) - du[0]).length(), 2e-4f);
        EXPECT_LT(((P[4] - P[3]) / (2 * h) - dv[0]).length(), 2e-4f);
    }
}

/// The area on the screen of what is diced, in pixels.
double diced_area(testing::TestScene& scene, size_t* micropolygons = nullptr) {
    const testing::DicedScene diced(scene);
    const Camera camera = make_camera(scene.scene.options);
    double area = 0;
    for (const Grid& grid : diced.grids)
        for (int v = 0; v < grid.shape.nv; ++v)
            for (int u = 0; u < grid.shape.nu; ++u) {
                V2f p[4];
                for (int i = 0; i < 4; ++i)
                    p[i] = camera.raster_from_camera(grid.vertex_at_key(u + (i & 1), v + (i >> 1), 0, 1));
                const V2f a = p[3] - p[0], b = p[2] - p[1];
                area += 0.5 * std::abs(static_cast<double>(a.x) * b.y - static_cast<double>(a.y) * b.x);
            }
    if (micropolygons) *micropolygons = static_cast<size_t>(diced.stats.micropolygons);
    return area;
}

TEST(Points, EverySizeCoversTheAreaOfItsCircle) {
    for (const double diameter : {0.1, 0.8, 1.1, 1.16, 1.2, 1.3, 1.9, 2.44, 2.5, 4.0, 7.0, 10.3, 30.0}) {
        testing::TestScene scene;
        const Camera camera = make_camera(scene.scene.options);
        const auto width = static_cast<float>(diameter) / camera.pixels_per_length(5).x;
        const Primitive primitive =
            primitive_of({places({0.1f, 0, 0}),
                          parameter("constantwidth", StorageClass::Constant, ValueType::Float, {width})},
                         {});
        scene.keep_all().add(primitive.shape_keys[0]);
        size_t micropolygons = 0;
        const double wanted = kHalfTurnOfDiscs / 4 * diameter * diameter;
        EXPECT_NEAR(diced_area(scene, &micropolygons), wanted, 0.03 * wanted) << diameter;
        if (diameter < 1.12) {
            EXPECT_EQ(micropolygons, 1u) << diameter;
        }
    }
}

TEST(Points, ThoseInTheEyesPlaneAreLeftOut) {
    testing::TestScene scene;
    const Primitive primitive =
        primitive_of({places({0, 0, -5, 0.2f, 0, -5.0000005f, 0, 0, -9, 0, 0, 0})}, {});
    scene.add(primitive.shape_keys[0]);
    const testing::DicedScene diced(scene);
    ASSERT_GT(diced.grids.size(), 0u);  // the last one's
    for (const Grid& grid : diced.grids) EXPECT_NEAR(grid.vertex_at_key(0, 0, 0, 1).z, 5, 1e-5f);
}

TEST(Points, MoveWithTheirWidths) {
    Points points;
    points.count = 1;
    std::vector<std::shared_ptr<const Shape>> keys;
    for (const float width : {1.0f, 3.0f}) {
        ParameterList list;
        list.set(places({width, 0, 0}));
        list.set(parameter("width", StorageClass::Varying, ValueType::Float, {width}));
        keys.push_back(testing::shape_of(points, std::move(list)));
    }
    Primitive primitive;
    primitive.attributes = std::make_shared<Attributes>();
    primitive.shape_keys = keys;
    primitive.camera_from_object = std::vector(5, testing::translation(0, 0, 9));
    Diagnostics diagnostics;
    const auto surface = make_surface(primitive, diagnostics);
    for (int key = 0; key < 5; ++key) {
        const V2f uv[2] = {{0, 0.5f}, {1, 0.5f}};
        V3f P[2];
        surface->evaluate(0, uv, key, nullptr, P, {}, {});
        const float width = 1 + 0.5f * static_cast<float>(key);
        EXPECT_NEAR(P[1].x - P[0].x, width, 1e-6f);
        EXPECT_NEAR(P[1].x + P[0].x, 2 * width, 1e-6f);
        const Box3f box = surface->bound(0, {0, 0}, {1, 1}, key);
        EXPECT_LE(box.min.x, P[0].x + 1e-6f);
        EXPECT_GE(box.max.x, P[1].x - 1e-6f);
    }
}

Parameter text(const std::string& name, const std::string& value) {
    Parameter parameter;
    parameter.name = name, parameter.declaration = {StorageClass::Uniform, ValueType::String, 1};
    parameter.strings = {value};
    return parameter;
}

TEST(Points, PicturesAreRectanglesTurnedByTheirAngle) {
    const Primitive primitive = primitive_of(
        {places({0, 0, 0, 3, 0, 0}), parameter("width", StorageClass::Varying, ValueType::Float, {2, 1}),
         parameter("patchangle", StorageClass::Varying, ValueType::Float, {0, 90}),
         parameter("patchaspectratio", StorageClass::Constant, ValueType::Float, {4}), text("type", "patch")},
        {testing::translation(0, 0, 9)});
    Diagnostics diagnostics;
    const auto surface = make_surface(primitive, diagnostics);
    const V2f corners[4] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    const V3f upright[4] = {{-1, 0.25f, 0}, {1, 0.25f, 0}, {-1, -0.25f, 0}, {1, -0.25f, 0}};
    const V3f turned[4] = {{2.875f, -0.5f, 0}, {2.875f, 0.5f, 0}, {3.125f, -0.5f, 0}, {3.125f, 0.5f, 0}};
    for (int face = 0; face < 2; ++face) {
        V3f P[4];
        surface->evaluate(face, corners, 0, nullptr, P, {}, {});
        const Box3f box = surface->bound(face, {0, 0}, {1, 1}, 0);
        for (int i = 0; i < 4; ++i) {
            EXPECT_LT((P[i] - (face == 0 ? upright : turned)[i]).length(), 1e-5f) << face << " " << i;
            for (int k = 0; k < 3; ++k) {
                EXPECT_LE(box.min[k], P[i][k] + 1e-5f);
                EXPECT_GE(box.max[k], P[i][k] - 1e-5f);
            }
        }
    }
}

TEST(Points, SpheresHaveASpheresNormals) {
    for (const char* type : {"particle", "blobby"}) {
        const Primitive primitive =
            primitive_of({places({0, 0, 0}), text("type", type)}, {testing::translation(0, 0, 5)});
        Diagnostics diagnostics;
        const auto surface = make_surface(primitive, diagnostics);
        std::vector<V2f> uv;
        for (const float u : {0.0f, 0.3f, 0.5f, 1.0f})
            for (const float v : {0.0f, 0.5f, 0.8f, 1.0f}) uv.emplace_back(u, v);
        ShadingGrid grid;
        grid.u.resize(uv.size()), grid.v.resize(uv.size()), grid.s.resize(uv.size()),
            grid.t.resize(uv.size());
        grid.N.resize(uv.size());
        const bool sphere = std::string(type) == "blobby";
        ASSERT_EQ(surface->evaluate_variables(0, uv, nullptr, grid), sphere);
        if (!sphere) continue;
        std::vector<V3f> P(uv.size());
        surface->evaluate(0, uv, 0, nullptr, P, {}, {});
        for (size_t i = 0; i < uv.size(); ++i) {
            const V3f at = P[i] / 0.5f;  // its width is 1
            EXPECT_NEAR(grid.N.at(i).x, at.x, 1e-5f);
            EXPECT_NEAR(grid.N.at(i).y, at.y, 1e-5f);
            EXPECT_NEAR(grid.N.at(i).z, -std::sqrt(std::max(1 - at.dot(at), 0.0f)), 1e-3f);
        }
    }
}

TEST(Points, AnUnknownTypeIsSaidAndDrawnAsDisks) {
    const Primitive primitive = primitive_of({places({0, 0, 0}), text("type", "hexagon")}, {M44f()});
    Diagnostics diagnostics;
    EXPECT_NE(make_surface(primitive, diagnostics), nullptr);
    EXPECT_EQ(diagnostics.count(Severity::Warning), 1u);
}

}  // namespace
}  // namespace trapeze
