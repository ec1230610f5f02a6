/// Mattes, deep pictures, and variables of one sample a pixel, in whole frames: what they say of the picture,
/// and that they depend on nothing but the scene.
#include <gtest/gtest.h>

#include <cmath>

#include "composite/filters/glow_filter.h"
#include "composite/mattes/matte_layers.h"
#include "composite/mattes/murmur_hash.h"
#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

constexpr const char* kNamesOfThings[] = {"ball", "mover", "near", "hair", "wall"};

/// A ball, one that moves, one out of focus, transparent hairs and a wall. Names in `held_out` are Matte.
std::string named_scene(const std::string& options, const std::string& held_out = "") {
    std::string text =
        "Format 64 48 1 PixelSamples 6 6 PixelFilter \"gaussian\" 2 2 Projection \"perspective\" \"fov\" "
        "[40] Shutter 0 1 DepthOfField 2 .4 5 " +
        options + "\nWorldBegin LightSource \"distantlight\" 1 \"to\" [1 -1 2] Surface \"matte\" ";
    const std::string things[] = {
        "Color [.9 .3 .2] Translate -1 0 5 Sphere .8 -.8 .8 360",
        "MotionBegin [0 1] Translate .6 -.6 5 Translate 1.4 .2 5.2 MotionEnd Color [.2 .6 .9] Sphere .5 -.5 .5 360",
        "Translate .3 .6 2.5 Color [.4 .8 .3] Sphere .2 -.2 .2 360",
        "Surface \"constant\" Opacity [.5 .5 .5] Curves \"linear\" [2 2 2] \"nonperiodic\" \"P\" [-2 -1 4 2 1 4 -2 1 4.5 "
        "2 -1 4.5 -1 -1.2 5 -1 1.2 5] \"constantwidth\" [.04]",
        "Polygon \"P\" [-3 -1 8 1 -1 8 1 1 8 -3 1 8]"};
    for (size_t i = 0; i < std::size(things); ++i) {
        const std::string name = kNamesOfThings[i];
        text += "AttributeBegin Attribute \"identifier\" \"string name\" [\"" + name + "\"] " +
                (held_out.find(name) != std::string::npos ? "Matte 1 " : "") + things[i] + " AttributeEnd\n";
    }
    return text + "WorldEnd\n";
}

constexpr const char* kMatteDisplays =
    "Display \"x.exr\" \"exr\" \"rgba\" Display \"+x.exr\" \"exr\" \"crypto_object\" Display \"+x.exr\" \"exr\" "
    "\"crypto_material\" ";
constexpr const char* kDeepDisplays =
    "Display \"x.exr\" \"exr\" \"rgba\" Display \"+d.exr\" \"DeepEXR\" \"rgba\" ";
constexpr const char* kKeptDisplays =
    "Display \"x.exr\" \"exr\" \"rgba\" Display \"+x.exr\" \"exr\" \"point P\" \"string filter\" \"zmin\" "
    "Display \"+x.exr\" \"exr\" \"point P\" \"string filter\" \"max\" Display \"+x.exr\" \"exr\" \"color albedo\" "
    "Display \"+x.exr\" \"exr\" \"vector motion\" \"string filter\" \"zmax\" ";

FrameResult render_frame_of(const std::string& text, const RenderSettings& settings, int threads = 2) {
    const WorkFolder folder;
    folder.write("a.rib", text);
    return std::move(render_scene((folder / "a.rib").string(), settings, threads).at(0));
}

Image render_text(const std::string& text, const RenderSettings& settings = {}, int threads = 2) {
    return render_frame_of(text, settings, threads).image;
}

/// How much of a pixel the ids of a layer cover together, or one of them.
float coverage(const Image& image, size_t pixel, size_t layer, const char* name = nullptr) {
    const float* const ranks = &image.mattes[image.matte_floats * pixel + kMatteFloats * layer];
    float sum = 0;
    for (int rank = 0; rank < kMatteRanks; ++rank)
        if (!name || ranks[2 * rank] == matte_id(murmur_hash_3(name))) sum += ranks[2 * rank + 1];
    return sum;
}

void expect_coverages_are_alpha(const Image& image) {
    ASSERT_EQ(image.matte_floats, 2 * kMatteFloats);
    EXPECT_EQ(image.matte_loss, 0);
    for (size_t pixel = 0; pixel < image.z.size(); ++pixel)
        for (size_t layer = 0; layer < 2; ++layer)
            ASSERT_NEAR(coverage(image, pixel, layer), image.rgba[4 * pixel + 3], 1e-6) << pixel;
}

constexpr const char* kAdaptiveOptions =
    "Hider \"hidden\" \"int minsamples\" 9 \"int maxsamples\" 36 PixelVariance .0003 ";

TEST(Mattes, CoveragesSumUpToAlpha) {
    for (const char* options :
         {"", "PixelFilter \"box\" 1 1 ", "PixelFilter \"disk\" 3 3 ", kAdaptiveOptions})
        expect_coverages_are_alpha(render_text(named_scene(std::string(kMatteDisplays) + options)));
}

TEST(Mattes, FiltersWithNegativeWeightsGiveWayToABox) {
    const Image sharp =
        render_text(named_scene(std::string(kMatteDisplays) + "PixelFilter \"catmull-rom\" 4 4 "));
    const Image box = render_text(named_scene(std::string(kMatteDisplays) + "PixelFilter \"box\" 4 4 "));
    EXPECT_EQ(sharp.mattes, box.mattes);
    EXPECT_NE(sharp.rgba, box.rgba);
}

TEST(Mattes, AMaskIsThePictureOfItsObjectWithTheOthersHeldOut) {
    const Image image = render_text(named_scene(kMatteDisplays));
    for (const std::string name : kNamesOfThings) {
        std::string others;
        for (const std::string other : kNamesOfThings)
            if (other != name) others += other + ' ';
        const Image alone = render_text(named_scene("", others));
        double covered = 0;
        for (size_t pixel = 0; pixel < image.z.size(); ++pixel) {
            const float mask = coverage(image, pixel, 0, name.c_str());
            ASSERT_NEAR(mask, alone.rgba[4 * pixel + 3], 1e-6) << name << pixel;
            covered += mask;
        }
        EXPECT_GT(covered, 5) << name;
    }
}

TEST(Mattes, MoreThanSixNamesInAPixelAreTold) {
    std::string text =
        "Format 4 4 1 PixelSamples 8 8 " + std::string(kMatteDisplays) + "WorldBegin Surface \"constant\" ";
    for (int i = 0; i < 16; ++i) {
        const std::string x = std::to_string(-1 + i / 8.0), next = std::to_string(-1 + (i + 1) / 8.0);
        text += "Attribute \"identifier\" \"string name\" [\"" + std::to_string(i) + "\"] Polygon \"P\" [" +
                x + " -1 1 " + next + " -1 1 " + next + " 1 1 " + x + " 1 1]\n";
    }
    const Image image = render_text(text + "WorldEnd\n");
    EXPECT_GT(image.matte_loss, 0);
    float lost = 0;
    for (size_t pixel = 0; pixel < 16; ++pixel)
        lost = std::max(lost, image.rgba[4 * pixel + 3] - coverage(image, pixel, 0));
    EXPECT_NEAR(image.matte_loss, lost, 1e-6);
}

TEST(DeepPictures, FlattenedAreTheFlatPicture) {
    for (const char* options : {"", kAdaptiveOptions}) {
        const Image image = render_text(
            named_scene(std::string(kDeepDisplays) + "PixelFilter \"box\" 1 1 Exposure 2 1 " + options));
        ASSERT_EQ(image.deep.size(), image.z.size());
        size_t samples = 0, most = 0;
        for (size_t pixel = 0; pixel < image.z.size(); ++pixel) {
            float sum[4] = {};
            for (const DeepSample& sample : image.deep[pixel]) {
                const float let_through = 1 - sum[3];
                for (int c = 0; c < 4; ++c) sum[c] += let_through * sample.rgba[c];
            }
            for (size_t c = 0; c < 4; ++c) ASSERT_NEAR(sum[c], image.rgba[4 * pixel + c], 1e-5) << pixel;
            samples += image.deep[pixel].size(), most = std::max(most, image.deep[pixel].size());
            ASSERT_TRUE(image.deep[pixel].empty() ||
                        image.deep[pixel].front().depth >= image.z[pixel] * .999f);
        }
        EXPECT_GT(most, 3u);
        EXPECT_LT(samples, 6 * image.z.size()) << "samples of one surface merge";
    }
}

TEST(KeptVariables, AreOfTheNearestAndFarthestSurface) {
    const Image image = render_text(named_scene(kKeptDisplays));
    ASSERT_EQ(image.aov_channels, 12);
    size_t seen = 0, moved = 0;
    for (size_t pixel = 0; pixel < image.z.size(); ++pixel) {
        const float* const values = &image.aovs[12 * pixel];
        const float nearest = values[2], greatest = values[5];
        if (image.z[pixel] >= kInfinity) {
            for (int c = 0; c < 12; ++c)
                ASSERT_TRUE(values[c] == 0 || (c > 5 && c < 9)) << "only sums come from beside";
            continue;
        }
        ++seen;
        // P is as the shutter opens, the depth when it is seen, in between .2 nearer to it for what moves;
        // and P is of a corner of the micropolygon.
        ASSERT_NEAR(nearest, image.z[pixel], .3f) << pixel;
        ASSERT_GE(greatest, 0);
        moved += values[9] != 0;
        ASSERT_TRUE(values[9] == 0 || values[10] > 0) << "to the right and up";
    }
    EXPECT_GT(seen, 500u);
    EXPECT_GT(moved, 20u);
}

/// The whole image's part in `window`.
Image part_in(Image whole, const PixelRect& window) {
    trim(window, whole);
    return whole;
}

TEST(MattesAndDeepPictures, AreTheSameForThreadsRegionsMethodsCropsAndMemory) {
    for (const char* displays : {kMatteDisplays, kDeepDisplays, kKeptDisplays}) {
        const Image image = render_text(named_scene(displays));
        RenderSettings regions, method, memory;
        regions.regions_at_least = 17;
        method.sampler = "bruteforce";
        memory.memory_bytes = size_t{1} << 20;  // layers come in passes
        EXPECT_TRUE(render_text(named_scene(displays), {}, 1) == image);
        EXPECT_TRUE(render_text(named_scene(displays), {}, 5) == image);
        EXPECT_TRUE(render_text(named_scene(displays), regions) == image);
        EXPECT_TRUE(render_text(named_scene(displays), method) == image);
        const FrameResult in_passes = render_frame_of(named_scene(displays), memory);
        EXPECT_GT(in_passes.stats.layer_passes, 0u);
        EXPECT_TRUE(in_passes.image == image);
        for (const char* crop : {"CropWindow 0 .5 0 .5 ", "CropWindow .3 .9 .1 1 "}) {
            const Image part = render_text(named_scene(displays + std::string(crop)));
            ASSERT_FALSE(part.rgba.empty());
            EXPECT_TRUE(part == part_in(image, part.window)) << crop;
        }
    }
}

}  // namespace
}  // namespace trapeze::testing
