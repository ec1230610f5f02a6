/// Faces measured many at once: what one by one gives, bit for bit, on every instruction set.
#include "tessellate/face_estimates.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <string>

#include "core/simd/targets_harness.h"
#include "tessellate/face_kinds_harness.h"
#include "tessellate/split.h"
#include "tessellate/surfaces/camera_facing.h"
#include "tessellate/surfaces/curve_values.h"

namespace trapeze {
namespace {

using testing::for_each_target;
using testing::for_kinds;
using testing::hairs_of;
using testing::kBezier;
using testing::Measured;
using testing::mirrored;

bool same_bits(const V3f& a, const V3f& b) {
    for (int k = 0; k < 3; ++k)
        if (std::bit_cast<uint32_t>(a[k]) != std::bit_cast<uint32_t>(b[k])) return false;
    return true;
}

/// Expects one point of a block's faces to be where evaluation puts it.
void expect_point(const Measured& faces, const FaceLattices& lattices, int first, int shape_key, int number,
                  V2f uv, EvaluationScratch& scratch) {
    for (int i = 0; i < FaceLattices::kFaces; ++i) {
        if (!(lattices.there >> i & 1)) continue;
        const FaceLattices::Point& P = lattices.points[number];
        ASSERT_TRUE(
            same_bits({P[0][i], P[1][i], P[2][i]}, faces.object_point(first + i, uv, shape_key, scratch)))
            << first + i << " " << uv;
    }
}

TEST(FaceLattices, AreTheSamePointsAsOneByOneOnEveryInstructionSet) {
    using Lattice = FaceLattices;
    int there = 0, all = 0;
    for_kinds([&](const Measured& faces) {
        ASSERT_TRUE(faces.surface->has_lattices());
        EvaluationScratch scratch;
        for_each_target([&] {
            for (int first = 0; first < faces.surface->face_count(); first += Lattice::kFaces) {
                const int count = std::min(faces.surface->face_count() - first, Lattice::kFaces);
                const std::vector<FaceLattices> keys = faces.lattices(first);
                all += count;
                there += std::popcount(keys[0].there);
                for (int key = 0; key < faces.keys(); ++key) {
                    const FaceLattices& lattices = keys[static_cast<size_t>(key)];
                    const int shape_key = faces.placed->mix_of(key).first;
                    EXPECT_EQ(lattices.there >> count, 0u);
                    const auto expect_at = [&](int number, V2f uv) {
                        expect_point(faces, lattices, first, shape_key, number, uv, scratch);
                    };
                    for (int r = 0; r < Lattice::kLines; ++r)
                        for (int c = 0; c < Lattice::kLines; ++c)
                            expect_at(Lattice::inner(r, c), Lattice::inner_uv(r, c));
                    for (int side = 0; side < 4; ++side)
                        for (int i = 0; i < Lattice::kSidePoints; ++i) {
                            expect_at(Lattice::side(side, i), Lattice::side_uv(lattices.runs, side, i));
                            if (faces.measure->keys() > 0)
                                expect_at(Lattice::beside(side, i),
                                          Lattice::beside_uv(lattices.runs, side, i));
                        }
                }
            }
        });
    });
    EXPECT_GT(there, all / 2);
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

/// A line of a face, its points at all keys and those beside it, one by one.
struct Line {
    std::vector<V3f> P, beside;

    Line(const Measured& faces, int face, int pieces, const std::function<V2f(int)>& uv,
         const std::function<V2f(int)>& beside_uv, EvaluationScratch& scratch) {
        std::vector<V2f> at, besides;
        for (int i = 0; i <= pieces; ++i) at.push_back(uv(i)), besides.push_back(beside_uv(i));
        const size_t n = at.size() * static_cast<size_t>(faces.keys());
        P.resize(n), beside.resize(n);
        faces.placed->positions(face, at, faces.keys(), scratch, P);
        faces.placed->positions(face, besides, faces.keys(), scratch, beside);
    }
};

void expect_same(const RateEstimate& got, const RateEstimate& expected, const std::string& what) {
    EXPECT_EQ(got.sum, expected.sum) << what;
    EXPECT_EQ(got.longest, expected.longest) << what;
    EXPECT_EQ(got.pieces, expected.pieces) << what;
    EXPECT_EQ(got.deep, expected.deep) << what;
}

/// Whole lines of faces that are measured, also those that are asked for only by some.
TEST(LatticeLines, AreAsLongAsOneByOneOnEveryInstructionSet) {
    using Lattice = FaceLattices;
    int measured = 0, all = 0, foreshortened = 0, eights = 0;
    const auto see = [&](const Measured& faces) {
        EvaluationScratch scratch;
        const float rate = faces.rate.pixels_per_segment;
        for_each_target([&] {
            const int first = faces.surface->face_count() / 2 / Lattice::kFaces * Lattice::kFaces;
            const std::vector<FaceLattices> lattices = faces.lattices(first);
            std::vector<PlacedLattices> keys;
            for (int key = 0; key < faces.keys(); ++key)
                keys.push_back({&lattices[static_cast<size_t>(key)], faces.placed->camera_from_object(key)});
            LatticeLines lines;
            faces.measure->of(keys, lines);
            all += std::min(faces.surface->face_count() - first, Lattice::kFaces);
            measured += std::popcount(lines.measured);
            for (int i = 0; i < Lattice::kFaces; ++i) {
                if (!(lines.measured >> i & 1)) continue;
                // Returns whether the line wants more than four segments.
                const auto expect_line = [&](const Line& line, const LatticeLine& lengths,
                                             const LatticeLine* seen, const std::string& what) {
                    const size_t points = line.P.size() / keys.size();
                    const RateEstimate expected = faces.measure->of(std::span(line.P).first(points));
                    expect_same(lengths.of(i), expected, what);
                    if (seen && faces.measure->may_want_less(expected)) {
                        expect_same(seen->of(i), faces.measure->foreshortened(line.P, line.beside),
                                    what + ", foreshortened");
                        ++foreshortened;
                    }
                    return expected.segments(rate) > kCoarseEdgePieces;
                };
                const std::string name = "face " + std::to_string(first + i);
                for (int axis = 0; axis < 2; ++axis)
                    for (int number = 0; number < Lattice::kLines; ++number)
                        for (const int pieces : {2, 4}) {
                            if (pieces == 2 && number % 2 == 1) continue;
                            const auto uv = [&](int line, int k) {
                                const int along = k * (4 / pieces);
                                return axis == 0 ? Lattice::inner_uv(line, along)
                                                 : Lattice::inner_uv(along, line);
                            };
                            const int beside = number > 0 ? number - 1 : 1;
                            const Line line(
                                faces, first + i, pieces, [&](int k) { return uv(number, k); },
                                [&](int k) { return uv(beside, k); }, scratch);
                            const LatticeLine& lengths =
                                pieces == 2 ? lines.two[axis][number / 2] : lines.lengths.four[axis][number];
                            expect_line(line, lengths, pieces == 2 ? nullptr : &lines.seen.four[axis][number],
                                        name + " axis " + std::to_string(axis));
                        }
                for (int side = 0; side < 4; ++side) {
                    const FaceRuns runs = lattices[0].runs;
                    const auto line = [&](int pieces) {
                        return Line(
                            faces, first + i, pieces,
                            [&](int k) { return Lattice::side_uv(runs, side, k * (8 / pieces)); },
                            [&](int k) { return Lattice::beside_uv(runs, side, k * (8 / pieces)); }, scratch);
                    };
                    const std::string what = name + " side " + std::to_string(side);
                    if (!expect_line(line(4), lines.lengths.side_four[side], &lines.seen.side_four[side],
                                     what))
                        continue;
                    expect_line(line(8), lines.lengths.side_eight[side], &lines.seen.side_eight[side], what);
                    ++eights;
                }
            }
        });
    };
    for_kinds(see);
    EXPECT_GT(measured, all / 3);
    EXPECT_GT(foreshortened, 1000);
    EXPECT_GT(eights, 100);
}

/// Edges and subpatches are those that a closer look gives.
TEST(FaceEstimates, ChangeNothing) {
    int known = 0, unknown = 0, known_edges = 0, unknown_edges = 0;
    for_kinds([&](const Measured& faces) {
        VertexTableMaker maker(*faces.placed);
        const std::vector<FaceEstimate> estimates =
            estimate_faces(*faces.placed, *faces.measure, faces.rate, maker);
        ASSERT_EQ(static_cast<int>(estimates.size()), faces.surface->face_count());
        EvaluationScratch scratch;
        EdgeTessellations edges;
        for (uint32_t e = 0; e < faces.surface->edge_count(); ++e) {
            const EdgeLine line = faces.surface->edge(e);
            edges.add(*faces.placed, line, *faces.measure, faces.rate, scratch);
            const int segments = estimates[static_cast<size_t>(line.face)].segments_of(line);
            ++(segments > 0 ? known_edges : unknown_edges);
            if (segments == 0) continue;
            ASSERT_EQ(edges.of(e).size(), 1u);
            EXPECT_EQ(edges.of(e)[0].segments, segments);
        }
        const VertexTable vertices(*faces.placed), taken = maker.finish();
        for (uint32_t v = 0; v < faces.surface->vertex_count(); ++v)
            for (size_t key = 0; key < vertices.keys_of(v).size(); ++key)
                ASSERT_TRUE(same_bits(taken.keys_of(v)[key], vertices.keys_of(v)[key])) << v;
        const RasterBound raster(faces.context.camera, {0, 0, 640, 480});
        SplitContext context;
        context.surface = faces.placed.get(), context.surface_edges = &edges, context.vertices = &vertices;
        context.measure = faces.measure.get(), context.raster = &raster, context.rate = faces.rate;
        const int all = faces.surface->face_count();
        const Splits expected = split_faces(context, 0, all);
        context.estimates = estimates;
        const Splits got = split_faces(context, 0, all);
        ASSERT_EQ(got.bounds.size(), expected.bounds.size());
        for (size_t i = 0; i < got.bounds.size(); ++i) EXPECT_EQ(got.bounds[i], expected.bounds[i]);
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
    EXPECT_GT(known, unknown);
    EXPECT_GT(unknown, 10);
    EXPECT_GT(known_edges, unknown_edges);
    EXPECT_GT(unknown_edges, 10);
}

}  // namespace
}  // namespace trapeze
