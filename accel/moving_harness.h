/// What trees over moving micropolygons are tested on, and how: strips that fly about, everything that is
/// awkward, and rays in all directions that must see what testing everything sees.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "accel/rays_harness.h"

namespace trapeze::testing {

/// Strips in all directions whose ends fly about, every eighth of them long: what spatial splits are for.
inline void add_strips(GridMaker& maker, int count, int keys, Noise& noise) {
    for (int n = 0; n < count; ++n) {
        std::array<V3f, 3> from, along;
        for (size_t pose = 0; pose < 3; ++pose)
            from[pose] = noise.point(.4f), along[pose] = noise.point(n % 8 == 0 ? 4 : .3f);
        const V3f middle = noise.point(3), across = noise.point(.15f);
        maker.add(1, 1, keys, [&](int i, int j, float t) {
            const auto between = [t](const std::array<V3f, 3>& p) {
                return t < .5f ? p[0] + (p[1] - p[0]) * (2 * t) : p[1] + (p[2] - p[1]) * (2 * t - 1);
            };
            return middle + between(from) + between(along) * static_cast<float>(j) +
                   across * static_cast<float>(i);
        });
    }
}

/// A ray towards some micropolygon, or along an axis.
inline SpaceRay noisy_ray(const GridMaker& maker, Noise& noise, int round) {
    SpaceRay ray{noise.point(4), V3f(0), noise(0, 1)};
    if (round % 8 == 0) {
        ray.direction[round / 8 % 3] = 1;
        return ray;
    }
    const auto& grids = maker.grids().grids;
    const Grid& grid = grids[noise.engine() % grids.size()];
    const float u = noise(0, 1), v = noise(0, 1);
    const V3f a = grid.vertex(0, 0, ray.time), b = grid.vertex(1, 0, ray.time),
              c = grid.vertex(0, 1, ray.time);
    const V3f at = a + (b - a) * u + (c - a) * v;
    ray.direction = at.length2() < 1e3f ? at - ray.origin : noise.point(1);
    return ray;
}

/// All kinds of motion, what cannot be bounded, twins in the same place, and points.
inline void add_all_kinds(GridMaker& maker, Noise& noise) {
    for (const int keys : {1, 2, 3, 5, 17}) add_strips(maker, 60, keys, noise);
    add_sheets(maker, 6, 5, noise);
    maker.add(2, 2, 1, [](int i, int j, float) { return V3f(3e38f * (i - 1), 3e38f * (j - 1), 3e38f); });
    for (int twin = 0; twin < 40; ++twin) {
        maker.add(1, 1, 2, [](int i, int j, float t) {
            return V3f(4 * static_cast<float>(i) - 2, 3 * static_cast<float>(j) - 2,
                       t + static_cast<float>(i + j));
        });
        maker.add(1, 1, 2, [](int, int, float t) { return V3f(t, 1, 2); });
    }
}

/// How many of some rays in all directions see something else than by testing everything. At least
/// `least_hits` of them must hit something for the answer to mean anything.
template <class Tree>
int differing_rays(const GridMaker& maker, const Tree& tree, int rays, int least_hits) {
    Noise noise;
    SampleStats stats;
    int differing = 0, hits = 0;
    for (int round = 0; round < rays; ++round) {
        const SpaceRay ray = noisy_ray(maker, noise, round);
        const DepthRange range{noise(-1, 1), noise(2, 12)};
        TraceRay trace_ray = TraceRay::turned(axis_ray(ray), range);
        ClosestHit policy;
        tree.trace(trace_ray, policy, stats);
        differing += !(policy.best == closest_naively(maker.grids(), ray, range));
        hits += policy.found();
    }
    EXPECT_GE(hits, least_hits);
    return differing;
}

template <class Tree>
int differing_rays(const GridMaker& maker, const Tree& tree, int rays) {
    return differing_rays(maker, tree, rays, rays / 2);
}

/// What the closest hits of some rays in all directions cost.
template <class Tree>
SampleStats stats_of_rays(const GridMaker& maker, const Tree& tree, int rays) {
    Noise noise;
    SampleStats stats;
    for (int round = 0; round < rays; ++round) {
        TraceRay ray = TraceRay::turned(axis_ray(noisy_ray(maker, noise, round)), {});
        ClosestHit policy;
        tree.trace(ray, policy, stats);
    }
    return stats;
}

/// Whether the layers that rays see are those of a tree where each micropolygon is in one leaf.
template <class PlainTree, class Tree>
void expect_same_layers(const GridMaker& maker, const PlainTree& plain, const Tree& cut, Noise& noise) {
    SampleStats stats;
    size_t layers = 0;
    for (int round = 0; round < 2000; ++round) {
        const TraceRay ray = TraceRay::turned(axis_ray(noisy_ray(maker, noise, round)), {});
        // As if all were transparent.
        struct Transparent {
            HitsUntilOpaque& to;
            void consider(const Hit& hit, bool, TraceRay& r) { to.consider(hit, false, r); }
        };
        const auto layers_of = [&](const auto& tree, bool may_repeat) {
            std::vector<Hit> all;
            HitsUntilOpaque policy{all};
            policy.may_repeat = may_repeat;
            Transparent transparent{policy};
            TraceRay copy = ray;
            tree.trace(copy, transparent, stats);
            std::sort(all.begin(), all.end(), in_front);
            return all;
        };
        const std::vector<Hit> expected = layers_of(plain, false);
        ASSERT_EQ(expected, layers_of(cut, true));
        layers += expected.size();
    }
    EXPECT_GT(layers, 1000u);
}

}  // namespace trapeze::testing
