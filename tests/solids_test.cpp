/// Constructive solid geometry and clipping planes: what samples see of diced spheres against intervals of
/// rays through exact ones, in motion and out of focus, for several methods.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/scene/scene.h"
#include "core/scene/solid_state.h"
#include "sample/cut_hits.h"
#include "tessellate/dicing_harness.h"

namespace trapeze {
namespace {

using Operation = Solid::Operation;

struct Ball {
    V3f centre;
    V3f travel;  ///< while the shutter is open
    float radius = 1;
};

const std::vector<Ball> kBalls = {{{0, 0, 5}, {0.2f, 0, 0}, 1},
                                  {{0.5f, 0.3f, 4.4f}, {0, -0.3f, 0.1f}, 0.8f},
                                  {{-0.6f, 0.4f, 4.7f}, {0, 0, 0}, 0.6f}};

/// Balls of a scene, ball i bounding solid leaf[i]; diced, packed and sampled.
struct BallScene {
    testing::TestScene scene;
    RenderContext context;
    Grids grids;

    explicit BallScene(std::vector<Solid> solids, const std::vector<int>& leaf) {
        Options& options = scene.scene.options;
        options.width = 64, options.height = 48, options.fov = 40;
        options.f_stop = 4, options.focal_length = 0.5f, options.focal_distance = 4.5f;
        options.shutter_close = 1;
        scene.attributes->shading_rate = 0.1f;
        for (const Ball& ball : kBalls) {
            const auto shape = testing::shape_of(
                testing::quadric(Quadric::Kind::Sphere, {ball.radius, -ball.radius, ball.radius, 360}));
            const V3f end = ball.centre + ball.travel;
            scene.add({shape}, {testing::translation(ball.centre.x, ball.centre.y, ball.centre.z),
                                testing::translation(end.x, end.y, end.z)});
        }
        scene.scene.solids = std::move(solids);
        for (size_t i = 0; i < leaf.size(); ++i) scene.scene.primitives[i].solid = leaf[i];
    }

    void dice() {
        context = scene.context();
        context.samples_x = context.samples_y = 2;
        const Tessellation tessellation(context);
        DiceScratch scratch;
        ShadingGrid grid;
        GridArena& arena = grids.arenas.emplace_back();
        for (size_t i = 0; i < tessellation.subpatches().size(); ++i) {
            tessellation.dice(i, grid, scratch);
            grid.Ci = grid.Cs, grid.Oi = grid.Os;
            int64_t not_finite = 0;
            grids.grids.push_back(
                pack_grid(grid, arena, &not_finite, pack_options(scene.scene, *grid.primitive)));
        }
    }

    HitBuffer hits(const std::string& method, const PixelRect& pixels, SampleTile& samples) {
        std::string error;
        const auto sampler = choose_sampler(method, "stratified", &error);
        EXPECT_TRUE(sampler) << error;
        const auto pattern = sampler->make_pattern(context);
        const auto visibility = sampler->prepare(context, grids);
        pattern->make_tile(pixels, samples);
        HitBuffer found;
        SampleScratch scratch;
        SampleStats stats;
        visibility->resolve(samples, found, scratch, stats);
        return found;
    }
};

/// Where a ray crosses a ball at its time; nothing when it passes by.
std::vector<double> crossings(const AxisRay& ray, const Ball& ball) {
    const V3d centre = V3d(ball.centre) + V3d(ball.travel) * ray.time;
    const V3d o = V3d(ray.ox, ray.oy, 0) - centre, d(ray.ux, ray.uy, 1);
    const double a = d.dot(d), b = o.dot(d), c = o.dot(o) - double{ball.radius} * ball.radius;
    const double disc = b * b - a * c;
    if (disc <= 0) return {};
    return {(-b - std::sqrt(disc)) / a, (-b + std::sqrt(disc)) / a};
}

bool passes_near_silhouette(const AxisRay& ray, Ball ball) {
    ball.radius += 0.01f;
    const size_t outside = crossings(ray, ball).size();
    ball.radius -= 0.02f;
    return crossings(ray, ball).size() != outside;
}

using Inside = std::array<bool, 3>;
using Formula = std::function<bool(const Inside&)>;

/// Depths at which the ray enters or leaves what the formula describes. `unsure` when crossings are so near
/// to each other, or to a silhouette, that dicing may change their order.
std::vector<double> expected_depths(const AxisRay& ray, const Formula& formula, bool* unsure) {
    std::vector<std::pair<double, size_t>> all;
    *unsure = false;
    for (size_t b = 0; b < kBalls.size(); ++b) {
        const std::vector<double> own = crossings(ray, kBalls[b]);
        *unsure |= passes_near_silhouette(ray, kBalls[b]);
        for (const double depth : own) all.emplace_back(depth, b);
    }
    std::sort(all.begin(), all.end());
    Inside inside{};
    std::vector<double> depths;
    for (size_t i = 0; i < all.size(); ++i) {
        *unsure |= i > 0 && all[i].first - all[i - 1].first < 0.02;
        const bool before = formula(inside);
        inside[all[i].second] = !inside[all[i].second];
        if (formula(inside) != before) depths.push_back(all[i].first);
    }
    return depths;
}

void expect_hits(BallScene& balls, const Formula& formula) {
    balls.dice();
    int sure = 0, seen = 0;
    for (int y = 0; y < 48; y += 16)
        for (int x = 0; x < 64; x += 16) {
            const PixelRect pixels{x, y, x + 16, y + 16};
            SampleTile samples;
            const HitBuffer hits = balls.hits("raytrace", pixels, samples);
            for (const char* other : {"bruteforce", "raytrace:tree=paper"}) {
                SampleTile same;
                EXPECT_EQ(balls.hits(other, pixels, same), hits) << other;
            }
            for (size_t s = 0; s < samples.size(); ++s) {
                bool unsure = false;
                const auto depths = expected_depths(samples.rays[s], formula, &unsure);
                if (unsure) continue;
                ++sure;
                ASSERT_EQ(hits.of(s).size(), depths.size());
                for (size_t i = 0; i < depths.size(); ++i, ++seen)
                    EXPECT_NEAR(hits.of(s)[i].depth, depths[i], 0.02);
            }
        }
    EXPECT_GT(sure, 64 * 48 * 4 / 2);
    EXPECT_GT(seen, 150);
}

constexpr Solid leaf(int parent, int place) {
    return {Operation::Primitive, parent, place};
}

TEST(Solids, Union) {
    BallScene balls({{Operation::Union, -1, 0}, leaf(0, 0), leaf(0, 1), leaf(0, 2)}, {1, 2, 3});
    expect_hits(balls, [](const Inside& in) { return in[0] || in[1] || in[2]; });
}

TEST(Solids, Intersection) {
    BallScene balls({{Operation::Intersection, -1, 0}, leaf(0, 0), leaf(0, 1), leaf(0, 2)}, {1, 2, 3});
    expect_hits(balls, [](const Inside& in) { return in[0] && in[1] && in[2]; });
}

TEST(Solids, DifferenceTakesAwayAllButTheFirst) {
    BallScene balls({{Operation::Difference, -1, 0}, leaf(0, 0), leaf(0, 1), leaf(0, 2)}, {1, 2, 3});
    expect_hits(balls, [](const Inside& in) { return in[0] && !in[1] && !in[2]; });
}

TEST(Solids, Nested) {
    BallScene balls(
        {{Operation::Difference, -1, 0}, {Operation::Union, 0, 0}, leaf(1, 0), leaf(1, 1), leaf(0, 1)},
        {2, 4, 3});
    expect_hits(balls, [](const Inside& in) { return (in[0] || in[2]) && !in[1]; });
}

TEST(Solids, SurfacesOfOneLeafBoundItTogether) {
    BallScene balls({{Operation::Primitive, -1, 0}}, {0, 0, 0});
    expect_hits(balls, [](const Inside& in) { return (in[0] != in[1]) != in[2]; });
}

TEST(Solids, ApartFromOtherSurfaces) {
    // The third ball is no solid: opaque outside, it ends the lists.
    BallScene balls({{Operation::Difference, -1, 0}, leaf(0, 0), leaf(0, 1)}, {1, 2, -1});
    balls.dice();
    for (const Grid& grid : balls.grids.grids) EXPECT_EQ(grid.opaque, grid.primitive == 2);
    SampleTile samples;
    const HitBuffer hits = balls.hits("raytrace", {0, 0, 64, 48}, samples);
    int ends = 0;
    for (size_t s = 0; s < samples.size(); ++s)
        for (const Hit& hit : hits.of(s))
            if (balls.grids.grids[MicropolygonId::unpack(hit.id).grid].primitive == 2) {
                ++ends;
                EXPECT_EQ(hit, hits.of(s).back());
            }
    EXPECT_GT(ends, 100);
}

TEST(Solids, ClippingPlanesCutAnySurface) {
    BallScene balls({}, {});
    balls.scene.scene.clipping_planes = {{V3f(0, 0, 1), 4.5f}, {V3f(1, 0, 0), -0.3f}};
    balls.dice();
    SampleTile samples;
    const HitBuffer hits = balls.hits("raytrace", {0, 0, 64, 48}, samples);
    int seen = 0, unsure = 0;
    for (size_t s = 0; s < samples.size(); ++s) {
        const AxisRay& ray = samples.rays[s];
        size_t expected = 0;
        bool near_border = false;
        for (const Ball& ball : kBalls) {
            near_border |= passes_near_silhouette(ray, ball);
            for (const double z : crossings(ray, ball)) {
                const double x = ray.ox + ray.ux * z;
                near_border |= std::abs(z - 4.5) < 0.02 || std::abs(x + 0.3) < 0.02;
                expected += z >= 4.5 && x >= -0.3;
            }
        }
        unsure += near_border;
        if (near_border) continue;
        EXPECT_EQ(hits.of(s).size(), expected);
        seen += static_cast<int>(expected);
    }
    EXPECT_GT(seen, 1000);
    EXPECT_LT(unsure, static_cast<int>(samples.size()) / 3);
}

TEST(Solids, RaysThatStartInsideKnowIt) {
    const std::vector<Solid> solids = {{Operation::Difference, -1, 0}, leaf(0, 0), leaf(0, 1)};
    SolidState state(solids);
    EXPECT_TRUE(state.cross(1));
    EXPECT_TRUE(state.cross(2));
    EXPECT_TRUE(state.cross(2));
    EXPECT_TRUE(state.cross(1));
    EXPECT_FALSE(state.cross(2));
    state.reset();
    EXPECT_TRUE(state.cross(1));
}

}  // namespace
}  // namespace trapeze
