/// Patch meshes against RISpec's basis formula: positions, derivatives, shared borders, bounds, variables of
/// all classes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "tessellate/dicing_harness.h"
#include "tessellate/surfaces/bezier.h"
#include "tessellate/surfaces/face_evaluation.h"
#include "tessellate/surfaces/forms_harness.h"

namespace trapeze {
namespace {

using testing::expect_near;
using testing::kBezier;
using testing::kBSpline;
using testing::kCatmullRom;

const M44f kPower(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);

PatchMesh bicubic(int nu, int nv, const M44f& u_basis, int u_step, const M44f& v_basis, int v_step) {
    PatchMesh mesh;
    mesh.bicubic = true;
    mesh.nu = nu, mesh.nv = nv;
    mesh.u_basis = u_basis, mesh.v_basis = v_basis;
    mesh.u_step = u_step, mesh.v_step = v_step;
    return mesh;
}

std::vector<float> random_floats(size_t n, uint32_t seed) {
    std::vector<float> values(n);
    for (size_t i = 0; i < n; ++i) values[i] = 2 * unit_float(hash(seed, static_cast<uint32_t>(i))) - 1;
    return values;
}

struct MadePatches {
    Primitive primitive;
    Diagnostics diagnostics;
    std::unique_ptr<Surface> surface;
    std::shared_ptr<Attributes> attributes = std::make_shared<Attributes>();

    MadePatches(const PatchMesh& mesh, ParameterList variables) {
        primitive.attributes = attributes;
        primitive.shape_keys = {testing::shape_of(mesh, std::move(variables))};
        primitive.camera_from_object = {M44f()};
        surface = make_surface(primitive, diagnostics);
    }
    static MadePatches random(const PatchMesh& mesh, uint32_t seed) {
        ParameterList variables;
        variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point,
                                         random_floats(static_cast<size_t>(mesh.nu) * mesh.nv * 3, seed)));
        return {mesh, std::move(variables)};
    }
    V3f at(int face, V2f uv, V3f* dPdu = nullptr, V3f* dPdv = nullptr) const {
        V3f P, du, dv;
        surface->evaluate(face, {&uv, 1}, 0, nullptr, {&P, 1}, {&du, 1}, {&dv, 1});
        if (dPdu) *dPdu = du;
        if (dPdv) *dPdv = dv;
        return P;
    }
};

/// [t^3 t^2 t 1] * basis, in double.
std::array<double, 4> basis_weights(const M44f& basis, double t) {
    const double power[4] = {t * t * t, t * t, t, 1};
    std::array<double, 4> w{};
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) w[j] += power[i] * static_cast<double>(basis[i][j]);
    return w;
}

/// RISpec's formula for a bicubic patch, in double.
V3f direct(const Primitive& primitive, int face, V2f uv) {
    const PatchMesh& mesh = std::get<PatchMesh>(primitive.shape().topology);
    const std::vector<float>& P = primitive.shape().variables.find("P")->floats;
    const int i0 = face % mesh.patches_u() * mesh.u_step, j0 = face / mesh.patches_u() * mesh.v_step;
    const auto u = basis_weights(mesh.u_basis, static_cast<double>(uv.x));
    const auto v = basis_weights(mesh.v_basis, static_cast<double>(uv.y));
    V3d sum(0, 0, 0);
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
            const float* const p = &P[3 * (((j0 + j) % mesh.nv) * mesh.nu + (i0 + i) % mesh.nu)];
            sum += V3d(p[0], p[1], p[2]) * (u[i] * v[j]);
        }
    return V3f(sum);
}

/// Meshes of several bases and steps, open and closed.
std::vector<PatchMesh> meshes() {
    PatchMesh closed = bicubic(7, 5, kBSpline, 1, kBSpline, 1);
    closed.u_wraps = closed.v_wraps = true;
    PatchMesh half_closed = bicubic(6, 7, kBezier, 3, kCatmullRom, 1);
    half_closed.u_wraps = true;
    return {bicubic(7, 4, kBezier, 3, kBezier, 3), bicubic(6, 8, kBSpline, 1, kPower, 4), closed,
            half_closed};
}

TEST(Patches, AgreeWithTheBasisFormula) {
    for (const PatchMesh& mesh : meshes()) {
        const MadePatches made = MadePatches::random(mesh, 3);
        ASSERT_EQ(made.surface->face_count(), mesh.patches_u() * mesh.patches_v());
        for (int face = 0; face < made.surface->face_count(); ++face)
            for (float u = 0; u <= 1; u += 0.25f)
                for (float v = 0; v <= 1; v += 0.25f)
                    expect_near(made.at(face, {u, v}), direct(made.primitive, face, {u, v}), 2e-6f);
    }
}

/// Batches of any size, bilinear and bicubic, give what one point alone does, to the bit.
TEST(Patches, BatchesAreAsTheFormulaOfOnePoint) {
    for (const int degree : {1, 3}) {
        BezierPatch patch;
        patch.degree = degree;
        const std::vector<float> values = random_floats(48, 7);
        for (size_t i = 0; i < 16; ++i) patch.p[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2], 0};
        for (size_t count = 1; count <= 40; ++count) {
            std::vector<V2f> uv;
            for (size_t i = 0; i < count; ++i)
                uv.emplace_back(unit_float(hash(1, static_cast<uint32_t>(i))), static_cast<float>(i % 5) / 4);
            std::vector<V3f> P(count), du(count), dv(count);
            evaluate_bezier(patch, uv, sink_of(P), sink_of(du), sink_of(dv));
            for (size_t i = 0; i < count; ++i) {
                Control value, by_u, by_v;
                patch.at(uv[i], &value, &by_u, &by_v);
                EXPECT_EQ(P[i], xyz(value)) << uv[i];
                EXPECT_EQ(du[i], xyz(by_u)) << uv[i];
                EXPECT_EQ(dv[i], xyz(by_v)) << uv[i];
            }
            std::vector<V3f> alone(count);
            evaluate_bezier(patch, uv, sink_of(alone), {}, {});
            EXPECT_EQ(alone, P);
        }
    }
}

TEST(Patches, DerivativesAreThoseOfPositions) {
    constexpr float h = 1.0f / 128;
    for (const PatchMesh& mesh : meshes()) {
        const MadePatches made = MadePatches::random(mesh, 4);
        V3f du, dv;
        made.at(0, {0.4f, 0.7f}, &du, &dv);
        expect_near(du, (made.at(0, {0.4f + h, 0.7f}) - made.at(0, {0.4f - h, 0.7f})) / (2 * h), 2e-3f);
        expect_near(dv, (made.at(0, {0.4f, 0.7f + h}) - made.at(0, {0.4f, 0.7f - h})) / (2 * h), 2e-3f);
    }
}

TEST(Patches, NeighboursMeetAtTheirEdges) {
    const V2f from[4] = {{0, 0}, {1, 0}, {0, 1}, {0, 0}}, to[4] = {{1, 0}, {1, 1}, {1, 1}, {0, 1}};
    for (const PatchMesh& mesh : meshes()) {
        if (mesh.v_basis == kPower) continue;  // its patches do not join
        const MadePatches made = MadePatches::random(mesh, 5);
        for (int face = 0; face < made.surface->face_count(); ++face)
            for (int s = 0; s < 4; ++s) {
                const EdgeLine line = made.surface->edge(made.surface->sides(face)[s].edge);
                for (const float t : {0.0f, 0.375f, 1.0f})
                    expect_near(made.at(face, from[s] + (to[s] - from[s]) * t),
                                made.at(line.face, line.from + (line.to - line.from) * t), 2e-6f);
            }
    }
}

TEST(Patches, BoundsHoldTheSurface) {
    for (const PatchMesh& mesh : meshes()) {
        const MadePatches made = MadePatches::random(mesh, 6);
        const V2f lo(0.25f, 0.5f), hi(0.5f, 0.625f);
        const Box3f box = made.surface->bound(0, lo, hi, 0);
        Box3f sampled;
        for (float u = 0; u <= 1; u += 0.125f)
            for (float v = 0; v <= 1; v += 0.125f) sampled.extendBy(made.at(0, lo + (hi - lo) * V2f(u, v)));
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(box.min[k], sampled.min[k] + 1e-6f);
            EXPECT_GE(box.max[k], sampled.max[k] - 1e-6f);
        }
        EXPECT_LT(box.size().length(), 2 * sampled.size().length());
    }
}

TEST(Patches, BezierBasisIsKeptExactly) {
    EXPECT_EQ(bezier_from_basis(kBezier), M44f());
}

TEST(Patches, RationalQuarterCircle) {
    const PatchMesh mesh = bicubic(4, 4, kBezier, 3, kBezier, 3);
    // A quarter of the unit circle as a cubic of weights 1, (1 + sqrt 2) / 3, .., 1, extruded along z.
    const float w = (1 + std::sqrt(2.0f)) / 3, a = 2 - std::sqrt(2.0f);
    const float arc[4][3] = {{1, 0, 1}, {w, a * w, w}, {a * w, w, w}, {0, 1, 1}};
    std::vector<float> Pw;
    for (int j = 0; j < 4; ++j)
        for (const auto& p : arc) Pw.insert(Pw.end(), {p[0], p[1], p[2] * static_cast<float>(j), p[2]});
    ParameterList variables;
    variables.set(testing::parameter("Pw", StorageClass::Vertex, ValueType::HPoint, Pw));
    const MadePatches made(mesh, variables);
    const Box3f box = made.surface->bound(0, {0, 0}, {1, 1}, 0);
    for (float u = 0; u <= 1; u += 0.125f) {
        V3f du, dv;
        const V3f P = made.at(0, {u, 0.5f}, &du, &dv);
        EXPECT_NEAR(std::hypot(P.x, P.y), 1, 1e-5f);
        EXPECT_NEAR(P.z, 1.5f, 1e-5f);
        EXPECT_NEAR(du.x * P.x + du.y * P.y, 0, 1e-4f);  // tangent to the circle
        EXPECT_GT(du.length(), 0.5f);
        expect_near(dv, {0, 0, 3}, 1e-4f);
        EXPECT_TRUE(box.intersects(P));
    }
}

ShadingGrid variables_of(const MadePatches& made, int face, const std::vector<V2f>& uv) {
    ShadingGrid grid;
    const size_t n = uv.size();
    grid.shape = {static_cast<uint8_t>(n - 1), 0};
    for (auto* values : {&grid.u, &grid.v, &grid.s, &grid.t}) values->resize(n);
    for (auto* triples : {&grid.Cs, &grid.Os, &grid.N}) triples->resize(n);
    made.surface->evaluate_variables(face, uv, nullptr, grid);
    return grid;
}

TEST(Patches, VariablesOfAllClasses) {
    PatchMesh mesh;  // bilinear, 2 x 2 patches, closed along u
    mesh.nu = 2, mesh.nv = 3, mesh.u_wraps = true;
    ParameterList variables;
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point, random_floats(18, 9)));
    variables.set(testing::parameter("constant_one", StorageClass::Constant, ValueType::Float, {7}));
    variables.set(testing::parameter("uniform_one", StorageClass::Uniform, ValueType::Float, {1, 2, 3, 4}));
    variables.set(
        testing::parameter("varying_one", StorageClass::Varying, ValueType::Float, {0, 1, 10, 11, 20, 21}));
    variables.set(
        testing::parameter("vertex_one", StorageClass::Vertex, ValueType::Float, {0, 1, 10, 11, 20, 21}));
    std::vector<float> corners(16);
    for (int i = 0; i < 16; ++i) corners[i] = static_cast<float>(i);
    variables.set(testing::parameter("corner_one", StorageClass::FaceVarying, ValueType::Float, corners));
    const MadePatches made(mesh, variables);
    const ShadingGrid grid = variables_of(made, 3, {{0.25f, 0.5f}, {1, 0}});  // second column, second row
    EXPECT_FLOAT_EQ(grid.u[0], 0.625f);
    EXPECT_FLOAT_EQ(grid.v[0], 0.75f);
    EXPECT_FLOAT_EQ(grid.s[0], 0.625f);
    EXPECT_FLOAT_EQ(grid.t[0], 0.75f);
    EXPECT_TRUE(grid.find("uniform_one")->uniform);
    EXPECT_EQ(grid.find("constant_one")->planes[0][0], 7);
    EXPECT_EQ(grid.find("uniform_one")->planes[0][0], 4);
    EXPECT_FLOAT_EQ(grid.find("varying_one")->planes[0][0], 15.75f);
    EXPECT_FLOAT_EQ(grid.find("varying_one")->planes[0][1], 10);  // round the seam
    EXPECT_FLOAT_EQ(grid.find("vertex_one")->planes[0][0], 15.75f);
    EXPECT_FLOAT_EQ(grid.find("corner_one")->planes[0][0], 12 + 0.25f + 1);
}

TEST(Patches, VertexVariablesFollowTheBasis) {
    const PatchMesh mesh = bicubic(4, 4, kBSpline, 1, kBSpline, 1);
    ParameterList variables;
    const std::vector<float> P = random_floats(48, 2);
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point, P));
    variables.set(testing::parameter("where", StorageClass::Vertex, ValueType::Color, P));
    const MadePatches made(mesh, variables);
    const ShadingGrid grid = variables_of(made, 0, {{0.3f, 0.6f}});
    const V3f at = made.at(0, {0.3f, 0.6f});
    // Numbers are added in another order than positions; all are within (-1, 1).
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(grid.find("where")->planes[k][0], at[k], 0x1p-22f);
}

/// Shaders divide by differences: what runs along u alone must not differ along v by rounding.
TEST(Patches, VertexVariablesThatRunOneWayAreThatAlone) {
    for (const bool bicubic_one : {false, true}) {
        PatchMesh mesh;
        mesh.nu = mesh.nv = 2;
        if (bicubic_one) mesh = bicubic(4, 4, kBSpline, 1, kBSpline, 1);
        const int side = bicubic_one ? 4 : 2;
        ParameterList variables;
        std::vector<float> s;
        for (int i = 0; i < side * side; ++i) s.push_back(0.1f + 0.2f * static_cast<float>(i % side));
        variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point,
                                         random_floats(static_cast<size_t>(3 * side * side), 5)));
        variables.set(testing::parameter("s", StorageClass::Vertex, ValueType::Float, s));
        const MadePatches made(mesh, variables);
        for (int i = 0; i <= 40; ++i) {
            std::vector<V2f> column;
            for (int j = 0; j <= 40; ++j)
                column.push_back({static_cast<float>(i) / 40, static_cast<float>(j) / 40});
            const ShadingGrid grid = variables_of(made, 0, column);
            for (size_t j = 1; j < column.size(); ++j) EXPECT_EQ(grid.s[j], grid.s[0]) << i << " " << j;
        }
    }
}

TEST(Patches, MissingPointsAreReported) {
    Primitive primitive;
    primitive.attributes = std::make_shared<Attributes>();
    primitive.shape_keys = {testing::shape_of(PatchMesh{})};
    Diagnostics diagnostics;
    EXPECT_EQ(make_surface(primitive, diagnostics), nullptr);
    EXPECT_EQ(diagnostics.count(Severity::Error), 1u);
}

}  // namespace
}  // namespace trapeze
