/// Subdivision surfaces against known limits and against OpenSubdiv in double: creases, boundaries, holes,
/// shared edges, the same bits in any batch and from any thread, and meshes that make no sense.
#include <gtest/gtest.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <cstring>
#include <thread>

#include "tessellate/mesh_harness.h"
#include "tessellate/topology/surface.h"

namespace trapeze {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Bfr = OpenSubdiv::Bfr;
using OpenSubdiv::Sdc::Options;
using Scheme = SubdivisionMesh::Scheme;
using Tag = SubdivisionMesh::Tag;
using testing::Cage;
using testing::evaluate;
using testing::Evaluated;

const Tag kInterpolate{"interpolateboundary", {1}, {}, {}};

/// Next to extraordinary vertices tangents are differences of points 1/64 apart, in floats.
constexpr float kNormalRounding = 1e-4f;

/// A mesh and its surface; the primitive outlives it.
struct MadeLimit {
    Diagnostics diagnostics;
    Primitive primitive;
    std::unique_ptr<Surface> surface;

    explicit MadeLimit(const Cage& cage, std::vector<Tag> tags = {}, Scheme scheme = Scheme::CatmullClark)
        : MadeLimit(cage, {cage.P}, std::move(tags), scheme) {}
    MadeLimit(const Cage& cage, const std::vector<std::vector<float>>& keys, std::vector<Tag> tags = {},
              Scheme scheme = Scheme::CatmullClark) {
        primitive =
            testing::primitive_of(testing::subdivision_of(cage, tags, scheme), {{testing::points(keys[0])}});
        std::vector<std::shared_ptr<const Shape>> shapes{primitive.shape_keys.front()};
        for (size_t k = 1; k < keys.size(); ++k)
            shapes.push_back(std::make_shared<const Shape>(
                Shape{testing::subdivision_of(cage, tags, scheme), {{testing::points(keys[k])}}}));
        primitive.shape_keys = shapes;
        surface = make_subdivision_surface(primitive, diagnostics);
    }
    const Surface& operator*() const { return *surface; }
    uint64_t warnings() const { return diagnostics.count(Severity::Warning); }
    uint64_t errors() const { return diagnostics.count(Severity::Error); }
};

std::vector<V2f> random_places(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<V2f> uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5f, 0}};
    while (static_cast<int>(uv.size()) < count) uv.emplace_back(unit(random), unit(random));
    return uv;
}

/// Catmull-Clark's limit at a vertex of valence 3 is (9 v + 4 edge neighbours + face neighbours) / 24.
TEST(SubdivisionSurface, CornerOfACube) {
    const MadeLimit made(testing::cube_cage());
    for (uint32_t v = 0; v < 8; ++v) {
        const SurfacePoint at = (*made).vertex(v);
        const Evaluated e = evaluate(*made, at.face, {at.uv});
        const V3f corner(v & 1 ? 1.0f : -1.0f, v & 2 ? 1.0f : -1.0f, v & 4 ? 1.0f : -1.0f);
        testing::expect_near(e.P[0], corner * 0.5f, 1e-6f, "limit");
        // The normal points outward along the diagonal.
        testing::expect_near(e.dPdu[0].cross(e.dPdv[0]).normalized(), corner.normalized(), kNormalRounding,
                             "normal");
    }
}

/// Loop's limit: v (1 - n g) + g (neighbours), g = 1 / (n + 3 / (8 b)), which is 31/220 for n = 4.
TEST(SubdivisionSurface, VerticesOfALoopOctahedron) {
    const Cage cage = testing::octahedron_cage();
    const MadeLimit made(cage, {}, Scheme::Loop);
    EXPECT_EQ((*made).face_count(), 24);
    for (uint32_t v = 0; v < 6; ++v) {
        const V3f corner(cage.P[3 * v], cage.P[3 * v + 1], cage.P[3 * v + 2]);
        const SurfacePoint at = (*made).vertex(v);
        const Evaluated e = evaluate(*made, at.face, {at.uv});
        testing::expect_near(e.P[0], corner * (96.0f / 220), 1e-6f, "limit");
        testing::expect_near(e.dPdu[0].cross(e.dPdv[0]).normalized(), corner, kNormalRounding, "normal");
    }
}

/// OpenSubdiv in double precision, refined further than the renderer does.
struct Reference {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    std::unique_ptr<Bfr::RefinerSurfaceFactory<>> factory;
    std::vector<double> P;

    Reference(const Cage& cage, Options options, const std::vector<int>& crease_pairs = {},
              const std::vector<float>& sharpness = {}) {
        Far::TopologyDescriptor d;
        d.numVertices = cage.vertex_count();
        d.numFaces = static_cast<int>(cage.sizes.size());
        d.numVertsPerFace = cage.sizes.data();
        d.vertIndicesPerFace = cage.vertices.data();
        d.numCreases = static_cast<int>(sharpness.size());
        d.creaseVertexIndexPairs = crease_pairs.data();
        d.creaseWeights = sharpness.data();
        using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
        refiner.reset(Factory::Create(d, Factory::Options(OpenSubdiv::Sdc::SCHEME_CATMARK, options)));
        Bfr::SurfaceFactory::Options accurate;
        accurate.SetApproxLevelSmooth(8).SetApproxLevelSharp(10);
        factory = std::make_unique<Bfr::RefinerSurfaceFactory<>>(*refiner, accurate);
        P.assign(cage.P.begin(), cage.P.end());
    }

    void expect_same(const Surface& surface, int face, int mesh_face, float tolerance) const {
        Bfr::Surface<double> limit;
        ASSERT_TRUE(factory->InitVertexSurface(mesh_face, &limit));
        std::vector<double> patch(static_cast<size_t>(limit.GetNumPatchPoints()) * 3);
        limit.PreparePatchPoints(P.data(), 3, patch.data(), 3);
        const std::vector<V2f> uv = random_places(64, 5);
        const Evaluated e = evaluate(surface, face, uv);
        for (size_t i = 0; i < uv.size(); ++i) {
            const double at[2] = {uv[i].x, uv[i].y};
            double p[3], u[3], v[3];
            limit.Evaluate(at, patch.data(), 3, p, u, v);
            testing::expect_near(e.P[i], V3d(p[0], p[1], p[2]), tolerance, "P");
            const V3f du(V3d(u[0], u[1], u[2])), dv(V3d(v[0], v[1], v[2]));
            if (du.cross(dv).length() < 1e-5f) continue;  // at a smooth boundary's corners
            testing::expect_near(e.dPdu[i].cross(e.dPdv[i]).normalized(), du.cross(dv).normalized(),
                                 20 * tolerance, "normal");
            if (!limit.IsRegular()) continue;  // else the speed in u and v depends on the refinement
            testing::expect_near(e.dPdu[i], du, 10 * tolerance, "dPdu");
            testing::expect_near(e.dPdv[i], dv, 10 * tolerance, "dPdv");
        }
    }
};

TEST(SubdivisionSurface, RegularFacesAreExact) {
    const Cage cage = testing::sheet_cage(5, 1);
    for (const int rule : {1, 2}) {
        const MadeLimit made(cage, {{"interpolateboundary", {rule}, {}, {}}});
        Options options;
        options.SetVtxBoundaryInterpolation(rule == 1 ? Options::VTX_BOUNDARY_EDGE_AND_CORNER
                                                      : Options::VTX_BOUNDARY_EDGE_ONLY);
        const Reference reference(cage, options);
        for (int face = 0; face < 25; ++face) {
            const bool smooth_corner = rule == 2 && (face % 5) % 4 == 0 && (face / 5) % 4 == 0;
            reference.expect_same(*made, face, face, smooth_corner ? 2e-3f : 5e-6f);
            if (HasFailure()) FAIL() << "face " << face << " rule " << rule;
        }
    }
}

TEST(SubdivisionSurface, SharpInteriorEdgesOnRegularFaces) {
    const Cage cage = testing::sheet_cage(4, 1);
    const std::vector<int> chain = {10, 11, 12, 13, 14};
    const MadeLimit made(cage, {kInterpolate, {"crease", chain, {10}, {}}});
    Options options;
    options.SetVtxBoundaryInterpolation(Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    const Reference reference(cage, options, {10, 11, 11, 12, 12, 13, 13, 14}, {10, 10, 10, 10});
    for (int face = 0; face < 16; ++face) reference.expect_same(*made, face, face, 5e-6f);
}

TEST(SubdivisionSurface, SemiSharpCreases) {
    const Cage cage = testing::cube_cage();
    // One sharpness for each edge, round the top.
    const MadeLimit made(cage, {{"crease", {4, 5, 7, 6, 4}, {2, 1.5f, 2, 3}, {}}});
    const Reference reference(cage, Options(), {4, 5, 5, 7, 7, 6, 6, 4}, {2, 1.5f, 2, 3});
    for (int face = 0; face < 6; ++face) reference.expect_same(*made, face, face, 1e-3f);
    EXPECT_EQ(made.warnings(), 0u);
}

TEST(SubdivisionSurface, SharpCubeIsACube) {
    const std::vector<Tag> tags = {{"crease", {0, 1, 3, 2, 0, 4, 5, 7, 6, 4}, {10}, {}},
                                   {"crease", {1, 5}, {10}, {}},
                                   {"crease", {2, 6}, {10}, {}},
                                   {"crease", {3, 7}, {10}, {}},
                                   {"corner", {0, 1, 2, 3, 4, 5, 6, 7}, {10}, {}}};
    const MadeLimit made(testing::cube_cage(), tags);
    for (int face = 0; face < 6; ++face)
        for (const V3f& p : evaluate(*made, face, random_places(50, 2)).P)
            EXPECT_NEAR(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1, 1e-6);
    testing::expect_near(testing::position(*made, (*made).vertex(7)), V3f(1, 1, 1), 1e-6f, "corner");
}

TEST(SubdivisionSurface, CornerKeepsItsVertex) {
    const MadeLimit made(testing::cube_cage(), {{"corner", {0, 7}, {10, 0}, {}}});
    testing::expect_near(testing::position(*made, (*made).vertex(0)), V3f(-1, -1, -1), 1e-6f, "sharp");
    testing::expect_near(testing::position(*made, (*made).vertex(7)), V3f(0.5f, 0.5f, 0.5f), 1e-6f, "smooth");
}

TEST(SubdivisionSurface, BilinearIsTheCage) {
    const Cage cage = testing::prism_cage(5);
    const MadeLimit made(cage, {}, Scheme::Bilinear);
    EXPECT_EQ((*made).face_count(), 5 + 5 * (1 + 3));
    for (uint32_t v = 0; v < static_cast<uint32_t>(cage.vertex_count()); ++v)
        testing::expect_near(testing::position(*made, (*made).vertex(v)),
                             V3f(cage.P[3 * v], cage.P[3 * v + 1], cage.P[3 * v + 2]), 1e-6f, "vertex");
    testing::expect_joined(*made, 1e-6f);
    testing::expect_bounded_and_differentiated(*made, 1e-3f);
}

TEST(SubdivisionSurface, FacesShareEdges) {
    const Tag crease{"crease", {0, 1, 2}, {1.5f}, {}};
    for (int n : {3, 5, 8}) {
        const MadeLimit made(testing::prism_cage(n), {crease});
        EXPECT_EQ((*made).face_count(), (n == 4 ? 1 : n) + n * (1 + 3));
        testing::expect_joined(*made, 2e-5f);
        testing::expect_bounded_and_differentiated(*made, 2e-2f);
    }
    const MadeLimit loop(testing::octahedron_cage(), {{"crease", {0, 1, 2, 3, 0}, {2}, {}}}, Scheme::Loop);
    testing::expect_joined(*loop, 2e-5f);
    testing::expect_bounded_and_differentiated(*loop, 2e-2f);
    const MadeLimit sheet(testing::sheet_cage(4, 0.7f), {kInterpolate});
    testing::expect_joined(*sheet, 1e-5f);
    testing::expect_bounded_and_differentiated(*sheet, 1e-2f);
}

/// One point at a time, in blocks, with and without derivatives, by any scratch.
TEST(SubdivisionSurface, BitsDoNotDependOnTheBatch) {
    const MadeLimit regular(testing::sheet_cage(4, 0.7f), {kInterpolate}), mixed(testing::prism_cage(5)),
        loop(testing::octahedron_cage(), {}, Scheme::Loop),
        linear(testing::prism_cage(5), {}, Scheme::Bilinear);
    for (const MadeLimit* made : {&regular, &mixed, &loop, &linear}) {
        const Surface& surface = **made;
        const auto scratch = surface.make_scratch();
        const std::vector<V2f> uv = random_places(77, 9);
        for (int face = 0; face < surface.face_count(); ++face) {
            const Evaluated all = evaluate(surface, face, uv);
            for (size_t i = 0; i < uv.size(); ++i) {
                V3f P, du, dv, alone;
                surface.evaluate(face, {&uv[i], 1}, 0, scratch.get(), {&P, 1}, {&du, 1}, {&dv, 1});
                surface.evaluate(face, {&uv[i], 1}, 0, scratch.get(), {&alone, 1}, {}, {});
                ASSERT_EQ(std::memcmp(&P, &all.P[i], sizeof P), 0);
                ASSERT_EQ(std::memcmp(&alone, &all.P[i], sizeof P), 0);
                ASSERT_EQ(std::memcmp(&du, &all.dPdu[i], sizeof P), 0);
                ASSERT_EQ(std::memcmp(&dv, &all.dPdv[i], sizeof P), 0);
            }
        }
    }
}

/// Threads fill the library's cache of irregular patches at the same time.
TEST(SubdivisionSurface, ThreadsGetTheSameBits) {
    const Cage cage = testing::prism_cage(9);
    const std::vector<Tag> tags = {{"crease", {9, 10, 11, 12, 13, 14}, {1, 2, 3, 2.5f, 1.5f}, {}}};
    const std::vector<V2f> uv = random_places(9, 2);
    for (int round = 0; round < 10; ++round) {
        const MadeLimit together(cage, tags);
        const int faces = (*together).face_count();
        std::vector<std::vector<Evaluated>> results(4, std::vector<Evaluated>(faces));
        std::vector<std::thread> threads;
        for (int t = 0; t < 4; ++t)
            threads.emplace_back([&, t] {
                for (int i = 0; i < faces; ++i) {
                    const int face = t % 2 ? i : faces - 1 - i;
                    results[t][face] = evaluate(*together, face, uv);
                }
            });
        for (std::thread& thread : threads) thread.join();
        const MadeLimit alone(cage, tags);
        for (int face = 0; face < faces; ++face) {
            const Evaluated expected = evaluate(*alone, face, uv);
            for (const auto& result : results)
                for (const auto& [a, b] :
                     {std::pair(&result[face].P, &expected.P), std::pair(&result[face].dPdu, &expected.dPdu)})
                    ASSERT_EQ(std::memcmp(a->data(), b->data(), uv.size() * sizeof(V3f)), 0);
        }
    }
}

TEST(SubdivisionSurface, BoundaryRules) {
    const Cage cage = testing::sheet_cage(3, 0);
    const auto drawn = [](const Surface& surface) {
        int count = 0;
        for (int face = 0; face < surface.face_count(); ++face) count += !surface.is_hole(face);
        return count;
    };
    const MadeLimit none(cage);
    EXPECT_EQ(drawn(*none), 1);
    EXPECT_FALSE((*none).is_hole(4));
    testing::expect_joined(*none, 1e-6f);
    const MadeLimit corners(cage, {{"interpolateboundary", {}, {}, {}}});  // no number means 1
    EXPECT_EQ(drawn(*corners), 9);
    testing::expect_near(testing::position(*corners, (*corners).vertex(0)), V3f(0, 0, 0), 1e-6f,
                         "sharp corner");
    const MadeLimit edges(cage, {{"interpolateboundary", {2}, {}, {}}});
    EXPECT_EQ(drawn(*edges), 9);
    // The boundary curve's limit: (neighbours + 4 v) / 6.
    testing::expect_near(testing::position(*edges, (*edges).vertex(0)), V3f(1 / 6.0f, 1 / 6.0f, 0), 1e-6f,
                         "round");
}

TEST(SubdivisionSurface, HolesLeaveTheRestAsItIs) {
    const Cage cage = testing::cube_cage();
    const MadeLimit whole(cage), open(cage, {{"hole", {0, 1}, {}, {}}});
    const std::vector<V2f> uv = random_places(20, 4);
    for (int face = 0; face < 6; ++face) {
        EXPECT_EQ((*open).is_hole(face), face < 2);
        if ((*open).is_hole(face)) continue;
        const Evaluated a = evaluate(*whole, face, uv), b = evaluate(*open, face, uv);
        EXPECT_EQ(std::memcmp(a.P.data(), b.P.data(), a.P.size() * sizeof(V3f)), 0);
    }
    for (uint32_t e = 0; e < (*open).edge_count(); ++e) EXPECT_FALSE((*open).is_hole((*open).edge(e).face));
    testing::expect_joined(*open, 1e-5f);
}

TEST(SubdivisionSurface, ShapeKeys) {
    const Cage cage = testing::prism_cage(5);
    std::vector<float> later = cage.P;
    for (size_t i = 0; i < later.size(); ++i) later[i] = 2 * later[i] + static_cast<float>(i % 7);
    Cage moved = cage;
    moved.P = later;
    const MadeLimit moving(cage, std::vector{cage.P, later}), fixed(moved);
    const std::vector<V2f> uv = random_places(20, 4);
    for (int face = 0; face < (*moving).face_count(); ++face) {
        const Evaluated a = evaluate(*moving, face, uv, 1), b = evaluate(*fixed, face, uv);
        EXPECT_EQ(std::memcmp(a.P.data(), b.P.data(), a.P.size() * sizeof(V3f)), 0);
        const Box3f box = (*moving).bound(face, {0, 0}, {1, 1}, 1);
        for (const V3f& p : a.P) EXPECT_TRUE(box.intersects(p));
    }
}

TEST(SubdivisionSurface, OptionsChangeTheSurface) {
    const Cage cage = testing::prism_cage(5);
    // On the last face, a triangle at the top: at its centre, or at a corner of the ring below.
    const auto at = [&](int pieces_back, V2f uv, std::vector<Tag> tags) {
        const MadeLimit made(cage, std::move(tags));
        EXPECT_EQ(made.warnings(), 0u);
        return evaluate(*made, (*made).face_count() - pieces_back, {uv}).P[0];
    };
    const V3f plain = at(1, {1, 1}, {});
    EXPECT_GT((at(1, {1, 1}, {{"smoothtriangles", {2}, {}, {}}}) - plain).length(), 1e-4f);
    EXPECT_EQ(at(1, {1, 1}, {{"smoothtriangles", {0}, {}, {}}}), plain);
    EXPECT_EQ(at(1, {1, 1}, {{"creasemethod", {}, {}, {"normal"}}}), plain);
    const Tag crease{"crease", {5, 6, 7, 8, 9, 5}, {1, 3, 1, 2, 3.5f}, {}};
    const V3f normal = at(3, {0.5f, 0}, {crease});
    EXPECT_GT((at(3, {0.5f, 0}, {crease, {"creasemethod", {}, {}, {"chaikin"}}}) - normal).length(), 1e-4f);
}

TEST(SubdivisionSurface, WrongTagsAreReportedAndLeftOut) {
    const std::vector<Tag> wrong = {{"wrinkle", {1}, {}, {}},
                                    {"crease", {0, 7}, {2}, {}},
                                    {"crease", {0, 99}, {2}, {}},
                                    {"crease", {0, 1, 3}, {1, 2, 3}, {}},
                                    {"crease", {0}, {1}, {}},
                                    {"corner", {-1}, {1}, {}},
                                    {"hole", {6}, {}, {}},
                                    {"interpolateboundary", {7}, {}, {}},
                                    {"facevaryinginterpolateboundary", {-1}, {}, {}},
                                    {"creasemethod", {}, {}, {"bent"}}};
    const MadeLimit plain(testing::cube_cage());
    for (const Tag& tag : wrong) {
        const MadeLimit made(testing::cube_cage(), {tag});
        ASSERT_TRUE(made.surface) << tag.name;
        EXPECT_EQ(made.warnings(), 1u) << tag.name;
        EXPECT_EQ(evaluate(*made, 3, {{0.3f, 0.6f}}).P[0], evaluate(*plain, 3, {{0.3f, 0.6f}}).P[0]);
    }
}

TEST(SubdivisionSurface, RefusesWhatHasNoSurface) {
    Cage outside = testing::cube_cage();
    outside.vertices[5] = 8;
    Cage missing = testing::cube_cage();
    missing.vertices.pop_back();
    for (const Cage& cage : {outside, missing}) {
        const MadeLimit made(cage);
        EXPECT_FALSE(made.surface);
        EXPECT_EQ(made.errors(), 1u);
    }
    const MadeLimit loop(testing::cube_cage(), {}, Scheme::Loop);  // of quads
    EXPECT_FALSE(loop.surface);
    EXPECT_EQ(loop.errors(), 1u);
    const MadeLimit fan(testing::prism_cage(300));
    EXPECT_FALSE(fan.surface);
    EXPECT_EQ(fan.errors(), 1u);
}

/// Three faces at an edge, faces that run against each other, cones that touch in a vertex, stray vertices,
/// quads of which two corners are one vertex.
TEST(SubdivisionSurface, NonManifoldMeshes) {
    Cage fins;
    fins.P = {0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0, 1, -1, 1, 0, -1, 1, 1, -1, -1, 0, -1, -1, 1, 9, 9, 9};
    fins.sizes = {4, 4, 4};
    fins.vertices = {0, 1, 3, 2, 0, 1, 5, 4, 0, 1, 7, 6};
    Cage against = testing::sheet_cage(2, 0.3f);
    std::reverse(against.vertices.begin(), against.vertices.begin() + 4);
    Cage cones;
    cones.P = {0, 0, 0, 1, 0, 1, 0, 1, 1, -1, -1, 1, 1, 0, -1, 0, 1, -1, -1, -1, -1};
    cones.sizes.assign(6, 3);
    cones.vertices = {0, 1, 2, 0, 2, 3, 0, 3, 1, 0, 4, 5, 0, 5, 6, 0, 6, 4};
    Cage doubled = testing::cube_cage();  // each face is there twice
    doubled.sizes.insert(doubled.sizes.end(), 6, 4);
    for (size_t i = 0; i < 24; ++i) doubled.vertices.push_back(doubled.vertices[i]);
    Cage pole = testing::octahedron_cage();
    pole.sizes.assign(8, 4);
    for (int face = 0; face < 8; ++face)
        pole.vertices.insert(pole.vertices.begin() + 4 * face + 3, pole.vertices[4 * face + 2]);
    for (const Cage& cage : {fins, against, cones, doubled, pole})
        for (const std::vector<Tag>& tags : {std::vector<Tag>{kInterpolate}, std::vector<Tag>{}}) {
            const MadeLimit made(cage, tags);
            ASSERT_TRUE(made.surface);
            testing::expect_joined(*made, 2e-5f);
            for (uint32_t v = 0; v < (*made).vertex_count(); ++v) {
                const V3f p = testing::position(*made, (*made).vertex(v));
                EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
            }
        }
}

TEST(SubdivisionSurface, RandomConnectivity) {
    std::mt19937 random(17);
    int surfaces = 0;
    for (int round = 0; round < 600; ++round) {
        const bool loop = round % 3 == 0;
        const MadeLimit made(testing::random_cage(random, loop),
                             {{"interpolateboundary", {round % 2 + 1}, {}, {}}},
                             loop ? Scheme::Loop : Scheme::CatmullClark);
        EXPECT_EQ(made.errors(), made.surface ? 0u : 1u);
        if (!made.surface) continue;
        ++surfaces;
        for (int face = 0; face < (*made).face_count(); ++face) {
            (*made).bound(face, {0, 0}, {1, 1}, 0);
            for (const V3f& p : evaluate(*made, face, random_places(6, 1)).P)
                ASSERT_TRUE(std::isfinite(p.x + p.y + p.z)) << "round " << round;
        }
    }
    EXPECT_GT(surfaces, 200);
}

}  // namespace
}  // namespace trapeze
