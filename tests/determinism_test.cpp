/// Every tiny scene renders to the same bits whatever the visibility method, the threads, the regions and the
/// crop.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "core/simd/simd_limit.h"
#include "sample/every_method_harness.h"
#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

void expect_same(const std::vector<FrameResult>& a, const std::vector<FrameResult>& b,
                 const std::string& what) {
    ASSERT_EQ(a.size(), b.size()) << what;
    for (size_t i = 0; i < a.size(); ++i)
        EXPECT_TRUE(same_bits(a[i].image, b[i].image)) << what << ", world " << i;
}

class TinyScene : public ::testing::TestWithParam<std::string> {};

TEST_P(TinyScene, IsTheSameForEveryThreadCountAndRegionSplit) {
    const std::string path = tiny_scene_path(GetParam());
    RenderSettings settings;
    const auto reference = render_scene(path, settings, 2);
    ASSERT_FALSE(reference.empty());

    for (const int threads : {1, 7}) expect_same(reference, render_scene(path, settings, threads), "threads");
    for (const int regions : {3, 40}) {
        RenderSettings split = settings;
        split.regions_at_least = regions;
        const auto results = render_scene(path, split, 2);
        expect_same(reference, results, std::to_string(regions) + " regions");
        // A picture this small may have fewer tiles than that.
        for (const FrameResult& result : results) EXPECT_GT(result.stats.regions, 1);
    }
}

/// A crop has the bits of the whole picture, though what lies beside it is not even measured.
TEST_P(TinyScene, IsTheSameInTiles) {
    const std::string path = tiny_scene_path(GetParam());
    const auto whole = render_scene(path, {}, 2);
    constexpr PictureTile kGrid{4, 3, 0};
    const auto first = static_cast<int>(GetParam().size() % 4);
    for (int number = 1 + first; number <= kGrid.count(); number += 4) {
        RenderSettings settings;
        settings.tile = PictureTile{kGrid.columns, kGrid.rows, number};
        const auto tile = render_scene(path, settings, 2);
        ASSERT_EQ(tile.size(), whole.size());
        for (size_t i = 0; i < tile.size(); ++i) {
            const Image &a = whole[i].image, &b = tile[i].image;
            size_t others = 0;
            for (int y = b.window.y0; y < b.window.y1; ++y)
                for (int x = b.window.x0; x < b.window.x1; ++x) {
                    const size_t at = a.index(x, y), own = b.index(x, y);
                    others += a.z[at] != b.z[own];
                    for (size_t c = 0; c < 4; ++c) others += a.rgba[4 * at + c] != b.rgba[4 * own + c];
                }
            EXPECT_FALSE(b.window.empty());
            EXPECT_EQ(others, 0u) << number << ", world " << i;
        }
    }
}

/// The rows of the table of methods, each as it is by default, and one of their other forms: these take turns
/// from scene to scene.
std::vector<MethodForm> methods_for(const std::string& scene) {
    std::vector<MethodForm> rows, others;
    for (MethodForm& form : every_method())
        (form.name.find(':') == std::string::npos ? rows : others).push_back(std::move(form));
    const std::vector<std::string> all = tiny_scenes();
    const auto number = static_cast<size_t>(std::find(all.begin(), all.end(), scene) - all.begin());
    if (!others.empty()) rows.push_back(others[number % others.size()]);
    return rows;
}

/// Methods that have samples of their own show what brute force shows with those.
TEST_P(TinyScene, IsTheSameForEveryMethod) {
    const std::string path = tiny_scene_path(GetParam());
    const auto render = [&](const std::string& method, const std::string& pattern) {
        RenderSettings settings;
        settings.sampler = method, settings.pattern = pattern;
        return render_scene(path, settings, 2);
    };
    std::map<std::string, std::vector<FrameResult>> truths;
    for (const auto& [method, pattern] : methods_for(GetParam())) {
        std::vector<FrameResult>& truth = truths[pattern];
        if (truth.empty()) truth = render("bruteforce", pattern);
        ASSERT_FALSE(truth.empty());
        if (method != "bruteforce") expect_same(truth, render(method, pattern), method);
    }
}

/// The picture's last tiles are small. The next tile's samples are then still looked at all together: each
/// hit of what solids are made of is found once, or twice where lists had no room.
TEST(Determinism, SmallTilesOfSolidsLeaveOthersWhole) {
    const auto hits_by = [](const std::string& method) {
        RenderSettings settings;
        settings.sampler = method, settings.pattern = "interval";
        return render_scene(tiny_scene_path("csg.rib"), settings, 1).at(0).stats.sample.predicate_hits;
    };
    const uint64_t once = hits_by("bruteforce");
    EXPECT_GT(once, 100'000u);
    EXPECT_LT(hits_by("interval"), 2 * once);
}

/// Scenes are more than forms of methods: each form has its turn.
TEST(Determinism, EveryFormOfAMethodRendersSomeScene) {
    std::set<std::string> turns;
    for (const std::string& scene : tiny_scenes())
        if (!scene.starts_with("make_"))
            for (const MethodForm& form : methods_for(scene)) turns.insert(form.name);
    for (const MethodForm& form : every_method()) EXPECT_TRUE(turns.contains(form.name)) << form.name;
}

/// Whether the build has one instruction set alone, as those for sanitizers: then all names stand for it.
#if defined(HWY_COMPILE_ONLY_STATIC)
constexpr bool kOneInstructionSet = true;
#else
constexpr bool kOneInstructionSet = false;
#endif

TEST_P(TinyScene, IsTheSameOnEveryInstructionSet) {
    const std::string path = tiny_scene_path(GetParam());
    const auto reference = render_scene(path, {}, 2);
    std::set<std::string> targets;
    int usable = 0;
    std::string error;
    for (const std::string_view name : simd_names()) {
        if (name == "best" || !limit_simd(name, &error)) continue;
        ++usable;
        const auto limited = render_scene(path, {}, 2);
        expect_same(reference, limited, std::string(name));
        targets.insert(std::string(limited[0].stats.simd_target));
        if (kOneInstructionSet) break;
    }
    limit_simd("best", &error);
    EXPECT_GT(usable, 0);
    EXPECT_EQ(targets.size(), static_cast<size_t>(usable)) << "the limit limits nothing";
}

INSTANTIATE_TEST_SUITE_P(All, TinyScene, ::testing::ValuesIn(tiny_scenes_without_maps()), test_name);

TEST(Seed, ChangesTheSamplesAndNothingElse) {
    RenderSettings settings;
    const auto a = render_scene(tiny_scene_path(tiny_scenes().front()), settings);
    const auto b = render_scene(tiny_scene_path(tiny_scenes().front()), settings);
    settings.seed = 1;
    const auto c = render_scene(tiny_scene_path(tiny_scenes().front()), settings);
    EXPECT_TRUE(same_bits(a[0].image, b[0].image));
    EXPECT_FALSE(same_bits(a[0].image, c[0].image));
    EXPECT_EQ(a[0].stats.tessellate.micropolygons, c[0].stats.tessellate.micropolygons);
}

TEST(MemoryBudget, SplitsThePictureAndChangesNothingElse) {
    // Large enough that grids take tens of times the memory that is handed out at once.
    WorkFolder folder;
    folder.write("large.rib",
                 "Format 200 150 1\nPixelSamples 2 2\nShutter 0 1\nProjection \"perspective\" \"fov\" 40\n"
                 "Translate 0 0 3\nWorldBegin\nShadingRate .04\nMotionBegin [0 1]\nTranslate 0 0 0\n"
                 "Translate .1 0 0\nMotionEnd\nSphere 1 -1 1 360\nWorldEnd\n");
    const std::string path = (folder / "large.rib").string();
    RenderSettings settings;
    const auto whole = render_scene(path, settings);
    ASSERT_EQ(whole[0].stats.regions, 1);
    settings.memory_bytes = whole[0].stats.peak_region_bytes / 3;
    const auto parts = render_scene(path, settings);
    EXPECT_GT(parts[0].stats.regions, 3);
    EXPECT_LE(parts[0].stats.peak_region_bytes, settings.memory_bytes);
    expect_same(whole, parts, "memory budget");
}

TEST(TwoRendersInOneProcess, DoNotSeeEachOther) {
    const auto scenes = tiny_scenes();
    RenderSettings settings;
    const auto alone_a = render_scene(tiny_scene_path(scenes.front()), settings, 1);
    const auto alone_b = render_scene(tiny_scene_path(scenes.back()), settings, 1);
    std::vector<FrameResult> together_a, together_b;
    std::thread other([&] { together_b = render_scene(tiny_scene_path(scenes.back()), settings, 1); });
    together_a = render_scene(tiny_scene_path(scenes.front()), settings, 1);
    other.join();
    expect_same(alone_a, together_a, "first");
    expect_same(alone_b, together_b, "second");
}

/// Some grids never end, others do after more turns than they would have afterwards: which of them come first
/// must not show.
TEST(Determinism, EndlessLoopsLeaveTheSameInEveryOrder) {
    const WorkFolder folder;
    folder.write("spin.sl",
                 "surface spin() { float i = 0, end = 40 + 400 * t; if (s > 0.95) end = 1e20;\n"
                 "while (i < end) i += 1; Ci = color(i / 1000, s, t); Oi = 1; }");
    folder.write("a.rib",
                 "Format 96 96 1 PixelSamples 1 1 WorldBegin Surface \"spin\"\n"
                 "Polygon \"P\" [-1 -1 1 1 -1 1 1 1 1 -1 1 1] \"st\" [0 0 1 0 1 1 0 1]\nWorldEnd\n");
    const std::string path = (folder / "a.rib").string();
    const auto reference = render_scene(path, {}, 1, true);
    ASSERT_EQ(reference.size(), 1u);
    const std::vector<float>& rgba = reference[0].image.rgba;
    EXPECT_GT(*std::max_element(rgba.begin(), rgba.end()), 0.2f);
    for (const int threads : {2, 7}) expect_same(reference, render_scene(path, {}, threads, true), "threads");
    RenderSettings split;
    split.regions_at_least = 9;
    expect_same(reference, render_scene(path, split, 2, true), "regions");
}

/// A world that is larger or smaller by a power of two has the same numbers but for their exponents.
TEST(Determinism, OfUnits) {
    const auto micropolygons = [](const std::string& shape, int power) {
        const WorkFolder folder;
        std::ostringstream scale;
        scale << std::ldexp(1.0, power);
        folder.write("a.rib", "Format 60 60 1 PixelSamples 1 1 Projection \"perspective\" \"fov\" 40 Scale " +
                                  scale.str() + " " + scale.str() + " " + scale.str() +
                                  " Translate 0 0 5 WorldBegin Surface \"constant\" " + shape +
                                  " WorldEnd\n");
        const auto frames = render_scene((folder / "a.rib").string(), RenderSettings());
        return frames.empty() ? 0 : frames.front().stats.tessellate.micropolygons;
    };
    for (const std::string shape :
         {"Sphere 1 -1 1 360", "Torus 1 .4 0 360 360",
          "PatchMesh \"bilinear\" 2 \"nonperiodic\" 2 \"nonperiodic\" \"P\" [-1 -1 0 1 -1 2 -1 1 0 1 1 2]"}) {
        const auto expected = micropolygons(shape, 0);
        EXPECT_GT(expected, 100u) << shape;
        for (const int power : {-12, 10, 17, 24, 30})
            EXPECT_EQ(micropolygons(shape, power), expected) << shape << power;
    }
}

}  // namespace
}  // namespace trapeze::testing
