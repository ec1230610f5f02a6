/// Closed surfaces stay closed, bit for bit, whatever displacement shaders read at the borders of grids.
#include <gtest/gtest.h>

#include <cmath>

#include "shade/materials/shader_folder_harness.h"
#include "shade/shading.h"
#include "tessellate/leak_harness.h"
#include "tessellate/mesh_harness.h"

namespace trapeze {
namespace {

using testing::ShaderFolder;
using testing::TestScene;

/// A scene of one closed surface, and its displacement through the language.
struct DisplacedScene {
    TestScene scene;
    ShaderFolder folder;

    explicit DisplacedScene(const std::string& source) {
        folder.write("bumps", source);
        scene.scene.options.search_paths["shader"] = {folder.path()};
        const auto shader = std::make_shared<ShaderInstance>();
        shader->name = "bumps";
        scene.attributes->displacement = shader;
        scene.keep_all();
    }

    /// Rays from a ball at `centre`, camera space.
    void expect_closed(const V3f& centre, float radius, int64_t rays = 200'000) {
        const RenderContext context = scene.context();
        const Shading shading(context);
        ShadeScratch scratch;
        ShadeStats stats;
        float farthest = 0;
        const auto count = testing::count_leaks(
            scene,
            [&](uint32_t n, float) {
                return centre + testing::random_direction(n, 7) * radius * unit_float(hash(n, 8));
            },
            rays,
            [&](ShadingGrid& grid) {
                const Triples before = grid.P[0];
                shading.shade(grid, scratch, stats);
                for (size_t i = 0; i < grid.vertex_count(); ++i)
                    farthest = std::max(farthest, (grid.P[0].at(i) - before.at(i)).length());
            });
        EXPECT_EQ(count.leaks, 0);
        EXPECT_EQ(count.wrong_sides, 0);
        EXPECT_EQ(count.open_sides, 0u);
        EXPECT_GT(farthest, 0.01f);
        EXPECT_EQ(scene.diagnostics.count(Severity::Error), 0u);
    }
};

const M44f kNear = testing::translation(0.3f, 0.2f, 1.2f);

std::shared_ptr<const Shape> sphere() {
    return testing::shape_of(testing::quadric(Quadric::Kind::Sphere, {1, -1, 1, 360}));
}

/// s jumps at the seam, u and v run over it, and the poles have all s at once.
TEST(DisplacedWatertight, TextureCoordinatesAtASeam) {
    DisplacedScene test("displacement bumps() { P += normalize(N) * 0.08 * sin(5 * s + u) * cos(9 * t); }");
    test.scene.add(sphere(), kNear);
    test.expect_closed(V3f(0.3f, 0.2f, 1.2f), 0.7f);
}

TEST(DisplacedWatertight, DerivativesAndRandomNumbers) {
    DisplacedScene test(
        "displacement bumps() {"
        "  float slope = length(Du(P)) * 0.01 + area(P) * 5 + length(calculatenormal(P)) * 0.01;"
        "  P += normalize(N) * (slope + 0.03 * random() + 0.05 * filterstep(0.3, mod(10 * v, 1)));"
        "  N = calculatenormal(P); }");
    test.scene.add({sphere()}, {kNear, testing::translation(0.4f, 0.1f, 1.3f)});
    test.expect_closed(V3f(0.35f, 0.15f, 1.25f), 0.5f);
}

/// Each corner of the cube has another texture on each of its faces, and each face another length.
TEST(DisplacedWatertight, MeshWithSeamsAndUniformVariables) {
    DisplacedScene test(
        "displacement bumps(float deep = 0; varying float st2 = 0;) {"
        "  P += normalize(N) * (deep + 0.05 * noise(20 * st2, 7 * t)); }");
    const testing::Cage cage = testing::cube_cage();
    SubdivisionMesh mesh;
    mesh.vertices_per_face = cage.sizes;
    mesh.vertices = cage.vertices;
    mesh.vertex_count = static_cast<int>(cage.P.size() / 3);
    std::vector<float> corners, deep;
    for (size_t i = 0; i < cage.vertices.size(); ++i) corners.push_back(unit_float(hash(uint32_t(i), 3)));
    for (size_t i = 0; i < cage.sizes.size(); ++i) deep.push_back(0.02f * static_cast<float>(i));
    ParameterList variables;
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point, cage.P));
    variables.set(testing::parameter("st2", StorageClass::FaceVarying, ValueType::Float, corners));
    variables.set(testing::parameter("deep", StorageClass::Uniform, ValueType::Float, deep));
    for (const auto scheme : {SubdivisionMesh::Scheme::CatmullClark, SubdivisionMesh::Scheme::Bilinear}) {
        mesh.scheme = scheme;
        test.scene.scene.primitives.clear();
        test.scene.add(testing::shape_of(mesh, variables), testing::translation(0.1f, 0.2f, 1.6f));
        test.expect_closed(V3f(0.1f, 0.2f, 1.6f), 0.3f);
    }
}

/// A surface shader that moves P, behind a displacement shader that does.
TEST(DisplacedWatertight, SurfacesThatMove) {
    DisplacedScene test("displacement bumps() { P += normalize(N) * 0.04 * sin(30 * xcomp(P)); }");
    test.folder.write("swell",
                      "surface swell() { P += normalize(N) * 0.08 * sin(5 * s + u) * cos(9 * t);"
                      "  N = calculatenormal(P); Ci = Cs; Oi = Os; }");
    const auto surface = std::make_shared<ShaderInstance>();
    surface->name = "swell";
    test.scene.attributes->surface = surface;
    test.scene.add(sphere(), kNear);
    test.expect_closed(V3f(0.3f, 0.2f, 1.2f), 0.7f);
    test.scene.attributes->displacement.reset();
    test.scene.is_displaced = [](uint32_t) { return true; };
    test.expect_closed(V3f(0.3f, 0.2f, 1.2f), 0.7f);
}

TEST(DisplacedWatertight, LayersOfDisplacement) {
    DisplacedScene test("displacement bumps() { P += normalize(N) * 0.04 * sin(30 * xcomp(P)); }");
    test.folder.write("swell", "displacement swell() { P += normalize(N) * 0.05 * noise(9 * s, 5 * t); }");
    const auto layer = std::make_shared<ShaderInstance>();
    layer->name = "swell", layer->layer = "first";
    const auto last = std::make_shared<ShaderInstance>(*test.scene.attributes->displacement);
    last->layer = "second";
    last->earlier_layers = {layer};
    test.scene.attributes->displacement = last;
    test.scene.add(sphere(), kNear);
    test.expect_closed(V3f(0.3f, 0.2f, 1.2f), 0.7f);
}

}  // namespace
}  // namespace trapeze
