/// Every method finds what testing everything finds, bit for bit: on every scene, for any number of threads,
/// on every instruction set of the machine.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <map>
#include <random>

#include "accel/hit_policies.h"
#include "accel/trace_ray.h"
#include "core/noise_harness.h"
#include "core/simd/targets_harness.h"
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
using testing::Noise;
using testing::TestFrame;
using testing::tiles_of;

struct TestScene {
    std::string name;
    TestFrame frame;
    GridMaker maker;
    bool must_hit = true;
};

V3f rotated(const V3f& p, float angle) {
    return {p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle),
            p.z};
}

/// Wavy sheets at random places and orientations.
void add_sheets(GridMaker& maker, int count, int keys, uint32_t seed, float motion = 1) {
    Noise noise{std::mt19937(seed)};
    for (int n = 0; n < count; ++n) {
        const V3f origin = noise.point(3, 3, 9), along_u = noise.point(2, -1, 1),
                  along_v = noise.point(2, -1, 1);
        const V3f shift = noise.point(motion, -motion / 2, motion / 2);
        const float turn = noise(-motion, motion);
        const int nu = 1 + static_cast<int>(noise.engine() % 16),
                  nv = 1 + static_cast<int>(noise.engine() % 16);
        maker.add(nu, nv, keys, [=](int i, int j, float t) {
            const float u = static_cast<float>(i) / static_cast<float>(nu),
                        v = static_cast<float>(j) / static_cast<float>(nv);
            const V3f p = origin + along_u * u + along_v * v + V3f(0, 0, 0.2f * std::sin(9 * u + 7 * v));
            return keys == 1 ? p : rotated(p, turn * t) + shift * t;
        });
    }
}

/// Loose quads of random corners, needles and points among them.
void add_shards(GridMaker& maker, int count, int keys, uint32_t seed, float z_from, float z_to) {
    Noise noise{std::mt19937(seed)};
    for (int n = 0; n < count; ++n) {
        const int kind = n % 5;
        const V3f centre = noise.point(3, z_from, z_to);
        std::array<std::array<V3f, 4>, 2> corner;
        for (auto& pose : corner)
            for (V3f& p : pose) p = centre + noise.point(1, -1, 1);
        for (auto& pose : corner) {
            if (kind == 1) pose[2] = pose[0], pose[3] = pose[1];   // a line
            if (kind == 2) pose[1] = pose[2] = pose[3] = pose[0];  // a point
            if (kind == 3)
                pose[3] = pose[0] + (pose[1] - pose[0]) * 0.5f, pose[2] = pose[0] + V3f(1e-6f, 0, 1e-6f);
            if (kind == 4) std::swap(pose[2], pose[3]);  // likelier a bow-tie
        }
        maker.add(1, 1, keys, [&](int i, int j, float t) {
            const size_t c = static_cast<size_t>(i + 2 * j);
            return corner[0][c] + (corner[1][c] - corner[0][c]) * t;
        });
    }
}

/// Adds an empty scene of a name to a list that has room.
class AddScene {
  public:
    explicit AddScene(std::vector<TestScene>& scenes) : scenes_(scenes) {}
    TestScene& operator()(const char* name, bool motion, bool defocus) const {
        return scenes_.emplace_back(TestScene{name, TestFrame(40, 24, 3, motion, defocus), {}});
    }

  private:
    std::vector<TestScene>& scenes_;
};

void add_kinds_of_blur(const AddScene& scene) {
    add_sheets(scene("static", false, false).maker, 30, 1, 1);
    add_sheets(scene("motion", true, false).maker, 30, 2, 2);
    add_sheets(scene("defocus", false, true).maker, 30, 1, 3);
    {
        TestScene& parallel = scene("orthographic without a lens", false, false);
        parallel.frame.options.projection = "orthographic";
        parallel.frame.options.screen_window = {-4, 4, -3, 3};
        parallel.frame.update();
        add_sheets(parallel.maker, 30, 1, 35);
    }
    add_sheets(scene("motion and defocus", true, true).maker, 30, 2, 4);
    {
        TestScene& blades = scene("blades and motion", true, true);
        blades.frame.context.camera.aperture = {5, 36, -.8f, .7f};
        add_sheets(blades.maker, 30, 2, 36);
        TestScene& triangle = scene("three blades", false, true);
        triangle.frame.context.camera.aperture = {3, 10, 0, 0};
        add_sheets(triangle.maker, 30, 1, 37);
    }
    add_sheets(scene("five keys", true, true).maker, 20, 5, 5, 2);
    {
        GridMaker& maker = scene("mixed key counts", true, true).maker;
        int seed = 10;
        for (const int keys : {1, 2, 3, 5, 9, 65}) add_sheets(maker, 6, keys, seed++);
    }
}

void add_thin_things(const AddScene& scene) {
    {
        GridMaker& maker = scene("hair", true, true).maker;
        Noise noise{std::mt19937(20)};
        for (int n = 0; n < 200; ++n) {
            const V3f root = noise.point(3, 4, 8), lean = noise.point(1, -1, 1),
                      shift = noise.point(1, -1, 1);
            maker.add(1, 16, 2, [=](int i, int j, float t) {
                const float s = static_cast<float>(j) / 16;
                return root + lean * s + V3f(0.5f * s * s + 0.002f * static_cast<float>(i), 0, 0) +
                       shift * (t * s);
            });
        }
    }
    {
        // Slivers along the very rays of samples: the weights of their hits round to anything.
        TestScene& slivers = scene("edge-on slivers", false, false);
        Noise noise{std::mt19937(21)};
        SampleTile samples;
        StratifiedPattern(slivers.frame.context).make_tile({12, 4, 28, 20}, samples);
        for (size_t n = 0; n < 3 * samples.size(); ++n) {
            const AxisRay& ray = samples.rays[n / 3];
            const float middle = 5 + 0.01f * static_cast<float>(n % 3), thin = std::pow(10.0f, noise(-9, -6));
            const V2f lean(noise(-0.3f, 0.3f), noise(-0.3f, 0.3f));
            std::array<V3f, 4> corner;
            for (V3f& p : corner) {  // nearly on a line through the ray, slanted in depth
                const float along = noise(-1, 1), z = middle + 2 * along;
                p = V3f(ray.ux * z + lean.x * along, ray.uy * z + lean.y * along, z) +
                    noise.point(thin, -thin, thin);
            }
            slivers.maker.add(1, 1, 1,
                              [&](int i, int j, float) { return corner[static_cast<size_t>(i + 2 * j)]; });
        }
        add_sheets(slivers.maker, 3, 1, 34);
    }
}

void add_degenerate_things(const AddScene& scene) {
    {
        TestScene& behind = scene("behind the lens", true, true);
        behind.must_hit = false;
        add_shards(behind.maker, 100, 2, 22, -9, -2);
    }
    add_shards(scene("crossing the eye plane", true, true).maker, 100, 2, 23, -1, 1);
    add_shards(scene("needles, bow-ties, points", false, false).maker, 300, 1, 24, 2, 8);
    add_shards(scene("needles, bow-ties, points moving", true, true).maker, 300, 2, 25, 2, 8);
    {
        GridMaker& maker = scene("floor under the camera", false, true).maker;
        for (int part = 0; part < 8; ++part)
            maker.add(16, 16, 1, [=](int i, int j, float) {
                return V3f(static_cast<float>(i) * 4 - 32, -1, static_cast<float>(j + 16 * part) * 0.5f - 20);
            });
    }
}

void add_looks_and_cameras(const AddScene& scene) {
    {
        GridMaker& maker = scene("transparent layers", true, true).maker;
        maker.opaque = false;
        add_sheets(maker, 40, 2, 26);
        maker.opaque = true;
        add_sheets(maker, 6, 2, 27);
    }
    {
        GridMaker& maker = scene("one-sided", true, false).maker;
        maker.facing = Facing::PositiveOnly;
        add_sheets(maker, 15, 2, 28);
        maker.facing = Facing::NegativeOnly;
        add_sheets(maker, 15, 1, 29);
    }
    {
        GridMaker& maker = scene("ties", false, true).maker;
        for (int copy = 0; copy < 3; ++copy) add_sheets(maker, 10, 1, 30);
        maker.opaque = false;
        for (int copy = 0; copy < 2; ++copy) add_sheets(maker, 10, 1, 30);
    }
    {
        GridMaker& maker = scene("all at one place", false, false).maker;
        for (int n = 0; n < 70; ++n)
            maker.add(3, 2, 1, [](int i, int j, float) { return V3f(0.3f * i - 0.5f, 0.3f * j, 4); });
    }
    {
        TestScene& ortho = scene("orthographic", true, true);
        ortho.frame.options.projection = "orthographic";
        ortho.frame.options.screen_window = std::array{-4.0f, 4.0f, -3.0f, 3.0f};
        ortho.frame.update();
        add_sheets(ortho.maker, 30, 2, 31);
    }
    {
        TestScene& clipped = scene("clipped", true, true);
        clipped.frame.options.near_clip = 4.5f, clipped.frame.options.far_clip = 6;
        clipped.frame.update();
        clipped.maker.opaque = false;
        add_sheets(clipped.maker, 30, 2, 32);
    }
    {
        GridMaker& maker = scene("far from the origin and huge", true, false).maker;
        maker.add(8, 8, 2,
                  [](int i, int j, float t) { return V3f(1e3f * (i - 4), 1e3f * (j - 4) + 500 * t, 900); });
        maker.add(1, 1, 1, [](int i, int j, float) {
            return V3f(2e30f * (i - 0.5f), 3e30f * (j - 0.5f), 1e20f * (i + 1));
        });
        maker.add(1, 1, 1,
                  [](int i, int j, float) { return V3f(1e16f * (i - 0.5f), 1e16f * (j - 0.5f), 100); });
        add_sheets(maker, 10, 2, 33);
    }
}

std::vector<TestScene> make_scenes() {
    std::vector<TestScene> scenes;
    scenes.reserve(32);  // scenes stay where they are: their contexts are referred to
    const AddScene scene(scenes);
    add_kinds_of_blur(scene);
    add_thin_things(scene);
    add_degenerate_things(scene);
    add_looks_and_cameras(scene);
    return scenes;
}

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

/// What no bound has a say in: every sample against every micropolygon, one by one.
std::vector<HitBuffer> resolve_naively(const TestScene& scene, const SamplePattern& pattern) {
    const Camera& camera = scene.frame.context.camera;
    const auto tiles = tiles_of({-2, -2, scene.frame.options.width + 2, scene.frame.options.height + 2});
    std::vector<HitBuffer> buffers(tiles.size());
    for (size_t n = 0; n < tiles.size(); ++n) {
        SampleTile samples;
        pattern.make_tile(tiles[n], samples);
        HitBuffer& buffer = buffers[n];
        buffer.first.push_back(0);
        for (const AxisRay& ray : samples.rays) {
            std::vector<Hit> hits;
            Hit opaque = kNoHit;
            for (size_t g = 0; g < scene.maker.grids().grids.size(); ++g) {
                const Grid& grid = scene.maker.grids().grids[g];
                for (int v = 0; v < grid.shape.nv; ++v)
                    for (int u = 0; u < grid.shape.nu; ++u) {
                        float depth;
                        if (!hit_micropolygon(ray, grid.quad(u, v, ray.time), grid.facing, &depth)) continue;
                        if (!(depth >= camera.near_clip && depth <= camera.far_clip)) continue;
                        const MicropolygonId id{static_cast<uint32_t>(g), static_cast<uint8_t>(u),
                                                static_cast<uint8_t>(v)};
                        hits.push_back({depth, id.packed()});
                        if (grid.opaque && in_front(hits.back(), opaque)) opaque = hits.back();
                    }
            }
            std::sort(hits.begin(), hits.end(), in_front);
            for (const Hit& hit : hits)
                if (!in_front(opaque, hit)) buffer.hits.push_back(hit);
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

TEST_P(Agreement, OfAllInstructionSets) {
    Truths truths(scene());
    for_each_target([&] {
        for (const auto& [method, pattern] : every_method({.one_of_each_tree = true}))
            EXPECT_TRUE(resolve(scene(), method) == truths.of(pattern)) << method;
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
