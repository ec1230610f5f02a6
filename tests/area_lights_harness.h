/// A square that tells what it gets of a light next to a formula [decision 0030]. A face of radiosity 1 all
/// around it has diffuse() 1.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {

/// What the square asks: red is found, green expected.
inline std::string asks(const std::string& expected) {
    return expected + "Ci = color(comp(diffuse(normal(0, 0, -1)), 0), expected, 1);";
}

/// A RIS light, in a block of its own.
inline std::string ris(const std::string& light, const std::string& place, const std::string& parameters = "",
                       int samples = 256) {
    return "AttributeBegin Attribute \"visibility\" \"int camera\" [0] " + place + " Light \"" + light +
           "\" \"l\" \"int fixedSampleCount\" [" + std::to_string(samples) + "] " + parameters +
           " AttributeEnd ";
}

/// The mean of what was found is that of what was expected within `of_mean`, over the picture; a point's
/// within `of_one`, which is some five deviations of independent samples, or less; and so the mean of a block
/// of 64 points within an eighth of that: what is too bright here and too dark there does not cancel.
inline void expect_lit(const Image& image, double of_mean, double of_one) {
    constexpr int kBlock = 8;
    struct Sums {
        double found = 0, expected = 0;
        void add(const Pixel& p) {
            found += static_cast<double>(p.red), expected += static_cast<double>(p.green);
        }
    };
    std::map<std::pair<int, int>, Sums> blocks;
    Sums all;
    int i = 0;
    for (const Pixel& p : pixels(image)) {
        const int x = i % image.width, y = i++ / image.width;
        if (p.alpha == 0) continue;
        all.add(p), blocks[{x / kBlock, y / kBlock}].add(p);
        ASSERT_NEAR(p.red, p.green, of_one * static_cast<double>(p.green) + 1e-6);
    }
    EXPECT_GT(all.expected, 0);
    EXPECT_NEAR(all.found, all.expected, of_mean * all.expected);
    for (const auto& [at, sums] : blocks)
        EXPECT_NEAR(sums.found, sums.expected, std::max(of_mean, of_one / kBlock) * sums.expected + 1e-6)
            << "block " << at.first << ' ' << at.second;
}

/// Lambert's formula: half the sum of the sides' angles, each by the cosine between N and the plane through P
/// and the side; over pi.
inline const std::string kPolygon =
    "float side(point p, a, b) { vector u = normalize(a - p), v = normalize(b - p);"
    "  return acos(clamp(u . v, -1, 1)) * zcomp(normalize(u ^ v)); }"
    "float polygon(point p, a, b, c, d) { extern point P;"
    "  return abs(side(p, a, b) + side(p, b, c) + side(p, c, d) + side(p, d, a)) / (2 * PI); } ";
inline const std::string kUnitSquare =
    "float expected = polygon(P, point(-.5, -.5, 3), point(.5, -.5, 3), point(.5, .5, 3), point(-.5, .5, 3));";

inline Case lit_by(const std::string& lights) {
    Case c;
    c.may_say = "ris";
    c.functions = kPolygon;
    c.asker = lights;
    return c;
}

/// RSL's: the mean over the shape of the cosines over the squared distance, which is pi over the area times
/// the form factor.
inline std::string arealight(const std::string& shape, const std::string& parameters = "") {
    return "AttributeBegin Attribute \"visibility\" \"int camera\" [0] "
           "Attribute \"light\" \"int nsamples\" [256] "
           "AreaLightSource \"arealight\" \"a\" " +
           parameters + " Translate 0 0 3 " + shape + " AttributeEnd Illuminate \"a\" 1 ";
}

}  // namespace trapeze::testing
