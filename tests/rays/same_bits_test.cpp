/// Whatever rays of shaders meet and ask: the same bits for any number of threads, with little memory, and on
/// every instruction set.
#include <set>

#include "core/simd/simd_limit.h"
#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// What a square's rays meet, and how it asks.
struct Meeting {
    const char* name;
    std::map<std::string, std::string> shaders;
    std::string options, asker, things, body;
};

void PrintTo(const Meeting& meeting, std::ostream* out) {
    *out << meeting.name;
}

const std::string kMeetMoving = "MotionBegin [0 1] Translate -.5 0 2 Translate .6 .2 3 MotionEnd ";
const std::string kAsksAllAround = "Ci = occlusion(P, normal(0, 0, -1), 16);";
const std::string kAsksAhead = "Ci = trace(P, vector(.1 * xcomp(P), .1 * ycomp(P), -1));";
const std::string kMetBall = "Sphere .7 -.7 .7 360 ";

const Meeting kMeetings[] = {
    {"displaced_and_moving",
     {{"bump",
       "displacement bump() { P += .1 * sin(9 * s) * sin(7 * t) * normalize(N); N = calculatenormal(P); }"}},
     "Shutter 0 1 ",
     "Attribute \"trace\" \"int samplemotion\" [1] ",
     "Attribute \"trace\" \"int displacements\" [1] Attribute \"displacementbound\" \"float sphere\" [.1] "
     "Displacement \"bump\" Surface \"tints\" " +
         kMeetMoving + kMetBall,
     kAsksAllAround + " Ci += transmission(P, point(0, 0, 0));"},
    {"levels",
     {},
     "Option \"trace\" \"int levels\" [4] ",
     "",
     "Surface \"tints\" Translate 0 0 2 " + kMetBall,
     "Ci = trace(P, vector(0, 0, -1), \"samplecone\", .6, \"samples\", 8) +"
     "  occlusion(P, normal(0, 0, -1), 16);"},
    {"begun_over_micropolygons",
     {},
     "",
     "",
     "Surface \"tints\" Translate 0 0 2 " + kMetBall,
     "Ci = trace(P, vector(0, 0, -1), \"samplebase\", 1, \"samples\", 4);"},
    {"area_light",
     {},
     "Shutter 0 1 ",
     "AttributeBegin Attribute \"light\" \"int nsamples\" [9] AreaLightSource \"arealight\" \"a\" " +
         kMeetMoving +
         "Sphere .2 -.2 .2 360 AttributeEnd Illuminate \"a\" 1 Attribute \"trace\" \"int samplemotion\" [1] ",
     "Translate .3 0 4 Sphere .3 -.3 .3 360 ",
     "Ci = diffuse(normal(0, 0, -1));"},
    {"gathered",
     {{"stripes", "surface stripes(output varying float way = 0) { way = s + 2 * t; Ci = way; Oi = .5; }"}},
     "",
     "",
     "Surface \"stripes\" Translate 0 0 2 " + kMetBall,
     "float way = 0, length = 0; Ci = 0;"
     "gather(\"illuminance\", P, vector(0, 0, -1), .3, 9, \"surface:way\", way, \"ray:length\", length)"
     "  Ci += color(way, length, 0) / 9; else Ci += color(0, 0, .1);"},
    {"volumes",
     {{"haze", "volume haze(float k = .5) { Ci = exp(-k * length(I)) * Ci; Oi = 1; }"}},
     "",
     "",
     "Interior \"haze\" Surface \"constant\" Opacity .3 .3 .3 Translate 0 0 2 " + kMetBall + wall("0"),
     kAsksAhead},
    {"ends_in_media",
     {{"smoke",
       "volume smoke() { float t = exp(-length(I) * (.1 + random())); Ci = mix(color .5, Ci, t);"
       " Oi = mix(color 1, Oi, t); }"}},
     "Shutter 0 1 ",
     "Attribute \"trace\" \"int samplemotion\" [1] ",
     "Interior \"smoke\" Surface \"constant\" Opacity .3 .3 .3 Translate 0 0 2 " + kMetBall +
         "Sphere 9 -9 9 360 ",
     "Ci = transmission(P, point(0, 0, 1.5), \"samples\", 8) +"
     "  trace(P, vector(0, 0, -1), \"maxdist\", 2 + xcomp(P), \"samples\", 8);"},
    {"solids",
     {},
     "",
     "",
     "Surface \"tints\" Translate 0 0 2 SolidBegin \"difference\" SolidBegin \"primitive\" " + kMetBall +
         "SolidEnd SolidBegin \"primitive\" Translate .3 .2 .4 " + kMetBall + "SolidEnd SolidEnd ",
     kAsksAhead + kAsksAllAround},
    {"hits_of_shaders",
     {{"leaves", "surface leaves() { Oi = mod(floor(8 * s) + floor(8 * t), 2); Ci = Oi * color(s, t, 1); }"}},
     "",
     "",
     "Attribute \"shade\" \"string transmissionhitmode\" \"shader\" \"string diffusehitmode\" \"shader\" "
     "Surface \"leaves\" Translate 0 0 2 " +
         kMetBall,
     "Ci = transmission(P, point(0, 0, 0)) + indirectdiffuse(P, normal(0, 0, -1), 16);"},
    {"loose_ends",
     {},
     "",
     "",
     "Surface \"tints\" Translate 0 0 2 " + kMetBall + "Translate 0 0 2.9 Sphere .09 -.09 .09 360 ",
     "Ci = transmission(P, point(0, 0, 4.9)) + occlusion(P - vector(0, 0, .002), normal(0, 0, -1), 16) +"
     "  color(min(trace(P - vector(0, 0, .4), vector(.3 * xcomp(P), .3 * ycomp(P), -1)), 9));"},
    {"within_a_ball",
     {{"walls",
       "surface walls() { vector n = faceforward(normalize(N), I);"
       "  Ci = occlusion(P, n, 16) + trace(P, reflect(I, n)) * color(1, .1, .01); Oi = 1; }"}},
     "",
     "",
     "Attribute \"trace\" \"int maxspeculardepth\" [3] Surface \"walls\" Translate 0 0 5 Sphere 2 -2 2 360 ",
     kAsksAhead},
    {"instances",
     {},
     "Shutter 0 1 ",
     "Attribute \"trace\" \"int samplemotion\" [1] ",
     "ObjectBegin \"o\" Surface \"tints\" Sphere .2 -.2 .2 360 ObjectEnd " + kMeetMoving +
         "ObjectInstance \"o\" Translate .4 0 0 ObjectInstance \"o\" Translate .4 .1 0 ObjectInstance \"o\" "
         "Translate -1.2 0 0 ObjectInstance \"o\" Translate 0 .6 0 ObjectInstance \"o\" ",
     kAsksAllAround + " Ci += trace(P, vector(0, 0, -1));"},
};

class RaysSameBits : public ::testing::TestWithParam<Meeting> {
  protected:
    static Case asking() {
        const Meeting& meeting = GetParam();
        Case c;
        c.shaders = meeting.shaders;
        c.shaders["tints"] =
            "surface tints() { Ci = color(s, t, abs(normalize(N) . normalize(I))); Oi = Os; }";
        c.options = meeting.options, c.asker = meeting.asker;
        c.things = meeting.things;
        return c;
    }
    static Image render(int threads = 2, size_t memory = 0, int regions = 1) {
        Case c = asking();
        c.threads = threads;
        c.settings.regions_at_least = regions;
        if (memory > 0) c.settings.memory_bytes = memory, c.may_say = "memory-budget";
        return c.render(GetParam().body);
    }
};

TEST_P(RaysSameBits, ForAnyNumberOfThreadsAndRegionsAndLittleMemory) {
    const Image one = render(1);
    EXPECT_GT(mean(one, [](const Pixel& p) { return static_cast<double>(p.red + p.green + p.blue); }), 0.01)
        << "rays tell nothing";
    EXPECT_TRUE(same_bits(one, render(4)));
    EXPECT_TRUE(same_bits(one, render(2, 0, 5)));
    EXPECT_TRUE(same_bits(one, render(2, size_t{3} << 20)));
}

TEST_P(RaysSameBits, OnEveryInstructionSet) {
    const Image best = render();
    std::string error;
    for (const std::string_view name : simd_names())
        if (name != "best" && limit_simd(name, &error)) {
            EXPECT_TRUE(same_bits(best, render())) << name;
        }
    limit_simd("best", &error);
}

INSTANTIATE_TEST_SUITE_P(All, RaysSameBits, ::testing::ValuesIn(kMeetings),
                         [](const auto& meeting) { return std::string(meeting.param.name); });

}  // namespace
}  // namespace trapeze::testing
