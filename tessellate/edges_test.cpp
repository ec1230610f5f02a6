/// Edges and their intervals: cover the edge once, have the wished length on the picture, stay few near and
/// behind the eye, and both neighbours find the same vertices on them.
#include <gtest/gtest.h>

#include "core/random.h"
#include "tessellate/border.h"
#include "tessellate/dicing_harness.h"

namespace trapeze {
namespace {

using testing::TestScene;

/// The left edge of a long bilinear patch that leads away from the eye, at x = -1, y = -1.
struct LongEdge {
    TestScene scene;
    std::unique_ptr<Surface> surface;
    RenderContext context;
    std::unique_ptr<PlacedSurface> placed;
    EvaluationScratch scratch;
    EdgeTessellations tessellations;
    EdgeLine line;

    LongEdge(float z0, float z1, float pixels_per_segment) {
        PatchMesh mesh;
        ParameterList variables;
        variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point,
                                         {-1, -1, z0, 1, -1, z0, -1, -1, z1, 1, -1, z1}));
        scene.scene.options.width = 1000, scene.scene.options.height = 1000;
        scene.add(testing::shape_of(mesh, variables), M44f());
        surface = make_surface(scene.scene.primitives[0], scene.diagnostics);
        context = scene.context();
        placed = std::make_unique<PlacedSurface>(*surface, scene.scene.primitives[0], false);
        line = surface->edge(surface->sides(0)[kLeft].edge);
        EdgeRate rate;
        rate.pixels_per_segment = pixels_per_segment;
        const ScreenMetric metric(context.camera);
        tessellations.add(*placed, line,
                          LineMeasure(metric, context.camera, *placed, false, pixels_per_segment), rate,
                          scratch);
    }
    /// A point of the edge, camera space.
    V3f at(float parameter) {
        const V2f uv = line.from + (line.to - line.from) * parameter;
        V3f P;
        placed->positions(line.face, {&uv, 1}, 1, scratch, {&P, 1});
        return P;
    }
};

TEST(Edges, IntervalsCoverTheEdgeOnce) {
    LongEdge edge(1, 500, 1);
    float at = 0;
    for (const EdgeInterval& interval : edge.tessellations.of(0)) {
        EXPECT_EQ(interval.begin, at);
        EXPECT_GE(interval.segments, 1);
        EXPECT_LE(interval.segments, 16);
        at = interval.end();
    }
    EXPECT_EQ(at, 1);
    EXPECT_GT(edge.tessellations.of(0).size(), 10u);
}

TEST(Edges, SegmentsHaveTheRateInPixels) {
    for (const float rate : {0.5f, 1.0f, 4.0f}) {
        LongEdge edge(1.5f, 4, rate);
        double total = 0;
        int count = 0;
        for (const EdgeInterval& interval : edge.tessellations.of(0))
            for (int k = 0; k < interval.segments; ++k, ++count) {
                const V2f a = edge.context.camera.raster_from_camera(edge.at(interval.parameter_of(k)));
                const V2f b = edge.context.camera.raster_from_camera(edge.at(interval.parameter_of(k + 1)));
                const float pixels = (b - a).length();
                EXPECT_LT(pixels, 1.6f * rate);
                total += static_cast<double>(pixels);
            }
        EXPECT_GT(total / count, 0.6 * static_cast<double>(rate));
        EXPECT_LE(total / count, 1.01 * static_cast<double>(rate));
    }
}

TEST(Edges, EyePlaneAndBehindNeedFewSegments) {
    // Within 1.4 of the eye: angles there are bounded, whatever the length.
    EXPECT_LT(LongEdge(-1000, 1000, 1).tessellations.of(0).size(), 600u);
    EXPECT_LT(LongEdge(-1e6f, 1e6f, 1).tessellations.of(0).size(), 600u);
    // Through the eye itself the depth limit ends it.
    TestScene scene;
    PatchMesh mesh;
    ParameterList variables;
    variables.set(testing::parameter("P", StorageClass::Vertex, ValueType::Point,
                                     {0, 0, -3, 1, 0, -3, 0, 0, 5, 1, 0, 5}));
    scene.keep_all().add(testing::shape_of(mesh, variables), M44f());
    const RenderContext context = scene.context();
    const Tessellation tessellation(context);
    EXPECT_GT(tessellation.subpatches().size(), 0u);
    EXPECT_LT(tessellation.subpatches().size(), 20000u);
}

TEST(Edges, NotFiniteIsOneSegment) {
    LongEdge edge(1, std::numeric_limits<float>::quiet_NaN(), 1);
    ASSERT_EQ(edge.tessellations.of(0).size(), 1u);
    EXPECT_EQ(edge.tessellations.of(0)[0].segments, 1);
}

TEST(Edges, SnappingGoesToTheNearestVertex) {
    const EdgeInterval interval{0.25f, 2, 3};  // vertices at 1/4, 1/3, 5/12, 1/2
    EXPECT_EQ(interval.end(), 0.5f);
    EXPECT_EQ(interval.snap(0.25f), 0);
    EXPECT_EQ(interval.snap(0.28125f), 0);
    EXPECT_EQ(interval.snap(0.3125f), 1);
    EXPECT_EQ(interval.snap(0.375f), 2);  // half way goes up
    EXPECT_EQ(interval.snap(0.5f), 3);
    EXPECT_EQ(interval.parameter_of(3), 0.5f);
}

TEST(Edges, BordersTakeAllVerticesInOrder) {
    for (int count = 0; count <= 16; ++count)
        for (int n = std::max(count, 1); n <= 16; ++n) {
            BorderSide side;
            side.count = count;
            EXPECT_EQ(side.vertex_of_border(0, n), 0);
            EXPECT_EQ(side.vertex_of_border(n, n), count);
            for (int i = 0; i < n; ++i) {
                const int step = side.vertex_of_border(i + 1, n) - side.vertex_of_border(i, n);
                EXPECT_TRUE(step == 0 || step == 1);
            }
        }
}

TEST(Edges, EndsOnEdgesFollowThemToTheirVertices) {
    LongEdge base(5, 6, 20);  // one interval of few segments
    ASSERT_EQ(base.tessellations.of(0).size(), 1u);
    EdgeTessellations of_surface;
    of_surface.append(base.tessellations);
    for (uint32_t e = 1; e < base.surface->edge_count(); ++e) of_surface.append(base.tessellations);
    std::vector<EdgeLine> made_lines;
    EdgeTessellations made;
    const Edges edges{base.surface.get(), &of_surface, &made_lines, &made};
    const EdgeInterval& whole = base.tessellations.of(0)[0];
    for (const float p : {0.0f, 0.125f, 0.4375f, 0.5f, 1.0f}) {
        const BorderPoint direct = edges.vertex(0, whole, whole.snap(p));
        const BorderPoint followed = edges.end({true, 0, p});
        EXPECT_EQ(direct.is_vertex, followed.is_vertex);
        EXPECT_EQ(direct.at.uv, followed.at.uv);
        EXPECT_EQ(followed.moved, whole.parameter_of(whole.snap(p)) != p);
    }
    EXPECT_TRUE(edges.end({true, 0, 0}).is_vertex);
    EXPECT_EQ(edges.interval(0, 1, 0.5f), edges.interval(0, 0, 1));
}

TEST(Edges, RenumberedAndAppendedKeepTheirIntervals) {
    LongEdge a(1, 30, 1), b(1, 3, 20);
    EdgeTessellations all;
    all.append(a.tessellations);
    all.append(b.tessellations);
    const uint32_t numbers[2] = {1, 0};
    all.renumber(numbers);
    EXPECT_EQ(all.of(1).size(), a.tessellations.of(0).size());
    EXPECT_EQ(all.of(0).size(), b.tessellations.of(0).size());
}

}  // namespace
}  // namespace trapeze
