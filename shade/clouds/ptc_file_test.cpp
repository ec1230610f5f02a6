#include "shade/clouds/ptc_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "shade/clouds/clouds_harness.h"
#include "shade/clouds/ptc_harness.h"

namespace trapeze::testing {
namespace {

/// Both numbers of a normal are rounded to the nearest of 65536: the angle by at most pi / 65535, the height
/// by at most 1 / 65535, of which the part beside it, sqrt(1 - z^2), is off by no more than sqrt(2 / 65535)
/// where it is least itself.
constexpr float kAngleStep = 4.8e-5f, kHeightStep = 1.53e-5f, kBesideStep = 5.6e-3f;

void expect_normal(const V3f& found, const V3f& expected) {
    const float beside = std::sqrt(std::max(0.0f, 1 - expected.z * expected.z));
    // d sqrt(1 - z^2) = z dz / sqrt(1 - z^2), and no more than kBesideStep.
    const float off = std::min(kBesideStep, beside > 0 ? 1.01f * kHeightStep / beside : kBesideStep) + 1e-6f;
    EXPECT_NEAR(found.z, expected.z, kHeightStep);
    EXPECT_NEAR(found.x, expected.x, off + kAngleStep * beside);
    EXPECT_NEAR(found.y, expected.y, off + kAngleStep * beside);
}

TEST(PtcFile, IsReadByPartiosSteps) {
    const PointCloud cloud = some_cloud(57);
    const PartioFile file = read_as_partio(ptc_of(cloud));
    EXPECT_EQ(file.version, 0);
    EXPECT_EQ(file.left, "");
    EXPECT_EQ(file.specs, (std::vector<std::string>{"float _area", "color _radiosity", "point _where",
                                                    "vector _flow", "normal _bent"}));
    const Box3f box = cloud.bounds();
    EXPECT_EQ(file.bounds, (std::array{box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z}));
    ASSERT_EQ(file.particles.size(), cloud.size());
    for (size_t i = 0; i < cloud.size(); ++i) {
        const PartioParticle& p = file.particles[i];
        EXPECT_EQ(V3f(p.position[0], p.position[1], p.position[2]), cloud.positions[i]);
        expect_normal(V3f(p.normal[0], p.normal[1], p.normal[2]), cloud.normals[i]);
        EXPECT_EQ(p.radius, cloud.radii[i]);
        const float* const values = cloud.values.data() + i * cloud.floats_per_point();
        EXPECT_EQ(p.attributes.at("_area"), std::vector<float>(values, values + 1));
        EXPECT_EQ(p.attributes.at("_radiosity"), std::vector<float>(values + 1, values + 4));
        EXPECT_EQ(p.attributes.at("_bent"), std::vector<float>(values + 10, values + 13));
    }
}

TEST(PtcFile, ComesBackAsItWas) {
    const PointCloud cloud = some_cloud(311);
    std::string problem;
    const auto read = read_ptc(ptc_of(cloud), &problem);
    ASSERT_TRUE(read) << problem;
    EXPECT_EQ(read->channels, cloud.channels);
    EXPECT_EQ(read->positions, cloud.positions);
    EXPECT_EQ(read->radii, cloud.radii);
    EXPECT_EQ(read->values, cloud.values);
    for (size_t i = 0; i < cloud.size(); ++i) expect_normal(read->normals[i], cloud.normals[i]);
}

TEST(PtcFile, AxesAndNoNormalComeBack) {
    PointCloud cloud;
    for (const V3f& n : {V3f(1, 0, 0), V3f(-1, 0, 0), V3f(0, 1, 0), V3f(0, -1, 0), V3f(0, 0, 1),
                         V3f(0, 0, -1), V3f(0, 0, 0), V3f(0, -1e-7f, 1)}) {
        cloud.positions.emplace_back(0, 0, 0), cloud.radii.push_back(1);
        cloud.normals.push_back(n);
    }
    std::string problem;
    const auto read = read_ptc(ptc_of(cloud), &problem);
    ASSERT_TRUE(read) << problem;
    for (size_t i = 0; i < cloud.size(); ++i) expect_normal(read->normals[i], cloud.normals[i]);
    EXPECT_EQ(read->normals[6], V3f(0));
}

/// PRMan writes further numbers, whose meaning nobody knows, in versions 1 and 2.
TEST(PtcFile, LaterVersionsHaveMoreInFrontOfTheirPoints) {
    const PointCloud cloud = some_cloud(9);
    const std::string plain = ptc_of(cloud);
    const size_t in_front = 4 + 4 + 8 + 6 * 4;
    for (const int version : {1, 2}) {
        std::string bytes = plain;
        const size_t channels = bytes.find("normal _bent\n") + std::strlen("normal _bent\n");
        bytes.insert(channels, 8, 'x');
        bytes.insert(in_front, version == 1 ? 16 : 16 + 33 * 4, '\xef');
        bytes[4] = static_cast<char>(version);
        std::string problem;
        const auto read = read_ptc(bytes, &problem);
        ASSERT_TRUE(read) << problem;
        EXPECT_EQ(read->positions, cloud.positions);
        EXPECT_EQ(read->values, cloud.values);
        EXPECT_EQ(read_as_partio(bytes).particles.size(), cloud.size());
    }
}

std::string ptc_problem_of(const std::string& bytes) {
    std::string problem;
    EXPECT_FALSE(read_ptc(bytes, &problem)) << problem;
    return problem;
}

TEST(PtcFile, CutShortAnywhereIsAMessage) {
    const std::string bytes = ptc_of(some_cloud(3));
    for (size_t size = 0; size < bytes.size(); ++size) EXPECT_NE(ptc_problem_of(bytes.substr(0, size)), "");
}

TEST(PtcFile, WhatCannotBeIsAMessage) {
    const std::string good = ptc_of(some_cloud(2));
    const auto with = [&](size_t at, const auto& value) {
        std::string bytes = good;
        std::memcpy(bytes.data() + at, &value, sizeof value);
        return bytes;
    };
    constexpr size_t kVersion = 4, kCount = 8, kChannels = 4 + 4 + 8 + (6 + 16 + 16 + 3) * 4;
    EXPECT_EQ(ptc_problem_of(with(kVersion, 3)), "it is of version 3; 2 is the newest that is known");
    EXPECT_EQ(ptc_problem_of(with(kVersion, -1)), "it is of version -1; 2 is the newest that is known");
    EXPECT_EQ(ptc_problem_of(with(kCount, 3.0)), "it says that it has 3 points, and has 2");
    for (const double count : {1e300, -1.0, 1.5, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()})
        EXPECT_NE(ptc_problem_of(with(kCount, count)), "") << count;
    EXPECT_EQ(ptc_problem_of(with(kChannels, 2147483647)), "it says that it has 2147483647 channels");
    EXPECT_EQ(ptc_problem_of(with(kChannels, -5)), "it says that it has -5 channels");
    EXPECT_EQ(ptc_problem_of(with(kChannels + 4, 12)), "its channels have 13 numbers where it says 12");
    std::string other = good;
    other.replace(other.find("float _area"), 5, "flood");
    EXPECT_EQ(ptc_problem_of(other), "its channel 1 has no type and name that are known");
    EXPECT_EQ(ptc_problem_of("ply"), "it is no point cloud");
}

}  // namespace
}  // namespace trapeze::testing
