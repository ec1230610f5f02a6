#include "shade/clouds/cloud_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shade/clouds/clouds_harness.h"

namespace trapeze::testing {
namespace {

/// What CloudTree::find() says, point by point.
std::vector<CloudShare> by_brute_force(const PointCloud& cloud, const CloudPlace& place) {
    std::vector<CloudShare> shares;
    double sum = 0;
    for (uint32_t i = 0; i < cloud.size(); ++i) {
        const double of_cloud = CloudTree::kReach * static_cast<double>(cloud.radii[i]);
        const double reach = static_cast<double>(place.radius_scale) *
                             (place.radius > 0 ? static_cast<double>(place.radius) : of_cloud);
        double d2 = 0, facing = 0;
        for (int k = 0; k < 3; ++k) {
            const double d = static_cast<double>(cloud.positions[i][k]) - place.position[k];
            d2 += d * d, facing += static_cast<double>(cloud.normals[i][k]) * place.normal[k];
        }
        if (place.normal == V3f(0) || cloud.normals[i] == V3f(0)) facing = 1;
        if (d2 >= reach * reach || facing <= 0) continue;
        const double weight =
            std::pow(1 - d2 / (reach * reach), 4) * facing * std::pow(static_cast<double>(cloud.radii[i]), 2);
        shares.push_back({i, weight});
        sum += weight;
    }
    for (CloudShare& share : shares) share.weight /= sum;
    return shares;
}

void expect_same(std::vector<CloudShare> found, const std::vector<CloudShare>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    std::ranges::sort(found, {}, &CloudShare::point);
    for (size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].point, expected[i].point);
        EXPECT_NEAR(found[i].weight, expected[i].weight, 1e-12);
    }
}

TEST(CloudTree, FindsWhatTestingEveryPointFinds) {
    size_t found = 0;
    for (const size_t points : {0, 1, 7, 8, 9, 300, 2000}) {
        const PointCloud cloud = some_cloud(points, static_cast<uint32_t>(points));
        const CloudTree tree(cloud);
        Numbers numbers(5);
        std::vector<CloudShare> shares;
        for (int i = 0; i < 200; ++i) {
            CloudPlace place;
            place.position = numbers.in_cube() * 7.0f;
            if (i % 3) place.normal = numbers.in_cube().normalized();
            if (i % 4 == 1) place.radius = numbers.between(0, 5);
            if (i % 4 == 2) place.radius_scale = numbers.between(.1f, 3);
            tree.find(place, shares);
            found += shares.size();
            expect_same(shares, by_brute_force(cloud, place));
        }
    }
    EXPECT_GT(found, 4000u);
}

/// Squares of side `h`, whose corners are the points, each with its share of the area.
PointCloud plane(int side, float h) {
    PointCloud cloud;
    for (int y = 0; y <= side; ++y)
        for (int x = 0; x <= side; ++x) {
            const float share = (x % side ? 1.0f : .5f) * (y % side ? 1.0f : .5f);
            cloud.positions.emplace_back(h * static_cast<float>(x), h * static_cast<float>(y), 0);
            cloud.normals.emplace_back(0, 0, 1);
            cloud.radii.push_back(h * std::sqrt(share / std::numbers::pi_v<float>));
        }
    return cloud;
}

/// Everything between the points of a grid is found, be it a single square; and all points that count are no
/// farther than the reach of the largest, so that a function of slope 1 is off by no more than that.
TEST(CloudTree, CoversGridsWithoutHoles) {
    for (const int side : {1, 2, 16}) {
        const float h = .3f, reach = CloudTree::kReach * h / std::sqrt(std::numbers::pi_v<float>);
        const PointCloud cloud = plane(side, h);
        const CloudTree tree(cloud);
        Numbers numbers(3);
        std::vector<CloudShare> shares;
        for (int i = 0; i < 500; ++i) {
            CloudPlace place;
            place.normal = {0, 0, 1};
            const float size = h * static_cast<float>(side), x = numbers.between(0, size);
            place.position = {x, numbers.between(0, size), 0};
            tree.find(place, shares);
            ASSERT_FALSE(shares.empty());
            double mean = 0;
            for (const CloudShare& share : shares) mean += share.weight * cloud.positions[share.point].x;
            EXPECT_NEAR(mean, x, reach);
        }
    }
}

/// In the middle of a grid the mean of x is off by what Poisson's summation formula gives: the gradient of
/// the kernel's transform at the frequencies of the grid, over its value at 0. The kernel (1 - d^2 / R^2)^4
/// has the transform 768 pi R^2 J5(z) / z^5, z = k R, whose value at 0 is pi R^2 / 5 and whose derivative by
/// z is that with -J6 for J5; |J5| and |J6| are at most sqrt(2 / (pi z)). With R = 4 h / sqrt(pi) the
/// frequencies along x have z = 14.18, the two of which give 2 * 1.42e-3 R; the next, diagonal ones (20.05)
/// together 6e-4 R, all others less than 1e-4 R. The weights' sum may be less than its mean by 6e-3 of it.
TEST(CloudTree, KeepsLinearFunctionsInTheMiddle) {
    const float h = .1f, reach = CloudTree::kReach * h / std::sqrt(std::numbers::pi_v<float>);
    const PointCloud cloud = plane(32, h);
    const CloudTree tree(cloud);
    Numbers numbers(8);
    std::vector<CloudShare> shares;
    for (int i = 0; i < 500; ++i) {
        CloudPlace place;
        const float x = numbers.between(1, 2);
        place.position = {x, numbers.between(1, 2), 0};
        tree.find(place, shares);
        double mean = 0;
        for (const CloudShare& share : shares) mean += share.weight * cloud.positions[share.point].x;
        EXPECT_NEAR(mean, x, reach * 3.7e-3);
    }
}

TEST(CloudTree, PointsOfTheOtherSideDoNotCount) {
    PointCloud cloud;
    for (const float z : {1.0f, -1.0f}) {
        cloud.positions.emplace_back(0, 0, .01f * z), cloud.normals.emplace_back(0, 0, z);
        cloud.radii.push_back(1);
    }
    const CloudTree tree(cloud);
    std::vector<CloudShare> shares;
    CloudPlace place;
    place.position = V3f(0);
    place.normal = {0, 0, 1};
    tree.find(place, shares);
    ASSERT_EQ(shares.size(), 1u);
    EXPECT_EQ(shares[0].point, 0u);
    place.normal = V3f(0);
    tree.find(place, shares);
    EXPECT_EQ(shares.size(), 2u);
}

TEST(CloudTree, WhatIsNotFiniteIsNotFound) {
    PointCloud cloud = some_cloud(50);
    cloud.positions[3].x = NAN, cloud.positions[9].y = INFINITY, cloud.radii[12] = NAN;
    const CloudTree tree(cloud);
    std::vector<CloudShare> shares;
    CloudPlace place;
    place.position = V3f(0), place.radius = 100;
    tree.find(place, shares);
    EXPECT_EQ(shares.size(), 47u);
    place.position.x = NAN;
    tree.find(place, shares);
    EXPECT_TRUE(shares.empty());
}

TEST(CloudTree, PointsWithoutARadiusTakeTheUsualOne) {
    PointCloud cloud = plane(16, .1f);
    std::ranges::fill(cloud.radii, 0.0f);
    const CloudTree tree(cloud);
    std::vector<CloudShare> shares;
    CloudPlace place;
    place.position = {.77f, .33f, 0};
    tree.find(place, shares);
    EXPECT_GE(shares.size(), 4u);
    EXPECT_LE(shares.size(), 30u);
}

}  // namespace
}  // namespace trapeze::testing
