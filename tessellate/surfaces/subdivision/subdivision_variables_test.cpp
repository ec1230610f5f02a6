/// Variables of subdivision meshes by class: limits, linear ones, and facevarying ones with and without
/// seams.
#include <gtest/gtest.h>

#include <cmath>

#include "tessellate/mesh_harness.h"
#include "tessellate/topology/surface.h"

namespace trapeze {
namespace {

using Scheme = SubdivisionMesh::Scheme;
using Tag = SubdivisionMesh::Tag;
using testing::Cage;
using testing::evaluate;
using testing::variables_at;

const Tag kInterpolateBorders{"interpolateboundary", {1}, {}, {}};
Tag face_varying_rule(int rule) {
    return {"facevaryinginterpolateboundary", {rule}, {}, {}};
}

struct MadeVariables {
    Diagnostics diagnostics;
    Primitive primitive;
    std::unique_ptr<Surface> surface;

    MadeVariables(const Cage& cage, ParameterList variables, std::vector<Tag> tags,
                  Scheme scheme = Scheme::CatmullClark) {
        variables.values.push_back(testing::points(cage.P));
        primitive = testing::primitive_of(testing::subdivision_of(cage, std::move(tags), scheme), variables);
        surface = make_subdivision_surface(primitive, diagnostics);
    }
    ShadingGrid at(int face, const std::vector<V2f>& uv) const {
        bool has_normals;
        return variables_at(*surface, face, uv, &has_normals);
    }
};

Parameter floats(std::string name, StorageClass storage, std::vector<float> values,
                 ValueType type = ValueType::Float) {
    return {std::move(name), {storage, type, 1}, std::move(values), {}};
}

/// A value for each corner, by its vertex's coordinate.
std::vector<float> at_corners(const Cage& cage, int coordinate) {
    std::vector<float> values;
    for (int vertex : cage.vertices) values.push_back(cage.P[3 * vertex + coordinate]);
    return values;
}

const std::vector<V2f> kPoints = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5f, 0.5f}, {0.3f, 0.9f}};

TEST(SubdivisionVariables, DefaultsAreTheFacesOwn) {
    const MadeVariables made(testing::cube_cage(), {}, {});
    const ShadingGrid grid = made.at(2, kPoints);
    for (size_t i = 0; i < kPoints.size(); ++i) {
        EXPECT_EQ(V2f(grid.u[i], grid.v[i]), kPoints[i]);
        EXPECT_EQ(V2f(grid.s[i], grid.t[i]), kPoints[i]);
    }
    EXPECT_TRUE(grid.variables.empty());
}

/// What lies on the vertices like P is evaluated like P, whatever the kind of face.
TEST(SubdivisionVariables, VertexVariablesAreLimits) {
    for (const Scheme scheme : {Scheme::CatmullClark, Scheme::Bilinear}) {
        const Cage cage = testing::prism_cage(5);
        const MadeVariables made(cage, {{floats("Pref", StorageClass::Vertex, cage.P, ValueType::Point)}}, {},
                                 scheme);
        for (int face = 0; face < made.surface->face_count(); ++face) {
            const ShadingGrid grid = made.at(face, kPoints);
            const auto e = evaluate(*made.surface, face, kPoints);
            for (size_t i = 0; i < kPoints.size(); ++i)
                for (int k = 0; k < 3; ++k) ASSERT_EQ(grid.find("Pref")->planes[k][i], e.P[i][k]);
        }
    }
}

TEST(SubdivisionVariables, ArraysOfManyFloats) {
    const Cage cage = testing::prism_cage(5);
    Parameter many{"many", {StorageClass::Vertex, ValueType::Float, 21}, {}, {}};
    for (int v = 0; v < cage.vertex_count(); ++v)
        for (int k = 0; k < 21; ++k)
            many.floats.push_back(cage.P[3 * v + k % 3] * static_cast<float>(1 << (k / 3)));
    const MadeVariables made(cage, {{many}}, {});
    for (int face = 0; face < made.surface->face_count(); ++face) {
        const ShadingGrid grid = made.at(face, kPoints);
        const auto e = evaluate(*made.surface, face, kPoints);
        for (size_t i = 0; i < kPoints.size(); ++i)
            for (int k = 0; k < 21; ++k)
                ASSERT_EQ(grid.find("many")->planes[k][i], e.P[i][k % 3] * static_cast<float>(1 << (k / 3)));
    }
}

TEST(SubdivisionVariables, VaryingIsLinearOverTheFace) {
    const Cage cage = testing::sheet_cage(3, 0);
    std::vector<float> w;
    for (int v = 0; v < cage.vertex_count(); ++v) w.push_back(cage.P[3 * v] + 10 * cage.P[3 * v + 1]);
    const MadeVariables made(cage, {{floats("w", StorageClass::Varying, w)}}, {kInterpolateBorders});
    const ShadingGrid grid = made.at(5, kPoints);  // [2, 3] x [1, 2]
    for (size_t i = 0; i < kPoints.size(); ++i)
        EXPECT_FLOAT_EQ(grid.find("w")->planes[0][i], 2 + kPoints[i].x + 10 * (1 + kPoints[i].y));
    // On pieces of a pentagon: the centre is the mean of the corners.
    const Cage prism = testing::prism_cage(5);
    const MadeVariables cut(prism, {{floats("w", StorageClass::Varying, {1, 2, 3, 4, 5, 0, 0, 0, 0, 0, 0})}},
                            {});
    EXPECT_FLOAT_EQ(cut.at(0, {{1, 1}, {0, 0}, {1, 0}}).find("w")->planes[0][0], 3);
    EXPECT_FLOAT_EQ(cut.at(0, {{1, 1}, {0, 0}, {1, 0}}).find("w")->planes[0][1], 5);
    EXPECT_FLOAT_EQ(cut.at(0, {{1, 1}, {0, 0}, {1, 0}}).find("w")->planes[0][2], 4.5f);
}

TEST(SubdivisionVariables, UniformAndConstant) {
    const Cage cage = testing::prism_cage(5);
    std::vector<float> number;
    for (size_t i = 0; i < cage.sizes.size(); ++i) number.push_back(static_cast<float>(i));
    Parameter label{"label", {StorageClass::Uniform, ValueType::String, 1}, {}, {}};
    for (float n : number) label.strings.push_back("face " + std::to_string(static_cast<int>(n)));
    const MadeVariables made(
        cage,
        {{floats("number", StorageClass::Uniform, number),
          floats("Os", StorageClass::Constant, {0.1f, 0.2f, 0.3f}, ValueType::Color), label}},
        {});
    // The pentagon's five pieces, then a quad and a triangle in turn.
    for (const auto& [face, mesh_face] : {std::pair(0, 0), {4, 0}, {5, 1}, {6, 2}, {8, 2}, {9, 3}}) {
        const ShadingGrid grid = made.at(face, kPoints);
        EXPECT_TRUE(grid.find("number")->uniform);
        EXPECT_EQ(grid.find("number")->planes[0][0], static_cast<float>(mesh_face));
        EXPECT_EQ(grid.find("label")->strings[0], "face " + std::to_string(mesh_face));
        EXPECT_EQ(grid.Os.at(3), V3f(0.1f, 0.2f, 0.3f));
    }
}

TEST(SubdivisionVariables, FaceVaryingIsBilinearWithoutTag) {
    const Cage cage = testing::cube_cage();
    std::vector<float> s, t;
    for (int face = 0; face < 6; ++face) {
        const float first = static_cast<float>(face);
        s.insert(s.end(), {first, first + 1, first + 1, first});
        t.insert(t.end(), {0, 0, 1, 1});
    }
    for (const auto& tags : {std::vector<Tag>{}, std::vector<Tag>{face_varying_rule(0)}}) {
        const MadeVariables made(
            cage, {{floats("s", StorageClass::FaceVarying, s), floats("t", StorageClass::FaceVarying, t)}},
            tags);
        for (int face = 0; face < 6; ++face) {
            const ShadingGrid grid = made.at(face, kPoints);
            for (size_t i = 0; i < kPoints.size(); ++i) {
                EXPECT_FLOAT_EQ(grid.s[i], static_cast<float>(face) + kPoints[i].x);
                EXPECT_FLOAT_EQ(grid.t[i], kPoints[i].y);
            }
        }
    }
}

/// Values that agree along all edges have no seams: they follow P.
TEST(SubdivisionVariables, SmoothFaceVaryingFollowsTheSurface) {
    const Cage cage = testing::prism_cage(5);
    for (const StorageClass storage : {StorageClass::FaceVarying, StorageClass::FaceVertex})
        for (const int rule : {1, 2}) {
            const MadeVariables made(
                cage,
                {{floats("s", storage, at_corners(cage, 0)), floats("t", storage, at_corners(cage, 1)),
                  floats("z", storage, at_corners(cage, 2))}},
                {face_varying_rule(rule)});
            for (int face = 0; face < made.surface->face_count(); ++face) {
                const ShadingGrid grid = made.at(face, kPoints);
                const auto e = evaluate(*made.surface, face, kPoints);
                for (size_t i = 0; i < kPoints.size(); ++i) {
                    EXPECT_NEAR(grid.s[i], e.P[i].x, 1e-6);
                    EXPECT_NEAR(grid.t[i], e.P[i].y, 1e-6);
                    EXPECT_NEAR(grid.find("z")->planes[0][i], e.P[i].z, 1e-6);
                }
            }
        }
}

/// A seam between the left and right half of a sheet: smooth on either side, a jump across, its line kept.
TEST(SubdivisionVariables, Seams) {
    const Cage cage = testing::sheet_cage(4, 0);
    std::vector<float> s = at_corners(cage, 0), t = at_corners(cage, 1);
    for (size_t i = 0; i < s.size(); ++i) {
        const int column = static_cast<int>(i / 4) % 4;
        s[i] = s[i] * s[i] + (column >= 2 ? 100.0f : 0.0f);
    }
    const ParameterList st{
        {floats("s", StorageClass::FaceVarying, s), floats("t", StorageClass::FaceVarying, t)}};
    for (const int rule : {1, 2, 3}) {
        const MadeVariables made(cage, st, {kInterpolateBorders, face_varying_rule(rule)});
        const int left = 5, right = 6;  // on either side of the seam, away from the border
        const ShadingGrid a = made.at(left, {{1, 0.25f}, {0, 0.25f}}), b = made.at(right, {{0, 0.25f}});
        EXPECT_NEAR(a.s[0], 4, 1e-5);
        EXPECT_NEAR(b.s[0], 104, 1e-4);
        EXPECT_NEAR(a.t[0], 1.25f, 1e-5);
        EXPECT_NEAR(b.t[0], 1.25f, 1e-5);
        // x^2 at 1 as the B-spline limit (0 + 4 * 1 + 4) / 6.
        EXPECT_NEAR(a.s[1], 8 / 6.0f, 1e-5);
        // Where the seam meets the border an island has a corner: kept, but where only edges are.
        const float corner = made.at(1, {{1, 0}}).t[0];
        EXPECT_NEAR(corner, rule == 2 ? 1 / 6.0f : 0, 1e-6) << rule;
    }
}

/// Each face an island of its own.
TEST(SubdivisionVariables, IslandsOnRegularAndIrregularFaces) {
    const Cage cage = testing::cube_cage();
    std::vector<float> s, t;
    for (int face = 0; face < 6; ++face) {
        const float first = 2 * static_cast<float>(face);
        s.insert(s.end(), {first, first + 1, first + 1, first});
        t.insert(t.end(), {0, 0, 1, 1});
    }
    const MadeVariables made(
        cage, {{floats("s", StorageClass::FaceVertex, s), floats("t", StorageClass::FaceVertex, t)}}, {});
    for (int face = 0; face < 6; ++face) {
        const ShadingGrid grid = made.at(face, kPoints);
        for (size_t i = 0; i < 4; ++i) {
            EXPECT_NEAR(grid.s[i], 2 * static_cast<float>(face) + kPoints[i].x, 1e-5);
            EXPECT_NEAR(grid.t[i], kPoints[i].y, 1e-5);
        }
        EXPECT_NEAR(grid.s[4], 2 * static_cast<float>(face) + 0.5f, 1e-5);
    }
}

/// Random seams on random connectivity.
TEST(SubdivisionVariables, AnythingHasFiniteValues) {
    std::mt19937 random(23);
    for (int round = 0; round < 400; ++round) {
        const bool loop = round % 3 == 0;
        const Cage cage = testing::random_cage(random, loop);
        std::vector<float> values;
        for (size_t i = 0; i < cage.vertices.size(); ++i) values.push_back(static_cast<float>(random() % 2));
        const MadeVariables made(cage, {{floats("seamed", StorageClass::FaceVertex, values)}},
                                 {kInterpolateBorders, face_varying_rule(round % 4)},
                                 loop ? Scheme::Loop : Scheme::CatmullClark);
        if (!made.surface) continue;
        for (int face = 0; face < made.surface->face_count(); ++face) {
            const ShadingGrid grid = made.at(face, kPoints);
            for (float value : grid.find("seamed")->planes[0])
                ASSERT_TRUE(value > -1e-3f && value < 1.001f) << "round " << round << " face " << face;
        }
    }
}

TEST(SubdivisionVariables, NormalsOfTheUser) {
    const Cage cage = testing::cube_cage();
    const MadeVariables made(cage, {{floats("N", StorageClass::Vertex, cage.P, ValueType::Normal)}}, {});
    bool has_normals = false;
    const ShadingGrid grid = variables_at(*made.surface, 0, kPoints, &has_normals);
    EXPECT_TRUE(has_normals);
    EXPECT_EQ(grid.N.at(3), evaluate(*made.surface, 0, kPoints).P[3]);
}

}  // namespace
}  // namespace trapeze
