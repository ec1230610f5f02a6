#include "shade/vm/kernels/color.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math.h"
#include "shade/vm/kernels/kernel_harness.h"

namespace trapeze::vm {
namespace {

using testing::for_each_target;
using testing::KernelNumbers;
using testing::Register;
using testing::same_float;

V3d convert(const char* from, const char* to, const V3f& c) {
    Register out(3, true, kLanes), in(3, true, kLanes);
    for (int k = 0; k < 3; ++k) in.set(0, k, c[k]);
    find_color_conversion(from, to)(kLanes, std::vector{out.operand(), in.operand()});
    return {out.at(0, 0), out.at(0, 1), out.at(0, 2)};
}

void expect_color(const V3d& actual, const V3d& expected, double error = 2e-6) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(actual[k], expected[k], error) << k << ' ' << expected;
}

/// Smith's hexcone, with a branch for each sixth.
V3d rgb_from_hsv(const V3d& c) {
    const double h = (c[0] - std::floor(c[0])) * 6, s = c[1], v = c[2];
    const int sixth = static_cast<int>(h);
    const double f = h - sixth, p = v * (1 - s), q = v * (1 - s * f), t = v * (1 - s * (1 - f));
    const V3d sixths[] = {{v, t, p}, {q, v, p}, {p, v, t}, {p, q, v}, {t, p, v}, {v, p, q}};
    return sixths[sixth % 6];
}

TEST(Color, HuesMakeAHexagon) {
    KernelNumbers numbers;
    for (int i = 0; i < 500; ++i) {
        const V3f hsv(numbers.between(0, 0.9999f), numbers.between(0.01f, 1), numbers.between(0.01f, 2));
        const V3d rgb = rgb_from_hsv(V3d(hsv));
        expect_color(convert("hsv", "rgb", hsv), rgb);
        expect_color(convert("hsv", "rgb", hsv + V3f(3, 0, 0)), rgb, 1e-5);
        expect_color(convert("rgb", "hsv", V3f(rgb)), V3d(hsv), 5e-5);
        // The same colour has lightness v (1 - s / 2).
        const double v = hsv[2] / 2, lightness = v * (1 - hsv[1] / 2.0);
        const V3d hsl(hsv[0], hsv[1] * v / (2 * std::min(lightness, 1 - lightness)), lightness);
        expect_color(convert("rgb", "hsl", V3f(rgb * 0.5)), hsl, 1e-4);
        expect_color(convert("hsl", "rgb", V3f(hsl)), rgb * 0.5, 1e-5);
    }
    for (const auto& [rgb, hue] :
         {std::pair{V3f(1, 0, 0), 0.0}, {V3f(0, 1, 0), 1 / 3.0}, {V3f(0, 0, 1), 2 / 3.0}}) {
        expect_color(convert("rgb", "hsv", rgb), V3d(hue, 1, 1));
        expect_color(convert("rgb", "hsl", rgb), V3d(hue, 1, 0.5));
    }
}

TEST(Color, GreysHaveNoHue) {
    for (float grey : {0.0f, 0.25f, 1.0f}) {
        expect_color(convert("rgb", "hsv", V3f(grey)), V3d(0, 0, grey));
        expect_color(convert("rgb", "hsl", V3f(grey)), V3d(0, 0, grey));
        expect_color(convert("rgb", "YIQ", V3f(grey)), V3d(grey, 0, 0));
    }
    expect_color(convert("rgb", "xyY", V3f(0)), V3d(0));
    expect_color(convert("xyY", "rgb", V3f(0)), V3d(0));
}

TEST(Color, WhiteIsD65) {
    expect_color(convert("rgb", "xyY", V3f(1)), V3d(0.3127, 0.3290, 1), 1e-3);
    expect_color(convert("rgb", "XYZ", V3f(1)), V3d(0.9505, 1, 1.0888), 1e-3);
    expect_color(convert("rgb", "xyY", V3f(1, 0, 0)), V3d(0.64, 0.33, 0.2127), 1e-3);
    expect_color(convert("rgb", "yiq", V3f(1, 0, 0)), V3d(0.299, 0.596, 0.212));
}

TEST(Color, ConversionsComeBack) {
    constexpr const char* kSpaces[] = {"rgb", "hsv", "hsl", "xyz", "xyY", "YIQ"};
    KernelNumbers numbers;
    for (const char* from : kSpaces)
        for (const char* to : kSpaces)
            for (int i = 0; i < 20; ++i) {
                const V3f rgb(numbers.between(0.1f, 1), numbers.between(0.1f, 1), numbers.between(0.1f, 1));
                const V3f c(convert("rgb", from, rgb));
                const V3f back(convert(to, from, V3f(convert(from, to, c))));
                SCOPED_TRACE(std::string(from) + " " + to);
                expect_color(convert(from, "rgb", back), V3d(rgb), 2e-5);
            }
}

TEST(Color, IsTheSameOnAllTargets) {
    constexpr const char* kSpaces[] = {"rgb", "hsv", "hsl", "xyz", "xyY", "YIQ"};
    KernelNumbers numbers;
    for (bool moderate : {true, false})
        for (const char* from : kSpaces)
            for (const char* to : kSpaces) {
                Register in(3, false, 256), first(3, false, 256);
                in.fill([&] { return moderate ? numbers.between(-2, 2) : numbers.any(); });
                find_color_conversion(from, to)(256, std::vector{first.operand(), in.operand()});
                for_each_target([&] {
                    Register out(3, false, 256);
                    find_color_conversion(from, to)(256, std::vector{out.operand(), in.operand()});
                    for (size_t i = 0; i < out.planes().size(); ++i) {
                        ASSERT_TRUE(same_float(out.planes()[i], first.planes()[i]))
                            << from << ' ' << to << ' ' << i;
                        ASSERT_TRUE(!moderate || std::isfinite(out.planes()[i])) << from << ' ' << to;
                    }
                });
            }
}

TEST(Color, UnknownSpacesHaveNoKernel) {
    EXPECT_EQ(find_color_conversion("rgb", "cmyk"), nullptr);
    EXPECT_EQ(find_color_conversion("", "rgb"), nullptr);
}

}  // namespace
}  // namespace trapeze::vm
