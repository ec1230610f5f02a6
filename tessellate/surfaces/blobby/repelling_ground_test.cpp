/// Repelling planes: the published profile and its slope, surfaces that stay above the ground, and what
/// happens without one.
#include "tessellate/surfaces/blobby/repelling_ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/scene/scene.h"
#include "tessellate/surfaces/blobby/blobby_mesh.h"

namespace trapeze {
namespace {

CellSizes ground_cells(float size) {
    return [size](const Box3f&) { return size; };
}

/// The example of RISpec 5.6.
constexpr Repulsion kExample{0.4f, 0.01f, 0.3f, 0.08f};

/// By a table: z, bump(z / 0.3), ease(z / 0.4) as fractions.
TEST(RepellingGround, RepelsByThePublishedProfile) {
    const struct {
        float z;
        double bump, ease;
    } rows[] = {
        {0.1f, 125.0 / 729, 0.15625},    // r = 1/3: (5/9)^3; e = 1/4: 1/16 * 5/2
        {0.15f, 27.0 / 64, 0.31640625},  // r = 1/2: (3/4)^3; e = 3/8: 9/64 * 9/4
        {0.2f, 512.0 / 729, 0.5},        // r = 2/3: (8/9)^3; e = 1/2
        {0.3f, 1.0, 0.84375},            // the peak; e = 3/4: 9/16 * 3/2
    };
    for (const auto& row : rows)
        EXPECT_NEAR(kExample.at(row.z), (0.08 * row.bump - 0.01 / row.z) * (1 - row.ease), 1e-6) << row.z;
    EXPECT_EQ(kExample.at(0.4f), 0);
    EXPECT_EQ(kExample.at(5), 0);
    EXPECT_FLOAT_EQ(kExample.at(0), -1e4f) << "-B / 1e-6";
    EXPECT_EQ(kExample.at(-3), kExample.at(0));
    // Beyond twice the peak nothing is left of the bulge.
    const Repulsion low{10, 0.01f, 0.3f, 0.08f};
    EXPECT_NEAR(low.at(2), (-0.01 / 2) * (1 - 0.04 * 2.6), 1e-7);
}

TEST(RepellingGround, SlopesAreThoseOfTheProfile) {
    for (float z = 0.02f; z < 0.5f; z += 0.007f) {
        const double h = 1e-3 * z;
        const double difference = (static_cast<double>(kExample.at(static_cast<float>(z + h))) -
                                   kExample.at(static_cast<float>(z - h))) /
                                  (2 * h);
        EXPECT_NEAR(kExample.slope(z), difference, 2e-3 * (1 + std::abs(difference))) << z;
    }
    EXPECT_EQ(kExample.slope(-1), 0);
    EXPECT_EQ(kExample.slope(1), 0);
}

TEST(RepellingGround, OddParametersAreSurvived) {
    for (const Repulsion& odd :
         {Repulsion{}, Repulsion{0.4f, 0.1f, 0, 1}, Repulsion{-1, 1, -1, 1}, Repulsion{1, 0, 1e-30f, 1e30f}})
        for (const float z : {-1.0f, 0.0f, 1e-30f, 0.5f, 1.0f, kInfinity}) {
            EXPECT_TRUE(std::isfinite(odd.at(z))) << z;
            EXPECT_FALSE(std::isnan(odd.slope(z))) << z;
        }
}

/// A ball of radius 1 (drawn at 1/2) at (0, 0, height) and a plane, added.
Blobby ball_over_plane(float height, const Repulsion& r) {
    Blobby b;
    b.leaf_count = 2;
    b.code = {1001, 0, 1003, 0, 16, 0, 2, 0, 1};
    b.floats = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, height, 1, r.reach, r.barrier, r.peak, r.bulge};
    b.strings = {"ground.z"};
    return b;
}

FindGround at_z_zero() {
    return [](const std::string& name) -> GroundHeight {
        if (name != "ground.z") return {};
        return [](const V3f& p) { return p.z; };
    };
}

/// On the ball's axis below its middle the field is (1 - (h - z)^2)^3 + repulsion(z), which rises with z.
float lowest_point(float height, const Repulsion& r) {
    double lo = 1e-6, hi = height;
    for (int k = 0; k < 100; ++k) {
        const double z = (lo + hi) / 2, s = 1 - (height - z) * (height - z);
        (s * s * s + r.at(static_cast<float>(z)) > 27.0 / 64 ? hi : lo) = z;
    }
    return static_cast<float>(hi);
}

TEST(RepellingGround, KeepsTheSurfaceAboveItself) {
    constexpr float kHeight = 0.3f;  // without the plane the ball would reach down to -0.2
    const BlobbyField field = blobby_field(ball_over_plane(kHeight, kExample), at_z_zero());
    ASSERT_EQ(field.grounds.size(), 1u);
    const float lowest = lowest_point(kHeight, kExample);
    EXPECT_GT(lowest, 0.01f);
    EXPECT_LT(lowest, 0.05f);
    for (const float cell : {0.05f, 0.02f}) {
        const BlobbyMesh mesh = blobby_mesh(field, ground_cells(cell));
        ASSERT_GT(mesh.points.size(), 200u);
        float low = 1, high = 0;
        for (size_t i = 0; i < mesh.points.size(); ++i) {
            const V3f& p = mesh.points[i];
            low = std::min(low, p.z), high = std::max(high, p.z);
            EXPECT_GT(p.z, 0.9f * lowest);
            if (p.z < 0.4f) continue;
            // Beyond the plane's reach the ball is a ball.
            EXPECT_NEAR((p - V3f(0, 0, kHeight)).length(), 0.5f, 1e-4f);
        }
        EXPECT_NEAR(low, lowest, 2e-3f);
        EXPECT_NEAR(high, kHeight + 0.5f, 2e-3f);
    }
}

TEST(RepellingGround, MayLieOnASlope) {
    // The ground z = x, whose heights are taken along z.
    const FindGround slope = [](const std::string&) -> GroundHeight {
        return [](const V3f& p) { return p.z - p.x; };
    };
    const BlobbyMesh mesh =
        blobby_mesh(blobby_field(ball_over_plane(0.2f, kExample), slope), ground_cells(0.03f));
    ASSERT_GT(mesh.points.size(), 200u);
    for (size_t i = 0; i < mesh.points.size(); ++i) {
        const V3f& p = mesh.points[i];
        EXPECT_GT(p.z - p.x, 0) << p.x << ' ' << p.z;
        // Flat against the ground, the surface looks down at it.
        if (p.z - p.x < 0.03f && std::hypot(p.x, p.y) < 0.1f) {
            EXPECT_GT(mesh.normals[i].dot(V3f(1, 0, -1).normalized()), 0.9f);
        }
    }
}

TEST(RepellingGround, WithoutItsFileTheBallIsWhole) {
    const BlobbyField field = blobby_field(ball_over_plane(0.3f, kExample));
    EXPECT_TRUE(field.grounds.empty());
    for (const V3f& p : blobby_mesh(field, ground_cells(0.05f)).points)
        EXPECT_NEAR((p - V3f(0, 0, 0.3f)).length(), 0.5f, 1e-4f);
}

/// A bulge that is above the threshold by itself would be an endless sheet: it ends where the ball does.
TEST(RepellingGround, EndsWhereTheBumpsEnd) {
    const BlobbyField field = blobby_field(ball_over_plane(0.3f, {2, 0.001f, 0.3f, 1}), at_z_zero());
    const BlobbyMesh mesh = blobby_mesh(field, ground_cells(0.05f));
    ASSERT_GT(mesh.points.size(), 200u);
    for (const V3f& p : mesh.points) EXPECT_LT((p - V3f(0, 0, 0.3f)).length(), 1.1f);
    for (const int v : mesh.vertices) EXPECT_GE(v, 0) << "an open side";
}

}  // namespace
}  // namespace trapeze
