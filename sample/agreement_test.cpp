/// Every method finds what testing everything finds, bit for bit: on every scene, for any number of threads,
/// on every instruction set of the machine.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <map>

#include "accel/hit_policies.h"
#include "accel/trace_ray.h"
#include "core/noise_harness.h"
#include "core/simd/targets_harness.h"
#include "sample/agreement_scenes_harness.h"
#include "sample/every_method_harness.h"
#include "sample/frame_harness.h"
#include "sample/patterns/interval_pattern.h"
#include "sample/patterns/stratified_pattern.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

using testing::every_method;
using testing::for_each_target;
using testing::GridMaker;
using testing::make_scenes;
using testing::Noise;
using testing::TestScene;
using testing::tiles_of;

/// Samples of a frame with a border of filter pixels around, tile by tile in parallel.
std::vector<HitBuffer> resolve(const TestScene& scene, const SamplePattern& pattern,
                               const Visibility& visibility) {
    const auto tiles = tiles_of({-2, -2, scene.frame.options.width + 2, scene.frame.options.height + 2});
    std::vector<HitBuffer> buffers(tiles.size());
    tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t i) {
        SampleTile samples;
        SampleScratch scratch;
        SampleStats stats;
        pattern.make_tile(tiles[i], samples);
        visibility.resolve(samples, buffers[i], scratch, stats);
        EXPECT_EQ(stats.rays, samples.size());
    });
    return buffers;
}

std::vector<HitBuffer> resolve(const TestScene& scene, std::string_view method_name,
                               std::string_view pattern_name = "") {
    std::string error;
    const auto sampler = choose_sampler(method_name, pattern_name, &error);
    EXPECT_TRUE(sampler) << error;
    return resolve(scene, *sampler->make_pattern(scene.frame.context),
                   *sampler->prepare(scene.frame.context, scene.maker.grids()));
}

/// The frame before a scene's: everything is elsewhere, each grid by a way of its own; what is opaque is not.
GridMaker frame_before(const GridMaker& maker) {
    GridMaker before;
    Noise noise;
    for (const Grid& grid : maker.grids().grids) {
        const V3f shift = noise.point(1, -1, 1);
        before.opaque = !grid.opaque, before.facing = grid.facing;
        before.add(grid.shape.nu, grid.shape.nv, 1,
                   [&](int i, int j, float) { return grid.vertex(i, j, 0) + shift; });
    }
    return before;
}

/// What the samples of a tile hit, one after another.
struct NaiveHits {
    std::vector<Hit> all;
    Hit opaque = kNoHit;  ///< the nearest
};

/// Tests all samples against a micropolygon.
void test_naively(const Grid& grid, size_t g, int u, int v, const Camera& camera,
                  std::span<const AxisRay> rays, std::span<NaiveHits> hits) {
    const MicropolygonId id{static_cast<uint32_t>(g), static_cast<uint8_t>(u), static_cast<uint8_t>(v)};
    auto quad = grid.quad(u, v, 0);
    for (size_t s = 0; s < rays.size(); ++s) {
        if (grid.moves()) quad = grid.quad(u, v, rays[s].time);
        float depth;
        if (!hit_micropolygon(rays[s], quad, grid.facing, &depth)) continue;
        if (!(depth >= camera.near_clip && depth <= camera.far_clip)) continue;
        const Hit hit{depth, id.packed()};
        hits[s].all.push_back(hit);
        if (grid.opaque && in_front(hit, hits[s].opaque)) hits[s].opaque = hit;
    }
}

/// What no bound has a say in: every sample against every micropolygon, one by one.
std::vector<HitBuffer> resolve_naively(const TestScene& scene, const SamplePattern& pattern) {
    const Camera& camera = scene.frame.context.camera;
    const auto tiles = tiles_of({-2, -2, scene.frame.options.width + 2, scene.frame.options.height + 2});
    std::vector<HitBuffer> buffers(tiles.size());
    for (size_t n = 0; n < tiles.size(); ++n) {
        SampleTile samples;
        pattern.make_tile(tiles[n], samples);
        std::vector<NaiveHits> found(samples.rays.size());
        for (size_t g = 0; g < scene.maker.grids().grids.size(); ++g) {
            const Grid& grid = scene.maker.grids().grids[g];
            for (int v = 0; v < grid.shape.nv; ++v)
                for (int u = 0; u < grid.shape.nu; ++u)
                    test_naively(grid, g, u, v, camera, samples.rays, found);
        }
        HitBuffer& buffer = buffers[n];
        buffer.first.push_back(0);
        for (NaiveHits& hits : found) {
            std::sort(hits.all.begin(), hits.all.end(), in_front);
            for (const Hit& hit : hits.all)
                if (!in_front(hits.opaque, hit)) buffer.hits.push_back(hit);
            buffer.first.push_back(static_cast<uint32_t>(buffer.hits.size()));
        }
    }
    return buffers;
}

size_t hit_count(const std::vector<HitBuffer>& buffers) {
    size_t count = 0;
    for (const HitBuffer& buffer : buffers) count += buffer.hits.size();
    return count;
}

/// How many samples differ; told in words rather than as two dumps.
size_t differing_samples(const std::vector<HitBuffer>& a, const std::vector<HitBuffer>& b) {
    size_t differing = 0;
    for (size_t tile = 0; tile < a.size(); ++tile)
        for (size_t s = 0; s < a[tile].size(); ++s)
            if (!std::ranges::equal(a[tile].of(s), b[tile].of(s))) ++differing;
    return differing;
}

const std::vector<TestScene>& scenes() {
    static const std::vector<TestScene> all = make_scenes();
    return all;
}

class Agreement : public ::testing::TestWithParam<size_t> {
  protected:
    const TestScene& scene() const { return scenes()[GetParam()]; }
};

TEST_P(Agreement, RayTracerAndBruteForceFindWhatTestingEverythingFinds) {
    const auto truth = resolve_naively(scene(), StratifiedPattern(scene().frame.context));
    EXPECT_EQ(hit_count(truth) > 0, scene().must_hit);
    EXPECT_EQ(differing_samples(resolve(scene(), "bruteforce"), truth), 0u);
    const auto traced = resolve(scene(), "raytrace");
    EXPECT_EQ(differing_samples(resolve(scene(), "raytrace:tree=paper"), truth), 0u);
    EXPECT_EQ(differing_samples(resolve(scene(), "raytrace:tree=paper,bundle=off"), truth), 0u);
    EXPECT_EQ(differing_samples(traced, truth), 0u);
    EXPECT_TRUE(traced == truth);
}

TEST_P(Agreement, EveryChoiceOfThePapersTreeFindsWhatBruteForceFinds) {
    const auto truth = resolve(scene(), "bruteforce");
    for (const std::string options :
         {"bounds=aabb", "bounds=aabb4d", "bounds=aabb4d,bundle=off,leaf=32", "orient_split=off,leaf=4",
          "orient_propagation=off,bundle=off", "ray_sort=off,leaf=16", "split=sah", "split=sah,bundle=off",
          "split=sah,bounds=aabb,leaf=4", "split=sah,bounds=aabb4d,leaf=32",
          "split=sah,orient_split=off,orient_propagation=off", "split=sah,bounds_from=children",
          "split=sah,ray_frames=cached,bundle=off"})
        EXPECT_EQ(differing_samples(resolve(scene(), "raytrace:tree=paper," + options), truth), 0u)
            << options;
}

TEST_P(Agreement, EveryChoiceOfInterpolatedBoxesFindsWhatBruteForceFinds) {
    const auto truth = resolve(scene(), "bruteforce");
    for (const std::string tree :
         {"interpolated,bundle=off", "interpolated,keys=2,leaf=4", "interpolated,keys=1,bundle=off",
          "msbvh,bundle=off", "msbvh,clip=box,keys=3", "msbvh,budget=8,leaf=4,ray_sort=off",
          "msbvh,clip=box,budget=8,bundle=off,keys=2", "lbvh,bundle=off", "lbvh,leaf=4,keys=2"})
        EXPECT_EQ(differing_samples(resolve(scene(), "raytrace:tree=" + tree), truth), 0u) << tree;
}

/// With one choice at a time they are in EveryMethodOfTheTable.
TEST_P(Agreement, ChoicesOfOtherPapersTreesTogetherFindWhatBruteForceFinds) {
    const auto truth = resolve(scene(), "bruteforce");
    for (const std::string tree :
         {"mbkd,duplicates=64,leaf=4,mailbox=off", "mbkd,duplicates=2,plane=0,ray_sort=off",
          "mbkd,plane=1,weight=whole", "loose,place=lowest,levels=9", "loose,skip=off,levels=12"})
        EXPECT_EQ(differing_samples(resolve(scene(), "raytrace:tree=" + tree), truth), 0u) << tree;
}

TEST_P(Agreement, UpdatedTreesFindWhatBruteForceFinds) {
    const auto truth = resolve(scene(), "bruteforce");
    const GridMaker before = frame_before(scene().maker);
    for (const std::string tree :
         {"refit", "msbvh,refit=on,bundle=off", "msbvh,clip=box,budget=8,refit=on", "lbvh,refit=on",
          "dynamic", "dynamic,thinning=1.1", "dynamic,reinsert=root", "dynamic,reinsert=rebuilt", "loose",
          "loose,place=lowest", "twolevel"}) {
        std::string error;
        const auto sampler = choose_sampler("raytrace:tree=" + tree, "", &error);
        ASSERT_TRUE(sampler) << error;
        const auto visibility = sampler->prepare(scene().frame.context, before.grids());
        ASSERT_TRUE(visibility->update(scene().maker.grids())) << tree;
        const auto pattern = sampler->make_pattern(scene().frame.context);
        EXPECT_EQ(differing_samples(resolve(scene(), *pattern, *visibility), truth), 0u) << tree;
    }
}

TEST(UpdatedTrees, OthersArePreparedAnew) {
    const TestScene& scene = scenes().front();
    for (const std::string_view method : {"raytrace", "raytrace:tree=gs", "raytrace:tree=lbvh", "interval"}) {
        std::string error;
        const auto sampler = choose_sampler(method, "", &error);
        EXPECT_FALSE(sampler->prepare(scene.frame.context, scene.maker.grids())->update(scene.maker.grids()));
    }
}

TEST_P(Agreement, IntervalFindsWhatTestingEverythingFinds) {
    const auto truth = resolve_naively(scene(), IntervalPattern(scene().frame.context));
    EXPECT_EQ(differing_samples(resolve(scene(), "bruteforce", "interval"), truth), 0u);
    EXPECT_EQ(differing_samples(resolve(scene(), "interval"), truth), 0u);
    EXPECT_EQ(differing_samples(resolve(scene(), "interval:cull=on"), truth), 0u);
    EXPECT_TRUE(resolve(scene(), "interval") == truth);
}

TEST_P(Agreement, IntervalWithShuffledPairingFindsWhatBruteForceFinds) {
    const auto truth = resolve(scene(), "bruteforce");
    EXPECT_EQ(differing_samples(resolve(scene(), "interval:pairing=shuffled"), truth), 0u);
    EXPECT_EQ(differing_samples(resolve(scene(), "interval:pairing=shuffled,cull=on"), truth), 0u);
}

TEST_P(Agreement, InterleaveUvtFindsWhatBruteForceFinds) {
    for (const std::string k : {"k=1", "k=2", "k=4"}) {
        const auto truth = resolve(scene(), "bruteforce", "interleaved:" + k);
        EXPECT_EQ(hit_count(truth) > 0, scene().must_hit);
        EXPECT_EQ(differing_samples(resolve(scene(), "interleaveuvt:" + k), truth), 0u) << k;
        EXPECT_EQ(differing_samples(resolve(scene(), "interleaveuvt:cull=on," + k), truth), 0u) << k;
    }
    const auto truth = resolve(scene(), "bruteforce", "interleaved");
    EXPECT_TRUE(resolve(scene(), "interleaveuvt") == truth);
}

TEST_P(Agreement, DualSpaceFindsWhatBruteForceFinds) {
    for (const char* pattern : {"stratified", "interval", "interleaved"}) {
        const auto truth = resolve(scene(), "bruteforce", pattern);
        EXPECT_EQ(differing_samples(resolve(scene(), "dualspace", pattern), truth), 0u) << pattern;
    }
}

/// What brute force finds in a scene, for each pattern that is asked for.
class Truths {
  public:
    explicit Truths(const TestScene& scene) : scene_(scene) {}
    const std::vector<HitBuffer>& of(const std::string& pattern) {
        std::vector<HitBuffer>& truth = found_[pattern];
        if (truth.empty()) truth = resolve(scene_, "bruteforce", pattern);
        return truth;
    }

  private:
    const TestScene& scene_;
    std::map<std::string, std::vector<HitBuffer>> found_;
};

/// What methods find with so many threads.
void expect_truth(const TestScene& scene, const std::vector<testing::MethodForm>& methods, int threads) {
    Truths truths(scene);
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<size_t>(threads));
    tbb::task_arena arena(threads);
    for (const auto& [method, pattern] : methods)
        arena.execute([&, &method = method, &pattern = pattern] {
            const auto found = resolve(scene, method);
            EXPECT_EQ(differing_samples(found, truths.of(pattern)), 0u) << method;
            EXPECT_TRUE(found == truths.of(pattern)) << method;
        });
}

/// What a new method is tested by, before it has tests of its own. In the other tests there are as many
/// threads as processors.
TEST_P(Agreement, EveryMethodOfTheTableFindsWhatBruteForceFinds) {
    expect_truth(scene(), every_method(), 1);
}

TEST_P(Agreement, OfManyThreads) {
    expect_truth(scene(), every_method({.few_numbers = true}), 7);
}

/// Trees that raytrace's option chooses are compiled once, for all instruction sets: what runs on them is
/// only the order of rays, and each set has a fourth of them.
TEST_P(Agreement, OfAllInstructionSets) {
    Truths truths(scene());
    size_t set = 0;
    for_each_target([&] {
        size_t turn = set++;
        for (const auto& [method, pattern] : every_method({.one_of_each_tree = true})) {
            if (method.find("tree=") != method.npos && turn++ % 4 != 0) continue;
            EXPECT_TRUE(resolve(scene(), method) == truths.of(pattern)) << method;
        }
    });
}

INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, ::testing::Range(size_t{0}, scenes().size()),
                         [](const ::testing::TestParamInfo<size_t>& tested) {
                             std::string name = scenes()[tested.param].name;
                             std::replace_if(
                                 name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                             return name;
                         });

}  // namespace
}  // namespace trapeze
