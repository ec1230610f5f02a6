/// Many rays through a WideTree in groups, on every instruction set of the machine: what is in their way is
/// what is in the way of each alone.
#include "accel/wide/rays/ray_groups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "accel/rays_harness.h"
#include "accel/wide/rays/single_ray.h"
#include "core/simd/targets_harness.h"

namespace trapeze {
namespace {

using testing::for_each_target;
using testing::GridMaker;
using testing::Noise;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Rays to all sides from points next to each other, as a grid's shading sends them, `rays` from each of
/// `side` x `side` points around `centre`.
void add_hemispheres(const V3f& centre, float width, int side, int rays, Noise& noise,
                     std::vector<RangedRay>& to) {
    const V3f along_u = noise.point(width), along_v = noise.point(width);
    for (int p = 0; p < side * side; ++p) {
        const V3f origin = centre + along_u * (static_cast<float>(p % side) / static_cast<float>(side)) +
                           along_v * (static_cast<float>(p / side) / static_cast<float>(side));
        for (int i = 0; i < rays; ++i) {
            RangedRay ray;
            ray.ray = {origin, noise.point(1), noise(0, 1)};
            if (i % 9 == 0) ray.ray.direction[i % 3] = 0;
            if (i % 3 == 0) ray.range = {noise(0, 1), noise(0, 6)};
            if (i % 4 == 0) ray.sure.min = ray.range.min + 1;
            if (i % 5 == 0) ray.sure.max = ray.range.min + 3;
            to.push_back(ray);
        }
    }
}

/// Rays from such points to a point.
void add_shadow_rays(const V3f& centre, const V3f& to, Noise& noise, std::vector<RangedRay>& rays) {
    for (int p = 0; p < 100; ++p) {
        RangedRay ray;
        const V3f origin =
            centre + V3f(0.01f * static_cast<float>(p % 10), 0.01f * static_cast<float>(p / 10), 0);
        ray.ray = {origin, to - origin, noise(0, 1)};
        rays.push_back(ray);
    }
}

/// How many of the rays have something opaque, layers alone, and nothing in their way.
struct Ways {
    int opaque = 0, layers = 0, nothing = 0;
};

Ways expect_same(const Grids& grids, const std::vector<RangedRay>& rays) {
    const WideTree tree(grids, {});
    Ways ways;
    std::vector<InTheWay> truth;
    for (const RangedRay& ray : rays) {
        truth.push_back(tree.in_the_way(ray.ray, ray.range, ray.sure));
        ++(truth.back() == InTheWay::Opaque   ? ways.opaque
           : truth.back() == InTheWay::Layers ? ways.layers
                                              : ways.nothing);
    }
    for_each_target([&] {
        std::vector<InTheWay> met(rays.size(), InTheWay::Layers);
        tree.in_the_way(rays, met);
        for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(met[i], truth[i]) << i;
    });
    return ways;
}

TEST(RayGroups, AreOfOneAxisAndHaveEveryRayOnce) {
    Noise noise;
    std::vector<RangedRay> rays;
    for (int k = 0; k < 5; ++k) add_hemispheres(noise.point(3), 0.1f, 12, 40, noise, rays);
    add_shadow_rays(V3f(0), V3f(3, 8, 2), noise, rays);
    rays[77].ray.direction = V3f(0);
    rays[99].ray.direction.y = kNan;
    RayGroups groups;
    for (int again = 0; again < 2; ++again) {
        groups.group(rays);
        std::vector<int> times(rays.size(), 0);
        size_t count = 0;
        groups.for_each([&](std::span<const uint32_t> group) {
            ++count;
            ASSERT_GT(group.size(), 0u);
            ASSERT_LE(group.size(), RayGroups::kMost);
            const TurnedRay first = axis_ray(rays[group[0]].ray);
            for (const uint32_t i : group) {
                ++times[i];
                const TurnedRay one = axis_ray(rays[i].ray);
                ASSERT_EQ(one.z_plane, first.z_plane);
                ASSERT_EQ(one.depth_sign, first.depth_sign);
                ASSERT_LE(std::abs(one.ray.ux - first.ray.ux), 0.51f);
                ASSERT_LE(std::abs(one.ray.uy - first.ray.uy), 0.51f);
            }
        });
        for (size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(times[i], i == 77 || i == 99 ? 0 : 1) << i;
        EXPECT_LT(count, rays.size() / 8);
    }
}

TEST(RayGroups, RaysFromPlacesFarApartAreNotTogether) {
    Noise noise;
    std::vector<RangedRay> rays;
    for (int k = 0; k < 8; ++k)
        add_shadow_rays(V3f(static_cast<float>(5 * k), 0, 0), V3f(0, 0, 90), noise, rays);
    RayGroups groups;
    groups.group(rays);
    groups.for_each([&](std::span<const uint32_t> group) {
        for (const uint32_t i : group) ASSERT_EQ(i / 100, group[0] / 100);
    });
}

TEST(RayGroups, FindWhatRaysFindAlone) {
    for (const int keys : {1, 2, 9}) {
        Noise noise;
        GridMaker maker;
        for (const bool solid : {true, false, true}) {
            maker.opaque = solid;
            testing::add_sheets(maker, 60, keys, noise);
            testing::add_sheets(maker, 20, 1, noise);
        }
        std::vector<RangedRay> rays;
        for (int k = 0; k < 12; ++k) add_hemispheres(noise.point(5), 0.2f, 8, 24, noise, rays);
        for (int k = 0; k < 12; ++k) add_shadow_rays(noise.point(5), noise.point(8), noise, rays);
        const Ways ways = expect_same(maker.grids(), rays);
        EXPECT_GT(ways.opaque, 1000);
        EXPECT_GT(ways.layers, 200);
        EXPECT_GT(ways.nothing, 1000);
    }
}

/// More grids than a list has places, so that nodes stand for them.
TEST(RayGroups, FindItAmongMoreGridsThanAreListed) {
    Noise noise;
    GridMaker maker;
    for (int n = 0; n < 4000; ++n) {
        const V3f at(0.05f * static_cast<float>(n % 20), 0.05f * static_cast<float>(n / 20 % 20),
                     3 + 0.1f * static_cast<float>(n / 400));
        maker.opaque = n % 5 != 0;
        maker.add(3, 3, n % 2 + 1, [=](int i, int j, float t) {
            return at + V3f(0.008f * static_cast<float>(i), 0.008f * static_cast<float>(j), 0.01f * t);
        });
    }
    std::vector<RangedRay> rays;
    for (int p = 0; p < 640; ++p) {
        RangedRay ray;
        ray.ray = {V3f(0.02f * static_cast<float>(p % 32), 0.02f * static_cast<float>(p / 32), 0),
                   V3f(noise(-0.2f, 0.3f), noise(-0.2f, 0.3f), 1), noise(0, 1)};
        rays.push_back(ray);
    }
    const Ways ways = expect_same(maker.grids(), rays);
    EXPECT_GT(ways.opaque, 50);
    EXPECT_GT(ways.nothing, 50);
}

/// Rays side by side, along each axis and against it, each of which meets something else.
TEST(RayGroups, FindItFromPointsFartherApartThanThingsAreLarge) {
    for (int axis = 0; axis < 6; ++axis) {
        const auto turned = [&](const V3f& v) {
            return V3f(v[axis % 3], v[(axis + 1) % 3], v[(axis + 2) % 3]) * (axis < 3 ? 1.0f : -1.0f);
        };
        Noise noise;
        GridMaker maker;
        for (int n = 0; n < 400; ++n) {
            const V3f at(static_cast<float>(n % 20), static_cast<float>(n / 20), noise(2, 9));
            maker.add(2, 2, n % 3 + 1, [=](int i, int j, float t) {
                return turned(at + V3f(0.2f * static_cast<float>(i), 0.2f * static_cast<float>(j), 0.1f * t));
            });
        }
        std::vector<RangedRay> rays;
        for (int p = 0; p < 1600; ++p) {
            const V3f from(0.5f * static_cast<float>(p % 40) + 0.1f, 0.5f * static_cast<float>(p / 40) + 0.1f,
                           p % 3 == 0 ? 12.0f : -1.0f);
            const V3f way(noise(-0.05f, 0.05f), noise(-0.05f, 0.05f), from.z > 0 ? -1.0f : 1.0f);
            RangedRay ray;
            ray.ray = {turned(from), turned(way), noise(0, 1)};
            rays.push_back(ray);
        }
        const Ways ways = expect_same(maker.grids(), rays);
        EXPECT_GT(ways.opaque, 100) << axis;
        EXPECT_GT(ways.nothing, 100) << axis;
    }
}

/// Groups of one ray alone, which have nothing to spare: walls along the axes, whose boxes are thin, and
/// ranges of no more than the depth of what is hit; from near, and from so far that rays round by more than
/// the tree has grown its boxes.
TEST(RayGroups, FindWhatRoundingTakesOutOfItsBox) {
    for (int n = 0; n < 6; ++n) {
        const int axis = n % 3;
        const float back = n < 3 ? 0.0f : 3e7f;
        const auto turned = [&](float x, float y, float z) {
            const float v[3] = {x, y, z};
            return V3f(v[axis], v[(axis + 1) % 3], v[(axis + 2) % 3]);
        };
        Noise noise;
        GridMaker maker;
        for (int k = 0; k < 64; ++k)
            maker.add(5, 5, 1, [=](int i, int j, float) {
                return turned(300.1f + static_cast<float>(k % 8) + 0.2f * static_cast<float>(i),
                              200.3f + static_cast<float>(k / 8) + 0.2f * static_cast<float>(j), 1000.3f);
            });
        const WideTree tree(maker.grids(), {});
        const V3f way = turned(0.3f, 0.2f, 1);
        std::vector<RangedRay> rays;
        for (int p = 0; p < 100; ++p) {
            RangedRay ray;
            ray.ray = {turned(noise(0.5f, 7.5f), noise(0.5f, 7.5f), 1.7f) - way * back, way, 0};
            const std::optional<Hit> hit = tree.closest(ray.ray, {});
            if (!hit) continue;
            ray.range = {hit->depth, hit->depth};
            rays.insert(rays.end(), RayGroups::kMost, ray);
        }
        const Ways ways = expect_same(maker.grids(), rays);
        EXPECT_GT(ways.opaque, 640) << n;
        EXPECT_EQ(ways.nothing, 0) << n;
    }
}

/// Small things under a sky: tests of its boxes round by more than the small ones are large.
TEST(RayGroups, FindItUnderASky) {
    Noise noise;
    GridMaker maker;
    testing::add_sheets(maker, 60, 2, noise);
    for (int n = 0; n < 8; ++n)
        maker.add(4, 4, 1, [=](int i, int j, float) {
            const float turn = 0.8f * (static_cast<float>(n) + 0.25f * static_cast<float>(i));
            return V3f(3000 * std::cos(turn), 900 * static_cast<float>(j - 1), 3000 * std::sin(turn));
        });
    std::vector<RangedRay> rays;
    for (int k = 0; k < 8; ++k) add_hemispheres(noise.point(4), 0.1f, 8, 32, noise, rays);
    EXPECT_GT(expect_same(maker.grids(), rays).opaque, 1000);
}

TEST(RayGroups, FindWhatHasNoBounds) {
    Noise noise;
    GridMaker maker;
    testing::add_sheets(maker, 40, 2, noise);
    maker.add(7, 5, 1, [](int i, int j, float) {
        return V3f(1e16f * (static_cast<float>(i) - 3.3f), 1e16f * (static_cast<float>(j) - 2.4f), 100);
    });
    std::vector<RangedRay> rays;
    for (int k = 0; k < 4; ++k) add_hemispheres(noise.point(4), 0.1f, 8, 16, noise, rays);
    EXPECT_GT(expect_same(maker.grids(), rays).opaque, 500);
}

TEST(RayGroups, WithoutDirectionOrNumbersFindNothing) {
    Noise noise;
    GridMaker maker;
    testing::add_sheets(maker, 60, 2, noise);
    std::vector<RangedRay> rays;
    add_shadow_rays(V3f(0), V3f(0, 0, 9), noise, rays);
    add_hemispheres(V3f(0), 0.1f, 8, 32, noise, rays);
    for (size_t i = 0; i < rays.size(); i += 3) {
        RangedRay& ray = rays[i];
        if (i % 7 == 0) ray.ray.direction = V3f(0);
        if (i % 7 == 1) ray.ray.direction[i % 2] = kNan;
        if (i % 7 == 2) ray.ray.origin.y = kNan;
        if (i % 7 == 3) ray.ray.time = kNan;
        if (i % 7 == 4) ray.range.min = kNan;
        if (i % 7 == 5) ray.range.max = kNan;
        if (i % 7 == 6) ray.range = {3, 2};
    }
    expect_same(maker.grids(), rays);
    expect_same(maker.grids(), {});
}

}  // namespace
}  // namespace trapeze
