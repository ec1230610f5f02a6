/// Surfaces in one place: rays see each of them once, in the order in which they stand in the scene.
#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

const std::string kHalfClear = "Opacity .5 .5 .5 Color .5 .5 .5 Surface \"constant\" ";

/// Whatever stands in the way: what comes through, and what is seen of white and of black.
void expect_through(const std::string& things, const std::string& through, const std::string& seen,
                    const std::map<std::string, std::string>& shaders = {}, size_t memory = 0) {
    Case c;
    c.shaders = shaders;
    c.things = things;
    if (memory > 0) c.settings.memory_bytes = memory, c.may_say = "memory-budget";
    const Image light = c.render("Ci = told(comp(transmission(P, point(0, 0, 0) + P - point(0, 0, 5)), 0), " +
                                 through + ", 1);");
    expect_told(light, 1e-5f, 64 * 64, 1e-5f);
    const Image color = c.render("Ci = told(comp(color trace(P, vector(0, 0, -1)), 0), " + seen + ", 1);");
    expect_told(color, 1e-5f, 64 * 64, 1e-5f);
}

TEST(Coincident, EachSurfaceCounts) {
    std::string things, through = "1", seen = "0";
    for (int surfaces = 1; surfaces <= 8; ++surfaces) {
        things += kHalfClear + wall("2");
        seen += " + .25 * " + through, through += " * .5";
        expect_through(things, through, seen);
    }
}

TEST(Coincident, TheOpaqueOneBehindAClearOneHides) {
    const std::string clear = "Opacity 0 0 0 Surface \"constant\" " + wall("2");
    const std::string hides = "Opacity 1 1 1 Color .25 1 1 Surface \"constant\" " + wall("2");
    expect_through(clear + hides, "0", ".25");
    expect_through(clear + clear + hides, "0", ".25");
    expect_through(hides + clear, "0", ".25");
}

/// Two shaders' cut-outs that leave no gap.
TEST(Coincident, CutOutsCompleteEachOther) {
    const auto cut = [](const std::string& name, const std::string& where) {
        return std::pair(name, "surface " + name + "() { point p = transform(\"world\", P); Oi = " + where +
                                   "; Ci = .75 * Oi; }");
    };
    expect_through("Surface \"left\" " + wall("2") + "Surface \"right\" " + wall("2"), "0", ".75",
                   {cut("left", "xcomp(p) < .11 ? 1 : 0"), cut("right", "xcomp(p) < .11 ? 0 : 1")});
}

TEST(Coincident, RoundThingsToo) {
    const std::string ball = "AttributeBegin Translate 0 0 2 Sphere 9 -9 9 360 AttributeEnd ";
    Case c;
    c.things = kHalfClear + ball + ball;
    expect_told(c.render("Ci = told(comp(transmission(P, P + 20 * vector(0, 0, 1)), 0), .25, 1);"), 1e-5f,
                64 * 64, 1e-5f);
}

/// Instances that share their grids have spaces of their own, in which distances round otherwise.
TEST(Coincident, InstancesCountBesideWhatIsNone) {
    const std::string object = "ObjectBegin 1 " + wall("2") + "ObjectEnd ";
    const std::string turned =
        "AttributeBegin Rotate 90 0 0 1 Translate 0 0 .3 Translate 0 0 -.3 ObjectInstance 1 AttributeEnd ";
    expect_through(object + kHalfClear + "ObjectInstance 1 " + turned + wall("2"), ".125", ".4375");
    expect_through(object + kHalfClear + wall("2") + turned + wall("2") + "ObjectInstance 1 ", ".0625",
                   ".46875");
}

TEST(Coincident, WithLittleMemoryToo) {
    expect_through(kHalfClear + wall("2") + wall("2") + wall("2"), ".125", ".4375", {}, size_t{1} << 20);
}

/// Of a solid the parts' surfaces make one border, wherever they lie.
TEST(Coincident, PartsOfASolidMakeOneBorder) {
    const auto box = [](const std::string& z0, const std::string& z1) {
        std::string faces =
            "SolidBegin \"primitive\" PointsPolygons [4 4 4 4 4 4] [0 1 3 2 5 4 6 7 1 0 4 5 2 3 7 6 0 2 6 4 3 1 5 7] \"P\" [";
        for (const std::string& z : {z0, z1})
            for (const char* y : {"-6", "6"})
                for (const char* x : {"-6", "6"}) faces += std::string(x) + " " + y + " " + z + " ";
        return faces + "] SolidEnd ";
    };
    for (const std::string kind : {"intersection", "union"})
        expect_through(
            kHalfClear + "SolidBegin \"" + kind + "\" " + box("2", "4") + box("2", "4.5") + "SolidEnd ",
            ".25", ".375");
}

/// What stands first in the scene hides what lies there, too.
TEST(Coincident, TheFirstIsInFront) {
    const std::string red = "Opacity 1 1 1 Color .25 1 1 Surface \"constant\" " + wall("2");
    const std::string dark = "Opacity 1 1 1 Color .75 1 1 Surface \"constant\" " + wall("2");
    expect_through(red + dark, "0", ".25");
    expect_through(dark + red, "0", ".75");
}

/// A mesh is one surface: a ray through an edge that its faces share meets it once.
TEST(Coincident, FacesOfOneMeshAreOneSurface) {
    std::string mesh = "PointsPolygons [4 4 4 4] [0 1 4 3 1 2 5 4 3 4 7 6 4 5 8 7] \"P\" [";
    for (const char* y : {"-6", "0", "6"})
        for (const char* x : {"-6", "0", "6"}) mesh += std::string(x) + " " + y + " 2 ";
    Case c;
    c.things = kHalfClear + mesh + "]";
    // Rays to the mesh's middle, and along its edges.
    expect_told(
        c.render(
            "point to = point(0, 0, 2) + 2 * (point(0, 0, 2) - P); Ci = told(comp(transmission(P, to), 0), .5, 1);"),
        1e-5f, 64 * 64, 1e-5f);
    expect_told(c.render("point q = point(0, ycomp(P), 5);"
                         "Ci = told(comp(transmission(q, q - 5 * vector(0, 0, 1)), 0), .5, 1);"),
                1e-5f, 64 * 64, 1e-5f);
}

}  // namespace
}  // namespace trapeze::testing
