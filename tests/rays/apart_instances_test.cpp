/// What instances do not share, and where spaces are odd.
#include <gtest/gtest.h>

#include "tests/rays/herd_harness.h"

namespace trapeze::testing {
namespace {

/// Objects of the same shapes, laid out otherwise: nested instances share their shapes.
TEST(RayInstances, OfOtherLayoutsAreApart) {
    std::string things =
        "ObjectBegin 1 Sphere .3 -.3 .3 360 ObjectEnd "
        "ObjectBegin 2 ObjectInstance 1 Translate 1 0 0 ObjectInstance 1 ObjectEnd "
        "ObjectBegin 3 ObjectInstance 1 Translate 0 1 0 ObjectInstance 1 ObjectEnd ";
    Herd balls(0, .3f);
    for (int i = 0; i < 12; ++i) {
        const V3f place(static_cast<float>(i % 4) * 3 - 4.5f, static_cast<float>(i / 4) * 3 - 3, 20);
        const bool second = i % 3 == 0;
        things += "AttributeBegin Translate " + text(place) + "ObjectInstance " + (second ? "2" : "3") +
                  " AttributeEnd ";
        balls.places.push_back(place);
        balls.places.push_back(place + (second ? V3f(1, 0, 0) : V3f(0, 1, 0)));
    }
    const RayWorldScene scene(things, kPerspectiveView);
    const RayWorldScene apart(balls.with("Sphere 1 -1 1 360"), kPerspectiveView);
    EXPECT_LT(scene.world().micropolygon_count(), apart.world().micropolygon_count());
    RayNumbers number;
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
        const RaySegment ray = some_ray(number, balls);
        float silhouette;
        const auto [ball, distance] = balls.nearest(ray, silhouette);
        if (silhouette < .02f) continue;
        const std::optional<RaySurfaceHit> hit = scene.world().closest(ray, RayKind::Diffuse);
        ASSERT_EQ(hit.has_value(), ball >= 0) << i;
        if (!hit) continue;
        ++met;
        ASSERT_EQ(hit->primitive, static_cast<uint32_t>(ball)) << i;
        ASSERT_NEAR(hit->distance, distance, .05f);
    }
    EXPECT_GT(met, 1500);
}

/// Of things at the same place the first one in the file is met, whether or not it shares, and with whom.
TEST(RayInstances, TiesGoToTheFirst) {
    Herd herd(24);
    for (V3f& place : herd.places) place = V3f(0, 0, 20);
    const auto apart = [](size_t i) {
        return i < 4 ? std::string("Opacity .5 .5 .5 ") : i < 8 ? std::string("Sides 1 ") : std::string();
    };
    Herd others = herd;
    for (size_t i = 0; i < others.places.size(); ++i) others.places[i].x = 3 + static_cast<float>(i);
    // The first one at the place is of the group whose first instance comes last.
    const RayWorldScene scene(
        kBallObject + others.with("ObjectInstance 1", apart) +
            "AttributeBegin Translate 0 0 20 Scale .5 .5 .5 ObjectInstance 1 AttributeEnd " +
            herd.with("ObjectInstance 1", apart),
        kPerspectiveView);
    RayNumbers number;
    for (int i = 0; i < 200; ++i) {
        const V3f from = number.in_cube(1);
        const std::optional<RaySurfaceHit> hit = scene.world().closest(
            ray_to(from, V3f(0, 0, 20) + number.in_cube(.1f) - from, 0), RayKind::Diffuse);
        ASSERT_TRUE(hit);
        ASSERT_EQ(hit->primitive, 24u);
    }
}

/// Where a space has no inverse at some time, nothing is met there, least of all elsewhere.
TEST(RayInstances, ThatCollapseAreNotMet) {
    for (const char* motion : {"MotionBegin [0 1] Scale 1 1 1 Scale 0 0 0 MotionEnd ",
                               "MotionBegin [0 1] Scale 1 1 1 Scale -1 1 1 MotionEnd ",
                               "MotionBegin [0 1] Rotate 0 0 0 1 Rotate 180 0 0 1 MotionEnd "}) {
        const Herd herd(12);
        const RayWorldScene scene("Attribute \"trace\" \"int samplemotion\" 1 " + kBallObject +
                                      herd.with(motion + std::string("ObjectInstance 1")),
                                  "Shutter 0 1 " + kPerspectiveView);
        RayNumbers number;
        for (int i = 0; i < 2000; ++i) {
            RaySegment ray = some_ray(number, herd);
            ray.time = i % 2 == 0 ? .5f : 1.0f;
            const std::optional<RaySurfaceHit> hit = scene.world().closest(ray, RayKind::Diffuse);
            if (!hit) continue;
            const V3f at = ray.origin + ray.direction * hit->distance;
            float nearest = kInfinity;
            for (const V3f& place : herd.places) nearest = std::min(nearest, (at - place).length());
            ASSERT_LT(nearest, herd.radius * 1.01f) << motion << ray.time;
        }
    }
}

/// Objects in large and in tiny units, far from their origin: each is met where it is, and leaves itself.
TEST(RayInstances, OfAnyUnitsDoNotHideThemselves) {
    for (const char* units : {"1", "1e-9", "1e9"}) {
        const double unit = std::stod(units);
        const std::string size = in_scientific(.5 / unit);
        std::string object = "ObjectBegin 1 Sphere " + size + " -" + size + ' ' + size + " 360 ObjectEnd ";
        Herd herd(12);
        const std::string scale = std::string("Scale ") + units + ' ' + units + ' ' + units + ' ';
        std::string things = object;
        for (const V3f& place : herd.places)
            things += "AttributeBegin Translate " + text(place) + scale + "ObjectInstance 1 AttributeEnd ";
        const RayWorldScene scene(things, kPerspectiveView);
        RayNumbers number;
        int met = 0;
        for (int i = 0; i < 2000; ++i) {
            const RaySegment ray = some_ray(number, herd);
            float silhouette;
            const auto [ball, distance] = herd.nearest(ray, silhouette);
            if (silhouette < .02f) continue;
            const std::optional<RaySurfaceHit> hit = scene.world().closest(ray, RayKind::Diffuse);
            ASSERT_EQ(hit.has_value(), ball >= 0) << units;
            met += hit.has_value();
        }
        EXPECT_GT(met, 500) << units;
    }
    // Vertices a thousand units away, in an instance that moves them by nothing.
    std::string mesh = "ObjectBegin 1 PointsPolygons [";
    const int rings = 16, sides = 32;
    for (int i = 0; i < rings * sides; ++i) mesh += "4 ";
    mesh += "] [";
    const auto corner = [&](int ring, int side) { return std::to_string(ring * sides + side % sides) + ' '; };
    for (int r = 0; r < rings; ++r)
        for (int q = 0; q < sides; ++q)
            mesh += corner(r, q) + corner(r + 1, q) + corner(r + 1, q + 1) + corner(r, q + 1);
    mesh += "] \"P\" [";
    for (int r = 0; r <= rings; ++r)
        for (int q = 0; q < sides; ++q) {
            const float a = 3.1415926f * static_cast<float>(r) / rings,
                        b = 6.2831853f * static_cast<float>(q) / sides;
            const V3f out(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
            mesh += text(V3f(305, 305, 1000) + out * 100);
        }
    mesh += "] ObjectEnd ";
    Case c;
    c.options = "Projection \"perspective\" \"fov\" 12 Format 64 64 1 ScreenWindow 1.9 3.9 1.9 3.9 ";
    c.asker = kSeen;
    c.asks = mesh +
             "ObjectInstance 1 Translate 0 -610 0 ObjectInstance 1 Translate -610 610 0 ObjectInstance 1 "
             "Translate 0 -610 0 ObjectInstance 1 ";
    // At the rim a sample may see a side that faces away.
    const Image image = c.render(
        "normal n = faceforward(normalize(N), I); Ci = told(occlusion(P, n, 64, \"maxdist\", 200), 0, zcomp(n) < -.1 ? 1 : 0);");
    expect_told(image, 0, 2500);
}

/// What has grids of its own, as many as without objects.
TEST(RayInstances, ShareOnlyWhatIsAlike) {
    struct Kind {
        const char* name;
        std::string object, before;
        int count = 8;
        std::string options = {};
    };
    const std::string bent = "MotionBegin [0 1] Sphere 1 -1 1 360 Sphere .8 -.8 .8 360 MotionEnd ";
    const Kind kinds[] = {
        {"few", "Sphere 1 -1 1 360 ", "", 3},
        {"displaced", "Sphere 1 -1 1 360 ",
         "Attribute \"trace\" \"displacements\" 1 Displacement \"dented\" Attribute \"displacementbound\" "
         "\"sphere\" .2 "},
        {"facing the eye",
         "Curves \"cubic\" [4] \"nonperiodic\" \"P\" [-1 0 0 -.3 1 0 .3 -1 0 1 0 0] "
         "\"constantwidth\" .1 ",
         ""},
        {"bending", bent, "Attribute \"trace\" \"int samplemotion\" 1 ", 8, "Shutter 0 1 "},
        {"solids", "Sphere 1 -1 1 360 ", "SolidBegin \"primitive\" "},
        {"blurred", "Sphere 1 -1 1 360 ", "GeometricApproximation \"motionfactor\" 1 "},
        {"small", "Sphere .01 -.01 .01 360 ", ""},
        {"stretched", "Sphere 1 -1 1 360 ", "Scale 5 1 1 "},
        {"with a part that turns",
         "Sphere 1 -1 1 360 MotionBegin [0 1] Rotate 0 1 0 0 Rotate 1 1 0 0 MotionEnd "
         "Translate 0 2 0 Sphere 1 -1 1 360 ",
         "Attribute \"trace\" \"int samplemotion\" 1 MotionBegin [0 1] Translate 0 0 0 Translate .1 0 0 MotionEnd ",
         8, "Shutter 0 1 "},
        {"with a weight", "Sphere 1 -1 1 360 ", "ConcatTransform [2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 2] "},
        {"seen by nobody",
         "Attribute \"visibility\" \"int diffuse\" 0 \"int specular\" 0 \"int transmission\" 0 "
         "Sphere 1 -1 1 360 ",
         ""},
    };
    for (const Kind& kind : kinds) {
        const Herd herd(kind.count);
        const auto before = [&](size_t) { return kind.before; };
        const std::string end = kind.before.starts_with("Solid") ? "SolidEnd " : "";
        const RayWorldScene instances(
            "ObjectBegin 1 " + kind.object + "ObjectEnd " + herd.with("ObjectInstance 1 " + end, before),
            kPerspectiveView + kind.options);
        const RayWorldScene apart(herd.with(kind.object + end, before), kPerspectiveView + kind.options);
        EXPECT_EQ(instances.world().micropolygon_count(), apart.world().micropolygon_count()) << kind.name;
    }
    // At the eye each is as fine as it looks; farther away it shares.
    Herd near(8);
    for (size_t i = 0; i < 8; ++i) near.places[i] = V3f(.1f * static_cast<float>(i), 0, 1.2f);
    EXPECT_EQ(RayWorldScene(kBallObject + near.with("ObjectInstance 1"), kPerspectiveView)
                  .world()
                  .micropolygon_count(),
              RayWorldScene(near.with("Sphere 1 -1 1 360"), kPerspectiveView).world().micropolygon_count());
    // Different rates, opacities and sides are apart: twice as much as alike.
    const Herd herd(16);
    const auto count = [&](const std::string& odd) {
        return RayWorldScene(
                   kBallObject + herd.with("ObjectInstance 1",
                                           [&](size_t i) { return i % 2 == 0 ? std::string() : odd; }),
                   kOrthographicView)
            .world()
            .micropolygon_count();
    };
    for (const char* odd : {"Opacity .5 .5 .5 ", "Sides 1 ", "Attribute \"visibility\" \"int specular\" 0 "})
        EXPECT_EQ(count(odd), 2 * count("")) << odd;
    for (const char* alike : {"Color 1 0 0 ", "Surface \"plastic\" ", "ReverseOrientation "})
        EXPECT_EQ(count(alike), count("")) << alike;
}

}  // namespace
}  // namespace trapeze::testing
