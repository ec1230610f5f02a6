/// Instances that share what rays meet: as if each had its own, but for the memory.
#include <gtest/gtest.h>

#include <set>

#include "tests/rays/herd_harness.h"

namespace trapeze::testing {
namespace {

TEST(RayInstances, TakeTheMemoryOfFew) {
    const Herd herd(200);
    for (const std::string& options : {kOrthographicView, kPerspectiveView}) {
        const RayWorldScene shared(kBallObject + herd.with("ObjectInstance 1"), options);
        const RayWorldScene apart(herd.with("Sphere 1 -1 1 360"), options);
        EXPECT_LT(shared.world().micropolygon_count() * 10, apart.world().micropolygon_count());
        EXPECT_GT(shared.world().micropolygon_count(), 1000u);
        EXPECT_LT(shared.world().bytes() * 5, apart.world().bytes());
        EXPECT_LT(shared.world().list_bytes() * 2, apart.world().list_bytes());
    }
}

/// By formula; whatever the view, the number of levels, and whether grids are made as rays come by.
TEST(RayInstances, AreMetWhereTheyAre) {
    const Herd herd(60);
    const auto color = [](size_t i) { return "Color " + text(V3f(static_cast<float>(i) / 64, .5f, 1)); };
    const std::string things = kBallObject + herd.with("ObjectInstance 1", color);
    for (const std::string& options :
         {kOrthographicView, kPerspectiveView, kLevels, kLevels + kPerspectiveView})
        for (const size_t bytes : {size_t{1} << 30, size_t{1} << 17}) {
            SCOPED_TRACE(options + std::to_string(bytes));
            const RayWorldScene scene(things, options, bytes);
            EXPECT_EQ(scene.world().rays_at_once() > 0, bytes < size_t{1} << 30);
            RayNumbers number;
            int met = 0;
            for (int i = 0; i < 6000; ++i) {
                const RaySegment ray = some_ray(number, herd, i % 2 == 0 ? 0 : number(0, .2f));
                float silhouette;
                const auto [ball, distance] = herd.nearest(ray, silhouette);
                const std::optional<RaySurfaceHit> hit = scene.world().closest(ray, RayKind::Diffuse);
                // Sides of a pixel at their distance, four or sixteen times as long for wide rays.
                const float side = level_side(hit ? hit->level : 2) * .1f + .1f;
                if (silhouette < side * side) continue;
                ASSERT_EQ(hit.has_value(), ball >= 0) << i;
                ASSERT_EQ(scene.world().blocked(ray, RayKind::Diffuse), ball >= 0);
                if (!hit) continue;
                ++met;
                ASSERT_EQ(hit->primitive, static_cast<uint32_t>(ball)) << i;
                ASSERT_FLOAT_EQ(hit->color.x,
                                static_cast<float>(ball) / 64);  // corners' weights make 1, about
                ASSERT_EQ(hit->attributes, &scene.scene().primitives[hit->primitive].attributes->rays);
                const V3f at = ray.origin + ray.direction * hit->distance - herd.places[hit->primitive];
                ASSERT_NEAR(at.length(), herd.radius, side * side / 8 / herd.radius + 1e-4f) << i;
                ShadingGrid grid;
                const int vertex = scene.world().dice(*hit, grid);
                const V3f P = grid.P[0].at(static_cast<size_t>(vertex)) - herd.places[hit->primitive];
                ASSERT_NEAR(P.length(), herd.radius, 2e-5f);
                ASSERT_LE((P - at).length(), side);
                ASSERT_EQ(grid.primitive_index, hit->primitive);
                ASSERT_EQ(grid.primitive->attributes, scene.scene().primitives[hit->primitive].attributes);
                ASSERT_NEAR(std::abs(grid.N.at(static_cast<size_t>(vertex)).dot(P)), herd.radius, 1e-4f);
            }
            EXPECT_GT(met, 2000);
        }
}

/// What a ray that wants one instance alone finds of each, for all others let it pass: the nearest of these
/// is what it finds without a wish. Bit for bit; also where instances reach into each other, are at the same
/// place, are turned, mirrored or stretched, and whether many are asked for at once or each alone.
TEST(RayInstances, AreAllMet) {
    const int count = 24;
    Herd herd(count, .3f);
    for (V3f& place : herd.places) place = V3f(0, 0, 20) + (place - V3f(0, 0, 20)) * .07f;
    herd.places[7] = herd.places[3], herd.places[11] = herd.places[3];
    const auto own = [](size_t i) {
        std::string before = "Attribute \"grouping\" \"membership\" \"g" + std::to_string(i) + "\" ";
        if (i % 2 == 1) before += "Opacity .5 .5 .5 ";
        if (i % 6 == 2) before += "Sides 1 ";
        if (i % 8 == 4) before += "Attribute \"visibility\" \"int transmission\" 0 ";
        return before;
    };
    const auto thing = [](int i) {
        const char* const turns[] = {"", "Rotate 30 1 2 3 ", "Scale -1 1 1 ",
                                     "Scale 1.3 .8 1 Rotate 50 0 1 2 "};
        return std::string(turns[i]) + "ObjectInstance 1";
    };
    // What may be displaced has small micropolygons, many of them.
    std::string things = "Attribute \"displacementbound\" \"float sphere\" [1e-6] " + kBoxObject;
    for (int turn = 0; turn < 4; ++turn) things += herd.with(thing(turn), own);
    for (const auto& [options, bytes] :
         {std::pair(kPerspectiveView, size_t{1} << 18), std::pair(kLevels, size_t{1} << 20)}) {
        const RayWorldScene whole(things, options), bricks(things, options, bytes);
        ASSERT_EQ(whole.world().rays_at_once(), 0u);
        ASSERT_GT(bricks.world().rays_at_once(), 0u);
        std::vector<RayFilter> of(static_cast<size_t>(count));
        for (size_t i = 0; i < of.size(); ++i) of[i].subset = RaySubset("g" + std::to_string(i));
        RayNumbers number;
        std::vector<RaySegment> rays;
        for (int i = 0; i < 800; ++i) {
            rays.push_back(some_ray(number, herd, number(0, .1f)));
            if (i % 5 == 0) rays.back().max = number(0, 20);
        }
        std::vector<const RaySegment*> asked;
        for (const RaySegment& ray : rays) asked.push_back(&ray);
        for (const RayKind kind : {RayKind::Diffuse, RayKind::Transmission}) {
            std::vector<std::optional<RaySurfaceHit>> together(rays.size());
            std::vector<std::optional<bool>> blocked(rays.size());
            bricks.world().closest(asked, kind, together);
            bricks.world().blocked(asked, kind, blocked);
            std::set<uint32_t> met;
            int unsure = 0;
            for (size_t i = 0; i < rays.size(); ++i) {
                std::optional<RaySurfaceHit> expected;
                for (const RayFilter& filter : of) {
                    RaySegment ray = rays[i];
                    ray.only = &filter;
                    const std::optional<RaySurfaceHit> hit = whole.world().closest(ray, kind);
                    if (hit &&
                        (!expected || hit->distance < expected->distance ||
                         (hit->distance == expected->distance && hit->primitive < expected->primitive)))
                        expected = hit;
                }
                const std::optional<RaySurfaceHit> alone = whole.world().closest(rays[i], kind);
                const std::optional<RaySurfaceHit> from_bricks = bricks.world().closest(rays[i], kind);
                for (const std::optional<RaySurfaceHit>& hit : {alone, from_bricks, together[i]}) {
                    ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
                    if (!hit) continue;
                    ASSERT_EQ(hit->distance, expected->distance) << i;
                    ASSERT_EQ(hit->primitive, expected->primitive) << i;
                    ASSERT_EQ(hit->place.id, expected->place.id);
                    ASSERT_EQ(hit->at, expected->at);
                    ASSERT_EQ(hit->from_outside, expected->from_outside);
                    met.insert(hit->primitive / 6);
                }
                const std::optional<bool> is_blocked = whole.world().blocked(rays[i], kind);
                ASSERT_EQ(bricks.world().blocked(rays[i], kind), is_blocked);
                ASSERT_EQ(blocked[i], is_blocked);
                ASSERT_EQ(is_blocked.value_or(expected.has_value()), expected.has_value());
                unsure += !is_blocked;
            }
            EXPECT_GT(met.size(), 40u) << "of 96";
            EXPECT_GT(unsure, 20);
        }
    }
}

/// Boxes of six primitives, and balls: stretched, turned and mirrored; from inside nothing gets out, and all
/// is met from the inside.
TEST(RayInstances, LetNothingThrough) {
    Herd herd(12, 1);
    for (size_t i = 0; i < 12; ++i)
        herd.places[i] =
            V3f(static_cast<float>(i % 2), static_cast<float>(i / 2 % 3), static_cast<float>(i / 6)) * 4.0f +
            V3f(-2, -4, 20);
    for (const std::string& object : {kBoxObject, kBallObject})
        for (const char* turn : {"", "Rotate 33 1 2 3 ", "Scale 1 -1.5 .7 Rotate 20 3 1 0 "}) {
            const std::string instance = turn + std::string("ObjectInstance 1");
            const RayWorldScene scene(object + herd.with(instance), kPerspectiveView);
            Herd three = herd;
            three.places.resize(3);
            const RayWorldScene apart(object + three.with(instance), kPerspectiveView);
            EXPECT_LT(scene.world().micropolygon_count(), 2 * apart.world().micropolygon_count());
            RayNumbers number;
            int leaks = 0;
            for (int i = 0; i < 60000; ++i) {
                const V3f from = herd.places[static_cast<size_t>(i) % 12] + number.in_cube(.3f);
                V3f way = number.in_cube(1);
                if (i % 3 == 0) way.x = way.y;  // towards edges
                const RaySegment ray = ray_to(from, way, 0);
                const std::optional<RaySurfaceHit> hit = scene.world().closest(ray, RayKind::Diffuse);
                leaks += !hit || scene.world().blocked(ray, RayKind::Diffuse) != true;
                if (hit && object == kBallObject) leaks += hit->from_outside;
            }
            EXPECT_EQ(leaks, 0) << object << turn;
        }
}

/// Each at the ray's time: along straight lines, and turning.
TEST(RayInstances, MoveAsTheyMove) {
    const Herd herd(40);
    const V3f way(1.5f, -1, .5f);
    std::string things = "Attribute \"trace\" \"int samplemotion\" 1 " + kBallObject;
    for (const V3f& place : herd.places)
        things +=
            "AttributeBegin MotionBegin [0 1] Translate " + text(place) + "Translate " + text(place + way) +
            "MotionEnd MotionBegin [0 .5 1] Rotate 0 1 2 3 Rotate 50 1 2 3 Rotate 90 1 2 3 MotionEnd Scale " +
            text(V3f(herd.radius)) + "ObjectInstance 1 AttributeEnd ";
    const RayWorldScene scene(things, "Shutter 0 1 " + kPerspectiveView);
    EXPECT_LT(scene.world().micropolygon_count(), 30000u);
    RayNumbers number;
    int met = 0;
    for (int i = 0; i < 6000; ++i) {
        RaySegment ray = some_ray(number, herd);
        ray.time = i % 7 == 0 ? 0 : i % 7 == 1 ? 1 : number(0, 1);
        Herd now = herd;
        for (V3f& place : now.places) place += way * ray.time;
        float silhouette;
        const auto [ball, distance] = now.nearest(ray, silhouette);
        if (silhouette < .02f) continue;
        // Where a ray begins, balls may be a little smaller than they are.
        const bool begins_at_one = std::ranges::any_of(now.places, [&](const V3f& place) {
            return std::abs((ray.origin - place).length() - herd.radius) < .05f;
        });
        if (begins_at_one) continue;
        const std::optional<RaySurfaceHit> hit = scene.world().closest(ray, RayKind::Diffuse);
        ASSERT_EQ(hit.has_value(), ball >= 0) << i;
        ASSERT_EQ(scene.world().blocked(ray, RayKind::Diffuse), ball >= 0);
        if (!hit) continue;
        ++met;
        ASSERT_EQ(hit->primitive, static_cast<uint32_t>(ball)) << i;
        // Balls that turn shrink between the keys of their motion.
        ASSERT_NEAR(hit->distance, distance, .05f) << i;
    }
    EXPECT_GT(met, 1500);
}

/// What shaders see at hits is the instance's own: its space, its colour, its variables.
TEST(RayInstances, AreShadedAsTheirOwn) {
    std::string places;
    for (int i = 0; i < 16; ++i)
        places +=
            "AttributeBegin Color " + text(V3f(.1f + static_cast<float>(i) / 20, 0, 0)) + "Translate " +
            text(V3f(-.75f + .5f * static_cast<float>(i % 4), -.75f + .5f * static_cast<float>(i / 4), 3)) +
            "Rotate " + std::to_string(20 * i) + " 1 1 0 Scale .2 .2 .2 ObjectInstance 1 AttributeEnd ";
    Case c;
    c.options = "Format 64 64 1 ";
    c.shaders["own"] =
        "surface own() { point at = transform(\"object\", P);"
        "Ci = color(length(at), comp(Cs, 0), abs(length(vtransform(\"object\", normalize(N))) - 5)); Oi = 1; }";
    c.things = "Surface \"own\" " + kBallObject + places;
    // Squares of half a unit, each in front of a ball.
    const Image image = c.render(
        "vector d = vector(0, 0, -1); color own = trace(P, d);"
        "float i = floor((xcomp(P) + 1) * 2), j = floor((ycomp(P) + 1) * 2);"
        "float x = xcomp(P) + .75 - .5 * i, y = ycomp(P) + .75 - .5 * j, sure = x * x + y * y < .025 ? 1 : 0;"
        "float want = .1 + (i + 4 * j) / 20;"
        "Ci = color(1024 * max(abs(comp(own, 0) - 1), max(abs(comp(own, 1) - want), comp(own, 2))),"
        "comp(own, 1), sure);");
    expect_told(image, 8e-3f, 1000);  // flat micropolygons pass beside the balls
}

/// Instances are discs each by each, with normals on their own outsides.
TEST(RayInstances, HaveDiscsOfTheirOwn) {
    const Herd herd(30);
    const auto turned = [](size_t i) {
        return i % 3 == 1 ? std::string("ReverseOrientation ") : std::string();
    };
    const RayWorldScene scene(kBallObject + herd.with("Scale -1 1 1 ObjectInstance 1", turned),
                              kPerspectiveView);
    const std::optional<Surfels> discs = scene.world().surfels(RayKind::Diffuse, size_t{1} << 30);
    ASSERT_TRUE(discs);
    std::vector<double> area(herd.places.size());
    ShadingGrid grid;
    for (size_t i = 0; i < discs->size(); ++i) {
        const int vertex = scene.world().dice_surfel(discs->ids[i], grid);
        const V3f P = grid.P[0].at(static_cast<size_t>(vertex));
        ASSERT_LT((P - discs->positions[i]).length(), .05f);
        area[grid.primitive_index] += discs->areas[i];
        const V3f out = discs->positions[i] - herd.places[grid.primitive_index];
        ASSERT_NEAR(out.length(), herd.radius, .01f);
        const float side = grid.primitive_index % 3 == 1 ? -1.0f : 1.0f;
        ASSERT_GT(side * discs->normals[i].dot(out.normalized()), .98f);
        ASSERT_GT(side * grid.N.at(static_cast<size_t>(vertex)).dot(out), 0);
    }
    for (const double of_ball : area) EXPECT_NEAR(of_ball, 4 * 3.14159 * .25, .03);
}

}  // namespace
}  // namespace trapeze::testing
