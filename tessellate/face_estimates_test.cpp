/// Faces measured many at once: what one by one gives, bit for bit, on every instruction set.
#include "tessellate/face_estimates.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "core/random.h"
#include "core/simd/targets_harness.h"
#include "tessellate/dicing_harness.h"
#include "tessellate/measure/lattice_measure.h"
#include "tessellate/split.h"
#include "tessellate/surfaces/camera_facing.h"
#include "tessellate/surfaces/curve_values.h"
#include "tessellate/surfaces/forms_harness.h"

namespace trapeze {
namespace {

using testing::for_each_target;
using testing::kBezier;
using testing::kBSpline;
using testing::TestScene;

bool same_bits(const V3f& a, const V3f& b) {
    for (int k = 0; k < 3; ++k)
        if (std::bit_cast<uint32_t>(a[k]) != std::bit_cast<uint32_t>(b[k])) return false;
    return true;
}

/// Numbers in -1 .. 1, one after the other.
struct Numbers {
    uint32_t n = 0;
    float operator()() { return 2 * unit_float(hash(7, n++)) - 1; }
};

/// Hairs of random places and lengths; one is a point.
std::shared_ptr<const Shape> hairs_of(const M44f& basis, int step, const std::vector<int>& counts,
                                      StorageClass width, float length) {
    Curves curves;
    curves.cubic = true;
    curves.basis = basis, curves.step = step;
    curves.vertices_per_curve = counts;
    std::vector<float> P;
    Numbers number;
    for (const int count : counts) {
        const V3f root(1.5f * number(), 1.2f * number(), number());
        const float own = length * std::abs(number());
        for (int i = 0; i < count; ++i) {
            const float along = own * static_cast<float>(i);
            P.insert(P.end(),
                     {root.x + along, root.y + along * 0.4f * number(), root.z + along * 0.4f * number()});
        }
    }
    for (size_t i = 0; i < 3 * static_cast<size_t>(counts[0]); ++i) P[i] = P[i % 3];
    ParameterList variables;
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point, P));
    std::vector<float> widths(width == StorageClass::Constant ? 1 : P.size() / 3);
    for (float& w : widths) w = 0.02f + 0.01f * number();
    variables.set(testing::parameter(width == StorageClass::Constant ? "constantwidth" : "width", width,
                                     ValueType::Float, widths));
    return testing::shape_of(curves, variables);
}

/// Points from less than a pixel to more than a grid.
std::shared_ptr<const Shape> dots(int count) {
    std::vector<float> P, widths;
    Numbers number;
    for (int i = 0; i < count; ++i) {
        P.insert(P.end(), {1.5f * number(), 1.2f * number(), number()});
        widths.push_back(0.3f * std::pow(std::abs(number()), 3.0f));
    }
    ParameterList variables;
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point, P));
    variables.set(testing::parameter("width", StorageClass::Vertex, ValueType::Float, widths));
    return testing::shape_of(trapeze::Points{count}, variables);
}

/// A surface, where it is placed, and how it is measured.
struct Measured {
    TestScene scene;
    RenderContext context;
    std::unique_ptr<Surface> surface;
    std::unique_ptr<PlacedSurface> placed;
    std::unique_ptr<ScreenMetric> metric;
    std::unique_ptr<LineMeasure> measure;
    EdgeRate rate;

    Measured(std::shared_ptr<const Shape> shape, const M44f& place) {
        scene.scene.options.width = 640, scene.scene.options.height = 480;
        scene.add(std::move(shape), place);
        context = scene.context();
        const Primitive& primitive = scene.scene.primitives[0];
        surface = make_surface(primitive, scene.diagnostics, {&context.camera, nullptr});
        placed = std::make_unique<PlacedSurface>(*surface, primitive, false);
        metric = std::make_unique<ScreenMetric>(context.camera);
        measure =
            std::make_unique<LineMeasure>(*metric, context.camera, *placed, false, rate.pixels_per_segment);
    }
    V3f object_point(int face, V2f uv) const {
        V3f P;
        surface->evaluate(face, {&uv, 1}, 0, nullptr, {&P, 1}, {}, {});
        return P;
    }
};

M44f mirrored() {
    M44f m;
    m[0][0] = -1, m[2][1] = 0.3f;
    return m * testing::translation(0.1f, 0, 4);
}

/// Calls f for faces of each kind.
template <class F>
void for_kinds(const F& f) {
    const M44f in_front = testing::translation(0, 0, 4);
    f(Measured(hairs_of(kBezier, 3, std::vector<int>(37, 4), StorageClass::Constant, 0.1f), in_front));
    f(Measured(hairs_of(kBezier, 3, std::vector<int>(20, 7), StorageClass::Vertex, 0.05f), mirrored()));
    f(Measured(hairs_of(kBSpline, 1, {9, 4, 5, 9, 12, 7, 4, 6, 23, 8, 8, 8, 8, 5, 5, 4, 9, 30},
                        StorageClass::Vertex, 0.05f),
               in_front));
    f(Measured(dots(75), in_front));
    f(Measured(dots(75), mirrored()));
    // Through the eye's plane, and many times as long as a grid.
    f(Measured(hairs_of(kBezier, 3, std::vector<int>(37, 4), StorageClass::Constant, 2),
               testing::translation(0, 0, 0.5f)));
}

TEST(FaceLattices, AreTheSamePointsAsOneByOneOnEveryInstructionSet) {
    for_kinds([](const Measured& faces) {
        ASSERT_TRUE(faces.surface->has_lattices());
        for_each_target([&] {
            int there = 0;
            const int all = faces.surface->face_count();
            for (int first = 0; first < all; first += FaceLattices::kFaces) {
                const int count = std::min(all - first, FaceLattices::kFaces);
                FaceLattices lattices;
                faces.surface->lattices(first, count, lattices);
                EXPECT_EQ(lattices.there >> count, 0u);
                for (int i = 0; i < count; ++i) {
                    if (!(lattices.there >> i & 1)) continue;
                    ++there;
                    for (int r = 0; r < FaceLattices::kRows; ++r)
                        for (int c = 0; c < FaceLattices::kColumns; ++c) {
                            if (!FaceLattices::has(r, c)) continue;
                            const auto& P = lattices.P[r][c];
                            const V2f uv = FaceLattices::uv(r, c);
                            ASSERT_TRUE(
                                same_bits({P[0][i], P[1][i], P[2][i]}, faces.object_point(first + i, uv)))
                                << first + i << " " << uv;
                        }
                }
            }
            EXPECT_GT(there, all / 4);
        });
    });
}

/// The formula for one point, with nothing in vectors.
TEST(RibbonRows, AreAsTheCameraFacesThemOnEveryInstructionSet) {
    const M44f place = mirrored();
    const Measured faces(hairs_of(kBezier, 3, std::vector<int>(9, 4), StorageClass::Constant, 0.1f), place);
    const Primitive& primitive = faces.scene.scene.primitives[0];
    const ParameterList& variables = primitive.shape().variables;
    const std::vector<float>& P = variables.find("P")->floats;
    const float width = variables.find("constantwidth")->floats[0];
    const CameraFacing facing(place, &faces.context.camera);
    for_each_target([&] {
        for (int face = 1; face < 9; ++face) {
            BezierCurve curve;
            for (size_t i = 0; i < 4; ++i)
                for (size_t k = 0; k < 3; ++k) curve.p[i][k] = P[static_cast<size_t>(face) * 12 + 3 * i + k];
            std::vector<V2f> uv;
            for (int j = 0; j < 40; ++j) uv.emplace_back(0.3f, static_cast<float>(j) / 39);
            std::vector<V3f> got(uv.size());
            faces.surface->evaluate(face, uv, 0, nullptr, got, {}, {});
            for (size_t j = 0; j < uv.size(); ++j) {
                Control c, by_t;
                curve.at(uv[j].y, &c, &by_t);
                const V3f centre(c[0], c[1], c[2]), tangent(by_t[0], by_t[1], by_t[2]);
                const float t = uv[j].y, wide = width * (1 - t) + width * t;
                const V3f expected = centre + facing.across(centre, tangent) * wide * (0.3f - 0.5f);
                EXPECT_TRUE(same_bits(got[j], expected)) << face << " " << uv[j];
            }
        }
    });
}

TEST(LatticeLines, AreAsLongAsOneByOneOnEveryInstructionSet) {
    for_kinds([](const Measured& faces) {
        EvaluationScratch scratch;
        for_each_target([&] {
            FaceLattices lattices;
            LatticeLines lines;
            const int count = std::min(faces.surface->face_count(), FaceLattices::kFaces);
            faces.surface->lattices(0, count, lattices);
            faces.measure->of(lattices, faces.placed->camera_from_object(0), lines);
            const auto expect_same = [&](int face, V2f from, V2f to, const LatticeLine& line) {
                std::vector<V2f> uv;
                for (int i = 0; i <= line.pieces; ++i)
                    uv.push_back(from +
                                 (to - from) * (static_cast<float>(i) / static_cast<float>(line.pieces)));
                std::vector<V3f> P(uv.size());
                faces.placed->positions(face, uv, 1, scratch, P);
                const RateEstimate expected = faces.measure->of(P), got = line.of(face);
                EXPECT_EQ(got.sum, expected.sum) << face << from << to;
                EXPECT_EQ(got.longest, expected.longest) << face << from << to;
                EXPECT_EQ(got.pieces, expected.pieces);
            };
            for (int face = 0; face < count; ++face) {
                if (!(lines.measured >> face & 1)) continue;
                for (int i = 0; i < 5; ++i) {
                    const float at = static_cast<float>(i) / 4;
                    expect_same(face, {0, at}, {1, at}, lines.four[0][i]);
                    expect_same(face, {at, 0}, {at, 1}, lines.four[1][i]);
                }
                for (int i = 0; i < 3; ++i) {
                    const float at = static_cast<float>(i) / 2;
                    expect_same(face, {0, at}, {1, at}, lines.two[0][i]);
                    expect_same(face, {at, 0}, {at, 1}, lines.two[1][i]);
                }
                for (int i = 0; i < 2; ++i) {
                    const float at = static_cast<float>(i);
                    expect_same(face, {at, 0}, {at, 1}, lines.eight[i]);
                }
            }
        });
    });
}

/// Edges and subpatches are those that a closer look gives.
TEST(FaceEstimates, ChangeNothing) {
    int known = 0, unknown = 0;
    for_kinds([&](const Measured& faces) {
        const std::vector<FaceEstimate> estimates = estimate_faces(*faces.placed, *faces.measure, faces.rate);
        ASSERT_EQ(static_cast<int>(estimates.size()), faces.surface->face_count());
        EvaluationScratch scratch;
        EdgeTessellations edges;
        for (uint32_t e = 0; e < faces.surface->edge_count(); ++e) {
            const EdgeLine line = faces.surface->edge(e);
            edges.add(*faces.placed, line, *faces.measure, faces.rate, scratch);
            const int side = side_along(line);
            ASSERT_GE(side, 0);
            const int segments = estimates[line.face].sides[side];
            if (segments == 0) continue;
            ASSERT_EQ(edges.of(e).size(), 1u);
            EXPECT_EQ(edges.of(e)[0].segments, segments);
        }
        const VertexTable vertices(*faces.placed);
        const RasterBound raster(faces.context.camera, {0, 0, 640, 480});
        SplitContext context;
        context.surface = faces.placed.get(), context.surface_edges = &edges, context.vertices = &vertices;
        context.measure = faces.measure.get(), context.raster = &raster, context.rate = faces.rate;
        const int all = faces.surface->face_count();
        const Splits expected = split_faces(context, 0, all);
        context.estimates = estimates;
        const Splits got = split_faces(context, 0, all);
        ASSERT_EQ(got.subpatches.size(), expected.subpatches.size());
        EXPECT_EQ(got.culled, expected.culled);
        for (size_t i = 0; i < got.subpatches.size(); ++i) {
            EXPECT_EQ(got.subpatches[i].face, expected.subpatches[i].face);
            EXPECT_EQ(got.subpatches[i].shape.nu, expected.subpatches[i].shape.nu);
            EXPECT_EQ(got.subpatches[i].shape.nv, expected.subpatches[i].shape.nv);
            EXPECT_EQ(got.subpatches[i].lo, expected.subpatches[i].lo);
            EXPECT_EQ(got.subpatches[i].hi, expected.subpatches[i].hi);
        }
        for (const FaceEstimate& estimate : estimates) ++(estimate.nu > 0 ? known : unknown);
    });
    EXPECT_GT(known, 40);
    EXPECT_GT(unknown, 10);
}

}  // namespace
}  // namespace trapeze
