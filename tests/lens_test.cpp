/// Lenses of blades in pictures: the shape, size and light of a small ball that is out of focus.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <fstream>
#include <map>

#include "sample/every_method_harness.h"
#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// Light of a picture about its middle, y up.
struct Blur {
    double light = 0, squares = 0;  ///< sums of values, and of values times distance in pixels, squared
    int lit = 0;                    ///< pixels
    std::complex<double> middle{0, 0};
    std::vector<std::pair<std::complex<double>, double>> points;

    explicit Blur(const Image& image) {
        for (int y = image.window.y0; y < image.window.y1; ++y)
            for (int x = image.window.x0; x < image.window.x1; ++x) {
                const double value = image.rgba[4 * image.index(x, y)];
                if (value == 0) continue;
                const std::complex<double> at(x + .5 - image.width / 2.0, image.height / 2.0 - y - .5);
                light += value, squares += value * std::norm(at), middle += value * at, ++lit;
                points.push_back({at, value});
            }
    }
    /// The direction of a corner of a shape of `blades` corners, degrees in [0, 360 / blades).
    double corner(int blades) const {
        std::complex<double> sum = 0;
        for (const auto& [at, value] : points) sum += value * std::pow(at / 30.0, blades);
        const double angle = std::arg(sum) / blades * 180 / M_PI;
        return angle < 0 ? angle + 360.0 / blades : angle;
    }
};

/// Half the side of the square of light, in pixels.
constexpr double kHalf = 1.79;

/// A small square of brightness 1000 at `depth` before the middle of 48 x 48 pixels. The lens has radius .6,
/// and is in focus at 4.
Blur render_blur(const std::string& aperture, double depth, const RenderSettings& settings = {},
                 int threads = 2, int samples = 32) {
    const WorkFolder folder;  // tests run side by side
    const std::string path = (folder / "lens_blades.rib").string();
    const double half = .01 * depth;
    std::ofstream(path)
        << "Display \"x\" \"exr\" \"rgba\" Format 48 48 1 PixelSamples " << samples << ' ' << samples
        << " PixelFilter \"box\" 1 1 Projection \"perspective\" \"fov\" [30] ScreenWindow -.5 .5 -.5 .5 "
           "DepthOfField 1 1.2 4 Hider \"hidden\" \"float[4] aperture\" ["
        << aperture << "] WorldBegin Surface \"constant\" Color 1000 1000 1000 Translate 0 0 " << depth
        << " Polygon \"P\" [" << -half << " " << -half << " 0 " << half << " " << -half << " 0 " << half
        << " " << half << " 0 " << -half << " " << half << " 0] WorldEnd\n";
    return Blur(render_scene(path, settings, threads).at(0).image);
}

/// Radius of the lens' disk in pixels.
double blur_radius(double depth) {
    return .6 * std::abs(1 - depth / 4) / depth * 48 / std::tan(15 * M_PI / 180);
}

/// The distance of an angle from one of those that are the same for a shape of so many corners.
double apart(double a, double b, int blades) {
    return std::abs(std::remainder(a - b, 360.0 / blades));
}

TEST(LensBlades, ASmallLightMakesTheShapeOfTheLens) {
    const double beyond = 9, radius = blur_radius(beyond);
    ASSERT_NEAR(radius, 14.93, .01);
    const double disk = render_blur("0 0 0 0", beyond).light;
    for (const int blades : {3, 4, 5, 6, 8})
        for (const double angle : {0.0, 20.0}) {
            const Blur blur =
                render_blur(std::to_string(blades) + " " + std::to_string(angle) + " 0 0", beyond);
            // As much light as through a disk, in the area of the polygon and a border of the square's size.
            EXPECT_NEAR(blur.light / disk, 1, .02) << blades;
            EXPECT_LT(std::abs(blur.middle) / blur.light, .15) << blades;
            const double step = 2 * M_PI / blades, sides = 2 * std::sin(step / 2) * blades;
            const double area = radius * radius * std::sin(step) / 2 * blades;
            EXPECT_GT(blur.lit, area) << blades;
            EXPECT_LT(blur.lit, area + (std::sqrt(2.0) * kHalf + 1) * radius * sides) << blades;
            // Regular polygons' moment, and the square's.
            EXPECT_NEAR(blur.squares / blur.light,
                        radius * radius * (2 + std::cos(step)) / 6 + kHalf * kHalf * 2 / 3, 1.5)
                << blades;
            EXPECT_LT(apart(blur.corner(blades), angle, blades), 2) << blades;
        }
}

TEST(LensBlades, BeforeTheFocusTheShapeIsUpsideDown) {
    const double before = 2.6;
    for (const int blades : {3, 5})
        EXPECT_LT(apart(render_blur(std::to_string(blades) + " 10 0 0", before).corner(blades), 190, blades),
                  2)
            << blades;
}

TEST(LensBlades, DensityMovesLightToTheRimOrTheMiddle) {
    const auto spread = [](const std::string& density) {
        const Blur blur = render_blur("6 0 0 " + density, 9);
        return blur.squares / blur.light - kHalf * kHalf * 2 / 3;
    };
    const double even = spread("0");
    EXPECT_NEAR(spread("1") / even, 4. / 3, .02);  // the mean of r'^2 is 1/2, 2/3 and 1/3
    EXPECT_NEAR(spread("-1") / even, 2. / 3, .02);
}

/// A lens without blades has a density, too: the mean of r^2 is 1/2, 2/3 and 1/3.
TEST(LensBlades, DensityIsThatOfADiskAlso) {
    const auto spread = [](const std::string& aperture) {
        const Blur blur = render_blur(aperture, 9);
        return blur.squares / blur.light - kHalf * kHalf * 2 / 3;
    };
    const double even = spread("0 0 0 0");
    for (const char* const round : {"0 0 0", "2 30 -1", "5 0 1", "129 0 0"}) {
        EXPECT_NEAR(spread(std::string(round) + " 1") / even, 4. / 3, .02) << round;
        EXPECT_NEAR(spread(std::string(round) + " -1") / even, 2. / 3, .02) << round;
    }
}

/// Each form of every method with its own pattern, and each method with all patterns that it honours: as
/// brute force with that pattern.
TEST(LensBlades, AreTheSameForEveryMethodAndAnyThreads) {
    const std::string star = "5 36 -.8 .7";
    const auto points = [&](const std::string& method, const std::string& pattern, int threads = 2) {
        RenderSettings settings;
        settings.sampler = method, settings.pattern = pattern;
        return render_blur(star, 9, settings, threads, 8).points;
    };
    std::map<std::string, decltype(Blur::points)> expected;
    const std::vector<MethodForm> forms = every_method();
    for (const MethodForm& form : forms)
        if (!expected.contains(form.pattern)) expected[form.pattern] = points("bruteforce", form.pattern);
    EXPECT_GE(expected.size(), sample_patterns().size());
    for (const MethodForm& form : forms)
        EXPECT_TRUE(points(form.name, form.pattern) == expected[form.pattern]) << form.name;
    for (const auto& [pattern, lit] : expected) {
        EXPECT_GT(lit.size(), 100u) << pattern;
        EXPECT_TRUE(points("raytrace", pattern, 7) == lit) << pattern;
        for (const VisibilityMethod& method : visibility_methods()) {
            const std::string name(method.name);
            std::string error;
            if (!method.is_exact || !choose_sampler(name, pattern, &error)) continue;
            EXPECT_TRUE(points(name, pattern) == lit) << name << ' ' << pattern;
        }
    }
}

}  // namespace
}  // namespace trapeze::testing
