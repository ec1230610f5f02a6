/// Adaptive sampling: the picture is that of all samples where these are taken, the same in the mean
/// elsewhere, and depends on nothing but the scene.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// A still ball, one that moves, one out of focus, hairs thinner than a pixel, half of them transparent.
std::string scene_of(const std::string& options, const std::string& things = "") {
    return "Format 96 64 1 PixelSamples 8 8 PixelFilter \"gaussian\" 2 2 Projection \"perspective\" \"fov\" [40] "
           "Shutter 0 1 DepthOfField 2 .4 5 " +
           options + "\nWorldBegin LightSource \"distantlight\" 1 \"to\" [1 -1 2] Surface \"matte\" " +
           things +
           "Color [.9 .3 .2] AttributeBegin Translate -1 0 5 Sphere .8 -.8 .8 360 AttributeEnd "
           "AttributeBegin MotionBegin [0 1] Translate .6 -.6 5 Translate 1.4 .2 5.2 MotionEnd Color [.2 .6 .9] "
           "Sphere .5 -.5 .5 360 AttributeEnd "
           "AttributeBegin Translate .3 .6 2.5 Color [.4 .8 .3] Sphere .2 -.2 .2 360 AttributeEnd "
           "Opacity [.5 .5 .5] Curves \"linear\" [2 2 2] \"nonperiodic\" \"P\" [-2 -1 4 2 1 4 -2 1 4.5 2 -1 4.5 "
           "-1 -1.2 5 -1 1.2 5] \"constantwidth\" [.01] WorldEnd\n";
}

constexpr const char* kAdaptive =
    "Hider \"hidden\" \"int minsamples\" 16 \"int maxsamples\" 64 PixelVariance .0003 ";
constexpr const char* kThreeLevels =
    "Hider \"hidden\" \"int minsamples\" 4 \"int maxsamples\" 64 PixelVariance .0003 ";

FrameResult render(const std::string& text, const RenderSettings& settings = {}, int threads = 2) {
    const WorkFolder folder;
    folder.write("a.rib", text);
    auto frames = render_scene((folder / "a.rib").string(), settings, threads);
    EXPECT_EQ(frames.size(), 1u);
    return std::move(frames.at(0));
}

double samples_per_pixel(const FrameResult& frame) {
    return static_cast<double>(frame.stats.samples) / (98.0 * 66.0);
}

TEST(Adaptive, TakesFewerSamplesAndIsNearTheWholePicture) {
    const FrameResult all = render(scene_of("")), some = render(scene_of(kAdaptive));
    EXPECT_EQ(samples_per_pixel(all), 64);
    EXPECT_GT(samples_per_pixel(some), 16.5);
    EXPECT_LT(samples_per_pixel(some), 45);
    double sum = 0;
    for (size_t i = 0; i < all.image.rgba.size(); ++i) {
        const double d = static_cast<double>(all.image.rgba[i]) - static_cast<double>(some.image.rgba[i]);
        sum += d * d;
    }
    const double rms = std::sqrt(sum / static_cast<double>(all.image.rgba.size()));
    EXPECT_GT(rms, 0);
    EXPECT_LT(rms, std::sqrt(.0003));
}

TEST(Adaptive, IsTheSameForThreadsRegionsAndMethods) {
    for (const char* options : {kAdaptive, kThreeLevels}) {
        const FrameResult reference = render(scene_of(options), {}, 1);
        EXPECT_TRUE(same_bits(reference.image, render(scene_of(options), {}, 7).image));
        for (const int regions : {3, 40}) {
            RenderSettings split;
            split.regions_at_least = regions;
            EXPECT_TRUE(same_bits(reference.image, render(scene_of(options), split).image)) << regions;
        }
        for (const char* method : {"raytrace:tree=paper,bundle=off", "raytrace:tree=paper", "bruteforce"}) {
            RenderSettings other;
            other.sampler = method;
            EXPECT_TRUE(same_bits(reference.image, render(scene_of(options), other).image)) << method;
        }
    }
}

/// Lists of transparent layers come in passes where they do not fit.
TEST(Adaptive, IsTheSameWhereLayersComeInPasses) {
    std::string sheets;
    for (int i = 0; i < 40; ++i)
        sheets += "AttributeBegin Opacity [.1 .2 .1] Polygon \"P\" [-3 -3 " + std::to_string(4 + .02 * i) +
                  " 3 -3 " + std::to_string(4 + .02 * i) + " 3 3 " + std::to_string(4.5 + .02 * i) +
                  " -3 3 " + std::to_string(4.5 + .02 * i) + "] AttributeEnd ";
    const std::string scene = scene_of(kAdaptive, sheets);
    const FrameResult reference = render(scene);
    RenderSettings small;
    small.memory_bytes = size_t{8} << 20;
    const FrameResult passes = render(scene, small);
    EXPECT_EQ(reference.stats.layer_passes, 0u);
    EXPECT_GT(passes.stats.layer_passes, 0u);
    EXPECT_TRUE(same_bits(reference.image, passes.image));
}

TEST(Adaptive, CropsArePartsOfTheWholePicture) {
    for (const char* options : {kAdaptive, kThreeLevels}) {
        const Image whole = render(scene_of(options)).image;
        for (const char* crop : {"0 .5 0 .5", ".43 .81 .37 .77", ".5 .52 .5 .52"}) {
            const Image part = render(scene_of(options + std::string("CropWindow ") + crop)).image;
            ASSERT_FALSE(part.rgba.empty());
            size_t other = 0;
            for (int y = part.window.y0; y < part.window.y1; ++y)
                for (int x = part.window.x0; x < part.window.x1; ++x) {
                    for (size_t c = 0; c < 4; ++c)
                        other += part.rgba[4 * part.index(x, y) + c] != whole.rgba[4 * whole.index(x, y) + c];
                    other += part.z[part.index(x, y)] != whole.z[whole.index(x, y)];
                }
            EXPECT_EQ(other, 0u) << crop;
        }
    }
}

/// Where every pixel takes all its samples, the picture is that of uniform sampling to the bit.
TEST(Adaptive, IsUniformWhereAllPixelsTakeAllSamples) {
    const std::string noisy =
        "Surface \"draws\" Polygon \"P\" [-9 -9 6 9 -9 6 9 9 6 -9 9 6] Surface \"matte\" ";
    const WorkFolder folder;
    folder.write("draws.sl", "surface draws() { Oi = 1; Ci = random(); }");
    const auto of = [&](const std::string& options) {
        folder.write("a.rib",
                     "Option \"searchpath\" \"string shader\" [\"" + folder.path().string() + ":&\"] " +
                         scene_of("Display \"+v\" \"null\" \"Ci\" ShadingRate .2 " + options, noisy));
        auto frames = render_scene((folder / "a.rib").string(), {});
        return std::move(frames.at(0));
    };
    for (const char* filter :
         {"", "PixelFilter \"box\" 1 1 ", "PixelFilter \"catmull-rom\" 4 4 ", "PixelFilter \"disk\" 3 3 "})
        for (const char* samples : {"PixelSamples 8 8 ", "PixelSamples 16 16 "}) {
            const FrameResult all = of(std::string(filter) + samples);
            const FrameResult some =
                of(std::string(filter) + samples +
                   "PixelVariance 1e-10 Hider \"hidden\" \"int minsamples\" 16 \"int maxsamples\" 64 ");
            EXPECT_EQ(some.stats.samples, all.stats.samples) << filter << samples;
            EXPECT_TRUE(same_bits(all.image, some.image)) << filter << samples;
        }
}

TEST(Adaptive, NeedsMoreThanAVarianceInTheScene) {
    const FrameResult all = render(scene_of(""));
    for (const char* options :
         {"PixelVariance .01 ", "PixelVariance .01 Hider \"hidden\" \"int maxsamples\" 64 ",
          "Hider \"hidden\" \"int minsamples\" 4 \"int maxsamples\" 64 "}) {
        const FrameResult some = render(scene_of(options));
        EXPECT_TRUE(same_bits(all.image, some.image)) << options;
    }
}

/// Mean differences to uniform sampling over many seeds, by channel and square of 16 pixels: within three of
/// their standard errors but for one in a hundred.
TEST(Adaptive, IsUniformInTheMean) {
    constexpr int kSide = 16;
    // Differences of pictures that begin with four samples are far from normal: they need more seeds.
    for (const auto& [options, seeds] : {std::pair{kAdaptive, 64}, {kThreeLevels, 96}}) {
        std::vector<double> sums, squares;
        for (int seed = 0; seed < seeds; ++seed) {
            RenderSettings settings;
            settings.seed = static_cast<uint32_t>(seed);
            const std::string larger = "Format 160 96 1 ";
            const Image all = render(scene_of(larger), settings).image,
                        some = render(scene_of(larger + options), settings).image;
            const int columns = all.window.width() / kSide, rows = all.window.height() / kSide;
            sums.resize(static_cast<size_t>(columns * rows) * 4), squares.resize(sums.size());
            for (int block = 0; block < columns * rows; ++block)
                for (size_t c = 0; c < 4; ++c) {
                    double difference = 0;
                    for (int i = 0; i < kSide * kSide; ++i) {
                        const size_t at = 4 * all.index(block % columns * kSide + i % kSide,
                                                        block / columns * kSide + i / kSide) +
                                          c;
                        difference += static_cast<double>(some.rgba[at]) - static_cast<double>(all.rgba[at]);
                    }
                    sums[static_cast<size_t>(block) * 4 + c] += difference;
                    squares[static_cast<size_t>(block) * 4 + c] += difference * difference;
                }
        }
        size_t beyond = 0, counted = 0;
        double worst = 0;
        for (size_t i = 0; i < sums.size(); ++i) {
            const double mean = sums[i] / seeds, variance = (squares[i] / seeds - mean * mean) / (seeds - 1);
            if (!(variance > 0)) {
                EXPECT_EQ(mean, 0);
                continue;
            }
            ++counted;
            worst = std::max(worst, std::abs(mean) / std::sqrt(variance));
            beyond += std::abs(mean) > 3 * std::sqrt(variance);
        }
        EXPECT_GE(counted, 150u);
        EXPECT_LE(static_cast<double>(beyond), .01 * static_cast<double>(counted)) << worst;
    }
}

TEST(Adaptive, IsRefusedByMethodsThatTakeAllSamples) {
    const WorkFolder folder;
    folder.write("a.rib", scene_of(kAdaptive));
    Diagnostics diagnostics;
    RenderSettings settings;
    settings.sampler = "interval";
    EXPECT_TRUE(render_worlds((folder / "a.rib").string(), settings, 2, diagnostics).empty());
    EXPECT_EQ(diagnostics.count(Severity::Error), 1u);
}

}  // namespace
}  // namespace trapeze::testing
