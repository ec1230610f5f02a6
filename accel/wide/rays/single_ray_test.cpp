/// Single rays through a WideTree on every instruction set of the machine, against testing every
/// micropolygon and against the scalar twin: the same hits, bit for bit.
#include "accel/wide/rays/single_ray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "accel/rays_harness.h"
#include "accel/wide/rays/scalar_ray_harness.h"
#include "core/simd/targets_harness.h"

namespace trapeze {
namespace {

using testing::for_each_target;
using testing::GridMaker;
using testing::Noise;
using testing::ScalarRay;

struct Query {
    SpaceRay ray;
    DepthRange range;
};

/// Rays of all kinds around things within `reach` of `centre`.
std::vector<Query> queries_around(const V3f& centre, float reach, int count, Noise& noise) {
    std::vector<Query> queries;
    for (int n = 0; n < count; ++n) {
        V3f direction = noise.point(1);
        if (n % 5 == 0) direction[n % 3] = 0;                         // along a plane of the axes
        if (n % 7 == 0) direction[n % 3] = n % 2 ? 1e-20f : -1e-30f;  // nearly
        if (n % 15 == 0) direction = V3f(0), direction[n / 15 % 3] = n % 2 ? 1.0f : -1.0f;
        V3f origin = centre + noise.point(reach);
        if (n % 11 == 0) {
            // From far out, towards something.
            const float far = std::ldexp(reach, n % 20);
            origin = centre + direction * -far + noise.point(reach);
        }
        DepthRange range;
        if (n % 3 == 0) range = {noise(-reach, reach), noise(0, 3 * reach)};
        queries.push_back({{origin, direction, noise(0, 1)}, range});
    }
    return queries;
}

void expect_hits(const WideTree& tree, const std::vector<Query>& queries, const std::vector<Hit>& truth) {
    for_each_target([&] {
        for (size_t n = 0; n < queries.size(); ++n) {
            const auto& [ray, range] = queries[n];
            ASSERT_EQ(closest_hit(tree, ray, range).value_or(kNoHit), truth[n]) << n;
            ASSERT_EQ(any_hit(tree, ray, range), truth[n] != kNoHit) << n;
        }
    });
}

/// Compares all targets with the truth; how many rays have hit.
int expect_truth(const Grids& grids, const std::vector<Query>& queries) {
    std::vector<Hit> truth;
    int hits = 0;
    for (const auto& [ray, range] : queries) {
        truth.push_back(testing::closest_naively(grids, ray, range));
        hits += truth.back() != kNoHit;
    }
    expect_hits(WideTree(grids, {}), queries, truth);
    return hits;
}

TEST(SingleRay, HitsWhatTestingEverythingHits) {
    for (const int keys : {1, 2, 5}) {
        Noise noise;
        GridMaker maker;
        testing::add_sheets(maker, 60, keys, noise);
        testing::add_sheets(maker, 20, 1, noise);
        // Ribbons, whose blocks share boxes.
        for (int n = 0; n < 20; ++n) {
            const V3f origin = noise.point(4), along = noise.point(0.3f);
            maker.add(n % 2 ? 16 : 1, n % 2 ? 1 : 13, keys, [=](int i, int j, float t) {
                return origin + along * static_cast<float>(i + j) +
                       V3f(0.1f * static_cast<float>(n % 2 ? j : i), t, 0.1f * static_cast<float>(i * j));
            });
        }
        EXPECT_GT(expect_truth(maker.grids(), queries_around(V3f(0), 5, 3000, noise)), 500);
    }
}

/// More rays than can be tested against everything, and grids that are seen from one side.
TEST(SingleRay, EqualsItsScalarTwin) {
    for (const int keys : {1, 2, 9}) {
        Noise noise;
        GridMaker maker;
        for (const Facing facing : {Facing::Both, Facing::PositiveOnly, Facing::NegativeOnly}) {
            maker.facing = facing;
            testing::add_sheets(maker, 200, keys, noise);
            testing::add_sheets(maker, 30, 1, noise);
        }
        const WideTree tree(maker.grids(), {});
        const std::vector<Query> queries = queries_around(V3f(0), 5, 10000, noise);
        std::vector<Hit> truth;
        for (const auto& [ray, range] : queries)
            truth.push_back(ScalarRay<ClosestHit>::traced(tree, ray, range).best);
        EXPECT_GT(std::count_if(truth.begin(), truth.end(), [](const Hit& hit) { return hit != kNoHit; }),
                  2000);
        expect_hits(tree, queries, truth);
    }
}

/// From each hit to the next, however many are as deep: what is there twice is met twice.
TEST(SingleRay, GoesOnFromHitToHit) {
    GridMaker maker;
    for (int copy = 0; copy < 2; ++copy) {
        Noise again;
        testing::add_sheets(maker, 40, 2, again);
    }
    const WideTree tree(maker.grids(), {});
    Noise noise;
    size_t most = 0;
    for (const auto& [ray, range] : queries_around(V3f(0), 5, 600, noise)) {
        std::vector<Hit> truth;
        testing::for_each_hit_naively(maker.grids(), ray, range,
                                      [&](const Hit& hit) { truth.push_back(hit); });
        std::sort(truth.begin(), truth.end(), in_front);
        most = std::max(most, truth.size());
        for_each_target([&, &ray = ray, &range = range] {
            std::vector<Hit> found;
            Hit from = kFirstHit;
            DepthRange rest = range;
            while (const std::optional<Hit> hit = tree.closest_from(ray, rest, from)) {
                found.push_back(*hit);
                rest.min = hit->depth, from = {hit->depth, hit->id + 1};
                ASSERT_LE(found.size(), truth.size());
            }
            ASSERT_EQ(found, truth);
        });
    }
    EXPECT_GE(most, 8u);
}

/// Layers are what is hit where no opaque grid is, wherever along the ray.
TEST(SingleRay, TellsWhatIsInTheWay) {
    Noise noise;
    GridMaker all, opaque;
    for (const bool solid : {true, false, true}) {
        all.opaque = solid;
        Noise again = noise;
        testing::add_sheets(all, 20, 2, noise);
        if (solid) testing::add_sheets(opaque, 20, 2, again);
    }
    const WideTree tree(all.grids(), {});
    int counts[3] = {0, 0, 0};
    std::vector<Query> queries = queries_around(V3f(0), 5, 3000, noise);
    std::vector<InTheWay> truth;
    std::vector<DepthRange> certain;  // hits outside of it are layers
    for (const auto& [ray, range] : queries) {
        const size_t n = certain.size();
        certain.push_back({n % 2 ? range.min + 2 : kAllDepths.min, n % 3 ? kAllDepths.max : range.min + 6});
        const DepthRange sure{std::max(range.min, certain[n].min), std::min(range.max, certain[n].max)};
        const bool blocked = testing::closest_naively(opaque.grids(), ray, sure) != kNoHit;
        const bool met = testing::closest_naively(all.grids(), ray, range) != kNoHit;
        truth.push_back(blocked ? InTheWay::Opaque : met ? InTheWay::Layers : InTheWay::Nothing);
        ++counts[static_cast<size_t>(truth.back())];
    }
    for (const int count : counts) EXPECT_GT(count, 100);
    for_each_target([&] {
        for (size_t n = 0; n < queries.size(); ++n)
            ASSERT_EQ(tree.in_the_way(queries[n].ray, queries[n].range, certain[n]), truth[n]) << n;
    });
}

TEST(SingleRay, HitsWhatIsFarFromTheOrigin) {
    for (const int keys : {1, 2}) {
        Noise noise;
        GridMaker maker;
        const V3f centre(-3000, 20, 10000);
        for (int n = 0; n < 60; ++n) {
            const V3f origin = centre + noise.point(4), along_u = noise.point(0.1f),
                      along_v = noise.point(0.1f);
            maker.add(9, 14, keys, [=](int i, int j, float t) {
                return origin + along_u * static_cast<float>(i) + along_v * static_cast<float>(j) +
                       V3f(t, 0, t);
            });
        }
        EXPECT_GT(expect_truth(maker.grids(), queries_around(centre, 5, 3000, noise)), 300);
    }
}

/// Grids of which each is twice as large and as far as the last: the deepest tree for their number, all nodes
/// of which rays along the axis meet.
TEST(SingleRay, GoesThroughDeepTrees) {
    for (const bool nearest_first : {false, true}) {
        Noise noise;
        GridMaker maker;
        for (int n = -40; n < 40; ++n)
            for (int k = 0; k < 4; ++k)
                maker.add(2, 2, 1, [=](int i, int j, float) {
                    const float size = std::ldexp(1.0f + 0.2f * static_cast<float>(k), n);
                    return V3f(size * static_cast<float>(i - 1), size * static_cast<float>(j - 1),
                               (nearest_first ? size : -size) + size * 0.1f * static_cast<float>(i));
                });
        std::vector<Query> queries;
        for (int n = 0; n < 300; ++n)
            queries.push_back(
                {{noise.point(1e-14f), V3f(noise(-0.6f, 0.6f), noise(-0.6f, 0.6f), n % 2 ? 1 : -1), 0},
                 {noise(0, 1) * std::ldexp(1.0f, n % 60 - 30), HUGE_VALF}});
        EXPECT_GT(expect_truth(maker.grids(), queries), 100);
    }
}

TEST(SingleRay, HitsGridsWithoutBounds) {
    Noise noise;
    GridMaker maker;
    testing::add_sheets(maker, 10, 2, noise);
    maker.add(7, 5, 1, [](int i, int j, float) {
        return V3f(1e16f * (static_cast<float>(i) - 3.3f), 1e16f * (static_cast<float>(j) - 2.4f), 100);
    });
    maker.add(1, 1, 2, [](int i, int j, float t) {
        return V3f(-50, 1e16f * (static_cast<float>(i) - 0.4f),
                   1e16f * (static_cast<float>(j) - 0.5f + 0.1f * t));
    });
    EXPECT_GT(expect_truth(maker.grids(), queries_around(V3f(0), 5, 600, noise)), 200);
}

TEST(SingleRay, WithoutDirectionOrNumbersHitsNothing) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    Noise noise;
    GridMaker maker;
    testing::add_sheets(maker, 30, 2, noise);
    const V3f z(0, 0, 1), zero(0);
    std::vector<Query> queries = {{{zero, zero, 0}, {}},      {{V3f(kNan), z, 0}, {}},
                                  {{zero, V3f(kNan), 0}, {}}, {{zero, z, kNan}, {}},
                                  {{zero, z, 0}, {kNan, 1}},  {{zero, z, 0}, {0, kNan}},
                                  {{zero, z, 0}, {3, 2}}};
    for (int k = 0; k < 6; ++k) {
        Query query{{V3f(0.1f), z, 0}, {}};
        (k < 3 ? query.ray.origin : query.ray.direction)[k % 3] = kNan;
        queries.push_back(query);
    }
    EXPECT_EQ(expect_truth(maker.grids(), queries), 0);
}

TEST(SingleRay, CountsWhatItLooksAt) {
    GridMaker maker;
    maker.add(8, 8, 1,
              [](int i, int j, float) { return V3f(static_cast<float>(i), static_cast<float>(j), 5); });
    const WideTree tree(maker.grids(), {});
    SingleRayCounts counts;
    EXPECT_TRUE(closest_hit(tree, {V3f(1.5f, 1.5f, 0), V3f(0, 0, 1), 0}, {}, &counts));
    EXPECT_TRUE(any_hit(tree, {V3f(1.5f, 1.5f, 0), V3f(0, 0, 1), 0}, {}, &counts));
    EXPECT_EQ(counts.nodes, 2u);
    EXPECT_EQ(counts.grids, 2u);
    EXPECT_EQ(counts.blocks, 2u);
}

}  // namespace
}  // namespace trapeze
