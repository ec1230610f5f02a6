/// Rays from inside a closed surface through the wide tree, alone and in bundles: none gets out. As a
/// control, rays from inside the same surface without one of its 6144 micropolygons: those that get out are
/// some of those that hit it.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "accel/rays_harness.h"
#include "accel/wide/bundle.h"
#include "core/simd/targets_harness.h"

namespace trapeze {
namespace {

using testing::add_torus;
using testing::for_each_target;
using testing::GridMaker;
using testing::Noise;

/// Micropolygon (2, 2) of grid (0, 1) of the whole torus.
const uint64_t kMissing = MicropolygonId{1, 2, 2}.packed();

TEST(Leaks, NoSingleRayLeavesAClosedSurface) {
    for (const int keys : {1, 2, 5}) {
        Noise noise;
        GridMaker closed, holed;
        add_torus(closed, keys), add_torus(holed, keys, V3f(0), true);
        const WideTree whole(closed.grids(), {}), open(holed.grids(), {});
        int leaks = 0, control = 0;
        for (int round = 0; round < 100000; ++round) {
            const float phi = noise(0, 6.28f), time = keys == 1 ? 0.0f : noise(0, 1);
            const V3f inside(3 * std::cos(phi) + time, 3 * std::sin(phi), -0.5f * time);
            const SpaceRay ray{inside, noise.point(1), time};
            const std::optional<Hit> hit = whole.closest(ray, {});
            leaks += !hit.has_value();
            if (open.closest(ray, {}).has_value()) continue;
            ++control;
            ASSERT_EQ(hit.value_or(kNoHit).id, kMissing) << round;
        }
        EXPECT_EQ(leaks, 0) << keys << " keys";
        EXPECT_GT(control, 3) << keys << " keys";
    }
}

/// What camera rays see of a tree: kNone or the id.
std::vector<uint32_t> seen(const WideTree& tree, const std::vector<AxisRay>& rays, RayBlur blur,
                           RayBundle& bundle, BundleScratch& scratch) {
    SampleStats stats;
    std::vector<uint32_t> order(rays.size());
    std::iota(order.begin(), order.end(), 0u);
    fill_bundle(rays, order, blur, bundle);
    trace_bundle(tree, {0, 100}, blur.lens, 2, bundle, scratch, stats);
    return {bundle.id, bundle.id + rays.size()};
}

/// Rays from a pinhole or a lens, of which those of a bundle lie close together.
std::vector<AxisRay> rays_of_bundle(RayBlur blur, Noise& noise) {
    const V2f middle(noise(-0.9f, 0.9f), noise(-0.9f, 0.9f));
    std::vector<AxisRay> rays;
    for (size_t i = 0; i < RayBundle::kRays; ++i) {
        const float ox = blur.lens ? noise(-0.05f, 0.05f) : 0.0f,
                    oy = blur.lens ? noise(-0.05f, 0.05f) : 0.0f;
        rays.push_back({ox, oy, 0, middle.x + noise(-0.05f, 0.05f) - ox / 2,
                        middle.y + noise(-0.05f, 0.05f) - oy / 2, blur.motion ? noise(0, 1) : 0.0f});
    }
    return rays;
}

TEST(Leaks, NoBundledRayLeavesAClosedSurface) {
    const auto bundle = std::make_unique<RayBundle>();
    const BundleScratchPointer scratch = make_bundle_scratch();
    for (const bool lens : {false, true})
        for (const int keys : {1, 2, 5}) {
            const RayBlur blur{keys > 1, lens};
            GridMaker closed, holed;
            // The eye is inside: in the middle of the tube, about which that moves by less than its radius.
            const V3f middle(-3.5f, 0, 0.2f);
            add_torus(closed, keys, middle), add_torus(holed, keys, middle, true);
            const WideTree whole(closed.grids(), {2.2f, 0.2f}), open(holed.grids(), {2.2f, 0.2f});
            for_each_target([&] {
                Noise noise;
                int leaks = 0, control = 0;
                for (int round = 0; round < 150; ++round) {
                    const std::vector<AxisRay> rays = rays_of_bundle(blur, noise);
                    const auto hits = seen(whole, rays, blur, *bundle, *scratch);
                    const auto through = seen(open, rays, blur, *bundle, *scratch);
                    for (size_t i = 0; i < rays.size(); ++i) {
                        leaks += hits[i] == RayBundle::kNone;
                        if (through[i] != RayBundle::kNone) continue;
                        ++control;
                        ASSERT_EQ(hits[i], kMissing);
                    }
                }
                EXPECT_EQ(leaks, 0) << keys << " keys" << lens;
                EXPECT_GT(control, 3) << keys << " keys" << lens;
            });
        }
}

}  // namespace
}  // namespace trapeze
