/// Maps and lookups that OpenImageIO does not bear, or hardly: few pixels and channels, numbers of every
/// size.
#include "core/random.h"
#include "shade/maps/map_files_harness.h"

namespace trapeze {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

class OddMapsTest : public MapFilesTest {
  protected:
    /// Channel c is 1 + c, inside and outside.
    std::string map(int channels, int width, int height) {
        ImageSpec spec(width, height, channels, TypeDesc::FLOAT);
        spec.attribute("wrapmodes", "periodic,clamp");
        return write(name_of(channels, width, height), spec,
                     [](int, int, int c) { return static_cast<float>(1 + c); });
    }
    static std::string name_of(int channels, int width, int height) {
        return std::to_string(channels) + "_" + std::to_string(width) + "x" + std::to_string(height) + ".exr";
    }
    std::vector<float> look(const std::string& file, const TextureLookup& at, const MapOptions& options,
                            size_t wanted) {
        const std::vector<Plane> out(planes_.begin(), planes_.begin() + static_cast<std::ptrdiff_t>(wanted));
        textures_.texture(textures_.find(file, {}), at, options, {1, {}}, out);
        return firsts(out);
    }
    std::vector<float> look_around(const std::string& file, const V3f& R, const V3f& change,
                                   const MapOptions& options, size_t wanted) {
        const std::vector<Plane> out(planes_.begin(), planes_.begin() + static_cast<std::ptrdiff_t>(wanted));
        textures_.environment(textures_.find(file, {}),
                              {{plane({R.x}), plane({R.y}), plane({R.z})},
                               {plane({change.x}), plane({change.y}), plane({change.z})},
                               {}},
                              options, {1, {}}, out);
        return firsts(out);
    }
    static std::vector<float> firsts(const std::vector<Plane>& planes) {
        std::vector<float> values;
        for (const Plane& plane : planes) values.push_back(plane[0]);
        return values;
    }
    TextureLookup at(float s, float t, float dsdu = 0, float dtdu = 0, float dsdv = 0, float dtdv = 0) {
        return {plane({s}), plane({t}), plane({dsdu}), plane({dtdu}), plane({dsdv}), plane({dtdv})};
    }

    Textures textures_{options_, &diagnostics_};
    std::vector<Plane> planes_{plane(kLanes, -1), plane(kLanes, -1), plane(kLanes, -1)};
};

TEST_F(OddMapsTest, ChannelsAreThoseOfTheFileAndFilledBeyond) {
    MapOptions options;
    options.fill = 0.125f;
    for (int channels = 1; channels <= 9; ++channels)  // more than OpenImageIO keeps together
        for (int width = 1; width <= 3; ++width) {
            const std::string file = map(channels, width, 4 - width);
            for (const float first : {-1e9f, 0.0f, 1.9f, 3.0f, 6.0f, 8.0f, 9.0f, 1e9f, INFINITY, NAN})
                for (const size_t wanted : {1, 3})
                    for (const float size : {0.0f, 0.7f}) {
                        options.first_channel = first;
                        const auto texels = look(file, at(0.4f, 0.6f, size, 0, 0, size), options, wanted);
                        const auto around = look_around(file, {1, 2, 0.1f}, V3f(size), options, wanted);
                        const float from = std::isfinite(first) ? std::max(std::trunc(first), 0.0f) : 0;
                        for (size_t k = 0; k < wanted; ++k) {
                            const float channel = from + static_cast<float>(k);
                            const float expected =
                                channel < static_cast<float>(channels) ? 1 + channel : 0.125f;
                            EXPECT_NEAR(texels[k], expected, 1e-4f) << file << " " << first << " " << k;
                            EXPECT_NEAR(around[k], expected, 1e-4f) << file << " " << first << " " << k;
                        }
                    }
        }
    EXPECT_TRUE(reported_.empty());
}

TEST_F(OddMapsTest, RegionsWithoutAreaMayBeBlurred) {
    // t is a function of s.
    const std::string file = map(1, 16, 16);
    ImageSpec strip(3, 80, 1, TypeDesc::FLOAT);
    strip.full_width = 900, strip.full_height = 80;
    const std::string part = write("part.exr", strip, [](int, int, int) { return 1.0f; });
    for (const float blur : {1e-6f, 0.1f, 1e30f}) {
        MapOptions options;
        options.sblur = options.tblur = blur;
        for (const std::string& name : {file, part})
            for (const float d : {1e-30f, 1e-8f, 1e-3f, 0.3f, 40.0f, 1e30f})
                for (const float slant : {0.0f, 1e-4f, 1.0f, 1e4f}) {
                    const auto seen =
                        look(name, at(0.5f, 0.5f, d, d * slant, 2 * d, 2 * d * slant), options, 1);
                    EXPECT_TRUE(std::isfinite(seen[0])) << d << " " << slant;
                    if (name == file && blur < 1) {
                        EXPECT_NEAR(seen[0], 1, 1e-3f) << d << " " << slant;
                    }
                }
    }
}

TEST_F(OddMapsTest, PartsOfPicturesRepeat) {
    // 16 pixels of 20 by 20, which are black beyond.
    ImageSpec spec(16, 16, 1, TypeDesc::FLOAT);
    spec.full_width = spec.full_height = 20;
    spec.attribute("wrapmodes", "periodic,periodic");
    const std::string file = write("part.exr", spec, [](int x, int, int) { return x < 8 ? 1.0f : 2.0f; });
    for (const float turn : {-3.0f, 0.0f, 1.0f, 5000.0f}) {
        EXPECT_NEAR(look(file, at(0.2f + turn, 0.3f - turn), {}, 1)[0], 1, 1e-3f) << turn;
        EXPECT_NEAR(look(file, at(0.6f + turn, 0.3f - turn), {}, 1)[0], 2, 1e-3f) << turn;
        EXPECT_NEAR(look(file, at(0.95f + turn, 0.3f - turn), {}, 1)[0], 0, 1e-3f) << turn;
    }
    EXPECT_TRUE(std::isfinite(look(file, at(0.2f, 0.2f, 3, 0, 0, 3), {}, 1)[0]));
}

TEST_F(OddMapsTest, NumbersOfEverySizeAreHarmless) {
    constexpr float kNumbers[] = {0,
                                  -0.0f,
                                  1,
                                  -1,
                                  0.5f,
                                  1e-45f,
                                  1e-20f,
                                  -1e-8f,
                                  16384,
                                  1e10f,
                                  2147483648.0f,
                                  -2147483648.0f,
                                  3e38f,
                                  -3e38f,
                                  INFINITY,
                                  -INFINITY,
                                  NAN};
    uint32_t draw = 0;
    const auto any = [&] { return kNumbers[hash(draw++) % std::size(kNumbers)]; };
    const std::string files[] = {map(3, 2, 3), map(1, 40, 1),
                                 write_depth_map(
                                     "depths.exr", 3, true, [&](int, int) { return any(); }, M44f())};
    for (int turn = 0; turn < 3000; ++turn) {
        const std::string& file = files[turn % 3];
        MapOptions options;
        for (LaneNumber* option : {&options.sblur, &options.tblur, &options.swidth, &options.twidth,
                                   &options.bias, &options.first_channel})
            if (hash(draw++) % 3 == 0) *option = any();
        options.filter = static_cast<MapOptions::Filter>(turn % 3);
        options.swrap = static_cast<MapOptions::Wrap>(turn % 5), options.lerp = turn % 2 == 0;
        const auto seen = look(file, at(any(), any(), any(), any(), any(), any()), options, 3);
        const auto around = look_around(file, {any(), any(), any()}, {any(), any(), any()}, options, 3);
        const Plane hidden = planes_[0];
        textures_.shadow(textures_.find_shadow(files[2], {}),
                         {{plane({any()}), plane({any()}), plane({any()})},
                          {plane({any()}), plane({any()}), plane({any()})},
                          {plane({any()}), plane({any()}), plane({any()})}},
                         M44f(), options, {1, {}}, hidden);
        EXPECT_TRUE(hidden[0] >= 0 && hidden[0] <= 1) << hidden[0];
        kept_.clear();
        planes_ = {plane(kLanes, -1), plane(kLanes, -1), plane(kLanes, -1)};
        if (file == files[2]) continue;
        for (size_t k = 0; k < 3; ++k)
            EXPECT_TRUE(std::isfinite(seen[k]) && std::isfinite(around[k])) << turn;
    }
}

TEST_F(OddMapsTest, FilesThatAreCutShortAreErrors) {
    const std::string whole = map(3, 40, 40);
    const auto bytes = std::filesystem::file_size(whole);
    for (const auto kept : {uintmax_t{0}, uintmax_t{5}, bytes / 3, bytes - 1}) {
        const std::string part = path("part" + std::to_string(kept) + ".exr");
        std::filesystem::copy_file(whole, part);
        std::filesystem::resize_file(part, kept);
        const size_t before = reported_.size();
        for (const float value : look(part, at(0.3f, 0.9f), {}, 3)) EXPECT_TRUE(std::isfinite(value));
        if (kept < bytes / 2) {
            EXPECT_GT(reported_.size(), before) << kept;
        }
    }
}

}  // namespace
}  // namespace trapeze
