#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "pipeline/compare/report/bar_chart.h"
#include "pipeline/compare/report/encoded_text.h"
#include "pipeline/compare/report/screen_pictures.h"
#include "pipeline/compare/report/viridis.h"
#include "pipeline/compare/report/worst_places.h"

namespace trapeze {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Image grey(int width, int height, float value) {
    Image image;
    image.width = width, image.height = height, image.window = {0, 0, width, height};
    image.rgba.assign(static_cast<size_t>(width) * height * 4, value);
    image.z.assign(static_cast<size_t>(width) * height, 1);
    return image;
}

TEST(EncodedText, NothingThatHtmlReadsIsLeft) {
    EXPECT_EQ(escaped("a<b>&\"'c"), "a&lt;b&gt;&amp;&quot;&#39;c");
    EXPECT_EQ(script_safe(R"("</script>")"), R"("\u003c/script>")");
}

TEST(EncodedText, Base64OfRfc4648) {
    const auto of = [](const std::string& text) {
        return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
    };
    EXPECT_EQ(of(""), "");
    EXPECT_EQ(of("f"), "Zg==");
    EXPECT_EQ(of("fo"), "Zm8=");
    EXPECT_EQ(of("foo"), "Zm9v");
    EXPECT_EQ(of("foobar"), "Zm9vYmFy");
    EXPECT_EQ(of("\xff\xfe\xfd"), "//79");
}

TEST(Viridis, GoesFromDarkBlueToYellowAndGetsLighter) {
    const auto distance = [](std::array<uint8_t, 3> a, std::array<int, 3> b) {
        return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
    };
    EXPECT_LE(distance(viridis(0), {68, 1, 84}), 3);
    EXPECT_LE(distance(viridis(0.5f), {33, 145, 140}), 3);
    EXPECT_LE(distance(viridis(1), {253, 231, 37}), 5);
    double last = -1;
    for (int i = 0; i <= 20; ++i) {
        const auto [r, g, b] = viridis(static_cast<float>(i) / 20);
        const double light = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        EXPECT_GT(light, last);
        last = light;
    }
}

TEST(ScreenPictures, ShrinkingTakesMeans) {
    LinearPicture picture{5, 2, {}};
    for (int i = 0; i < 10; ++i) picture.rgb.insert(picture.rgb.end(), {float(i), 0, 1});
    const LinearPicture small = shrunk(picture, 2);
    EXPECT_EQ(small.width, 2);
    EXPECT_EQ(small.height, 1);
    EXPECT_EQ(small.rgb, (std::vector<float>{3, 0, 1, 5, 0, 1}));
}

TEST(ScreenPictures, DifferencesAreScaledByAPowerOfTwoThatHoldsThem) {
    Comparison c;
    c.reference = grey(10, 10, 0.5f);
    c.methods.resize(1);
    c.methods[0].result.rate = {2, 2};
    c.methods[0].picture.image = grey(10, 10, 0.6f);
    EXPECT_EQ(difference_scale(c, {2, 2}), 8);
    EXPECT_NEAR(difference_of(c.methods[0].picture.image, c.reference, 8).rgb[5], 0.8f, 1e-5f);
    c.methods[0].picture.image = c.reference;
    EXPECT_EQ(difference_scale(c, {2, 2}), 64);
}

TEST(ScreenPictures, HeatIsLogarithmic) {
    const std::vector<float> map(1000, 100);
    const std::vector<const std::vector<float>*> maps{&map};
    const HeatScale scale = heat_scale(maps);
    EXPECT_EQ(scale.top, 100);
    EXPECT_EQ(scale.place(0), 0);
    EXPECT_NEAR(scale.place(10), 0.5f, 1e-6f);
    EXPECT_EQ(scale.place(1000), 1);
}

TEST(WorstPlaces, AreWhereTheErrorIsAndDoNotOverlap) {
    const Image reference = grey(200, 100, 0);
    Image pictures[2] = {reference, reference};
    const auto spoil = [&](size_t method, int x, int y, float value) {
        pictures[method].rgba[4 * reference.index(x, y)] = value;
    };
    spoil(0, 150, 60, 3);
    spoil(1, 20, 20, 2);
    const Image* const both[] = {&pictures[0], &pictures[1]};
    const auto places = worst_places(reference, both, 32, 3);
    ASSERT_EQ(places.size(), 2u) << "nothing else differs";
    EXPECT_FALSE(intersection(places[0], {150, 60, 151, 61}).empty());
    EXPECT_FALSE(intersection(places[1], {20, 20, 21, 21}).empty());
    EXPECT_EQ(places[0].width(), 32);
    EXPECT_TRUE(intersection(places[0], places[1]).empty());
}

TEST(WorstPlaces, FitSmallPictures) {
    const Image reference = grey(20, 10, 0), picture = grey(20, 10, 1);
    const Image* const one[] = {&picture};
    EXPECT_EQ(worst_places(reference, one, 96, 3), (std::vector<PixelRect>{{0, 0, 20, 10}}));
    EXPECT_TRUE(worst_places(reference, {}, 96, 3).empty());
}

TEST(BarChart, IsLogarithmicOnlyWhereBarsWouldVanish) {
    const std::string linear =
        bar_chart({{"a<b", "12 ms", "tracer", 12, 4}, {"b", "30 ms", "raster", 30, 0}}, "ms", "d");
    EXPECT_THAT(linear, HasSubstr("a&lt;b"));
    EXPECT_THAT(linear, HasSubstr("tracer first"));
    EXPECT_THAT(linear, Not(HasSubstr("logarithmic")));
    const std::string wide =
        bar_chart({{"a", "1", "tracer", 1, 0.5}, {"b", "1000", "raster", 1000, 0}}, "ms", "d");
    EXPECT_THAT(wide, HasSubstr("logarithmic"));
    EXPECT_THAT(wide, Not(HasSubstr("tracer first")));
    EXPECT_THAT(bar_chart({{"a", "0", "tracer", 0, 0}}, "ms", "d"), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace trapeze
