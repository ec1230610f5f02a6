/// Faces that share no edge and no vertex, and what is spared for them.
#include <gtest/gtest.h>

#include "tessellate/dice.h"
#include "tessellate/face_estimates.h"
#include "tessellate/face_kinds_harness.h"
#include "tessellate/split.h"

namespace trapeze {
namespace {

using testing::hairs_of;
using testing::kBezier;
using testing::kBSpline;
using testing::Measured;

/// Periodic curves and such whose segments do not join, besides.
template <class F>
void for_kinds_that_may_stand_alone(const F& f) {
    testing::for_kinds_not_foreshortened(f);
    const M44f in_front = testing::translation(0, 0, 4);
    const auto wrapped = [](std::shared_ptr<const Shape> shape) {
        Shape periodic = *shape;
        std::get<Curves>(periodic.topology).periodic = true;
        return std::make_shared<const Shape>(std::move(periodic));
    };
    f(Measured(wrapped(hairs_of(kBSpline, 1, {4, 5, 9}, StorageClass::Vertex, 0.05f)), in_front));
    f(Measured(wrapped(hairs_of(kBezier, 3, {3, 6, 9}, StorageClass::Constant, 0.05f)), in_front));
    f(Measured(hairs_of(kBezier, 4, std::vector<int>(9, 8), StorageClass::Constant, 0.05f), in_front));
}

/// Nobody else has their edges and vertices, which are evaluated at their own sides and corners.
TEST(FacesThatStandAlone, ShareNothing) {
    int alone = 0, together = 0;
    for_kinds_that_may_stand_alone([&](const Measured& faces) {
        const Surface& surface = *faces.surface;
        std::vector<int> uses_of_edge(surface.edge_count()), uses_of_vertex(surface.vertex_count());
        for (int face = 0; face < surface.face_count(); ++face)
            for (const SurfaceSide& side : surface.sides(face)) {
                const EdgeLine line = surface.edge(side.edge);
                ++uses_of_edge[side.edge];
                if (!line.start.on_edge) ++uses_of_vertex[line.start.id];
                if (!line.finish.on_edge) ++uses_of_vertex[line.finish.id];
            }
        for (int face = 0; face < surface.face_count(); ++face) {
            ++(surface.stands_alone(face) ? alone : together);
            if (!surface.stands_alone(face)) continue;
            const std::array<SurfaceSide, 4> sides = surface.sides(face);
            for (int s = 0; s < 4; ++s) {
                const EdgeLine line = surface.edge(sides[s].edge);
                EXPECT_EQ(sides[s].begin, 0);
                EXPECT_EQ(sides[s].end, 1);
                EXPECT_EQ(uses_of_edge[sides[s].edge], 1);
                EXPECT_EQ(line.face, face);
                const V2f from = FaceLattices::side_uv(FaceRuns::Upwards, s, 0),
                          to = FaceLattices::side_uv(FaceRuns::Upwards, s, FaceLattices::kSidePoints - 1);
                EXPECT_EQ(line.from, from);
                EXPECT_EQ(line.to, to);
                for (const auto& [end, uv] : {std::pair(line.start, from), std::pair(line.finish, to)}) {
                    ASSERT_FALSE(end.on_edge);
                    EXPECT_EQ(uses_of_vertex[end.id], 2);
                    EXPECT_EQ(surface.vertex(end.id).face, face);
                    EXPECT_EQ(surface.vertex(end.id).uv, uv);
                }
            }
        }
    });
    EXPECT_GT(alone, 100);
    EXPECT_GT(together, 10);
}

/// To the bit, positions and all else.
TEST(FacesThatStandAlone, AreDicedAsOthers) {
    int alone = 0;
    for_kinds_that_may_stand_alone([&](const Measured& faces) {
        VertexTableMaker maker(*faces.placed);
        const std::vector<FaceEstimate> estimates =
            estimate_faces(*faces.placed, *faces.measure, faces.rate, maker);
        const VertexTable vertices = maker.finish();
        EvaluationScratch scratch;
        EdgeTessellations edges;
        for (uint32_t e = 0; e < faces.surface->edge_count(); ++e)
            edges.add(*faces.placed, faces.surface->edge(e), *faces.measure, faces.rate, scratch);
        const RasterBound raster(faces.context.camera, {0, 0, 640, 480});
        SplitContext split;
        split.surface = faces.placed.get(), split.surface_edges = &edges, split.vertices = &vertices;
        split.measure = faces.measure.get(), split.raster = &raster, split.rate = faces.rate;
        split.estimates = estimates;
        const Splits splits = split_faces(split, 0, faces.surface->face_count());
        const DiceContext context{faces.placed.get(),
                                  {faces.surface.get(), &edges, &splits.made_lines, &splits.made},
                                  &vertices,
                                  faces.metric.get(),
                                  faces.rate.pixels_per_segment,
                                  false};
        DiceScratch::State state;
        for (Subpatch subpatch : splits.subpatches) {
            if (!subpatch.alone) continue;
            ++alone;
            EXPECT_EQ(subpatch.lo, V2f(0, 0));
            EXPECT_EQ(subpatch.hi, V2f(1, 1));
            for (const DiceFor wanted : {DiceFor::Shaders, DiceFor::Hits}) {
                ShadingGrid got, expected;
                subpatch.alone = true;
                dice_subpatch(context, subpatch, got, state, wanted);
                subpatch.alone = false;
                dice_subpatch(context, subpatch, expected, state, wanted);
                ASSERT_EQ(got.P.size(), expected.P.size());
                for (int k = 0; k < 3; ++k) {
                    for (size_t key = 0; key < got.P.size(); ++key)
                        EXPECT_EQ(got.P[key].c[k], expected.P[key].c[k]);
                    if (wanted == DiceFor::Hits) continue;
                    EXPECT_EQ(got.N.c[k], expected.N.c[k]);
                    EXPECT_EQ(got.dPdu.c[k], expected.dPdu.c[k]);
                    EXPECT_EQ(got.dPdv.c[k], expected.dPdv.c[k]);
                }
                if (wanted == DiceFor::Hits) continue;
                EXPECT_EQ(got.v, expected.v);
            }
        }
    });
    EXPECT_GT(alone, 100);
}

}  // namespace
}  // namespace trapeze
