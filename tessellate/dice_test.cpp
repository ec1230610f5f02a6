/// Grids as shading and tracing get them: rates, positions at keys, normals, derivatives, variables, shared
/// borders; and what a Tessellation leaves out.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>

#include "core/random.h"
#include "tessellate/dicing_harness.h"

namespace trapeze {
namespace {

using testing::TestScene;

std::shared_ptr<const Shape> sphere(float theta = 360, ParameterList variables = {}) {
    return testing::shape_of(testing::quadric(Quadric::Kind::Sphere, {1, -1, 1, theta}),
                             std::move(variables));
}

/// A bilinear square of 2 x 2 at z = 0, facing the eye (dPdu x dPdv along +z: see the first test).
std::shared_ptr<const Shape> square(ParameterList variables = {}, float z = 0) {
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point,
                                     {-1, -1, z, 1, -1, z, -1, 1, z, 1, 1, z}));
    return testing::shape_of(PatchMesh{}, std::move(variables));
}

/// All grids of a scene before they are shaded.
struct Diced {
    RenderContext context;
    Tessellation tessellation;
    std::vector<ShadingGrid> grids;

    Diced(TestScene& scene) : context(scene.context()), tessellation(context) {
        DiceScratch scratch;
        for (size_t i = 0; i < tessellation.subpatches().size(); ++i)
            tessellation.dice(i, grids.emplace_back(), scratch);
    }
};

/// A hash of all floats that shading and tracing get.
uint64_t bits_of(const ShadingGrid& grid) {
    uint64_t sum = grid.ordinal * 64 + grid.shape.nu * 256 + grid.shape.nv;
    const auto add = [&](const std::vector<float>& values) {
        for (const float value : values) sum = sum * 1099511628211u + std::bit_cast<uint32_t>(value);
    };
    const auto add_triples = [&](const Triples& t) {
        for (const auto& plane : t.c) add(plane);
    };
    for (const Triples& P : grid.P) add_triples(P);
    for (const Triples* t : {&grid.N, &grid.Ng, &grid.dPdu, &grid.dPdv, &grid.Cs, &grid.Os}) add_triples(*t);
    for (const auto* values : {&grid.u, &grid.v, &grid.s, &grid.t}) add(*values);
    for (const GridVariable& variable : grid.variables)
        for (const auto& plane : variable.planes) add(plane);
    return sum;
}

TEST(Dice, SquareHasTheShadingRateAndLooksAtTheEye) {
    for (const float rate : {0.25f, 1.0f, 4.0f}) {
        TestScene scene;
        scene.attributes->shading_rate = rate;
        scene.scene.options.width = scene.scene.options.height = 200;
        scene.add(square(), testing::translation(0, 0, 2));  // fills the middle half: 100 x 100 pixels
        const Diced diced(scene);
        // Rates are rounded up to whole segments: never fewer micropolygons, and a third more at most.
        const double wanted = 100 * 100 / static_cast<double>(rate);
        EXPECT_GE(static_cast<double>(diced.tessellation.stats().micropolygons), wanted);
        EXPECT_LT(static_cast<double>(diced.tessellation.stats().micropolygons), 1.35 * wanted);
        for (const ShadingGrid& grid : diced.grids)
            for (size_t i = 0; i < grid.vertex_count(); ++i) {
                EXPECT_EQ(grid.Ng.at(i), V3f(0, 0, 1));
                EXPECT_EQ(grid.N.at(i), V3f(0, 0, 1));
                EXPECT_EQ(grid.dPdu.at(i), V3f(2, 0, 0));
                EXPECT_EQ(grid.dPdv.at(i), V3f(0, 2, 0));
                EXPECT_EQ(grid.P[0].at(i).z, 2);
                EXPECT_NEAR(grid.P[0].at(i).x, 2 * grid.u[i] - 1, 1e-6f);
                EXPECT_FLOAT_EQ(grid.s[i], grid.u[i]);
                EXPECT_FLOAT_EQ(grid.t[i], grid.v[i]);
            }
    }
}

TEST(Dice, SameBitsWheneverAndWithWhateverScratch) {
    TestScene scene;
    ParameterList variables;
    variables.set(testing::parameter("tint", StorageClass::Varying, ValueType::Color,
                                     {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
    scene.add({sphere(360, variables)}, {testing::translation(0, 0, 3), testing::translation(0.5f, 0, 3)});
    scene.add(square(), testing::translation(0, 0, 4));
    const Diced diced(scene);
    const RenderContext context = scene.context();
    const Tessellation again(context);
    ASSERT_EQ(again.subpatches().size(), diced.grids.size());
    DiceScratch scratch;
    ShadingGrid grid;
    for (size_t n = 0; n < diced.grids.size(); ++n) {
        const size_t i = n * 7 % diced.grids.size();  // another order, one grid for all
        again.dice(i, grid, scratch);
        EXPECT_EQ(bits_of(grid), bits_of(diced.grids[i]));
        EXPECT_EQ(grid.P.size(), static_cast<size_t>(grid.key_count));
        EXPECT_EQ(again.subpatches()[i].bound, diced.tessellation.subpatches()[i].bound);
    }
}

TEST(Dice, SphereNormalsPointOutsideAlsoAtThePoles) {
    for (const bool reverse : {false, true}) {
        TestScene scene;
        scene.attributes->reverse_orientation = reverse;
        scene.keep_all().add(sphere(), testing::translation(0, 0, 3));
        const Diced diced(scene);
        for (const ShadingGrid& grid : diced.grids) {
            EXPECT_EQ(grid.reverse_orientation, reverse);
            for (size_t i = 0; i < grid.vertex_count(); ++i) {
                const V3f outside = grid.P[0].at(i) - V3f(0, 0, 3);
                EXPECT_NEAR(grid.N.at(i).dot(outside), reverse ? -1 : 1, 0.02f);
                EXPECT_GT(grid.dPdu.at(i).length(), 0);
                EXPECT_NEAR(grid.dPdu.at(i).dot(grid.Ng.at(i)), 0, 1e-4f);
            }
        }
    }
}

TEST(Dice, DerivativesAreByTheWholeSurfacesParameters) {
    TestScene scene;
    scene.add(sphere(180), testing::translation(0, 0, 3));
    const Diced diced(scene);
    for (const ShadingGrid& grid : diced.grids)
        for (size_t i = 0; i < grid.vertex_count(); ++i) {
            const float latitude = (grid.v[i] - 0.5f) * static_cast<float>(M_PI);
            if (std::abs(latitude) > 1.5f) continue;
            EXPECT_NEAR(grid.dPdu.at(i).length(), M_PI * std::cos(static_cast<double>(latitude)), 1e-4);
            EXPECT_NEAR(grid.dPdv.at(i).length(), M_PI, 1e-4);
        }
}

TEST(Dice, NoNormalAnywhereLooksAtTheEye) {
    TestScene scene;
    ParameterList variables;
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point,
                                     {-1, 0, 3, 1, 0, 3, -1, 0, 3, 1, 0, 3}));  // a line
    scene.keep_all().add(testing::shape_of(PatchMesh{}, variables), M44f());
    const Diced diced(scene);
    ASSERT_FALSE(diced.grids.empty());
    for (const ShadingGrid& grid : diced.grids)
        for (size_t i = 0; i < grid.vertex_count(); ++i) EXPECT_EQ(grid.Ng.at(i), V3f(0, 0, -1));
}

TEST(Dice, MotionKeysMixShapesAndTransforms) {
    TestScene scene;
    const auto shape = [](float z) { return square({}, z); };
    std::vector<M44f> matrices;
    for (int k = 0; k < 5; ++k) matrices.push_back(testing::translation(0.1f * static_cast<float>(k), 0, 4));
    scene.add({shape(0), shape(1), shape(3)}, matrices);
    scene.add({shape(0), shape(1)},
              {testing::translation(0, 0, 4), testing::translation(0, 0, 4), testing::translation(0, 1, 4)});
    scene.add({square()}, {testing::translation(0, 0, 4), testing::translation(0, 0, 4)});  // does not move
    const Diced diced(scene);
    for (const ShadingGrid& grid : diced.grids)
        for (size_t i = 0; i < grid.vertex_count(); ++i) {
            const V3f P = grid.P[0].at(i);
            const auto moved = [&](int key, const V3f& by) {
                EXPECT_NEAR((grid.P[key].at(i) - P - by).length(), 0, 1e-6f) << key;
            };
            if (grid.primitive_index == 0) {
                ASSERT_EQ(grid.key_count, 5);
                // Shape keys at times 0, 1/2, 1 and transforms at five times: both mixed at each of five
                // motion keys.
                moved(1, {0.1f, 0, 0.5f});
                moved(2, {0.2f, 0, 1});
                moved(3, {0.3f, 0, 2});
                moved(4, {0.4f, 0, 3});
            } else if (grid.primitive_index == 1) {
                ASSERT_EQ(grid.key_count, 3);
                moved(1, {0, 0, 0.5f});
                moved(2, {0, 1, 1});
            } else {
                EXPECT_EQ(grid.key_count, 1);
            }
        }
}

TEST(Dice, StillFramesHaveOneKey) {
    TestScene scene;
    scene.add({square()}, {testing::translation(0, 0, 4), testing::translation(0, 1, 4)});
    RenderContext context = scene.context();
    context.motion = false;
    const Tessellation tessellation(context);
    EXPECT_EQ(tessellation.subpatches()[0].key_count, 1);
}

TEST(Dice, GeometryGoesToCameraSpace) {
    TestScene scene;
    ParameterList variables;
    const auto four = [](V3f v) {
        std::vector<float> values;
        for (int i = 0; i < 4; ++i) values.insert(values.end(), {v.x, v.y, v.z});
        return values;
    };
    variables.set(testing::parameter("N", StorageClass::Varying, ValueType::Normal, four({1, 1, 0})));
    variables.set(testing::parameter("where", StorageClass::Varying, ValueType::Point, four({1, 2, 3})));
    variables.set(testing::parameter("way", StorageClass::Constant, ValueType::Vector, {1, 2, 3}));
    variables.set(testing::parameter("across", StorageClass::Constant, ValueType::Normal, {1, 1, 0}));
    variables.set(testing::parameter("tint", StorageClass::Constant, ValueType::Color, {1, 2, 3}));
    M44f stretch;
    // Normals go by the inverse transpose: (1, 1, 0) becomes (1/2, 1, 0).
    stretch.setScale(V3f(2, 1, 1));
    scene.attributes->color = {0.5f, 0.25f, 1};
    scene.add(square(variables), stretch * testing::translation(0, 0, 4));
    const Diced diced(scene);
    for (const ShadingGrid& grid : diced.grids) {
        const V3f n = V3f(0.5f, 1, 0).normalized();
        EXPECT_NEAR((grid.N.at(3) - n).length(), 0, 1e-6f);
        EXPECT_EQ(grid.Ng.at(3), V3f(0, 0, 1));
        const auto value = [&](const char* name) {
            const GridVariable* v = grid.find(name);
            return V3f(v->planes[0][0], v->planes[1][0], v->planes[2][0]);
        };
        EXPECT_EQ(value("where"), V3f(2, 2, 7));
        EXPECT_EQ(value("way"), V3f(2, 2, 3));
        EXPECT_NEAR((value("across") - V3f(0.5f, 1, 0)).length(), 0, 1e-6f);
        EXPECT_EQ(value("tint"), V3f(1, 2, 3));
        EXPECT_EQ(grid.Cs.at(0), V3f(0.5f, 0.25f, 1));
        EXPECT_EQ(grid.Os.at(0), V3f(1, 1, 1));
    }
}

/// All that displacement shaders read at vertices of a piece.
std::vector<float> values_of_piece(const ShadingGrid& pieces, size_t first) {
    std::vector<float> values;
    for (size_t i = first; i < first + 4; ++i) {
        for (const Triples* t : {&pieces.P[0], &pieces.N, &pieces.Ng, &pieces.dPdu, &pieces.dPdv, &pieces.Cs})
            for (int k = 0; k < 3; ++k) values.push_back(t->c[k][i]);
        for (const auto* plane : {&pieces.u, &pieces.v, &pieces.s, &pieces.t}) values.push_back((*plane)[i]);
    }
    return values;
}

/// Border vertices of all grids by position: whoever shares one has the same piece for it, and a vertex of
/// the piece is where the border vertex is.
TEST(Dice, DisplacedBordersShareWhatDisplacementReads) {
    TestScene scene;
    scene.attributes->displacement = std::make_shared<ShaderInstance>();
    scene.keep_all().add(sphere(), testing::translation(0.4f, 0.2f, 1.3f));
    const Diced diced(scene);
    std::map<std::array<float, 3>, std::vector<float>> shared_pieces;
    size_t shared = 0;
    for (const ShadingGrid& grid : diced.grids) {
        EXPECT_EQ(grid.shared_vertices.size(), 2u * (grid.shape.nu + grid.shape.nv + 2u));
        for (const auto& [vertex, in_border] : grid.shared_vertices) {
            size_t at = static_cast<size_t>(in_border), part = 0;
            for (; at >= grid.border[part].vertex_count(); ++part) at -= grid.border[part].vertex_count();
            const ShadingGrid& pieces = grid.border[part];
            const V3f P = grid.P[0].at(static_cast<size_t>(vertex));
            EXPECT_EQ(pieces.P[0].at(at), P);
            const auto [entry, is_new] =
                shared_pieces.try_emplace({P.x, P.y, P.z}, values_of_piece(pieces, at / 4 * 4));
            shared += !is_new;
            EXPECT_EQ(entry->second, values_of_piece(pieces, at / 4 * 4));
        }
    }
    EXPECT_GT(shared, shared_pieces.size());
}

/// A piece is about as large as the micropolygons beside it.
TEST(Dice, BorderPiecesHaveTheSizeOfMicropolygons) {
    TestScene scene;
    scene.attributes->displacement = std::make_shared<ShaderInstance>();
    scene.keep_all().add(square(), testing::translation(0, 0, 4));
    const Diced diced(scene);
    for (const ShadingGrid& grid : diced.grids) {
        const float side = (grid.P[0].at(1) - grid.P[0].at(0)).length();
        for (const ShadingGrid& pieces : grid.border)
            for (size_t i = 0; i < pieces.vertex_count(); i += 4) {
                EXPECT_NEAR((pieces.P[0].at(i + 1) - pieces.P[0].at(i)).length(), side, side / 2);
                EXPECT_NEAR((pieces.P[0].at(i + 2) - pieces.P[0].at(i)).length(), side, side / 2);
            }
    }
}

TEST(Dice, MemoryIsReusedBetweenGridsOfAPrimitive) {
    TestScene scene;
    scene.add({sphere()}, {testing::translation(0, 0, 3), testing::translation(0.5f, 0, 3)});
    const RenderContext context = scene.context();
    const Tessellation tessellation(context);
    DiceScratch scratch;
    ShadingGrid grid;
    size_t largest = 0;
    for (size_t i = 0; i < tessellation.subpatches().size(); ++i)
        if (tessellation.subpatches()[i].shape.vertex_count() >
            tessellation.subpatches()[largest].shape.vertex_count())
            largest = i;
    tessellation.dice(largest, grid, scratch);
    const float* const memory = grid.P[1].c[2].data();
    for (size_t i = 0; i < tessellation.subpatches().size(); ++i) {
        tessellation.dice(i, grid, scratch);
        EXPECT_EQ(grid.P[1].c[2].data(), memory);
    }
}

TEST(Tessellation, SubpatchesAreSmall) {
    TestScene scene;
    scene.scene.options.width = 640, scene.scene.options.height = 480;
    scene.add(sphere(), testing::translation(0, 0, 2));
    const RenderContext context = scene.context();
    const Tessellation tessellation(context);
    EXPECT_GT(tessellation.subpatches().size(), 200u);
    EXPECT_LT(tessellation.bytes(), 200 * tessellation.subpatches().size());
    EXPECT_EQ(tessellation.stats().grids, tessellation.subpatches().size());
}

/// What is too far to be diced in reasonable time is said, and what is merely far is diced.
TEST(Tessellation, SurfacesBeyondAllBoundsAreLeftOut) {
    for (const float radius : {1e9f, 1e13f, 1e20f, 3e38f}) {
        TestScene scene;
        M44f tilt;
        tilt.rotate(V3f(0.5f, 0, 0));
        scene.add(testing::shape_of(testing::quadric(Quadric::Kind::Disk, {0, radius, 360})),
                  tilt * testing::translation(0, 0, 4));
        const Diced diced(scene);
        const bool too_far = radius > 1e12f;
        EXPECT_EQ(scene.diagnostics.count(Severity::Error), too_far ? 1u : 0u);
        EXPECT_EQ(diced.tessellation.stats().primitives, too_far ? 0u : 1u);
        EXPECT_EQ(diced.grids.empty(), too_far);
    }
}

TEST(Tessellation, InvisibleAndBrokenPrimitivesAreLeftOut) {
    TestScene scene;
    scene.add(testing::shape_of(PatchMesh{}));  // no points
    scene.add(square());
    auto hidden = std::make_shared<Attributes>();
    hidden->visible_to_camera = false;
    scene.attributes = hidden;
    scene.add(square());
    const Diced diced(scene);
    EXPECT_EQ(scene.diagnostics.count(Severity::Error), 1u);
    EXPECT_EQ(diced.tessellation.stats().primitives, 1u);
    for (const SubpatchInfo& info : diced.tessellation.subpatches()) EXPECT_EQ(info.primitive, 1u);
}

}  // namespace
}  // namespace trapeze
