/// Closed subdivision and polygon meshes, diced at uneven rates by a camera that stands near them, have no
/// holes, standing still or moving.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "core/files/file_text_harness.h"
#include "tessellate/leak_harness.h"
#include "tessellate/mesh_harness.h"

namespace trapeze {
namespace {

using testing::Cage;
using testing::LeakCount;
using testing::TestScene;
using Scheme = SubdivisionMesh::Scheme;
using Tag = SubdivisionMesh::Tag;

M44f place(const V3f& angles, const V3f& at) {
    M44f m;
    m.rotate(angles);
    return m * testing::translation(at.x, at.y, at.z);
}

/// The numbers in the first brackets after a place in a RIB archive.
template <class T>
std::vector<T> numbers_after(const std::string& rib, const std::string& mark, int group) {
    size_t at = rib.find(mark);
    for (int i = 0; i <= group && at != std::string::npos; ++i) at = rib.find('[', at + 1);
    if (at == std::string::npos) return {};
    std::istringstream stream(rib.substr(at + 1, rib.find(']', at) - at - 1));
    std::vector<T> numbers;
    for (T number; stream >> number;) numbers.push_back(number);
    return numbers;
}

Cage spot_cage() {
    const std::string text = testing::file_text(TRAPEZE_SOURCE_DIR "/scenes/gallery/spot_mesh.rib");
    Cage cage;
    cage.sizes = numbers_after<int>(text, "SubdivisionMesh", 0);
    cage.vertices = numbers_after<int>(text, "SubdivisionMesh", 1);
    cage.P = numbers_after<float>(text, "\"P\"", 0);
    return cage;
}

std::vector<float> moved(const Cage& cage, float amount) {
    std::vector<float> P = cage.P;
    for (size_t i = 0; i < P.size(); ++i) P[i] += amount * std::sin(3 * P[(i + 1) % P.size()]);
    return P;
}

constexpr int64_t kFewRays = 100'000;  ///< for variants of what a million rays have tested

struct Pose {
    V3f centre{0, 0, 0};  ///< object space, inside the mesh
    float radius = 0.2f;  ///< all around is inside, too
    M44f from, to;
    float wobble = 0;  ///< by which the mesh changes its shape
};

/// Rays from a ball inside the mesh. A moving mesh has three keys of its shape and two of its place.
void expect_closed(const Cage& cage, const Topology& topology, const Pose& pose, float shading_rate = 1,
                   int64_t rays = 1'000'000) {
    TestScene scene;
    scene.attributes->shading_rate = shading_rate;
    std::vector<std::shared_ptr<const Shape>> shapes;
    std::vector<M44f> places = {pose.from};
    const bool moves = pose.to != M44f();
    for (const float amount : {0.0f, 0.5f, 1.0f}) {
        shapes.push_back(testing::shape_of(topology, {{testing::points(moved(cage, amount * pose.wobble))}}));
        if (!moves) break;
    }
    if (moves) places.push_back(pose.to);
    scene.keep_all().add(shapes, places);
    const LeakCount count = testing::count_leaks(
        scene,
        [&](uint32_t number, float time) {
            const V3f p = pose.centre + testing::random_direction(number, 7) *
                                            (pose.radius * std::cbrt(unit_float(hash(number, 8))));
            return moves ? p * pose.from * (1 - time) + p * pose.to * time : p * pose.from;
        },
        rays);
    EXPECT_EQ(scene.diagnostics.count(Severity::Warning) + scene.diagnostics.count(Severity::Error), 0u);
    EXPECT_GE(count.rays, rays);
    EXPECT_EQ(count.leaks, 0);
    EXPECT_EQ(count.wrong_sides, 0);
    EXPECT_GE(count.hits, count.rays);
    EXPECT_EQ(count.open_sides, 0u);
}

Pose still(const M44f& at) {
    Pose pose;
    pose.from = at;
    return pose;
}

Pose moving(const M44f& from, const M44f& to) {
    Pose pose;
    pose.from = from, pose.to = to, pose.wobble = 0.1f;
    return pose;
}

const M44f kNearMesh = place({0.3f, 0.5f, 0.1f}, {0.3f, 0.2f, 0.95f});
const M44f kLater = place({0.5f, 0.3f, 0.2f}, {0.2f, 0.25f, 1.05f});

TEST(MeshWatertight, Cube) {
    const Cage cage = testing::cube_cage();
    expect_closed(cage, testing::subdivision_of(cage), still(kNearMesh));
    expect_closed(cage, testing::subdivision_of(cage), moving(kNearMesh, kLater));
    expect_closed(cage, testing::subdivision_of(cage), still(kNearMesh), 500, kFewRays);
}

TEST(MeshWatertight, CreasesAndExtraordinaryVertices) {
    const Cage cage = testing::prism_cage(7);
    const std::vector<Tag> tags = {{"crease", {7, 8, 9, 10, 11, 12, 13, 7}, {10, 2.5f, 1, 10, 10, 3, 1}, {}},
                                   {"crease", {0, 1, 2, 3}, {2}, {}},
                                   {"corner", {4, 14}, {10, 1.5f}, {}}};
    expect_closed(cage, testing::subdivision_of(cage, tags), still(kNearMesh));
    expect_closed(cage, testing::subdivision_of(cage, tags), moving(kNearMesh, kLater));
}

TEST(MeshWatertight, PolygonsOfManySides) {
    const Cage cage = testing::prism_cage(5);
    expect_closed(cage, testing::subdivision_of(cage), still(kNearMesh), 1, kFewRays);
    expect_closed(cage, testing::subdivision_of(cage, {}, Scheme::Bilinear), moving(kNearMesh, kLater), 1,
                  kFewRays);
    expect_closed(cage, testing::polygons_of(cage), still(kNearMesh), 1, kFewRays);
    expect_closed(cage, testing::polygons_of(cage), moving(kNearMesh, kLater), 1, kFewRays);
}

TEST(MeshWatertight, Loop) {
    const Cage cage = testing::octahedron_cage();
    const std::vector<Tag> tags = {{"crease", {0, 1, 2}, {1.5f}, {}}};
    Pose pose = moving(place({0.3f, 0.5f, 0.1f}, {0.1f, 0.1f, 0.5f}), place({0.4f, 0.4f, 0}, {0, 0, 0.5f}));
    pose.radius = 0.1f;
    expect_closed(cage, testing::subdivision_of(cage, tags, Scheme::Loop), pose, 1, kFewRays);
}

TEST(MeshWatertight, Spot) {
    const Cage cage = spot_cage();
    ASSERT_EQ(cage.sizes.size(), 180u);
    ASSERT_EQ(cage.vertex_count(), 188);
    Pose pose = still(place({0, 0.8f, 0}, {-0.5f, 0.1f, 0.9f}));
    pose.centre = {0, -0.15f, 0.4f}, pose.radius = 0.08f;
    const Tag interpolate{"interpolateboundary", {1}, {}, {}};
    expect_closed(cage, testing::subdivision_of(cage, {interpolate}), pose);
    pose.to = place({0.1f, 1.0f, 0.1f}, {-0.45f, 0.15f, 0.8f});
    pose.wobble = 0.03f;
    expect_closed(cage, testing::subdivision_of(cage, {interpolate}), pose);
    expect_closed(cage, testing::polygons_of(cage), pose, 1, kFewRays);
}

}  // namespace
}  // namespace trapeze
