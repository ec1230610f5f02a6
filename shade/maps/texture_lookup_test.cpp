#include <gmock/gmock.h>

#include <barrier>
#include <bit>
#include <cmath>
#include <numbers>
#include <thread>

#include "shade/maps/make_maps.h"
#include "shade/maps/map_files_harness.h"

namespace trapeze {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;
using ::testing::Each;
using ::testing::FloatNear;

class TextureLookupTest : public MapFilesTest {
  protected:
    /// At one place, filtered over a square of that width.
    float look(const std::string& file, float s, float t, float width = 0, MapOptions options = {}) {
        const Plane out = plane(kLanes, -1);
        const Plane planes[] = {out};
        textures_.texture(textures_.find(file, {}), square(s, t, width), options, {1, {}}, planes);
        return out[0];
    }
    V3f color(const std::string& file, float s, float t, float width = 0, MapOptions options = {}) {
        const Plane planes[] = {plane(kLanes, -1), plane(kLanes, -1), plane(kLanes, -1)};
        textures_.texture(textures_.find(file, {}), square(s, t, width), options, {1, {}}, planes);
        return {planes[0][0], planes[1][0], planes[2][0]};
    }
    TextureLookup square(float s, float t, float width) {
        return {plane({s}), plane({t}), plane({width}), {}, {}, plane({width})};
    }
    static ImageSpec periodic(int side, int channels) {
        ImageSpec spec(side, side, channels, TypeDesc::FLOAT);
        spec.attribute("wrapmodes", "periodic,periodic");
        return spec;
    }
    /// 64 x 64 texels of 0 and 1.
    std::string checker() {
        return write("checker.exr", periodic(64, 1),
                     [](int x, int y, int) { return static_cast<float>((x + y) % 2); });
    }
    std::string three_channels() {
        return write("three.exr", periodic(16, 3),
                     [](int, int, int c) { return 0.25f * static_cast<float>(c + 1); });
    }

    Textures textures_{options_, &diagnostics_};
};

TEST_F(TextureLookupTest, AConstantPictureIsConstantHoweverItIsFiltered) {
    const std::string file = three_channels();
    for (const float width : {0.0f, 0.01f, 0.3f, 2.0f}) {
        const V3f seen = color(file, 0.37f, 0.61f, width);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(seen[k], 0.25f * static_cast<float>(k + 1), 1e-4f) << width;
    }
}

TEST_F(TextureLookupTest, AGradientIsItsPlace) {
    const std::string file = write("gradient.exr", ImageSpec(64, 32, 1, TypeDesc::FLOAT),
                                   [](int x, int, int) { return (static_cast<float>(x) + 0.5f) / 64; });
    for (const float s : {0.2f, 0.5f, 0.71f}) {
        EXPECT_NEAR(look(file, s, 0.3f), s, 1e-3f);
        EXPECT_NEAR(look(file, s, 0.3f, 0.05f), s, 5e-3f);
    }
}

TEST_F(TextureLookupTest, WideLookupsAverage) {
    const std::string file = checker();
    EXPECT_NEAR(look(file, 0.5f, 0.5f, 0.5f), 0.5f, 0.01f);
    MapOptions blurred;
    blurred.sblur = blurred.tblur = 0.5f;
    EXPECT_NEAR(look(file, 0.5f, 0.5f, 0, blurred), 0.5f, 0.01f);
}

TEST_F(TextureLookupTest, WidthMultipliesTheRegion) {
    const std::string file = checker();
    MapOptions narrow;
    narrow.swidth = narrow.twidth = 0;
    narrow.filter = MapOptions::Filter::Nearest;
    EXPECT_NEAR(look(file, 10.5f / 64, 20.5f / 64, 0.5f, narrow), 0, 1e-3f);
    EXPECT_NEAR(look(file, 11.5f / 64, 20.5f / 64, 0.5f, narrow), 1, 1e-3f);
}

TEST_F(TextureLookupTest, NearestTakesATexelAndBoxBlends) {
    const std::string file = write("step.exr", ImageSpec(2, 1, 1, TypeDesc::FLOAT),
                                   [](int x, int, int) { return static_cast<float>(x); });
    MapOptions options;
    options.filter = map_filter("nearest");
    EXPECT_EQ(look(file, 0.45f, 0.5f, 0, options), 0);
    EXPECT_EQ(look(file, 0.55f, 0.5f, 0, options), 1);
    options.filter = map_filter("box");
    EXPECT_NEAR(look(file, 0.5f, 0.5f, 0, options), 0.5f, 1e-3f);
    EXPECT_EQ(map_filter("gaussian"), MapOptions::Filter::Smooth);
}

TEST_F(TextureLookupTest, ChannelsStartAtTheFirstAndMissingOnesAreFilled) {
    const std::string file = three_channels();
    MapOptions options;
    options.first_channel = 2, options.fill = 0.125f;
    EXPECT_NEAR(look(file, 0.5f, 0.5f, 0, options), 0.75f, 1e-4f);
    const V3f seen = color(file, 0.5f, 0.5f, 0, options);
    EXPECT_NEAR(seen.x, 0.75f, 1e-4f);
    EXPECT_EQ(seen.y, 0.125f);
    EXPECT_EQ(seen.z, 0.125f);
    options.first_channel = 7;
    EXPECT_EQ(look(file, 0.5f, 0.5f, 0, options), 0.125f);
}

TEST_F(TextureLookupTest, FewerChannelsThanAColourHasAreFilled) {
    MapOptions filled;
    filled.fill = 0.125f;
    for (const int channels : {1, 2}) {
        const std::string file = write("few" + std::to_string(channels) + ".exr", periodic(8, channels),
                                       [](int, int, int c) { return 0.5f + 0.25f * static_cast<float>(c); });
        const float second = channels == 2 ? 0.75f : 0;
        EXPECT_EQ(color(file, 0.5f, 0.5f), V3f(0.5f, second, 0));
        EXPECT_EQ(color(file, 0.5f, 0.5f, 0.3f, filled), V3f(0.5f, channels == 2 ? 0.75f : 0.125f, 0.125f));
    }
}

TEST_F(TextureLookupTest, OutsidePicturesIsWhatIsAskedForThenWhatTheyRecordThenBlack) {
    const auto halves = [](int x, int, int) { return x < 8 ? 0.25f : 1.0f; };
    ImageSpec recorded(16, 16, 1, TypeDesc::FLOAT);
    const std::string plain = write("plain.exr", recorded, halves);
    recorded.attribute("wrapmodes", "periodic,clamp");
    const std::string marked = write("marked.exr", recorded, halves);
    EXPECT_EQ(look(plain, 1.25f, 0.5f), 0);
    EXPECT_EQ(look(plain, 0.25f, -0.5f), 0);
    EXPECT_NEAR(look(plain, 0.25f, 0.5f), 0.25f, 1e-4f);
    EXPECT_NEAR(look(marked, 1.25f, 7.5f), 0.25f, 1e-4f);
    MapOptions asked;
    asked.swrap = map_wrap("clamp"), asked.twrap = map_wrap("mirror");
    EXPECT_NEAR(look(plain, 1.25f, -0.5f, 0, asked), 1, 1e-4f);
    EXPECT_NEAR(look(marked, 1.25f, 0.5f, 0, asked), 1, 1e-4f);
    asked.swrap = map_wrap("black");
    EXPECT_EQ(look(marked, 1.25f, 0.5f, 0, asked), 0);
    asked.swrap = map_wrap("mirror");
    EXPECT_NEAR(look(plain, 1.25f, 0.5f, 0, asked), 1, 1e-4f);
    EXPECT_EQ(map_wrap("round"), MapOptions::Wrap::OfPicture);
}

TEST_F(TextureLookupTest, FarAwayPicturesStillRepeat) {
    const std::string file =
        write("far.exr", periodic(16, 1), [](int x, int, int) { return x < 8 ? 0.25f : 1.0f; });
    for (const float s : {4096.25f, -4096.75f, 65536.25f, 1048576.25f})
        EXPECT_NEAR(look(file, s, 0.5f), 0.25f, 1e-4f);
    EXPECT_TRUE(std::isfinite(look(file, 3e38f, -3e38f)));
}

TEST_F(TextureLookupTest, LanesThatAreOffKeepTheirValue) {
    const std::string file = three_channels();
    const float on = std::bit_cast<float>(~uint32_t{0});
    const Plane out = plane(kLanes, -1), mask = plane({0, on, 0, on, on});
    const Plane planes[] = {out};
    textures_.texture(textures_.find(file, {}), square(0.5f, 0.5f, 0), {}, {5, mask}, planes);
    for (const size_t i : {0, 2}) EXPECT_EQ(out[i], -1);
    for (const size_t i : {1, 3, 4}) EXPECT_NEAR(out[i], 0.25f, 1e-4f);
    EXPECT_EQ(out[kLanes - 1], out[4]);
    textures_.texture(nullptr, square(0.5f, 0.5f, 0), {}, {5, mask}, planes);
    EXPECT_EQ(out[0], -1);
    EXPECT_EQ(out[3], 0);
}

TEST_F(TextureLookupTest, FourCornersMakeMiddleAndSides) {
    const QuadSides sides{plane(kLanes, 0), plane(kLanes, 0), plane(kLanes, 0)};
    quad_sides(plane({1}), plane({3}), plane({2}), plane({4}), sides);
    EXPECT_THAT(sides.middle, Each(2.5f));
    EXPECT_THAT(sides.along_u, Each(2.0f));
    EXPECT_THAT(sides.along_v, Each(1.0f));
}

TEST_F(TextureLookupTest, AThreadOutlivesTexturesAndMeetsNewOnes) {
    // What the thread knew of a file is of no worth to the next ones, which may lie at the same address.
    std::barrier<> turn(2);
    std::unique_ptr<Textures> textures;
    float seen = -1;
    const std::string file = path("changing.exr");
    constexpr int kRenders = 20;
    std::thread worker([&] {
        const Plane out = plane(kLanes, -1);
        const Plane planes[] = {out};
        const TextureLookup at = square(0.5f, 0.5f, 0);
        for (int render = 0; render < kRenders; ++render) {
            turn.arrive_and_wait();
            textures->texture(textures->find(file, {}), at, {}, {1, {}}, planes);
            seen = textures->info(file) ? out[0] : -1;
            turn.arrive_and_wait();
        }
    });
    for (int render = 0; render < kRenders; ++render) {
        const float value = static_cast<float>(render + 1) / 32;
        write("changing.exr", ImageSpec(16, 16, 1, TypeDesc::FLOAT), [&](int, int, int) { return value; });
        textures = std::make_unique<Textures>(options_, &diagnostics_);
        turn.arrive_and_wait();
        turn.arrive_and_wait();
        EXPECT_NEAR(seen, value, 1e-4f) << render;
        textures.reset();
    }
    worker.join();
}

TEST_F(TextureLookupTest, InfoIsWhatTheFileSays) {
    ImageSpec spec(32, 16, 3, TypeDesc::FLOAT);
    M44f viewing(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16), projection = viewing * 2;
    spec.attribute("worldtocamera", OIIO::TypeMatrix, &viewing);
    spec.attribute("worldtoscreen", OIIO::TypeMatrix, &projection);
    const std::string file = write("info.tif", spec, [](int, int, int) { return 0.0f; });
    const auto info = textures_.info(file);
    ASSERT_TRUE(info);
    EXPECT_EQ(info->width, 32);
    EXPECT_EQ(info->height, 16);
    EXPECT_EQ(info->channels, 3);
    EXPECT_EQ(info->type, "texture");
    EXPECT_EQ(info->viewing_matrix, viewing);
    EXPECT_EQ(info->projection_matrix, projection);
    EXPECT_FALSE(textures_.info("nowhere.tif"));
    EXPECT_TRUE(reported_.empty());
    textures_.find("nowhere.tif", {});
    textures_.find("nowhere.tif", {});
    EXPECT_EQ(reported_.size(), 1u);
}

class EnvironmentTest : public TextureLookupTest {
  protected:
    /// The colour of a direction's longest part: red +x, cyan -x, green +y, magenta -y, blue +z, yellow -z.
    static V3f axis_color(const V3f& d) {
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (std::fabs(d[k]) > std::fabs(d[axis])) axis = k;
        V3f color(0);
        color[axis] = 1;
        return d[axis] > 0 ? color : V3f(1) - color;
    }
    /// By RISpec's mapping.
    std::string axes(int width, const std::string& name = "axes.tif") {
        return write(name, ImageSpec(width, width / 2, 3, TypeDesc::FLOAT), [&](int x, int y, int c) {
            const float longitude = (static_cast<float>(x) + 0.5f) / static_cast<float>(width) * 6.2831853f;
            const float latitude =
                (0.5f - (static_cast<float>(y) + 0.5f) / static_cast<float>(width / 2)) * 3.1415927f;
            return axis_color({std::cos(latitude) * std::cos(longitude),
                               std::cos(latitude) * std::sin(longitude), std::sin(latitude)})[c];
        });
    }
    V3f seen(const std::string& file, const V3f& R, float width = 0, MapOptions options = {}) {
        const Plane planes[] = {plane(kLanes, -1), plane(kLanes, -1), plane(kLanes, -1)};
        const EnvironmentLookup at{
            {plane({R.x}), plane({R.y}), plane({R.z})}, {plane({width}), {}, {}}, {{}, plane({width}), {}}};
        textures_.environment(textures_.find(file, {}), at, options, {1, {}}, planes);
        return {planes[0][0], planes[1][0], planes[2][0]};
    }
};

TEST_F(EnvironmentTest, ZIsUpAndXIsAtTheEdges) {
    for (const std::string& file : {axes(128), axes(128, "axes.exr")})
        for (const V3f& d :
             {V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1), V3f(1, 0.3f, -0.4f), V3f(-0.2f, 0.3f, 0.7f)})
            for (const float side : {1.0f, -1.0f}) {
                const V3f expected = axis_color(d * side);
                for (const float length : {1.0f, 20.0f}) {
                    const V3f found = seen(file, d * (side * length));
                    for (int k = 0; k < 3; ++k)
                        EXPECT_NEAR(found[k], expected[k], 0.02f) << d << side << " " << k;
                }
            }
}

/// The quarters of the picture, by their longitudes: red, green, blue, white.
TEST_F(EnvironmentTest, LongitudeRunsFromTheLeftEdge) {
    const std::string file =
        write("quarters.tif", ImageSpec(128, 64, 3, TypeDesc::FLOAT),
              [](int x, int, int c) { return x / 32 == c || x / 32 == 3 ? 1.0f : 0.0f; });
    const V3f colors[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    for (int quarter = 0; quarter < 4; ++quarter)
        for (const float turn : {0.2f, 0.5f, 0.8f})
            for (const float up : {-1.5f, 0.0f, 0.7f}) {
                const float longitude = (static_cast<float>(quarter) + turn) * 1.5707963f;
                const V3f found = seen(file, V3f(std::cos(longitude), std::sin(longitude), up));
                for (int k = 0; k < 3; ++k)
                    EXPECT_NEAR(found[k], colors[quarter][k], 0.02f) << quarter << " " << turn << " " << up;
            }
}

TEST_F(EnvironmentTest, MapsThatOpenExrMarksHaveItsUp) {
    ImageSpec spec(128, 64, 3, TypeDesc::FLOAT);
    spec.attribute("textureformat", "LatLong Environment");
    spec.attribute("oiio:updirection", "y");
    // OpenEXR: +z in the middle, +x a quarter to the left.
    const std::string file = write("marked.exr", spec, [](int x, int, int c) {
        return c == 0 && x >= 60 && x < 68 ? 1.0f : c == 1 && x >= 28 && x < 36 ? 1.0f : 0.0f;
    });
    EXPECT_NEAR(seen(file, V3f(0, 0, 1)).x, 1, 0.02f);
    EXPECT_NEAR(seen(file, V3f(1, 0, 0)).y, 1, 0.02f);
}

TEST_F(EnvironmentTest, BlurBlends) {
    const std::string file = axes(128);
    MapOptions options;
    options.sblur = options.tblur = 0.2f;
    const V3f edge = seen(file, V3f(1, 1, 0), 0, options);
    EXPECT_NEAR(edge.x, 0.5f, 0.15f);
    EXPECT_NEAR(edge.y, 0.5f, 0.15f);
}

TEST_F(EnvironmentTest, BlurIsAPartOfThePicturesHeight) {
    // White is from a quarter turn to three quarters.
    const std::string picture = write("half.tif", ImageSpec(256, 128, 3, TypeDesc::FLOAT),
                                      [](int x, int, int) { return x >= 64 && x < 192 ? 1.0f : 0.0f; });
    const std::string file = path("half.env");
    ASSERT_EQ(make_lat_long_environment(picture, file, {}), "");
    MapOptions options;
    for (const float blur : {1.0f, 2.0f}) {
        options.sblur = options.tblur = blur;
        for (const V3f& way : {V3f(-1, 0, 0), V3f(1, 0, 0), V3f(0, 1, 0), V3f(0.3f, 0.2f, 0.8f)})
            EXPECT_NEAR(seen(file, way, 0, options).x, 0.5f, 0.02f) << way.x << " " << way.y;
    }
    options.sblur = options.tblur = 0.25f;
    EXPECT_NEAR(seen(file, V3f(-1, 0, 0), 0, options).x, 1, 0.01f);
    EXPECT_NEAR(seen(file, V3f(1, 0, 0), 0, options).x, 0, 0.01f);
    // A border is as wide as the blur: a quarter of a half turn, of which a tenth of one is on the way to
    // white.
    const float angle = 0.1f * std::numbers::pi_v<float>;
    options.filter = map_filter("box");
    EXPECT_NEAR(seen(file, V3f(-std::sin(angle), std::cos(angle), 0), 0, options).x, 0.5f + 0.1f / 0.25f,
                0.05f);
}

TEST_F(EnvironmentTest, NoDirectionAndNoMapAreBlack) {
    EXPECT_EQ(seen(axes(32), V3f(0)), V3f(0));
    EXPECT_EQ(seen("", V3f(1, 0, 0)), V3f(0));
}

}  // namespace
}  // namespace trapeze
