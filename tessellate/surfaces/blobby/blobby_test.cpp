/// Blobbies: fields and their gradients by RISpec, meshes closed for cells of many sizes and as fine as the
/// screen asks for, blended variables, motion, and absurd input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/random.h"
#include "tessellate/dicing_harness.h"
#include "tessellate/leak_harness.h"
#include "tessellate/surfaces/blobby/blobby_mesh.h"

namespace trapeze {
namespace {

/// Sixteen floats of a scaled and moved unit sphere.
std::vector<float> ellipsoid(const V3f& scale, const V3f& place) {
    return {scale.x, 0, 0, 0, 0, scale.y, 0, 0, 0, 0, scale.z, 0, place.x, place.y, place.z, 1};
}

/// A request of some code and the floats of its leaves.
Blobby blobby(int leaves, std::vector<int> code, std::initializer_list<std::vector<float>> floats) {
    Blobby b;
    b.leaf_count = leaves;
    b.code = std::move(code);
    for (const auto& part : floats) b.floats.insert(b.floats.end(), part.begin(), part.end());
    return b;
}

/// The same everywhere.
CellSizes cells_of(float size) {
    return [size](const Box3f&) { return size; };
}

/// (1 - r^2)^3.
float bump(float r2) {
    return r2 < 1 ? (1 - r2) * (1 - r2) * (1 - r2) : 0.0f;
}

FieldValue value_at(const BlobbyField& field, const V3f& p) {
    std::vector<FieldValue> results;
    return field.program.at(p, field.leaves, results);
}

TEST(Blobby, FieldsOfEveryLeafAndOperator) {
    // The leaves at p are a = bump(0.25), b = bump(0.16) by a segment of radius 0.5, c = 0.3.
    const V3f p(0.5f, 0, 0);
    const float a = bump(0.25f), b = bump(0.16f), c = 0.3f;
    std::vector<float> segment{-1, 0.2f, 0, 1, 0.2f, 0, 0.5f};
    const std::vector<float> identity = ellipsoid({1, 1, 1}, {0, 0, 0});
    segment.insert(segment.end(), identity.begin(), identity.end());
    const std::pair<std::vector<int>, float> rows[] = {
        {{0, 3, 0, 1, 2}, a + b + c},
        {{1, 2, 0, 1}, a * b},
        {{2, 3, 0, 1, 2}, std::max({a, b, c})},
        {{3, 3, 0, 1, 2}, std::min({a, b, c})},
        {{4, 0, 1}, a - b},
        {{5, 0, 2}, a / c},
        {{6, 1}, -b},
        {{7, 1}, b},
    };
    for (const auto& [operation, wanted] : rows) {
        std::vector<int> code{1001, 0, 1002, 16, 1000, 39};
        code.insert(code.end(), operation.begin(), operation.end());
        const BlobbyField field = blobby_field(blobby(3, code, {identity, segment, {c}}));
        EXPECT_NEAR(value_at(field, p).value, wanted, 1e-6f) << operation[0];
    }
}

/// 1004: its five operands are passed over.
TEST(Blobby, FieldsOfCompiledCodeAreZero) {
    Blobby b = blobby(2, {1004, 0, 2, 3, 0, 0, 1001, 0, 0, 2, 0, 1}, {ellipsoid({1, 1, 1}, {0, 0, 0})});
    b.strings = {"field.so"};
    EXPECT_NEAR(value_at(blobby_field(b), V3f(0.5f, 0, 0)).value, bump(0.25f), 1e-6f);
}

/// Some program of everything, over ellipsoids, a segment and a constant.
BlobbyField some_field() {
    std::vector<float> segment{-0.5f, 0, 0.2f, 0.7f, 0.4f, 0, 0.6f};
    const std::vector<float> m = ellipsoid({1.5f, 1, 0.8f}, {0.2f, 0, -0.3f});
    segment.insert(segment.end(), m.begin(), m.end());
    return blobby_field(blobby(5, {1001, 0, 1001, 16, 1002, 32, 1000, 55, 1001, 56, 0, 3, 0, 1, 2, 2,
                                   2,    5, 3,    4,  6,    4,  1,    2,  7,    3,  0, 3, 7, 8, 0},
                               {ellipsoid({1, 1, 1}, {0, 0, 0}),
                                ellipsoid({0.5f, 1.2f, 0.7f}, {0.8f, 0.1f, 0}),
                                segment,
                                {0.1f},
                                ellipsoid({0.6f, 0.6f, 0.6f}, {0.3f, 0.3f, 0.3f})}));
}

V3f random_point(uint32_t i) {
    return {3 * unit_float(hash(i, 1)) - 1.5f, 3 * unit_float(hash(i, 2)) - 1.5f,
            3 * unit_float(hash(i, 3)) - 1.5f};
}

TEST(Blobby, GradientsAreThoseOfTheField) {
    const BlobbyField field = some_field();
    int compared = 0;
    for (uint32_t i = 0; i < 2000; ++i) {
        const V3f p = random_point(i);
        constexpr float h = 1e-3f;
        V3f difference;
        bool smooth = true;  // not across a maximum's or minimum's ridge
        for (int k = 0; k < 3; ++k) {
            V3f lo = p, hi = p;
            lo[k] -= h, hi[k] += h;
            const FieldValue a = value_at(field, lo), b = value_at(field, hi);
            difference[k] = (b.value - a.value) / (2 * h);
            smooth &= (a.gradient - b.gradient).length() < 0.1f;
        }
        if (!smooth) continue;
        EXPECT_LT((difference - value_at(field, p).gradient).length(), 5e-3f);
        ++compared;
    }
    EXPECT_GT(compared, 1500);
}

TEST(Blobby, ReducedProgramsGiveTheSameFieldWhereLeavesReach) {
    const BlobbyField field = some_field();
    for (uint32_t i = 0; i < 500; ++i) {
        const V3f p = random_point(i);
        std::vector<int> near;
        for (int leaf = 0; leaf < 5; ++leaf)
            if (field.leaves[leaf].ends && field.leaves[leaf].at(p).value > 0) near.push_back(leaf);
        const BlobbyProgram program = field.program.reduced(near);
        std::vector<FieldValue> results;
        EXPECT_EQ(program.at(p, field.leaves, results).value, value_at(field, p).value);
        EXPECT_LE(program.instructions.size(), field.program.instructions.size());
    }
}

TEST(Blobby, OneEllipsoidIsDrawnAtHalfItsExtent) {
    const BlobbyField field = blobby_field(blobby(1, {1001, 0}, {ellipsoid({2, 1, 0.5f}, {1, 2, 3})}));
    const BlobbyMesh mesh = blobby_mesh(field, cells_of(0.04f));
    ASSERT_GT(mesh.points.size(), 500u);
    for (size_t i = 0; i < mesh.points.size(); ++i) {
        const V3f q = mesh.points[i] - V3f(1, 2, 3), local(q.x / 2, q.y, q.z / 0.5f);
        EXPECT_NEAR(local.length(), 0.5f, 2e-5f);
        const V3f normal = V3f(local.x / 2, local.y, local.z / 0.5f).normalized();
        EXPECT_GT(mesh.normals[i].dot(normal), 0.9999f);
    }
    for (size_t i = 0; i + 4 <= mesh.vertices.size(); i += 4) {
        const V3f p = mesh.points[mesh.vertices[i]];
        const V3f along = mesh.points[mesh.vertices[i + 1]] - p, up = mesh.points[mesh.vertices[i + 3]] - p;
        if (along.cross(up).length() > 1e-6f) {
            EXPECT_GT(along.cross(up).dot(mesh.normals[mesh.vertices[i]]), 0);
        }
    }
}

TEST(Blobby, SegmentsAreDrawnAtHalfTheirRadius) {
    std::vector<float> segment{-1, 0, 0, 1, 0, 0, 0.8f};
    const std::vector<float> m = ellipsoid({1, 1, 1}, {0, 0, 5});
    segment.insert(segment.end(), m.begin(), m.end());
    const BlobbyMesh mesh = blobby_mesh(blobby_field(blobby(1, {1002, 0}, {segment})), cells_of(0.1f));
    ASSERT_GT(mesh.points.size(), 100u);
    for (const V3f& p : mesh.points) {
        const V3f nearest(std::clamp(p.x, -1.0f, 1.0f), 0, 5);
        EXPECT_NEAR((p - nearest).length(), 0.4f, 2e-5f);
    }
}

/// Two unit balls so far apart along x, combined by an operator's number.
Blobby two_balls(float distance, int operation) {
    return blobby(2, {1001, 0, 1001, 16, operation, 2, 0, 1},
                  {ellipsoid({1, 1, 1}, {-distance / 2, 0, 0}), ellipsoid({1, 1, 1}, {distance / 2, 0, 0})});
}

/// On the plane between two balls the sum is twice one ball's field.
TEST(Blobby, SumsBlend) {
    const BlobbyMesh mesh = blobby_mesh(blobby_field(two_balls(1, 0)), cells_of(0.02f));
    // 2 (1 - (1/4 + y^2))^3 = 27/64.
    const float waist = std::sqrt(0.75f - std::cbrt(27.0f / 128));
    float closest = 1;
    for (const V3f& p : mesh.points)
        if (std::abs(p.x) < 0.015f) closest = std::min(closest, std::abs(std::hypot(p.y, p.z) - waist));
    EXPECT_LT(closest, 1e-3f);
}

std::shared_ptr<const Shape> shape_of(const Blobby& b, std::vector<Parameter> variables = {}) {
    ParameterList list;
    for (Parameter& variable : variables) list.set(std::move(variable));
    return testing::shape_of(b, std::move(list));
}

TEST(Blobby, LeavesVariablesBlendByTheirFields) {
    Primitive primitive;
    primitive.attributes = std::make_shared<Attributes>();
    primitive.shape_keys = {
        shape_of(two_balls(1, 0),
                 {testing::parameter("Cs", StorageClass::Varying, ValueType::Color, {1, 0, 0, 0, 0, 1}),
                  testing::parameter("k", StorageClass::Constant, ValueType::Float, {7})})};
    primitive.camera_from_object = {M44f()};
    Diagnostics diagnostics;
    const auto surface = make_surface(primitive, diagnostics);
    ASSERT_NE(surface, nullptr);
    int between = 0;
    for (int face = 0; face < surface->face_count(); ++face) {
        const V2f uv(0, 0);
        V3f p;
        const auto scratch = surface->make_scratch();
        surface->evaluate(face, {&uv, 1}, 0, scratch.get(), {&p, 1}, {}, {});
        ShadingGrid grid;
        grid.shape = {0, 0};
        for (std::vector<float>* values : {&grid.u, &grid.v, &grid.s, &grid.t}) values->resize(1);
        for (Triples* t : {&grid.N, &grid.Cs, &grid.Os}) t->resize(1);
        EXPECT_TRUE(surface->evaluate_variables(face, {&uv, 1}, scratch.get(), grid));
        const auto field = [&](float x) { return bump((p - V3f(x, 0, 0)).dot(p - V3f(x, 0, 0))); };
        const float left = field(-0.5f), right = field(0.5f), red = left / (left + right);
        EXPECT_NEAR(grid.Cs.at(0).x, red, 1e-3f);
        EXPECT_NEAR(grid.Cs.at(0).z, 1 - red, 1e-3f);
        EXPECT_EQ(grid.variables[0].planes[0][0], 7);
        between += red > 0.2f && red < 0.8f;
    }
    EXPECT_GT(between, 20);
}

TEST(Blobby, PointsGoAlongWithTheLeaves) {
    Primitive primitive;
    primitive.attributes = std::make_shared<Attributes>();
    const auto ball = [](float radius, float x) {
        return shape_of(blobby(1, {1001, 0}, {ellipsoid({radius, radius, radius}, {x, 0, 0})}));
    };
    primitive.shape_keys = {ball(1, 0), ball(2, 10)};
    primitive.camera_from_object = {M44f()};
    Diagnostics diagnostics;
    const auto surface = make_surface(primitive, diagnostics);
    for (int face = 0; face < surface->face_count(); face += 7) {
        const V2f uv(0, 0);
        V3f p, q;
        const auto scratch = surface->make_scratch();
        surface->evaluate(face, {&uv, 1}, 0, scratch.get(), {&p, 1}, {}, {});
        surface->evaluate(face, {&uv, 1}, 1, scratch.get(), {&q, 1}, {}, {});
        EXPECT_LT((q - (p * 2.0f + V3f(10, 0, 0))).length(), 1e-4f);
    }
}

TEST(Blobby, MeshesAreClosed) {
    for (const int operation : {0, 2}) {
        testing::TestScene scene;
        const M44f place = testing::translation(0.3f, 0.1f, 2);
        scene.keep_all().add({shape_of(two_balls(0.9f, operation)), shape_of(two_balls(1.1f, operation))},
                             {place});
        // Near the left ball's middle, which moves a little.
        const testing::LeakCount count = testing::count_leaks(
            scene,
            [&](uint32_t n, float) {
                return (V3f(-0.5f, 0, 0) + testing::random_direction(n, 1) * 0.2f) * place;
            },
            200'000);
        EXPECT_EQ(count.leaks, 0);
        EXPECT_EQ(count.wrong_sides, 0);
        EXPECT_EQ(count.open_sides, 0u);
    }
}

/// Some program over many leaves, of sizes from 0.06 to 0.6.
BlobbyField cloud_of_many_sizes(int count) {
    Blobby b;
    b.leaf_count = count;
    for (uint32_t n = 0; n < static_cast<uint32_t>(count); ++n) {
        b.code.insert(b.code.end(), {1001, static_cast<int>(16 * n)});
        const float size = 0.06f * std::pow(10.0f, unit_float(hash(n, 4)));
        const auto leaf = ellipsoid(V3f(size, size, size), random_point(n));
        b.floats.insert(b.floats.end(), leaf.begin(), leaf.end());
    }
    b.code.insert(b.code.end(), {0, count});
    for (int n = 0; n < count; ++n) b.code.push_back(n);
    return blobby_field(b);
}

/// Every side of a polygon is one of a neighbour's, the other way about.
void expect_closed(const BlobbyMesh& mesh) {
    std::map<std::pair<int, int>, int> balance;
    const int* vertices = mesh.vertices.data();
    for (const int size : mesh.sizes) {
        ASSERT_GE(size, 3);
        for (int n = 0; n < size; ++n) {
            const int from = vertices[n], to = vertices[(n + 1) % size];
            balance[std::minmax(from, to)] += from < to ? 1 : -1;
        }
        vertices += size;
    }
    EXPECT_EQ(vertices, mesh.vertices.data() + mesh.vertices.size());
    for (const auto& [side, count] : balance) EXPECT_EQ(count, 0) << side.first << '-' << side.second;
}

TEST(Blobby, MeshesOfManyCellSizesAreClosed) {
    const CellSizes sizes[] = {
        cells_of(0.2f),
        [](const Box3f& where) { return 0.03f + 0.2f * std::max(where.min.x, 0.0f); },
        [](const Box3f& where) { return where.min.x > 0.3f ? 1.0f : 0.025f; },  // as abrupt as can be
        [](const Box3f& where) { return 0.015f * std::exp2(4 * (where.min.z + 1.5f)); },
    };
    for (const CellSizes& cells : sizes) {
        const BlobbyMesh mesh = blobby_mesh(cloud_of_many_sizes(60), cells);
        ASSERT_GT(mesh.points.size(), 500u);
        EXPECT_EQ(mesh.coarser, 1);
        expect_closed(mesh);
        const auto [least, most] = std::ranges::minmax(mesh.list_cells);
        EXPECT_GE(most, 2 * least);
    }
}

TEST(Blobby, CellsFollowTheSizesThatAreAskedFor) {
    const BlobbyField field = blobby_field(
        blobby(1, {1002, 0}, {{0, 0, 0, 16, 0, 0, 2, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}));
    // A cylinder of radius 1 along x whose cells may be larger and larger along it.
    const auto wanted = [](float x) { return 0.03f * std::exp2(x / 4); };
    const BlobbyMesh mesh =
        blobby_mesh(field, [&](const Box3f& where) { return wanted(std::max(where.min.x, 0.0f)); });
    expect_closed(mesh);
    size_t counts[4] = {};
    for (size_t i = 0; i < mesh.points.size(); ++i) {
        const float x = std::clamp(mesh.points[i].x, 0.0f, 16.0f);
        const float cell = mesh.list_cells[mesh.leaf_list_of_point[i]];
        EXPECT_LT(cell, 1.5f * wanted(x));
        EXPECT_GT(cell, 0.25f * wanted(x));
        if (x > 0 && x < 16) ++counts[static_cast<int>(x / 4)];
    }
    // Each quarter has a quarter of the points of the one before, for cells twice as large.
    EXPECT_GT(counts[0], 2 * counts[1]);
    EXPECT_GT(counts[1], 2 * counts[2]);
    EXPECT_GT(counts[2], 2 * counts[3]);
    EXPECT_GT(counts[3], 50u);
}

/// A ball of radius 1, 240 pixels a unit at distance 1: cells of three pixels near by, of a sixth of the
/// leaf's extent far away, and no smaller however far.
TEST(Blobby, FacesFollowTheScreen) {
    Options options;
    options.projection = "perspective";
    const Camera camera = make_camera(options);
    const struct {
        float distance, cell, share;  ///< three cells across: how they lie matters
    } rows[] = {{12, 3.0f / 240 * 10, 0.1f},
                {20, 3.0f / 240 * 18, 0.1f},
                {200, 4.0f / 6, 0.33f},
                {2000, 4.0f / 6, 0.33f}};
    for (const auto& row : rows) {
        Primitive primitive;
        primitive.attributes = std::make_shared<Attributes>();
        primitive.shape_keys = {shape_of(blobby(1, {1001, 0}, {ellipsoid({2, 2, 2}, {0, 0, row.distance})}))};
        primitive.camera_from_object = {M44f()};
        Diagnostics diagnostics;
        const auto surface = make_surface(primitive, diagnostics, {&camera, nullptr});
        ASSERT_NE(surface, nullptr);
        // A surface net has a quad for every edge of the grid that it meets: 3/2 of its area in cells.
        const float expected = 1.5f * 4 * static_cast<float>(M_PI) / (row.cell * row.cell);
        EXPECT_NEAR(surface->face_count(), expected, row.share * expected) << row.distance;
    }
}

/// However they lie on the grid.
TEST(Blobby, SmallBallsAreNotLost) {
    for (uint32_t n = 0; n < 300; ++n) {
        const BlobbyField field = blobby_field(
            blobby(2, {1001, 0, 1001, 16, 0, 2, 0, 1},
                   {ellipsoid({5, 5, 5}, {0, 0, 0}), ellipsoid(V3f(0.2f), V3f(9, 0, 0) + random_point(n))}));
        // Cells of 50 balls' diameters would do for the screen.
        const BlobbyMesh mesh = blobby_mesh(field, cells_of(10));
        const V3f centre = V3f(9, 0, 0) + random_point(n);
        const auto is_near = [&](const V3f& p) { return (p - centre).length() < 0.12f; };
        EXPECT_GE(std::ranges::count_if(mesh.points, is_near), 6) << n;
    }
}

TEST(Blobby, AbsurdOnesAreSurvived) {
    const Blobby cases[] = {
        blobby(1, {1001, 0}, {ellipsoid({0, 1, 1}, {0, 0, 0})}),  // flat
        blobby(1, {1001, 0}, {ellipsoid({1e30f, 1e30f, 1e30f}, {0, 0, 0})}),
        blobby(1, {1001, 0}, {ellipsoid({1e-20f, 1e-20f, 1e-20f}, {1e6f, 0, 0})}),
        blobby(1, {1000, 0}, {{5}}),  // everywhere inside
        blobby(1, {1001, 0}, {ellipsoid({1e-30f, 1e25f, 1e25f}, {3e38f, 0, 0})}),
        blobby(1, {1002, 0},
               {{3e38f, 0, 0, -3e38f, 0, 0, 3e38f, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3e38f, 0, 0, 1}}),
        blobby(2, {1001, 0, 1001, 16, 0, 2, 0, 1},
               {ellipsoid({1, 1, 1}, {-1e7f, 0, 0}), ellipsoid({1, 1, 1}, {1e7f, 0, 0})}),
        blobby(2, {1001, 0, 1000, 16, 5, 0, 1}, {ellipsoid({1, 1, 1}, {0, 0, 0}), {0}}),  // by zero
    };
    for (const Blobby& b : cases) {
        testing::TestScene scene;
        scene.add(shape_of(b));
        const testing::DicedScene diced(scene);
        EXPECT_EQ(diced.bad_values, 0);
    }
}

}  // namespace
}  // namespace trapeze
