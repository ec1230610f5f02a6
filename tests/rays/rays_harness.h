/// Pictures of squares that ask for rays.
///
/// A square that fills the picture asks: its shader leaves what rays tell in red and what a formula, at the
/// same point, says in green. Shading is constant over a micropolygon, so that each pixel holds a vertex'
/// values; none is left out but those that the shader says are near a silhouette (blue is 0 there).
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {

inline const std::string kSeen =
    "Attribute \"visibility\" \"int diffuse\" 1 \"int specular\" 1 \"int transmission\" 1 ";
inline const std::string kHidden = "Attribute \"visibility\" \"int camera\" 0 ";
/// A picture of 64 x 64 pixels, each with a sample in its middle; the camera sees -1..1, from z = 0 upwards.
inline const std::string kPicture =
    "Display \"x\" \"exr\" \"rgba\" Format 64 64 1 PixelFilter \"box\" 1 1 PixelSamples 1 1 "
    "Hider \"hidden\" \"jitter\" 0 ShadingInterpolation \"constant\" Projection \"orthographic\" ";
/// The square that asks.
inline const std::string kAsker = "Patch \"bilinear\" \"P\" [-1.2 1.2 5 1.2 1.2 5 -1.2 -1.2 5 1.2 -1.2 5] ";

/// The difference, much enlarged; what was found; whether it counts.
inline const std::string kTold =
    "color told(float found, expected, sure) {"
    "  return color(found == expected ? 0 : 1024 * (found - expected), found, sure); } ";

/// A world's picture. Its shaders are given by their names; the text is what stands between.
struct Case {
    std::map<std::string, std::string> shaders;
    std::string functions;      ///< before the shader that asks
    std::string things;         ///< hidden from the camera
    std::string options;        ///< before the world
    std::string asker;          ///< attributes of the square that asks
    std::string asks = kAsker;  ///< what the camera sees
    RenderSettings settings;
    int threads = 2;

    std::string may_say;  ///< the kind of a message that is expected, besides that nothing is there for rays

    std::vector<Diagnostic> said = {};

    Image render(const std::string& body) {
        const WorkFolder folder;
        shaders["ask"] = kTold + functions + "surface ask() { " + body + " Oi = 1; }";
        for (const auto& [name, text] : shaders) folder.write(name + ".sl", text);
        folder.write("a.rib", kPicture + "Option \"searchpath\" \"string shader\" [\"" +
                                  folder.path().string() + "\"] " + options + "\nWorldBegin AttributeBegin " +
                                  kHidden + kSeen + things + "\nAttributeEnd Surface \"ask\" " + asker +
                                  asks + "\nWorldEnd\n");
        Diagnostics diagnostics([&](const Diagnostic& d) { said.push_back(d); });
        Image image;
        for (FrameResult& result : render_worlds((folder / "a.rib").string(), settings, threads, diagnostics))
            image = std::move(result.image);
        for (const Diagnostic& d : said)
            EXPECT_TRUE(d.kind == "nothing-for-rays" || d.kind == may_say) << to_string(d) << "\n"
                                                                           << shaders["ask"];
        EXPECT_EQ(image.rgba.size(), size_t{64 * 64 * 4});
        return image;
    }
};

/// A pixel's values.
struct Pixel {
    float red, green, blue, alpha;
};

inline std::vector<Pixel> pixels(const Image& image) {
    std::vector<Pixel> all;
    for (size_t i = 0; i + 3 < image.rgba.size(); i += 4)
        all.push_back({image.rgba[i], image.rgba[i + 1], image.rgba[i + 2], image.rgba[i + 3]});
    return all;
}

/// Found is what was expected, wherever blue is above 0 and the square is seen; at least so many pixels say
/// so.
/// A quarter of them may differ by more than `tolerance`, but not by more than `at_most`.
inline void expect_told(const Image& image, float tolerance, int at_least = 3500, float at_most = 0) {
    int told = 0, differ = 0;
    for (const Pixel& p : pixels(image)) {
        if (!(p.blue > 0) || p.alpha == 0) continue;
        ++told;
        differ += std::abs(p.red) / 1024 > tolerance;
        ASSERT_LE(std::abs(p.red) / 1024, std::max(tolerance, at_most))
            << "found " << p.green << " after " << told << " pixels";
    }
    EXPECT_GE(told, at_least);
    EXPECT_LE(differ, told / 4);
}

/// Red is what was found, green what was expected, wherever blue is above 0 and the square is seen; at least
/// so many pixels say so. What is expected to be endless is so.
inline void expect_near(const Image& image, float tolerance, int at_least = 3000) {
    int told = 0;
    for (const Pixel& p : pixels(image)) {
        if (!(p.blue > 0) || p.alpha == 0) continue;
        ++told;
        if (p.green > 1e20f)
            ASSERT_GT(p.red, 1e20f) << told;
        else
            ASSERT_NEAR(p.red, p.green, tolerance) << told;
    }
    EXPECT_GE(told, at_least);
}

/// The mean of a pixel's number over all pixels that the square covers.
inline double mean(const Image& image, const std::function<double(const Pixel&)>& number) {
    double sum = 0, count = 0;
    for (const Pixel& p : pixels(image))
        if (p.alpha > 0) sum += number(p), ++count;
    EXPECT_GT(count, 0);
    return sum / count;
}

inline double mean_red(const Image& image) {
    return mean(image, [](const Pixel& p) { return static_cast<double>(p.red); });
}
inline double mean_found(const Image& image) {
    return mean(image, [](const Pixel& p) { return static_cast<double>(p.green); });
}

inline std::string sphere(const std::string& place, const std::string& radius) {
    return "AttributeBegin Translate " + place + " Sphere " + radius + " -" + radius + " " + radius +
           " 360 AttributeEnd ";
}

/// A square in a plane of equal z, from -6 to 6.
inline std::string wall(const std::string& z) {
    return "Patch \"bilinear\" \"P\" [-6 6 " + z + " 6 6 " + z + " -6 -6 " + z + " 6 -6 " + z + "] ";
}

// Distances.

/// Of an edge that moves by 1 while the shutter is open, in front of a disk of light: the mean of what it
/// shows.
inline void expect_moving_penumbra(Case& c) {
    const Image image = c.render(
        "float shown = 0, i; for (i = .5; i < 64; i += 1) {"
        "  float t = clamp(((i / 64 - .5) - .85 * xcomp(P)) / .15 / 3, -1, 1);"
        "  shown += (acos(t) - t * sqrt(1 - t * t)) / PI / 64; }"
        "Ci = color(comp(diffuse(normal(0, 0, -1)), 0) * 10009 / 9, shown, 1);");
    double error = 0, dark = 0, bright = 0;
    for (const Pixel& p : pixels(image)) {
        const double shown = static_cast<double>(p.green), off = static_cast<double>(p.red) - shown;
        // Five deviations of independent rays.
        ASSERT_LT(std::abs(off), 5 * std::sqrt(shown * (1 - shown) / 256) + 5e-3);
        error += off / 4096;
        dark += p.green<0.02f, bright += p.green> 0.98f;
    }
    EXPECT_NEAR(error, 0, 0.003);
    EXPECT_GT(dark, 100);
    EXPECT_GT(bright, 100);
}

}  // namespace trapeze::testing
