/// What no sample sees stays unshaded, and the picture is the same bits.
#include <gtest/gtest.h>

#include "sample/every_method_harness.h"
#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

RenderSettings culling(CullHidden cull) {
    RenderSettings settings;
    settings.cull_hidden = cull;
    return settings;
}

/// Renders a text with and without; returns the statistics of with. `shaders`: name and text.
FrameStats culled(const std::string& text,
                  const std::vector<std::pair<std::string, std::string>>& shaders = {},
                  RenderSettings settings = {}) {
    const WorkFolder folder;
    for (const auto& [name, body] : shaders) folder.write(name + ".sl", body);
    folder.write("a.rib", "Option \"searchpath\" \"string shader\" [\"" + folder.path().string() +
                              ":&\"] Display \"x\" \"exr\" \"rgba\" Format 64 48 1 PixelSamples 3 3 "
                              "Projection \"perspective\" \"fov\" 40 " +
                              text);
    const std::string path = (folder / "a.rib").string();
    settings.cull_hidden = CullHidden::Off;
    const auto whole = render_scene(path, settings);
    settings.cull_hidden = CullHidden::On;
    const auto part = render_scene(path, settings);
    EXPECT_EQ(whole.size(), 1u);
    EXPECT_EQ(part.size(), 1u);
    if (whole.empty() || part.empty()) return {};
    EXPECT_TRUE(same_bits(whole[0].image, part[0].image));
    EXPECT_EQ(whole[0].stats.unshaded_grids, 0u);
    EXPECT_EQ(whole[0].stats.shade.shaded_vertices,
              part[0].stats.shade.shaded_vertices + part[0].stats.unshaded_vertices);
    return part[0].stats;
}

class HiddenInTinyScene : public ::testing::TestWithParam<std::string> {};

TEST_P(HiddenInTinyScene, IsTheSameWithoutWhatIsHidden) {
    const std::string path = tiny_scene_path(GetParam());
    const auto reference = render_scene(path, culling(CullHidden::Off));
    for (const char* method : {"raytrace", "interval"}) {
        RenderSettings settings = culling(CullHidden::On);
        settings.regions_at_least = 3;
        settings.sampler = method;
        RenderSettings plain = settings;
        plain.cull_hidden = CullHidden::Off;
        const auto expected = std::string(method) == "raytrace" ? reference : std::vector<FrameResult>();
        const auto results = render_scene(path, settings);
        const auto whole = expected.empty() ? render_scene(path, plain) : std::vector<FrameResult>();
        const auto& right = expected.empty() ? whole : expected;
        ASSERT_EQ(results.size(), right.size());
        for (size_t i = 0; i < results.size(); ++i)
            EXPECT_TRUE(same_bits(results[i].image, right[i].image)) << method << ", world " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(All, HiddenInTinyScene, ::testing::ValuesIn(tiny_scenes_without_maps()), test_name);

const std::string kLight = "LightSource \"distantlight\" 1 ";
const std::string kWall = "Patch \"bilinear\" \"P\" [-9 9 3 9 9 3 -9 -9 3 9 -9 3] ";
const std::string kBall = "TransformBegin Translate 0 0 5 Sphere .8 -.8 .8 360 TransformEnd ";

/// The sides of balls that are turned away, and all that is behind a wall.
TEST(CullHidden, WhatIsHiddenIsNotShaded) {
    const FrameStats ball =
        culled("WorldBegin " + kLight + "Surface \"matte\" ShadingRate .05 " + kBall + "WorldEnd\n");
    EXPECT_GT(ball.unshaded_vertices, ball.shade.shaded_vertices / 2) << "nearly half of a ball";
    const FrameStats wall = culled("WorldBegin " + kLight + "Surface \"matte\" ShadingRate .05 " + kBall +
                                   kBall + "Color 1 0 0 " + kWall + "WorldEnd\n");
    const FrameStats alone = culled("WorldBegin " + kLight +
                                    "Surface \"matte\" ShadingRate .05 Color 1 0 0 " + kWall + "WorldEnd\n");
    EXPECT_EQ(wall.shade.shaded_vertices, alone.shade.shaded_vertices);
}

/// What moves hides what it uncovers in time, through a lens too.
TEST(CullHidden, BlurUncovers) {
    const std::string blur = "Shutter 0 1 DepthOfField 2 .5 4 ";
    const std::string moving = "MotionBegin [0 1] Translate 0 0 0 Translate 12 0 0 MotionEnd ";
    const FrameStats stats = culled(blur + "WorldBegin " + kLight + "Surface \"matte\" TransformBegin " +
                                    moving + kWall + "TransformEnd Color 0 1 0 " + kBall + "WorldEnd\n");
    EXPECT_GT(stats.shade.shaded_vertices, 100u);
}

/// Every method of the table, also those whose hits are not brute force's: behind what is opaque in part, is
/// half transparent in part, moves, and is out of focus.
TEST(CullHidden, IsTheSamePictureByEveryMethod) {
    const WorkFolder folder;
    folder.write("holes.sl", "surface holes() { Oi = mod(s * 9, 1) < .5 ? 1 : 0; Ci = Oi * Cs; }");
    const std::string front =
        "Surface \"matte\" Color 0 0 1 Patch \"bilinear\" \"P\" [-9 .5 3 -.2 .5 3 -9 -9 3 -.2 -9 3] "
        "Opacity .5 .7 .5 Color 1 1 0 Patch \"bilinear\" \"P\" [-.4 .3 2.8 9 .3 2.8 -.4 -9 2.8 9 -9 2.8] "
        "Opacity 1 1 1 AttributeBegin Surface \"holes\" MotionBegin [0 1] Translate 0 0 0 Translate .4 .2 0 "
        "MotionEnd Patch \"bilinear\" \"P\" [-.3 1 3.2 .6 1 3.2 -.3 .6 3.2 .6 .6 3.2] AttributeEnd ";
    folder.write("a.rib", "Option \"searchpath\" \"string shader\" [\"" + folder.path().string() +
                              ":&\"] Display \"x\" \"exr\" \"rgba\" Format 32 24 1 PixelSamples 2 2 "
                              "Projection \"perspective\" \"fov\" 40 Shutter 0 1 DepthOfField 4 .5 4 "
                              "WorldBegin " +
                              kLight + front + "Surface \"matte\" ShadingRate .3 Color 0 1 0 " + kBall +
                              "WorldEnd\n");
    for (const MethodForm& form : every_method({.exact_only = false, .few_numbers = true})) {
        SCOPED_TRACE(form.name);
        RenderSettings settings = culling(CullHidden::Off);
        settings.sampler = form.name, settings.regions_at_least = 2;
        const auto whole = render_scene((folder / "a.rib").string(), settings);
        settings.cull_hidden = CullHidden::On;
        const auto part = render_scene((folder / "a.rib").string(), settings);
        EXPECT_TRUE(same_bits(whole[0].image, part[0].image));
        EXPECT_GT(part[0].stats.unshaded_vertices, 500u);
        EXPECT_GT(part[0].stats.shade.shaded_vertices, 500u);
    }
}

/// A wall hides only what shaders cannot let through: by opacity, by a shader that sets it, by an atmosphere.
TEST(CullHidden, OnlyWhatIsSurelyOpaqueHides) {
    const std::string behind = "ShadingRate .2 " + kBall;
    const auto hidden = [&](const std::string& front) {
        return culled("WorldBegin " + kLight + "Surface \"matte\" " + behind + "ShadingRate 1 " + front +
                          kWall + "WorldEnd\n",
                      {{"holes", "surface holes() { Oi = mod(s * 9, 1) < .5 ? 1 : 0; Ci = Oi; }"},
                       {"solid", "surface solid() { Oi = Os; Ci = Cs; }"},
                       {"one", "surface one() { Oi = 1; Ci = Cs; if (s > .5) Oi = color(1, 1, 1); }"},
                       {"some", "surface some() { Oi = 1; Ci = Cs; if (s > .5) Oi = color(1, .5, 1); }"},
                       {"thin", "volume thin() { Oi = .5 * Oi; Ci = Ci; }"}})
            .unshaded_vertices;
    };
    const uint64_t all = hidden("Surface \"solid\" ");
    EXPECT_EQ(hidden("Surface \"one\" "), all);
    for (const char* front :
         {"Surface \"holes\" ", "Surface \"some\" ", "Opacity .5 .5 .5 ",
          "Surface \"solid\" Atmosphere \"thin\" ", "Surface \"constant\" Opacity .5 1 1 "})
        EXPECT_LT(hidden(front), all * 2 / 3) << front;
}

/// Shaders that print run wherever they are; so do primitives that ask to be shaded, and displaced ones,
/// which may come out from behind.
TEST(CullHidden, SomeAreShadedInAnyCase) {
    const auto unshaded = [&](const std::string& ball) {
        return culled("WorldBegin " + kLight + "Surface \"matte\" " + kWall + ball + kBall + "WorldEnd\n",
                      {{"says", "surface says() { if (u < 0) printf(\"never\"); Oi = Os; Ci = Cs; }"},
                       {"bakes",
                        "surface bakes() { Oi = Os; Ci = Cs;"
                        " if (u < 0) bake3d(\"x.ptc\", \"\", P, N, \"a\", u); }"},
                       {"talks",
                        "light talks() { illuminate(point(0, 0, 0)) {"
                        " if (xcomp(Ps) > 1e9) printf(\"never\"); Cl = 1; } }"},
                       {"hums", "volume hums() { if (xcomp(P) > 1e9) printf(\"never\"); Ci = Ci; Oi = Oi; }"},
                       {"bump", "displacement bump() { P -= vector(0, 0, 4); N = calculatenormal(P); }"}})
            .unshaded_vertices;
    };
    const uint64_t of_wall =
        culled("WorldBegin " + kLight + "Surface \"matte\" " + kWall + "WorldEnd\n").unshaded_vertices;
    EXPECT_GT(unshaded(""), of_wall);
    EXPECT_EQ(unshaded("Surface \"says\" "), of_wall);
    EXPECT_EQ(unshaded("Surface \"bakes\" "), of_wall);
    EXPECT_EQ(unshaded("LightSource \"talks\" 7 "), of_wall);
    EXPECT_EQ(unshaded("Atmosphere \"hums\" "), of_wall);
    EXPECT_EQ(unshaded("Attribute \"cull\" \"int hidden\" 0 "), of_wall);
    EXPECT_EQ(unshaded("Displacement \"bump\" Attribute \"displacementbound\" \"float sphere\" 4.1 "),
              of_wall);
}

/// Of a grid that is seen in part, vertices that no sample sees send no rays; unless what rays tell a vertex
/// goes on to others, or decides what the shader does, or how much lies behind.
TEST(CullHidden, VerticesThatAreSeenAlone) {
    const std::string half = "Surface \"constant\" Patch \"bilinear\" \"P\" [-9 9 3 .1 9 3 -9 -9 3 .1 -9 3] ";
    const auto rays = [&](const std::string& body) {
        const FrameStats stats =
            culled("WorldBegin Attribute \"visibility\" \"int diffuse\" 1 " + half +
                       "LightSource \"sky\" 1 Surface \"ask\" ShadingRate .3 " + kBall + "WorldEnd\n",
                   {{"ask", "surface ask() { Oi = Os; " + body + " }"},
                    {"sky",
                     "light sky() { solar(vector \"camera\" (0, 1, 1), 0) "
                     "Cl = 1 - occlusion(Ps, normalize(N), 4); }"}});
        return stats.shade.rays.diffuse;
    };
    const std::string open = "float o = occlusion(P, normalize(N), 4); ";
    const std::string sky = "color c = diffuse(normalize(N)); ";
    const uint64_t all = rays(open + "Ci = abs(Du(o));");
    EXPECT_GT(all, 1000u);
    for (const std::string& spread :
         {open + "varying float a = o; a = a * 2; Ci = area(point(a, a, a));",
          open + "if (o > .3) Ci = Du(s); else Ci = 0;",
          open + "varying float a = 0; while (a < o) a += .3; Ci = a;", sky + "Ci = abs(Du(comp(c, 0)));"})
        EXPECT_EQ(rays(spread), all) << spread;
    // More is seen then.
    EXPECT_EQ(rays(open + "Oi = 1 - o; Ci = o;"), rays(open + "Oi = 1 - o; Ci = abs(Du(o));"));
    for (const std::string& apart : {open + "Ci = o;", open + "Ci = o * length(Du(P));",
                                     open + "varying float a = o; a += 1; Ci = a + area(P);", sky + "Ci = c;",
                                     sky + "Ci = c + abs(Du(s));"}) {
        EXPECT_LT(rays(apart), all * 9 / 10) << apart;
        EXPECT_GT(rays(apart), all / 4) << apart;
    }
}

/// It is on where shaders trace rays and enough is opaque, and only there, unless it is asked for.
TEST(CullHidden, IsOnWhereItPays) {
    const WorkFolder folder;
    folder.write("ask.sl", "surface ask() { Ci = 1 - occlusion(P, normalize(N), 4); Oi = 1; }");
    const auto unshaded = [&](const std::string& shader, const std::string& things = kBall,
                              CullHidden cull = CullHidden::Auto) {
        folder.write("a.rib", "Option \"searchpath\" \"string shader\" [\"" + folder.path().string() +
                                  ":&\"] Display \"x\" \"exr\" \"rgba\" Format 64 48 1 WorldBegin "
                                  "ShadingRate .05 Attribute \"visibility\" \"int diffuse\" 1 Surface \"" +
                                  shader + "\" " + things + "WorldEnd\n");
        return render_scene((folder / "a.rib").string(), culling(cull))[0].stats.unshaded_grids;
    };
    EXPECT_GT(unshaded("ask"), 0u);
    EXPECT_EQ(unshaded("constant"), 0u);
    // Finely diced glass hides nothing, and the one opaque ball too little.
    const std::string glass = kBall + "Surface \"glassy\" ShadingRate .005 " + kBall;
    folder.write("glassy.sl", "surface glassy() { Ci = .1 * occlusion(P, normalize(N), 4); Oi = .1; }");
    EXPECT_EQ(unshaded("ask", glass), 0u);
    EXPECT_GT(unshaded("ask", glass, CullHidden::On), 0u);
    // Behind a wall that fills the picture there is next to nothing.
    const std::string wall =
        "Patch \"bilinear\" \"P\" [-3 3 2 3 3 2 -3 -3 2 3 -3 2] Translate 0 0 5 Sphere .2 -.2 .2 360 ";
    EXPECT_EQ(unshaded("ask", wall), 0u);
    EXPECT_GT(unshaded("ask", wall, CullHidden::On), 0u);
}

}  // namespace
}  // namespace trapeze::testing
