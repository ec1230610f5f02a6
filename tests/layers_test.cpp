/// Layers of surfaces that are not opaque: how many a sample sees (Hider "maxvpdepth"), and pictures whose
/// layers do not fit into memory, which come in passes.
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// Planes across the whole picture, from front to back, each with a colour and an opacity of its own; `given`
/// of `count` of them.
std::string pile(int given, const std::string& options = "", int pixels = 32) {
    std::string rib = "Format " + std::to_string(pixels) + " " + std::to_string(pixels * 3 / 4) +
                      " 1\nPixelSamples 2 2\nProjection \"perspective\" \"fov\" [40]\n" + options +
                      "\nWorldBegin\nShadingRate 64\nSurface \"constant\"\n";
    for (int i = 0; i < given; ++i) {
        const auto part = [i](int n) { return std::to_string(((i * n) % 97 + 1) / 98.0); };
        const std::string z = std::to_string(5 + 0.01 * i), thin = std::to_string((i % 7 + 1) * 0.002);
        rib += "Color [" + part(31) + " " + part(41) + " " + part(53) + "] Opacity [" + thin + " " + thin +
               " " + part(5) + "]\nPolygon \"P\" [-9 -9 " + z + " 9 -9 " + z + " 9 9 " + z + " -9 9 " + z +
               "]\n";
    }
    return rib + "WorldEnd\n";
}

class Layers : public ::testing::Test {
  protected:
    FrameResult render(const std::string& rib, const RenderSettings& settings = {}, int threads = 2) {
        folder_.write("a.rib", rib);
        auto results = render_scene((folder_ / "a.rib").string(), settings, threads);
        EXPECT_EQ(results.size(), 1u);
        return std::move(results.at(0));
    }

    WorkFolder folder_;
};

TEST_F(Layers, AThousandOverTheWholePictureKeepToTheirShareOfMemory) {
    const std::string rib = pile(1000);
    const FrameResult large = render(rib);
    for (const size_t megabytes : {64, 8}) {
        RenderSettings settings;
        settings.memory_bytes = megabytes << 20;
        const FrameResult small = render(rib, settings);
        EXPECT_TRUE(same_bits(large.image, small.image)) << megabytes;
        EXPECT_GT(small.stats.layer_passes, 0u) << megabytes;
        EXPECT_GT(small.stats.hit_list_bytes, 0u) << megabytes;
        EXPECT_LE(small.stats.hit_list_bytes, settings.memory_bytes / 8) << megabytes;
        EXPECT_EQ(small.stats.samples, large.stats.samples) << megabytes;
    }
}

TEST_F(Layers, BeyondTheLimitAreAsIfTheyWereNotThere) {
    const auto limited = [](int most) {
        return "Hider \"hidden\" \"int maxvpdepth\" " + std::to_string(most);
    };
    for (const int most : {1, 3, 40})
        for (const char* method : {"raytrace", "raytrace:tree=paper", "bruteforce", "dualspace"}) {
            RenderSettings settings;
            settings.sampler = method;
            settings.pattern = "stratified";
            const FrameResult seen = render(pile(60, limited(most)), settings);
            EXPECT_TRUE(same_bits(seen.image, render(pile(most)).image)) << method << ", " << most;
        }
    EXPECT_TRUE(same_bits(render(pile(60, limited(-1))).image, render(pile(60)).image));
    EXPECT_FALSE(same_bits(render(pile(60, limited(40))).image, render(pile(60)).image));
}

TEST_F(Layers, OfOpaqueSurfacesOneIsEnough) {
    const std::string path = tiny_scene_path("motion_both.rib");
    folder_.write("b.rib", "Hider \"hidden\" \"int maxvpdepth\" 1\nReadArchive \"" + path + "\"\n");
    const auto limited = render_scene((folder_ / "b.rib").string(), {});
    const auto whole = render_scene(path, {});
    ASSERT_EQ(limited.size(), whole.size());
    EXPECT_TRUE(same_bits(limited[0].image, whole[0].image));
}

/// Scenes with output variables, halfway depths, levels of detail in transition, holdouts, cuts, hair.
class LayersOf : public ::testing::TestWithParam<std::string> {};

TEST_P(LayersOf, AreTheSameInPassesOfAnyMethod) {
    const std::string path = tiny_scene_path(GetParam() + ".rib");
    for (const char* limit : {"", "Hider \"hidden\" \"int maxvpdepth\" 2\n"}) {
        WorkFolder folder;
        folder.write("a.rib", std::string(limit) + "ReadArchive \"" + path + "\"\n");
        const std::string file = (folder / "a.rib").string();
        const auto whole = render_scene(file, {});
        ASSERT_FALSE(whole.empty());
        for (const char* method :
             {"raytrace", "raytrace:tree=paper", "bruteforce", "interval:pairing=shuffled", "dualspace"}) {
            RenderSettings settings;
            settings.sampler = method;
            settings.pattern = "stratified";
            // Of solids whole lists must have room, and rasterizers take as long for one as for a tile's.
            settings.memory_bytes = (GetParam() == "csg" ? size_t{8} : size_t{1}) << 20;
            const auto in_passes = render_scene(file, settings);
            ASSERT_EQ(in_passes.size(), whole.size());
            for (size_t i = 0; i < whole.size(); ++i)
                EXPECT_TRUE(same_bits(in_passes[i].image, whole[i].image)) << method << ' ' << limit << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Tiny, LayersOf,
                         ::testing::Values("aov", "clipping_plane", "csg", "depth_midpoint", "detail",
                                           "matte_alpha", "max_layers", "opacity_varying", "sides"),
                         [](const ::testing::TestParamInfo<std::string>& scene) { return scene.param; });

/// Blurred balls in each other, whose opacity differs from vertex to vertex, with variables and ids.
std::string soap() {
    std::string rib =
        "Format 40 30 1\nPixelSamples 3 3\nProjection \"perspective\" \"fov\" [40]\nShutter 0 1\n"
        "DepthOfField 2 .5 5\nDisplay \"a.exr\" \"openexr\" \"rgba\"\n"
        "Display \"+a_n.exr\" \"openexr\" \"N\"\nDisplay \"+a_id.exr\" \"openexr\" \"id\"\nWorldBegin\n";
    for (int i = 0; i < 40; ++i) {
        const std::string radius = std::to_string(0.3 + 0.03 * i), x = std::to_string((i * 7 % 11 - 5) * 0.1);
        rib += "AttributeBegin\nOpacity [.1 .2 .3]\nMotionBegin [0 1]\nTranslate " + x +
               " 0 5\nTranslate 0 " + x + " 5.2\nMotionEnd\nSphere " + radius + " -1 " + radius +
               " 360 \"Cs\" [1 0 0 0 1 0 0 0 1 1 1 1]\nAttributeEnd\n";
    }
    return rib + "Translate 0 0 6\nSphere .8 -.8 .8 360\nWorldEnd\n";
}

TEST_F(Layers, OfBlurredThingsAreTheSameInPasses) {
    for (const char* limit : {"", "Hider \"hidden\" \"int maxvpdepth\" 5\n",
                              "Hider \"hidden\" \"string depthfilter\" \"midpoint\"\n",
                              "Option \"limits\" \"zthreshold\" [.1 .2 .25]\n"}) {
        const FrameResult whole = render(limit + soap());
        EXPECT_EQ(whole.stats.layer_passes, 0u);
        for (const char* method : {"raytrace", "raytrace:tree=paper", "bruteforce"})
            for (const int threads : {1, 3}) {
                RenderSettings settings;
                settings.sampler = method;
                settings.memory_bytes = 2 << 20;
                const FrameResult in_passes = render(limit + soap(), settings, threads);
                EXPECT_GT(in_passes.stats.layer_passes, 0u) << method;
                EXPECT_TRUE(same_bits(in_passes.image, whole.image)) << method << threads << limit;
            }
    }
}

/// As shadow maps of clear things want it: what lets more through has no depth, whatever else it does.
TEST_F(Layers, ThatAreTooClearHaveNoDepth) {
    const auto depth = [&](const std::string& option) {
        const FrameResult frame = render(
            option +
            "Format 4 4 1 PixelSamples 2 2 Projection \"orthographic\" Display \"a.exr\" \"openexr\" \"rgbaz\"\n"
            "WorldBegin Surface \"constant\"\n"
            "Opacity .25 .25 .25 Polygon \"P\" [-2 -2 3 2 -2 3 2 2 3 -2 2 3]\n"
            "Opacity .5 .5 .5 Polygon \"P\" [-2 -2 4 2 -2 4 2 2 4 -2 2 4]\n"
            "Opacity 1 1 1 Polygon \"P\" [-2 -2 5 2 -2 5 2 2 5 -2 2 5]\nWorldEnd\n");
        return frame.image.z.empty() ? -1 : frame.image.z[5];
    };
    EXPECT_EQ(depth(""), 3);
    EXPECT_EQ(depth("Option \"limits\" \"zthreshold\" [.25 .25 .25]\n"), 3);
    EXPECT_EQ(depth("Option \"limits\" \"color zthreshold\" [.5 .5 .5]\n"), 4);
    EXPECT_EQ(depth("Option \"limits\" \"zthreshold\" [.996 .996 .996]\n"), 5);
}

/// Balls around the eye and before it, cut out of each other in threes, none of them opaque but one behind
/// all.
std::string cut_balls(int count) {
    std::string rib =
        "Format 16 12 1\nPixelSamples 2 2\nProjection \"perspective\" \"fov\" [40]\n"
        "WorldBegin\nShadingRate 16\nSurface \"constant\"\n";
    const auto ball = [&](double z, double radius) {
        const std::string r = std::to_string(radius);
        rib += "SolidBegin \"primitive\" Translate 0 0 " + std::to_string(z) + " Sphere " + r + " -" + r +
               " " + r + " 360 SolidEnd\n";
    };
    for (int i = 0; i < count; ++i) {
        rib += "AttributeBegin Opacity [.02 .03 " + std::to_string(0.001 * (i % 9 + 1)) + "] Color [" +
               std::to_string((i * 31 % 97) / 97.0) + " 1 .5]\nSolidBegin \"difference\"\n";
        ball(i % 3, 4 + 0.01 * i);
        ball(2, 2 + 0.005 * i);
        ball(7, 1 + 0.002 * i);
        rib += "SolidEnd AttributeEnd\n";
    }
    return rib + "Translate 1 0 20 Sphere 3 -3 3 360\nWorldEnd\n";
}

TEST_F(Layers, OfManySolidsKeepToTheirShareOfMemory) {
    for (const char* limit : {"", "Hider \"hidden\" \"int maxvpdepth\" 150\n"}) {
        const std::string rib = limit + cut_balls(100);
        const FrameResult large = render(rib);
        EXPECT_EQ(large.stats.layer_passes, 0u);
        for (const char* method : {"raytrace", "raytrace:tree=paper", "bruteforce"}) {
            RenderSettings settings;
            settings.sampler = method;
            settings.memory_bytes = 24 << 20;
            const FrameResult small = render(rib, settings);
            EXPECT_TRUE(same_bits(large.image, small.image)) << method << limit;
            EXPECT_GT(small.stats.layer_passes, 0u) << method << limit;
            EXPECT_LE(small.stats.hit_list_bytes, settings.memory_bytes / 8) << method << limit;
        }
    }
}

TEST_F(Layers, OfEmbreeKeepToTheirShareOfMemory) {
    if (std::string error; !choose_sampler("embree", "stratified", &error))
        GTEST_SKIP() << "Embree is not here: " << error;
    for (const std::string& rib : {pile(1000), "Hider \"hidden\" \"int maxvpdepth\" 20\n" + pile(1000)}) {
        RenderSettings settings;
        settings.sampler = "embree";
        settings.pattern = "stratified";
        const FrameResult large = render(rib, settings);
        settings.memory_bytes = 16 << 20;
        const FrameResult small = render(rib, settings);
        EXPECT_TRUE(same_bits(large.image, small.image));
        EXPECT_GT(small.stats.layer_passes, 0u);
        EXPECT_LE(small.stats.hit_list_bytes, settings.memory_bytes / 8);
    }
}

TEST_F(Layers, LimitThatIsNoneIsAnError) {
    for (const char* wrong : {"0", "-2", "1e9"}) {
        folder_.write("w.rib",
                      std::string("Hider \"hidden\" \"float maxvpdepth\" ") + wrong + "\n" + pile(2));
        const Outcome outcome = run_program(folder_, "render w.rib -o w.exr");
        EXPECT_EQ(outcome.exit_code, 1) << wrong;
        EXPECT_NE(outcome.err.find("w.rib:1:"), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find("maxvpdepth"), std::string::npos) << outcome.err;
    }
}

TEST_F(Layers, LimitOnTheCommandLineReplacesTheScenes) {
    folder_.write("m.rib", pile(6, "Hider \"hidden\" \"int maxvpdepth\" 1"));
    folder_.write("n.rib", pile(2));
    EXPECT_EQ(run_program(folder_, "render m.rib -o m.exr --max-layers 2").exit_code, 0);
    EXPECT_EQ(run_program(folder_, "render n.rib -o n.exr").exit_code, 0);
    const OIIO::ImageBuf m((folder_ / "m.exr").string()), n((folder_ / "n.exr").string());
    const auto result = OIIO::ImageBufAlgo::compare(m, n, 0.0f, 0.0f);
    EXPECT_EQ(result.maxerror, 0);
    EXPECT_FALSE(result.error);
    EXPECT_EQ(run_program(folder_, "render n.rib --max-layers 0").exit_code, 2);
}

}  // namespace
}  // namespace trapeze::testing
