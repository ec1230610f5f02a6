/// Rays in any direction, asked of methods: what they meet is what testing every micropolygon says.
#include <gtest/gtest.h>

#include "accel/moving_harness.h"
#include "sample/every_method_harness.h"
#include "sample/frame_harness.h"

namespace trapeze {
namespace {

using testing::add_all_kinds;
using testing::add_torus;
using testing::every_method;
using testing::GridMaker;
using testing::Noise;
using testing::noisy_ray;
using testing::TestFrame;

std::vector<SpaceRay> noisy_rays(const GridMaker& maker, int count) {
    Noise noise;
    std::vector<SpaceRay> rays;
    for (int i = 0; i < count; ++i) rays.push_back(noisy_ray(maker, noise, i));
    rays[1].direction = V3f(0);
    rays[2].origin.y = NAN;
    rays[3].time = 0, rays[4].time = 1;
    return rays;
}

struct Answers {
    std::vector<uint8_t> met;  ///< empty where the method takes no such rays
    SampleStats stats;
};

Answers ask(const TestFrame& frame, const Grids& grids, const std::string& method,
            const std::vector<SpaceRay>& rays, DepthRange range) {
    std::string error;
    const auto sampler = choose_sampler(method, "", &error);
    EXPECT_TRUE(sampler) << error;
    Answers answers;
    std::vector<uint8_t> met(rays.size(), 2);
    if (sampler->prepare(frame.context, grids)->occluded(rays, range, met, answers.stats))
        answers.met = met;
    else
        EXPECT_EQ(std::ranges::count(met, 2), static_cast<std::ptrdiff_t>(met.size())) << method;
    return answers;
}

TEST(Occluded, IsWhatTestingEveryMicropolygonSays) {
    const TestFrame frame(16, 16, 1, true, true);
    GridMaker all_kinds, torus;
    Noise noise;
    add_all_kinds(all_kinds, noise);
    add_torus(torus, 3);
    for (const GridMaker* maker : {&all_kinds, &torus})
        for (const DepthRange range : {DepthRange{}, DepthRange{.5f, 3}}) {
            const auto rays = noisy_rays(*maker, 600);
            std::vector<uint8_t> truth;
            for (const SpaceRay& ray : rays)
                truth.push_back(testing::closest_naively(maker->grids(), ray, range).id !=
                                MicropolygonId::kNone);
            EXPECT_GT(std::ranges::count(truth, 1), 50);
            EXPECT_GT(std::ranges::count(truth, 0), 50);
            EXPECT_EQ(truth[1], 0);
            EXPECT_EQ(truth[2], 0);
            int asked = 0;
            for (const auto& form : every_method({.few_numbers = true})) {
                const Answers answers = ask(frame, maker->grids(), form.name, rays, range);
                if (answers.met.empty()) continue;
                ++asked;
                EXPECT_EQ(answers.met, truth) << form.name;
                EXPECT_EQ(answers.stats.rays, rays.size()) << form.name;
                EXPECT_GT(answers.stats.predicate_tests, 0u) << form.name;
            }
            EXPECT_GT(asked, 20) << "brute force and each of raytrace's trees";
        }
}

TEST(Occluded, IsNotAskedOfRasterizers) {
    const TestFrame frame(16, 16, 1, true, true);
    GridMaker maker;
    add_torus(maker, 2);
    const auto rays = noisy_rays(maker, 10);
    EXPECT_TRUE(ask(frame, maker.grids(), "interval", rays, {}).met.empty());
    EXPECT_FALSE(ask(frame, maker.grids(), "raytrace", rays, {}).met.empty());
}

}  // namespace
}  // namespace trapeze
