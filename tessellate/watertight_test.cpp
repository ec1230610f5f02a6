/// Closed surfaces, diced at uneven rates by a camera that stands near one side, have no holes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tessellate/leak_harness.h"
#include "tessellate/surfaces/forms_harness.h"

namespace trapeze {
namespace {

using testing::count_leaks;
using testing::kPi;
using testing::LeakCount;
using testing::TestScene;

/// No ray leaves without crossing the surface an odd number of times, and no side of a micropolygon is
/// without its neighbour.
void expect_closed_as_diced(const LeakCount& count) {
    EXPECT_GE(count.rays, 1'000'000);
    EXPECT_EQ(count.leaks, 0);
    EXPECT_EQ(count.wrong_sides, 0);
    EXPECT_EQ(count.open_sides, 0u);
    EXPECT_GE(count.hits, count.rays);
}

/// Evenly in the unit ball, by number.
V3f in_unit_ball(uint32_t number) {
    return testing::random_direction(number, 7) * std::cbrt(unit_float(hash(number, 8)));
}

M44f turned(float angle, const M44f& then) {
    M44f m;
    m.rotate(V3f(angle, 0.5f * angle, 0.3f * angle));
    return m * then;
}

const M44f kNear = testing::translation(0.3f, 0.2f, 1.1f);

/// Tiles of very different sizes: the near side of the sphere is 0.05 away.
TEST(Watertight, Sphere) {
    TestScene scene;
    scene.keep_all().add(testing::shape_of(testing::quadric(Quadric::Kind::Sphere, {1, -1, 1, 360})), kNear);
    expect_closed_as_diced(
        count_leaks(scene, [](uint32_t n, float) { return in_unit_ball(n) * 0.9f * kNear; }));
}

TEST(Watertight, SphereCoarselyDiced) {
    TestScene scene;
    scene.attributes->shading_rate = 2000;
    scene.keep_all().add(testing::shape_of(testing::quadric(Quadric::Kind::Sphere, {1, -1, 1, -360})), kNear);
    expect_closed_as_diced(
        count_leaks(scene, [](uint32_t n, float) { return in_unit_ball(n) * 0.4f * kNear; }));
}

TEST(Watertight, MovingSphere) {
    TestScene scene;
    std::vector<M44f> keys;
    for (int k = 0; k <= 4; ++k)
        keys.push_back(turned(0.7f * static_cast<float>(k),
                              testing::translation(0.1f * static_cast<float>(k), 0, 1.05f)));
    scene.keep_all().add({testing::shape_of(testing::quadric(Quadric::Kind::Sphere, {1, -1, 1, 360}))}, keys);
    // The chords between keys of a turning sphere go no deeper than cos(angle / 2).
    expect_closed_as_diced(count_leaks(
        scene, [](uint32_t n, float t) { return in_unit_ball(n) * 0.5f + V3f(0.4f * t, 0, 1.05f); }));
}

/// Waves along the normal that go on over the seam, in their bits.
void displace_by_texture(ShadingGrid& grid) {
    for (size_t i = 0; i < grid.vertex_count(); ++i) {
        const float s = grid.s[i] - std::floor(grid.s[i]);
        const float height = 0.1f * std::sin(8 * kPi * s) * std::sin(5 * kPi * grid.t[i]);
        for (Triples& P : grid.P) P.set(i, P.at(i) + grid.N.at(i) * height);
    }
}

TEST(Watertight, DisplacedMovingSphere) {
    TestScene scene;
    scene.attributes->displacement = std::make_shared<ShaderInstance>();
    scene.keep_all().add({testing::shape_of(testing::quadric(Quadric::Kind::Sphere, {1, -1, 1, 360}))},
                         {kNear, turned(0.3f, kNear)});
    expect_closed_as_diced(count_leaks(
        scene, [](uint32_t n, float) { return in_unit_ball(n) * 0.8f * kNear; }, 1'000'000,
        displace_by_texture));
}

/// Within `minor` of the circle of radius 1 about the z axis.
V3f inside_torus(uint32_t number, float minor) {
    const float theta = 2 * kPi * unit_float(hash(number, 1));
    const V3f ring(std::cos(theta), std::sin(theta), 0);
    return ring + in_unit_ball(number) * minor;
}

TEST(Watertight, Torus) {
    TestScene scene;
    const M44f place = turned(1.2f, testing::translation(0, 0, 1.3f));
    scene.keep_all().add(testing::shape_of(testing::quadric(Quadric::Kind::Torus, {1, 0.3f, 0, 360, 360})),
                         place);
    expect_closed_as_diced(
        count_leaks(scene, [&](uint32_t n, float) { return inside_torus(n, 0.25f) * place; }));
}

TEST(Watertight, DeformingTorus) {
    TestScene scene;
    const auto torus = [](float minor) {
        return testing::shape_of(testing::quadric(Quadric::Kind::Torus, {1, minor, 10, 370, 360}));
    };
    const M44f place = turned(1.2f, testing::translation(0, 0, 1.3f));
    scene.keep_all().add({torus(0.3f), torus(0.2f), torus(0.4f)}, {place});
    expect_closed_as_diced(
        count_leaks(scene, [&](uint32_t n, float) { return inside_torus(n, 0.15f) * place; }));
}

PatchMesh bspline_mesh(int nu, int nv) {
    PatchMesh mesh;
    mesh.bicubic = true;
    mesh.nu = nu, mesh.nv = nv;
    mesh.u_wraps = mesh.v_wraps = true;
    mesh.u_basis = mesh.v_basis = M44f(-1, 3, -3, 1, 3, -6, 3, 0, -3, 0, 3, 0, 1, 4, 1, 0) * (1 / 6.0f);
    mesh.u_step = mesh.v_step = 1;
    return mesh;
}

/// A closed mesh of bicubic B-splines, thicker in three places by `lumps`.
std::shared_ptr<const Shape> lumpy_torus(float lumps) {
    const PatchMesh mesh = bspline_mesh(9, 5);
    std::vector<float> P;
    for (int j = 0; j < mesh.nv; ++j)
        for (int i = 0; i < mesh.nu; ++i) {
            const float theta = 2 * kPi * static_cast<float>(i) / 9,
                        phi = 2 * kPi * static_cast<float>(j) / 5;
            const float minor = 0.45f + lumps * std::sin(3 * theta);
            const float r = 1 + minor * std::cos(phi);
            P.insert(P.end(), {r * std::cos(theta), r * std::sin(theta), minor * std::sin(phi)});
        }
    ParameterList variables;
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point, P));
    return testing::shape_of(mesh, variables);
}

TEST(Watertight, ClosedBicubicMesh) {
    TestScene scene;
    const M44f place = turned(0.4f, testing::translation(0.9f, 0, 0.4f));
    scene.keep_all().add(lumpy_torus(0.05f), place);
    expect_closed_as_diced(
        count_leaks(scene, [&](uint32_t n, float) { return inside_torus(n, 0.05f) * 0.93f * place; }));
}

TEST(Watertight, ClosedBicubicMeshThatMoves) {
    TestScene scene;
    const M44f place = turned(0.4f, testing::translation(0.9f, 0, 0.4f));
    const M44f later = turned(0.5f, testing::translation(0.9f, 0.02f, 0.4f));
    scene.keep_all().add({lumpy_torus(0.02f), lumpy_torus(0.06f), lumpy_torus(0.1f)}, {place, later});
    expect_closed_as_diced(count_leaks(scene, [&](uint32_t n, float t) {
        const V3f p = inside_torus(n, 0.03f) * 0.93f;
        return p * place * (1 - t) + p * later * t;
    }));
}

}  // namespace
}  // namespace trapeze
