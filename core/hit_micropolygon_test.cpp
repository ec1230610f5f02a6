#include "core/hit_micropolygon.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "core/grids_harness.h"
#include "core/noise_harness.h"

namespace trapeze {
namespace {

using testing::Noise;

AxisRay random_ray(Noise& noise) {
    return {noise(-1, 1), noise(-1, 1), 0, noise(-1, 1), noise(-1, 1), noise(0, 1)};
}

Quad random_quad(Noise& noise) {
    Quad q;
    for (int i = 0; i < 4; ++i) q.x[i] = noise(-2, 2), q.y[i] = noise(-2, 2), q.z[i] = noise(0.5f, 3);
    return q;
}

TEST(HitMicropolygon, HitsTheMiddleAndMissesBesides) {
    const Quad q{{0, 1, 0, 1}, {0, 0, 1, 1}, {2, 2, 4, 4}};
    float depth = 0;
    EXPECT_TRUE(hit_micropolygon({0.25f, 0.5f, 0, 0, 0, 0}, q, Facing::Both, &depth));
    EXPECT_FLOAT_EQ(depth, 3);
    EXPECT_FALSE(hit_micropolygon({1.25f, 0.5f, 0, 0, 0, 0}, q, Facing::Both, &depth));
    EXPECT_FALSE(hit_micropolygon({0.25f, -0.5f, 0, 0, 0, 0}, q, Facing::Both, &depth));
}

TEST(HitMicropolygon, FacingIsTheSignOfTheTurn) {
    Quad q{{0, 1, 0, 1}, {0, 0, 1, 1}, {2, 2, 2, 2}};  // 00, 10, 11, 01 counter-clockwise
    const AxisRay ray{0.3f, 0.6f, 0, 0, 0, 0};
    float depth;
    EXPECT_TRUE(hit_micropolygon(ray, q, Facing::PositiveOnly, &depth));
    EXPECT_FALSE(hit_micropolygon(ray, q, Facing::NegativeOnly, &depth));
    for (float& x : q.x) x = -x;
    const AxisRay mirrored{-0.3f, 0.6f, 0, 0, 0, 0};
    EXPECT_FALSE(hit_micropolygon(mirrored, q, Facing::PositiveOnly, &depth));
    EXPECT_TRUE(hit_micropolygon(mirrored, q, Facing::NegativeOnly, &depth));
}

/// Of a plane z = 2 + x + 2 y, as a ray along z meets it.
Quad on_plane(const std::array<V2f, 4>& corners) {
    Quad q;
    for (size_t i = 0; i < 4; ++i)
        q.x[i] = corners[i].x, q.y[i] = corners[i].y, q.z[i] = 2 + corners[i].x + 2 * corners[i].y;
    return q;
}

/// Two corners in one place make a triangle without an area, which borders on one that has some: rays through
/// this border are as deep as the latter says. Where grids join coarser ones they have such micropolygons.
TEST(HitMicropolygon, ATriangleWithoutAreaHasNoDepth) {
    Noise noise{std::mt19937(5)};
    int hits = 0;
    for (int round = 0; round < 200000; ++round) {
        const V2f a(noise(-2, 2), noise(-2, 2)), b(noise(-2, 2), noise(-2, 2)), c(noise(-2, 2), noise(-2, 2));
        const std::array<V2f, 3> triangle{a, b, c};
        // In either of the diagonal's triangles, either end of it, both ways round.
        std::array<V2f, 4> corners{a, b, a, c};
        if (round % 4 == 1) corners = {a, b, c, c};
        if (round % 4 == 2) corners = {a, a, b, c};
        if (round % 4 == 3) corners = {a, c, b, c};
        const V2f from = triangle[static_cast<size_t>(round / 4 % 3)],
                  to = triangle[static_cast<size_t>((round / 4 + 1) % 3)];
        const float area = std::abs((b - a).cross(c - a));
        if (area < 0.1f) continue;
        const V2f at = from + (to - from) * noise(0, 1);
        float depth;
        if (!hit_micropolygon({at.x, at.y, 0, 0, 0, 0}, on_plane(corners), Facing::Both, &depth)) continue;
        ++hits;
        ASSERT_NEAR(depth, 2 + at.x + 2 * at.y, 1e-4f) << round;
    }
    EXPECT_GT(hits, 50000);
}

/// Whatever way it turns.
TEST(HitMicropolygon, AVertexThatIsHitHasAllTheWeight) {
    int hits = 0;
    for (const float turn : {1.0f, -1.0f})
        for (const float zero : {0.0f, -0.0f}) {
            const std::array<V2f, 4> corners{V2f(0, 0), V2f(turn, 0), V2f(0, 1), V2f(turn, 1)};
            for (size_t i = 0; i < 4; ++i) {
                Quad q = on_plane(corners);
                for (size_t k = 0; k < 4; ++k) {
                    q.x[k] -= corners[i].x, q.y[k] -= corners[i].y;
                    if (q.x[k] == 0) q.x[k] = zero;
                    if (q.y[k] == 0) q.y[k] = zero;
                }
                const AxisRay ray{0, 0, 0, 0, 0, 0};
                const QuadWeights weights = hit_weights(ray, q);
                for (size_t k = 0; k < 4; ++k) EXPECT_EQ(weights.w[k], k == i ? 1 : 0) << turn << i;
                float depth;
                if (!hit_micropolygon(ray, q, Facing::Both, &depth)) continue;
                ++hits;
                EXPECT_EQ(depth, q.z[i]);
            }
        }
    EXPECT_GT(hits, 3);
}

TEST(HitMicropolygon, AnEdgeDecidesAlikeWhateverWayItIsWalked) {
    Noise noise{std::mt19937(3)};
    int crossings = 0;
    for (int round = 0; round < 100000; ++round) {
        // Many edges through the very origin or with an end on the axis.
        const float scale = round % 3 == 0 ? 1e-6f : 1.0f;
        const float zero = round % 2 == 0 ? 0.0f : -0.0f;
        const float ai = round % 11 == 0 ? zero : noise(-1, 1) * scale,
                    bi = round % 5 == 0 ? zero : noise(-1, 1);
        const float aj = round % 7 == 0 ? -ai : noise(-1, 1) * scale,
                    bj = round % 7 == 0 ? -bi : noise(-1, 1);
        predicate_detail::Edges e{};
        e.a[0] = ai, e.b[0] = bi, e.a[1] = aj, e.b[1] = bj;
        const bool forth = predicate_detail::crosses(e, 0, 1), back = predicate_detail::crosses(e, 1, 0);
        ASSERT_EQ(forth, back) << ai << ' ' << bi << ' ' << aj << ' ' << bj;
        crossings += forth;
    }
    EXPECT_GT(crossings, 10000);
}

TEST(HitMicropolygon, TheSameQuadFromAnyCornerInEitherTurn) {
    Noise noise{std::mt19937(3)};
    int hits = 0;
    for (int round = 0; round < 20000; ++round) {
        const Quad q = random_quad(noise);
        const AxisRay ray = random_ray(noise);
        float depth, other_depth;
        const bool hit = hit_micropolygon(ray, q, Facing::Both, &depth);
        hits += hit;
        constexpr int kOrders[7][4] = {{1, 3, 0, 2}, {3, 2, 1, 0}, {2, 0, 3, 1},                 // turned
                                       {0, 2, 1, 3}, {1, 0, 3, 2}, {3, 1, 2, 0}, {2, 3, 0, 1}};  // mirrored
        for (const auto& order : kOrders) {
            Quad turned;
            for (int i = 0; i < 4; ++i)
                turned.x[i] = q.x[order[i]], turned.y[i] = q.y[order[i]], turned.z[i] = q.z[order[i]];
            ASSERT_EQ(hit_micropolygon(ray, turned, Facing::Both, &other_depth), hit);
        }
    }
    EXPECT_GT(hits, 1000);
}

/// Every line meets a closed surface an even number of times, and a chain of floats decides it: no leak and
/// no double hit, on edges and vertices too.
TEST(HitMicropolygon, ClosedMeshIsCrossedAnEvenNumberOfTimes) {
    constexpr int kAround = 16, kAlong = 12;
    Noise noise{std::mt19937(3)};
    V3f vertex[kAlong][kAround];
    for (auto& ring : vertex)
        for (V3f& p : ring) p = V3f(noise(-1, 1), noise(-1, 1), noise(-1, 1));  // folded in any way
    int hits = 0;
    for (int round = 0; round < 20000; ++round) {
        AxisRay ray = random_ray(noise);
        if (round % 4 == 0) {  // through a vertex
            const V3f& p = vertex[noise.engine() % kAlong][noise.engine() % kAround];
            ray.ux = ray.uy = 0, ray.ox = p.x, ray.oy = p.y;
        }
        int count = 0;
        for (int j = 0; j < kAlong; ++j)
            for (int i = 0; i < kAround; ++i) {
                const V3f* corner[4] = {&vertex[j][i], &vertex[j][(i + 1) % kAround],
                                        &vertex[(j + 1) % kAlong][i],
                                        &vertex[(j + 1) % kAlong][(i + 1) % kAround]};
                Quad q;
                for (int c = 0; c < 4; ++c)
                    q.x[c] = corner[c]->x, q.y[c] = corner[c]->y, q.z[c] = corner[c]->z;
                float depth;
                count += hit_micropolygon(ray, q, Facing::Both, &depth);
            }
        ASSERT_EQ(count % 2, 0);
        hits += count;
    }
    EXPECT_GT(hits, 20000);
}

TEST(HitMicropolygon, DepthIsWithinTheQuadAndWhereItsWeightsSay) {
    Noise noise{std::mt19937(3)};
    int hits = 0;
    for (int round = 0; round < 50000; ++round) {
        const Quad q = random_quad(noise);
        const AxisRay ray = random_ray(noise);
        float depth;
        if (!hit_micropolygon(ray, q, Facing::Both, &depth)) continue;
        ++hits;
        ASSERT_GE(depth, *std::min_element(q.z, q.z + 4));
        ASSERT_LE(depth, *std::max_element(q.z, q.z + 4));
        const QuadWeights w = hit_weights(ray, q);
        float sum = 0;
        for (const float weight : w.w) {
            ASSERT_GE(weight, 0);
            sum += weight;
        }
        ASSERT_NEAR(sum, 1, 1e-5);
    }
    EXPECT_GT(hits, 2000);
}

TEST(HitMicropolygon, DepthOfAPlaneIsTheRaysOwn) {
    Noise noise{std::mt19937(3)};
    int hits = 0;
    for (int round = 0; round < 20000; ++round) {
        const float a = noise(-0.3f, 0.3f), b = noise(-0.3f, 0.3f), c = noise(2, 4);
        Quad q{{-2, 2, -2, 2}, {-2, -2, 2, 2}, {}};
        for (int i = 0; i < 4; ++i) {
            q.x[i] += noise(-0.5f, 0.5f), q.y[i] += noise(-0.5f, 0.5f);
            q.z[i] = c + a * q.x[i] + b * q.y[i];
        }
        AxisRay ray = random_ray(noise);
        ray.ux *= 0.2f, ray.uy *= 0.2f;
        float depth;
        if (!hit_micropolygon(ray, q, Facing::Both, &depth)) continue;
        ++hits;
        const float expected = (c + a * ray.ox + b * ray.oy) / (1 - a * ray.ux - b * ray.uy);
        ASSERT_NEAR(depth, expected, 1e-5f * 8);
    }
    EXPECT_GT(hits, 10000);
}

}  // namespace
}  // namespace trapeze
