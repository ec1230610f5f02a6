/// How errors fall, next to closed forms: from N rays to 4N the mean squared error, over a picture's points
/// and 16 seeds, falls at least by 4. Of area lights of each shape, at rest and while they move, and of calls
/// that spread rays.
///
/// What 16 seeds allow: pictures of other seeds and other numbers of rays are independent, so that the
/// deviation of the ratio of two mean squared errors follows from how those of single seeds differ. A ratio
/// may be above 1/4 by three deviations (one in a thousand is, where it is 1/4 in truth), and these three may
/// be a tenth of it at most: so the test can tell.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

constexpr int kSeeds = 16;

/// A picture of which red is found by rays, and green expected. "COUNT" stands for how many rays a point
/// takes, "SKY" for the file of a map.
struct Asked {
    const char* name;
    std::string lights;     ///< of the square that asks
    std::string functions;  ///< before its shader
    std::string body;       ///< of its shader
    std::string things;     ///< around
};

void PrintTo(const Asked& asked, std::ostream* out) {
    *out << asked.name;
}

std::string replaced(std::string text, const std::string& word, const std::string& by) {
    for (size_t at; (at = text.find(word)) != std::string::npos;) text.replace(at, word.size(), by);
    return text;
}

/// Mean squared errors over all points, one a seed.
std::vector<double> errors_of(const Asked& asked, int count, const std::string& sky) {
    std::vector<double> errors;
    const std::string rays = std::to_string(count);
    for (uint32_t seed = 0; seed < kSeeds; ++seed) {
        Case c;
        c.may_say = "ris";
        c.functions = asked.functions;
        c.asker = "ShadingRate 4 " + replaced(replaced(asked.lights, "COUNT", rays), "SKY", sky);
        c.things = asked.things;
        c.options = "Shutter 0 1 ";
        c.settings.seed = hash(seed, static_cast<uint32_t>(count));
        errors.push_back(mean(c.render(replaced(asked.body, "COUNT", rays)), [](const Pixel& p) {
            return std::pow(static_cast<double>(p.red) - static_cast<double>(p.green), 2);
        }));
    }
    return errors;
}

struct Estimate {
    double mean = 0;
    double variance = 0;  ///< of the mean, as a part of its square
};

Estimate estimate(const std::vector<double>& values) {
    const auto count = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (const double value : values) sum += value;
    for (const double value : values) squares += std::pow(value - sum / count, 2);
    return {sum / count, squares / (count - 1) / count / std::pow(sum / count, 2)};
}

/// A half of the sky is ten times as bright, and one of its pixels four thousand times.
constexpr int kAcross = 64, kDown = 32;

double sky_at(int x, int y) {
    return x == 23 && y == 9 ? 2000 : x < kAcross / 2 ? 5 : 0.5;
}

void write_sky(const std::string& file) {
    std::vector<float> sky;
    for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x) sky.insert(sky.end(), 3, static_cast<float>(sky_at(x, y)));
    const OIIO::ImageSpec spec(kAcross, kDown, 3, OIIO::TypeDesc::FLOAT);
    const auto out = OIIO::ImageOutput::create(file);
    ASSERT_TRUE(out && out->open(file, spec) && out->write_image(OIIO::TypeDesc::FLOAT, sky.data()) &&
                out->close());
}

/// What arrives at a face turned to -x. The map's poles, where lookups blend all longitudes, are along z: the
/// face sees next to nothing of them.
double expected_of_sky() {
    double expected = 0;
    for (int y = 0; y < kDown; ++y)
        for (int x = kAcross / 4; x < kAcross * 3 / 4; ++x) {
            const auto of_height = [](double down) { return down / 2 - std::sin(2 * down) / 4; };
            const double turn = 2 * M_PI / kAcross, down = M_PI / kDown;
            expected += sky_at(x, y) * (of_height(down * (y + 1)) - of_height(down * y)) *
                        (std::sin(turn * x) - std::sin(turn * (x + 1))) / M_PI;
        }
    return expected;
}

std::string ris_light(const std::string& light, const std::string& place,
                      const std::string& parameters = "") {
    return "AttributeBegin " + place + " Light \"" + light + "\" \"l\" \"int fixedSampleCount\" [COUNT] " +
           parameters + " AttributeEnd ";
}

const std::string kFacing = "Ci = color(comp(diffuse(normal(0, 0, -1)), 0), expected, 1);";
const std::string kDisk =
    "float a2 = xcomp(P) * xcomp(P) + ycomp(P) * ycomp(P), sum = 4 + a2 + 1;"
    "float expected = (1 - (4 + a2 - 1) / sqrt(sum * sum - 4 * a2)) / 2;";
const std::string kSide =
    "float side(point p, a, b) { vector across = normalize(a - p) ^ normalize(b - p);"
    "  float sine = length(across); return asin(sine) * zcomp(across) / sine / (2 * PI); } ";
const std::string kSquare =
    "point a = point(-.5, -.5, 3), b = point(.5, -.5, 3), c = point(.5, .5, 3), d = point(-.5, .5, 3);"
    "float expected = abs(side(P, a, b) + side(P, b, c) + side(P, c, d) + side(P, d, a)); ";
/// Lambert's formula for the outline of a cylinder about x at z = 2, of the radius .5 and length 1: of the
/// circle at each end the arc that is seen, and the lines between them.
const std::string kCylinder =
    "float h = 5 - 2, y = ycomp(P), away = sqrt(h * h + y * y);"
    "float middle = atan(h, y), half = acos(.5 / away);"
    "float expected = 0, i; uniform float steps = 256; point first, last, before;"
    "for (i = 0; i <= steps; i += 1) { float w = middle + half * (2 * i / steps - 1);"
    "  point at = point(-.5, .5 * cos(w), 2 + .5 * sin(w));"
    "  if (i > 0) expected += side(P, before, at); else first = at; before = at; }"
    "last = before; point lower = last;"
    "for (i = steps; i >= 0; i -= 1) { float w = middle + half * (2 * i / steps - 1);"
    "  point at = point(.5, .5 * cos(w), 2 + .5 * sin(w)); expected += side(P, before, at); before = at; }"
    "expected = abs(expected + side(P, before, first)); ";
const std::string kBall =
    "vector m = point(0, 0, 3) - P; float d2 = m . m; float expected = .25 / d2 * (2 / sqrt(d2)); ";
const std::string kSphere =
    "AttributeBegin Surface \"constant\" Translate 0 0 3 Sphere .5 -.5 .5 360 AttributeEnd ";

std::vector<Asked> all() {
    return {
        {"Rectangle", ris_light("PxrRectLight", "Translate 0 0 3"), kSide, kSquare + kFacing, ""},
        {"Disk", ris_light("PxrDiskLight", "Translate 0 0 3 Scale 2 2 1"), "", kDisk + kFacing, ""},
        {"Sphere", ris_light("PxrSphereLight", "Translate 0 0 2"), "",
         "vector m = point(0, 0, 2) - P; float expected = .25 / (m . m) * 3 / length(m);" + kFacing, ""},
        {"Cylinder", ris_light("PxrCylinderLight", "Translate 0 0 2"), kSide, kCylinder + kFacing, ""},
        {"Mesh",
         "AttributeBegin Attribute \"visibility\" \"int camera\" 0 Translate 0 0 3 "
         "Light \"PxrMeshLight\" \"m\" \"int fixedSampleCount\" [COUNT] "
         "Patch \"bilinear\" \"P\" [-.5 -.5 0 .5 -.5 0 -.5 .5 0 .5 .5 0] AttributeEnd ",
         kSide, kSquare + kFacing, ""},
        {"DistantDisk",
         ris_light("PxrDistantLight", "Rotate 30 1 0 0",
                   "\"float angleExtent\" [80] \"float intensity\" [1]"),
         "", "float s = sin(radians(40)); float expected = s * s * cos(radians(30));" + kFacing, ""},
        {"Dome", ris_light("PxrDomeLight", "", "\"string lightColorMap\" [\"SKY\"]"), "",
         "Ci = color(comp(diffuse(normal(-1, 0, 0)), 0), " + std::to_string(expected_of_sky()) + ", 1);", ""},
        {"WhiteDome", ris_light("PxrDomeLight", ""), "", "float expected = 1;" + kFacing, ""},
        {"Penumbra", ris_light("PxrDiskLight", "Translate 0 0 -95 Scale 6 6 1"), "",
         "float t = clamp(-xcomp(P) * 85 / 15 / 3, -1, 1);"
         "float shown = (acos(t) - t * sqrt(1 - t * t)) / PI;"
         "Ci = color(comp(diffuse(normal(0, 0, -1)), 0) * 10009 / 9, shown, 1);",
         "Patch \"bilinear\" \"P\" [-3 3 -10 0 3 -10 -3 -3 -10 0 -3 -10] "},
        {"Occlusion", "", "", kBall + "Ci = color(occlusion(P, normal(0, 0, -1), COUNT), expected, 1);",
         kSphere},
        {"OcclusionInTime", "Attribute \"trace\" \"int samplemotion\" 1 ", "",
         "float expected = 0, i; for (i = .5; i < 64; i += 1) {"
         "  vector m = point(i / 32 - 1, 0, 3) - P; float d2 = m . m;"
         "  expected += .25 / d2 * (2 / sqrt(d2)) / 64; }"
         "Ci = color(occlusion(P, normal(0, 0, -1), COUNT), expected, 1);",
         "MotionBegin [0 1] Translate -1 0 3 Translate 1 0 3 MotionEnd Sphere .5 -.5 .5 360 "},
        {"EvenOcclusion", "", "",
         kBall +
             "expected = 1 - sqrt(1 - .25 / d2); "
             "Ci = color(occlusion(P, normal(0, 0, -1), COUNT, \"distribution\", \"uniform\"), expected, 1);",
         kSphere},
        {"Indirectdiffuse", "", "",
         kBall + "Ci = color(comp(indirectdiffuse(P, normal(0, 0, -1), COUNT), 0), expected, 1);", kSphere},
        {"Gather", "", "",
         kBall + "color seen = 0, sum = 0; gather(\"illuminance\", P, normal(0, 0, -1), PI / 2, COUNT,"
                 "\"distribution\", \"cosine\", \"surface:Ci\", seen) { sum += seen; } else { }"
                 "Ci = color(comp(sum, 0) / COUNT, expected, 1);",
         kSphere},
        {"EvenGather", "", "",
         kBall + "expected = 1 - sqrt(1 - .25 / d2); float sum = 0;"
                 "gather(\"illuminance\", P, normal(0, 0, -1), PI / 2, COUNT) { sum += 1; } else { }"
                 "Ci = color(sum / COUNT, expected, 1);",
         kSphere},
    };
}

const std::string kInItsTime = "Attribute \"trace\" \"int samplemotion\" 1 ";
const std::string kPasses = "MotionBegin [0 1] Translate -1 0 0 Translate 1 0 0 MotionEnd ";
/// The mean of a formula while x goes from -1 to 1.
std::string mean_of_passing(const std::string& formula) {
    return "float expected = 0, i; for (i = .5; i < 64; i += 1) { float x = i / 32 - 1; expected += (" +
           formula + ") / 64; }";
}

/// A whole turn about the map's poles.
const std::string kTurnsAround = "MotionBegin [0 1] Rotate 0 0 0 1 Rotate 360 0 0 1 MotionEnd ";

/// What arrives of the sky where each row has its mean all around.
double expected_of_turned_sky() {
    double expected = 0;
    for (int y = 0; y < kDown; ++y) {
        const auto of_height = [](double down) { return down / 2 - std::sin(2 * down) / 4; };
        const double down = M_PI / kDown, part = of_height(down * (y + 1)) - of_height(down * y);
        for (int x = 0; x < kAcross; ++x) expected += sky_at(x, y) / kAcross * part * 2 / M_PI;
    }
    return expected;
}

/// What the shapes of lights of radiance 1 give from where their middles are.
const std::string kRadiances =
    kSide +
    "float square(point m) { extern point P; vector x = vector(.5, 0, 0), y = vector(0, .5, 0);"
    "  return abs(side(P, m - x - y, m + x - y) + side(P, m + x - y, m + x + y) +"
    "    side(P, m + x + y, m - x + y) + side(P, m - x + y, m - x - y)); }"
    "float disk(point m) { extern point P; float a2 = pow(xcomp(P - m), 2) + pow(ycomp(P - m), 2);"
    "  float sum = 4 + a2 + 1; return (1 - (4 + a2 - 1) / sqrt(sum * sum - 4 * a2)) / 2; }"
    "float ball(point m) { extern point P; vector w = m - P; return .25 / (w . w) * 2 / length(w); } ";

/// Lights that move while the shutter is open, and domes that a ball is in front of.
std::vector<Asked> of_lights_in_time_and_domes() {
    const auto passing = [](const char* name, const std::string& light, const std::string& formula) {
        return Asked{name, kInItsTime + light, kRadiances, mean_of_passing(formula) + kFacing, ""};
    };
    return {
        passing("Rectangle", ris_light("PxrRectLight", kPasses + "Translate 0 0 3"),
                "square(point(x, 0, 3))"),
        passing("Disk", ris_light("PxrDiskLight", kPasses + "Translate 0 0 3 Scale 2 2 1"),
                "disk(point(x, 0, 3))"),
        passing("Sphere", ris_light("PxrSphereLight", kPasses + "Translate 0 0 3"), "ball(point(x, 0, 3))"),
        passing("Mesh",
                "AttributeBegin Attribute \"visibility\" \"int camera\" 0 " + kPasses +
                    "Light \"PxrMeshLight\" \"m\" \"int fixedSampleCount\" [COUNT] "
                    "Patch \"bilinear\" \"P\" [-.5 -.5 3 .5 -.5 3 -.5 .5 3 .5 .5 3] AttributeEnd ",
                "square(point(x, 0, 3))"),
        passing("AreaLightSource",
                "AttributeBegin Attribute \"visibility\" \"int camera\" 0 "
                "Attribute \"light\" \"int nsamples\" [COUNT] AreaLightSource \"arealight\" \"a\" " +
                    kPasses +
                    "Patch \"bilinear\" \"P\" [-.5 -.5 3 .5 -.5 3 -.5 .5 3 .5 .5 3] AttributeEnd "
                    "Illuminate \"a\" 1 ",
                "PI * square(point(x, 0, 3))"),
        {"Dome", kInItsTime + ris_light("PxrDomeLight", kTurnsAround, "\"string lightColorMap\" [\"SKY\"]"),
         "",
         "Ci = color(comp(diffuse(normal(-1, 0, 0)), 0), " + std::to_string(expected_of_turned_sky()) +
             ", 1);",
         ""},
        {"DomeBehindABall", ris_light("PxrDomeLight", ""), kRadiances,
         "float expected = 1 - ball(point(0, 0, 3)); " + kFacing, kSphere},
        {"DomeBehindABallThatMoves", kInItsTime + ris_light("PxrDomeLight", ""), kRadiances,
         mean_of_passing("1 - 4 * ball(point(2 * x, 0, 3))") + kFacing,
         "Scale 2 1 1 " + kPasses + "Scale .5 1 1 Translate 0 0 3 Sphere 1 -1 1 360 "},
    };
}

/// Rays that fill a cone, in which the whole ball is: of solid angles, or by the cosine to its axis.
std::vector<Asked> of_cones() {
    const std::string even = kBall + "expected = (1 - sqrt(1 - .25 / d2)) / (1 - cos(1)); ";
    const std::string by_cosine = kBall + "expected /= sin(1) * sin(1); ";
    const std::string gather = "float sum = 0; gather(\"illuminance\", P, vector(0, 0, -1), 1, COUNT";
    return {
        {"Trace", "", "",
         even + "color seen = trace(P, vector(0, 0, -1), \"samples\", COUNT, \"samplecone\", 1);"
                "Ci = color(comp(seen, 0), expected, 1);",
         kSphere},
        {"Transmission", "", "",
         even + "color open = transmission(P, P - vector(0, 0, 9), \"samples\", COUNT, \"samplecone\", 1);"
                "Ci = color(comp(open, 0), 1 - expected, 1);",
         kSphere},
        {"TransmissionInTime", kInItsTime, "float even(vector m) { return 1 - sqrt(1 - .81 / (m . m)); } ",
         mean_of_passing("even(point(0, 0, -2 - 5 * x) - P) / (1 - cos(1.2))") +
             "color open = transmission(P, P - vector(0, 0, 99), \"samples\", COUNT, \"samplecone\", 1.2);"
             "Ci = color(comp(open, 0), 1 - expected, 1);",
         "MotionBegin [0 1] Translate 0 0 3 Translate 0 0 -7 MotionEnd Sphere .9 -.9 .9 360 "},
        {"ConeOfGather", "", "",
         even + gather + ") { sum += 1; } else { } Ci = color(sum / COUNT, expected, 1);", kSphere},
        {"ConeOfGatherByCosine", "", "",
         by_cosine + gather +
             ", \"distribution\", \"cosine\") { sum += 1; } else { } Ci = color(sum / COUNT, expected, 1);",
         kSphere},
    };
}

class RayErrors : public ::testing::TestWithParam<Asked> {};

TEST_P(RayErrors, FallAtLeastAsOneOverTheNumberOfRays) {
    const WorkFolder folder;
    const std::string sky = (folder / "sky.exr").string();
    write_sky(sky);
    for (const std::vector<int>& counts : {std::vector<int>{4, 16, 64}, {5, 20}}) {
        Estimate before{HUGE_VAL, 0};
        for (const int count : counts) {
            const Estimate now = estimate(errors_of(GetParam(), count, sky));
            const double ratio = 4 * now.mean / before.mean,
                         deviation = ratio * std::sqrt(now.variance + before.variance);
            EXPECT_LE(ratio, 1 + 3 * deviation) << "of " << count << " rays: " << now.mean;
            EXPECT_LE(3 * deviation, 0.1);
            before = now;
        }
    }
}

std::string name_of_asked(const ::testing::TestParamInfo<Asked>& asked) {
    return asked.param.name;
}
INSTANTIATE_TEST_SUITE_P(, RayErrors, ::testing::ValuesIn(all()), name_of_asked);
INSTANTIATE_TEST_SUITE_P(Moving, RayErrors, ::testing::ValuesIn(of_lights_in_time_and_domes()),
                         name_of_asked);
INSTANTIATE_TEST_SUITE_P(Cones, RayErrors, ::testing::ValuesIn(of_cones()), name_of_asked);

}  // namespace
}  // namespace trapeze::testing
