/// Beams never give up what one of their rays passes, tested with rays in doubles, and do give up most of the
/// rest.
#include "accel/paper/beam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "core/noise_harness.h"

namespace trapeze {
namespace {

using testing::Noise;

/// Whether a ray passes a box of some axes, in doubles.
bool passes(const AxisRay& ray, const AxesColumns& axes, const KeyBox& box, double near, double far) {
    for (int k = 0; k < 3; ++k) {
        const auto& c = axes.column;
        const double origin = double{c[0][k]} * ray.ox + double{c[1][k]} * ray.oy;
        const double slope = double{c[0][k]} * ray.ux + double{c[1][k]} * ray.uy + c[2][k];
        const double a = (box.low[k] - origin) / slope, b = (box.high[k] - origin) / slope;
        near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
    }
    return near <= far;
}

TEST(Beam, NeverGivesUpWhatARayOfItPasses) {
    Noise noise{std::mt19937(6)};
    int passed = 0, given_up = 0;
    for (int round = 0; round < 20000; ++round) {
        const float width = std::pow(10.0f, noise(-4, 0)), lens = round % 2 ? 0.2f : 0.0f;
        std::vector<AxisRay> rays(8);
        const float ux = noise(-1, 1), uy = noise(-1, 1);
        for (AxisRay& ray : rays)
            ray = {noise(-lens, lens),   noise(-lens, lens),   0,
                   ux + noise(0, width), uy + noise(0, width), noise(0, 1)};
        std::vector<uint32_t> indices(rays.size());
        std::iota(indices.begin(), indices.end(), 0u);
        const DepthRange range{noise(0, 2), noise(3, 9)};
        const Beam beam(rays, indices, range);
        const Axes axes =
            axes_of(V3d(noise(-1, 1), noise(-1, 1), noise(-1, 1)), V3d(noise(-1, 1), noise(-1, 1), 1));
        // A box about a point near the beam.
        const float z = noise(-1, 10);
        const V3f middle = axes.from_space(V3f(ux * z + noise(-1, 1), uy * z + noise(-1, 1), z));
        KeyBox box;
        for (int k = 0; k < 3; ++k)
            box.low[k] = middle[k] - noise(0, 1), box.high[k] = middle[k] + noise(0, 1);
        const AxesColumns columns(axes);
        bool any = false;
        for (const AxisRay& ray : rays) any |= passes(ray, columns, box, range.min, range.max);
        const bool met = beam.meets(columns, box, 12, 0);
        ASSERT_TRUE(met || !any) << round;
        passed += any, given_up += !met;
    }
    EXPECT_GT(passed, 2000);
    EXPECT_GT(given_up, 2000);
}

TEST(Beam, SlackReachesBehindTheLens) {
    const std::vector<AxisRay> rays(1);
    const std::vector<uint32_t> indices{0};
    const Beam beam(rays, indices, {0, 10});
    KeyBox behind;
    for (int k = 0; k < 3; ++k) behind.low[k] = -1, behind.high[k] = 1;
    behind.low[2] = -3, behind.high[2] = -2;
    EXPECT_FALSE(beam.meets(AxesColumns(Axes{}), behind, 3, 1));
    EXPECT_TRUE(beam.meets(AxesColumns(Axes{}), behind, 3, 2.5f));
}

}  // namespace
}  // namespace trapeze
