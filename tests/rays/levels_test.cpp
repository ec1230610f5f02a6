/// Levels of the geometry that rays meet: nothing is lost, and nothing met twice, where a ray changes from
/// one to the next.
#include <gtest/gtest.h>

#include "tests/rays/ray_world_harness.h"

namespace trapeze::testing {
namespace {

/// Up to 3, of which the first is as fine as level 0 where sides are of 4 pixels.
const std::string kMoreLevels = "Option \"trace\" \"int levels\" 4 Format 2048 2048 1 ";
/// 64 x 64 pixels of the smaller picture.
const std::string kMiddle = "CropWindow .375 .625 .375 .625 ";
const std::string kFourPixels = "ShadingRate 16 ";
/// Of 8 corners at +-1.
const std::string kCube = "[4 4 4 4 4 4] [0 1 3 2 5 4 6 7 1 0 4 5 2 3 7 6 0 2 6 4 3 1 5 7] ";
const std::string kCorners = "\"P\" [-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1] ";

TEST(RayLevels, WideRaysMeetCoarseGeometryFarAway) {
    const RayWorldScene fine("Sphere 30 -30 30 360"),
        large(kFourPixels + "Sphere 30 -30 30 360", kMoreLevels);
    const auto level_at = [](const RayWorldScene& scene, float spread) {
        return scene.world().closest(ray_to(V3f(0, 0, 0), V3f(1, .3f, .2f), spread), RayKind::Diffuse)->level;
    };
    // A pixel is 1/128 here, and 21 times as wide there.
    EXPECT_EQ(level_at(fine, 0), 0);
    EXPECT_EQ(level_at(fine, .04f), 0) << "width 1.2, sides .66";
    EXPECT_EQ(level_at(fine, .05f), 1) << "width 1.5";
    EXPECT_EQ(level_at(fine, .17f), 1) << "width 5.1, sides 2.65";
    EXPECT_EQ(level_at(fine, .19f), 2) << "width 5.7";
    EXPECT_EQ(level_at(large, .01f), 0);
    EXPECT_EQ(level_at(large, .03f), 2);
    EXPECT_EQ(level_at(large, .1f), 3);
    const RayWorldScene one("Sphere 30 -30 30 360", "Format 256 256 1 ");
    EXPECT_EQ(level_at(one, 1), 0);
    EXPECT_GT(fine.world().micropolygon_count(), one.world().micropolygon_count());
    EXPECT_LT(fine.world().micropolygon_count(), one.world().micropolygon_count() * 11 / 10);
}

/// A sphere's micropolygons are nowhere farther from it than their size says.
TEST(RayLevels, AreTheSameSurface) {
    for (const bool more : {false, true}) {
        const RayWorldScene sphere((more ? kFourPixels : "") + "Sphere 30 -30 30 360",
                                   more ? kMoreLevels : kLevels);
        const float pixel = (more ? 1.0f / 1024 : 1.0f / 128) * 30 / std::sqrt(2.0f);
        RayNumbers number;
        std::array<int, 4> met{};
        for (int i = 0; i < 20000; ++i) {
            const RaySegment ray = ray_to(V3f(0, 0, 0), number.in_cube(1), number(0, .3f));
            const std::optional<RaySurfaceHit> hit = sphere.world().closest(ray, RayKind::Diffuse);
            ASSERT_TRUE(hit);
            ++met[hit->level];
            const float side = std::max(more ? 4.0f : 1.0f, level_side(hit->level)) * pixel;
            // Half of a diagonal away from where they touch it; sides are at most half as long again as
            // wished.
            ASSERT_LE(hit->distance, 30.0001f);
            ASSERT_GE(hit->distance, 30 - 2.25f * side * side / (4 * 30)) << int{hit->level};
        }
        for (const int level : more ? std::vector{0, 2, 3} : std::vector{0, 1, 2}) EXPECT_GT(met[level], 500);
    }
}

/// Towards the shared edges and corners of faces, at distances at which the level changes.
TEST(RayLevels, EdgesLetNothingThrough) {
    for (const char* faces : {"PointsPolygons ", "SubdivisionMesh \"bilinear\" "})
        for (const float scale : {1.0f, 4.0f}) {
            const std::string tags = faces[0] == 'S' ? "[] [] [] [] " : "";
            const RayWorldScene cube("Rotate 20 1 2 3 Scale " + std::to_string(scale) + ' ' +
                                     std::to_string(scale) + ' ' + std::to_string(scale) + ' ' + faces +
                                     kCube + tags + kCorners);
            M44f turn;
            turn.setAxisAngle(V3f(1, 2, 3).normalized(), 20 * 3.14159265f / 180);
            RayNumbers number;
            std::array<int, 4> met{};
            for (int i = 0; i < 100000; ++i) {
                V3f edge(number(-1, 1), i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f);
                if (i & 4) edge = V3f(edge.y, edge.x, edge.z);
                if (i & 8) edge = V3f(edge.z, edge.y, edge.x);
                if (i % 17 == 0) edge = V3f(edge.x < 0 ? -1.0f : 1.0f, edge.y < 0 ? -1.0f : 1.0f, edge.z);
                const V3f target = edge * scale * turn, from = number.in_cube(.9f * scale) * turn;
                const RaySegment ray = ray_to(from, target - from, number(0, 1) * number(0, 1));
                const std::optional<RaySurfaceHit> hit = cube.world().closest(ray, RayKind::Diffuse);
                ASSERT_TRUE(hit) << i;
                ++met[hit->level];
                ASSERT_NEAR(hit->distance, (target - from).length(), 2e-4f * scale) << i;
                ASSERT_EQ(cube.world().blocked(ray, RayKind::Diffuse), true) << i;
            }
            EXPECT_GT(met[0], 1000);
            EXPECT_GT(met[1] + met[2], 1000);
        }
}

/// A ray from within a shape of the corners +-1 towards an edge that faces share.
struct AtEdge {
    V3f from, target;
};

/// A straight edge of a cube.
AtEdge at_straight_edge(RayNumbers& number) {
    V3f edge(number(-1, 1), number(-1, 1) < 0 ? -1.0f : 1.0f, number(-1, 1) < 0 ? -1.0f : 1.0f);
    if (number(0, 1) < .06f) edge.x = edge.x < 0 ? -1.0f : 1.0f;
    const float turn = number(0, 3);
    if (turn > 1) edge = V3f(edge.y, edge.x, edge.z);
    if (turn > 2) edge = V3f(edge.z, edge.y, edge.x);
    return {number.in_cube(.9f), edge};
}

/// Of a subdivided cube, z = +-1 of which are flat within the closed curves that sharp creases are: uniform
/// b-splines of their corners.
AtEdge at_crease(RayNumbers& number) {
    const V2f corners[] = {V2f(-1, -1), V2f(1, -1), V2f(1, 1), V2f(-1, 1)};
    const int first = static_cast<int>(number(0, 3.999f));
    const float t = number(0, 1) < .06f ? 0.0f : number(0, 1), s = 1 - t;
    const float weights[] = {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                             (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
    V2f at(0, 0);
    for (int i = 0; i < 4; ++i) at += corners[(first + i) % 4] * weights[i];
    return {number.in_cube(.4f), V3f(at.x, at.y, number(-1, 1) < 0 ? -1.0f : 1.0f)};
}

/// Of a cube subdivided without creases, or with those, edges lie in the planes of equal coordinates. The ray
/// comes to them, but not where the target is.
AtEdge at_plane_of_symmetry(RayNumbers& number) {
    const float side = number(-1, 1) < 0 ? -1.0f : 1.0f, from = number(-.4f, .4f), to = number(.3f, 1);
    return {V3f(from, side * from, number(-.4f, .4f)), V3f(to, side * to, number(-.5f, .5f))};
}

/// Corners of a cube, bent by an affine map: what is made of them is bent as they are.
std::string corners_of(const M44f& map) {
    std::string text = "\"P\" [";
    for (int i = 0; i < 8; ++i) {
        const V3f P = V3f(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f) * map;
        for (int k = 0; k < 3; ++k) text += std::to_string(P[k]) + ' ';
    }
    return text + "] ";
}

/// By how much a shape leans and grows while the shutter is open.
M44f map_at(float time, float scale, bool moves) {
    M44f turn, lean;
    turn.setAxisAngle(V3f(1, 2, 3).normalized(), .35f);
    lean[0][1] = .3f, lean[2][0] = -.2f, lean[1][1] = 1.4f, lean[3][0] = .25f;
    M44f map = turn;
    if (moves) map = turn * (1 - time) + turn * lean * time;
    map = map * scale;
    map[3][3] = 1;
    return map;
}

/// Faces, and rays towards their edges.
struct EdgesOf {
    std::string faces;
    AtEdge (*at)(RayNumbers&);
    float off;  ///< the most that a ray may meet them off the target, in sides of micropolygons
};

/// 100000 rays towards edges, at any time.
void expect_edges_are_closed(const EdgesOf& edges, float scale, bool moves) {
    SCOPED_TRACE(edges.faces + std::to_string(scale) + (moves ? " moves" : ""));
    const std::string open = edges.faces + corners_of(map_at(0, scale, moves)),
                      shut = edges.faces + corners_of(map_at(1, scale, moves));
    const RayWorldScene closed(
        moves ? "Attribute \"trace\" \"int samplemotion\" 1 MotionBegin [0 1] " + open + shut + "MotionEnd "
              : open,
        "Shutter 0 1 " + kLevels);
    RayNumbers number;
    std::array<int, 4> met{};
    int leaks = 0, off = 0;
    for (int i = 0; i < 100000; ++i) {
        const AtEdge place = edges.at(number);
        const float time = moves ? number(0, 1) : 0.0f;
        M44f map = map_at(0, scale, moves) * (1 - time) + map_at(1, scale, moves) * time;
        const V3f from = place.from * map, target = place.target * map;
        RaySegment ray = ray_to(from, target - from, number(0, 1) * number(0, 1));
        ray.time = time;
        const std::optional<RaySurfaceHit> hit = closed.world().closest(ray, RayKind::Diffuse);
        leaks += !hit || closed.world().blocked(ray, RayKind::Transmission) != true;
        if (!hit) continue;
        ++met[hit->level];
        const float distance = (target - from).length(),
                    side = target.length() * std::max(1.0f, level_side(hit->level)) / 128;
        off += !(std::abs(hit->distance - distance) <= edges.off * side);
    }
    EXPECT_EQ(leaks, 0);
    EXPECT_EQ(off, 0);
    EXPECT_GT(met[0], 1000);
    EXPECT_GT(met[1] + met[2], 1000);
}

/// Curved faces, and such that move.
TEST(RayLevels, EdgesOfWhatIsCurvedOrMovesLetNothingThrough) {
    const std::string smooth = "SubdivisionMesh \"catmull-clark\" " + kCube,
                      creased = smooth + "[\"crease\" \"crease\"] [5 1 5 1] [0 1 3 2 0 4 5 7 6 4] [10 10] ";
    const EdgesOf all[] = {
        {"PointsPolygons " + kCube, at_straight_edge, .002f},
        {smooth + "[] [] [] [] ", at_plane_of_symmetry, kInfinity},
        {creased, at_plane_of_symmetry, kInfinity},
        {creased, at_crease, .05f},
    };
    for (const EdgesOf& edges : all)
        for (const float scale : {1.0f, 4.0f})
            for (const bool moves : {false, true}) expect_edges_are_closed(edges, scale, moves);
}

/// A quarter of a million rays of all widths from all over the inside of each thing.
TEST(RayLevels, ClosedThingsLetNothingThrough) {
    const std::string things[] = {
        "Sphere 1 -1 1 360 ",
        "Cylinder 1 -1 1 360 Disk 1 1 360 Disk -1 1 360 ",
        "PointsPolygons " + kCube + kCorners,
        "SubdivisionMesh \"catmull-clark\" " + kCube + "[] [] [] [] " + kCorners,
        "SubdivisionMesh \"catmull-clark\" " + kCube + "[\"crease\"] [5 1] [0 1 3 2 0] [2.5] " + kCorners,
    };
    for (const std::string& thing : things)
        for (const float scale : {1.0f, 3.0f, 25.0f})
            for (const char* rate : {"1", "20"}) {
                SCOPED_TRACE(thing + std::to_string(scale) + rate);
                const std::string size = std::to_string(scale);
                const RayWorldScene closed("ShadingRate " + std::string(rate) + " Rotate 20 1 2 3 Scale " +
                                           size + ' ' + size + ' ' + size + ' ' + thing);
                RayNumbers number;
                int leaks = 0;
                for (int i = 0; i < 9000; ++i) {
                    const V3f from = number.in_cube(.3f * scale);
                    const RaySegment ray = ray_to(from, number.in_cube(1), number(0, 1) * number(0, 2));
                    leaks += !closed.world().closest(ray, RayKind::Diffuse);
                    leaks += closed.world().blocked(ray, RayKind::Transmission) != true;
                }
                EXPECT_EQ(leaks, 0);
            }
}

/// Shells around each other dim each ray as often as there are shells, whatever its width.
TEST(RayLevels, EachSheetIsMetOnce) {
    std::string things = "Opacity .5 .5 .5 ";
    for (const char* radius : {".7", "1", "1.6", "3", "5", "9", "17"})
        things += "Sphere " + std::string(radius) + " -" + radius + ' ' + radius + " 360 ";
    const RayWorldScene shells(things);
    RayNumbers number;
    int twice = 0;
    for (int i = 0; i < 50000; ++i) {
        RaySegment ray = ray_to(number.in_cube(.35f), number.in_cube(1), number(0, 1) * number(0, 2));
        int met = 0;
        while (const std::optional<RaySurfaceHit> hit = shells.world().closest(ray, RayKind::Diffuse)) {
            ++met;
            ray.min = hit->distance * (1 + 1e-6f) + 1e-5f, ray.level = hit->level;
        }
        twice += met != 7;
    }
    EXPECT_EQ(twice, 0);
}

/// Where all is in memory, and where bricks are made for many rays at once or for each alone.
TEST(RayLevels, HitsAreTheSameBitsHoweverTheyAreAsked) {
    std::string things = "ShadingRate .5 ";
    RayNumbers place;
    for (int i = 0; i < 12; ++i) {
        const V3f at = place.in_cube(2);
        things += "AttributeBegin Translate " + std::to_string(at.x) + ' ' + std::to_string(at.y) + ' ' +
                  std::to_string(at.z) +
                  (i % 3 == 0   ? " Sides 1 "
                   : i % 3 == 1 ? " Opacity .5 .5 .5 "
                                : " ") +
                  (i % 4 == 0 ? "Attribute \"visibility\" \"int transmission\" 0 " : "") +
                  "Sphere .6 -.6 .5 360 AttributeEnd ";
    }
    for (const std::string& options : {std::string("Format 256 256 1 "), kLevels}) {
        const RayWorldScene whole(things, options), bricks(things, options, size_t{4} << 20);
        ASSERT_EQ(whole.world().rays_at_once(), 0u);
        ASSERT_GT(bricks.world().rays_at_once(), 0u);
        RayNumbers number;
        std::vector<RaySegment> rays;
        for (int i = 0; i < 3000; ++i) {
            const V3f from = number.in_cube(3);
            rays.push_back(ray_to(from, number.in_cube(2) - from, number(0, .5f)));
            if (i % 5 == 0) rays.back().max = number(0, 3);
        }
        std::vector<const RaySegment*> asked;
        for (const RaySegment& ray : rays) asked.push_back(&ray);
        for (const RayKind kind : {RayKind::Diffuse, RayKind::Transmission}) {
            std::vector<std::optional<RaySurfaceHit>> hits(rays.size()), hits_of_whole(rays.size());
            std::vector<std::optional<bool>> blocked(rays.size()), blocked_of_whole(rays.size());
            bricks.world().closest(asked, kind, hits);
            bricks.world().blocked(asked, kind, blocked);
            whole.world().closest(asked, kind, hits_of_whole);
            whole.world().blocked(asked, kind, blocked_of_whole);
            int met = 0, open = 0, unsure = 0;
            for (size_t i = 0; i < rays.size(); ++i) {
                const std::optional<RaySurfaceHit> alone = whole.world().closest(rays[i], kind);
                const std::optional<RaySurfaceHit> from_bricks = bricks.world().closest(rays[i], kind);
                for (const std::optional<RaySurfaceHit>& hit : {hits[i], hits_of_whole[i], from_bricks}) {
                    ASSERT_EQ(hit.has_value(), alone.has_value()) << i;
                    if (!hit) continue;
                    ASSERT_EQ(hit->distance, alone->distance);
                    ASSERT_EQ(hit->place.id, alone->place.id);
                    ASSERT_EQ(hit->level, alone->level);
                    ASSERT_EQ(hit->at, alone->at);
                    ASSERT_EQ(hit->from_outside, alone->from_outside);
                }
                const std::optional<bool> is_blocked = whole.world().blocked(rays[i], kind);
                ASSERT_EQ(blocked[i], is_blocked);
                ASSERT_EQ(blocked_of_whole[i], is_blocked);
                ASSERT_EQ(bricks.world().blocked(rays[i], kind), is_blocked);
                met += alone.has_value(), open += is_blocked == false, unsure += !is_blocked;
            }
            EXPECT_GT(met, 500);
            EXPECT_GT(open, 500);
            EXPECT_GT(unsure, 100);
        }
    }
}

/// A convex thing hides nothing from itself, nor from what its hits ask in turn.
TEST(RayLevels, ConvexThingsDoNotHideThemselves) {
    Case c;
    c.options = kMiddle + kLevels;
    c.asker = kSeen + "Translate 0 0 3 ";
    c.asks = "AttributeBegin Sphere 1 -1 1 360 AttributeEnd ";
    expect_told(c.render("Ci = told(occlusion(P, normalize(P - point(0, 0, 3)), 16), 0, 1);"), 0, 300);
    // Hits of wide rays lie on coarse geometry, from where their own rays go.
    for (const char* place : {"0 0 3", "0 0 -20", "0 40 30"})
        for (const char* radius : {"1", "4"}) {
            Case d;
            d.options = kMiddle + kLevels;
            d.shaders["self"] =
                "surface self() { normal n = normalize(N);"
                "if (n . (P - transform(\"middle\", \"current\", point \"current\" (0, 0, 0))) < 0) n = -n;"
                "Ci = occlusion(P, normalize(P - point \"middle\" (0, 0, 0)), 16); Oi = 1; }";
            d.things = std::string("Surface \"self\" Translate ") + place +
                       " CoordinateSystem \"middle\" Sphere " + radius + " -" + radius + ' ' + radius +
                       " 360 ";
            const std::string towards =
                std::string("point \"world\" (") + place[0] + place[1] + place[2] + ")";
            expect_told(c.render("Ci = told(0, 0, 1);"), 0, 300);
            expect_told(d.render("Ci = told(comp(indirectdiffuse(P, normal(0, 0, -1), 64), 0), 0, 1);"), 0,
                        64 * 64);
        }
}

/// A ball's mirror image of what is far away is of coarse geometry, a plane's is as fine as the picture.
TEST(RayLevels, MirrorsWidenRaysAsTheyAreCurved) {
    for (const bool curved : {false, true}) {
        Image with[2];
        for (const int levels : {0, 1}) {
            Case c;
            c.options =
                "Projection \"perspective\" \"fov\" 40 " + kMiddle + (levels ? kLevels : "Format 256 256 1 ");
            c.asker = "Translate 0 0 3 Rotate 20 1 1 0 ";
            c.asks = curved ? "AttributeBegin Sphere .3 -.3 .3 360 AttributeEnd "
                            : "Polygon \"P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] ";
            c.things = "Surface \"constant\" Sphere 9 -9 9 360 ";
            with[levels] = c.render(
                "normal n = normalize(N); vector r = reflect(normalize(I), faceforward(n, I));"
                "float d = trace(P, r); point at = P + d * r; Ci = color(1024 * (length(at) - 9), length(at), 1);");
        }
        const std::vector<Pixel> fine = pixels(with[0]), coarse = pixels(with[1]);
        int differ = 0, seen = 0;
        for (size_t i = 0; i < fine.size(); ++i) {
            if (!(fine[i].blue > 0)) continue;
            ++seen, differ += fine[i].red != coarse[i].red;
            ASSERT_NEAR(fine[i].green, 9, .02f);
            ASSERT_NEAR(coarse[i].green, 9, .3f) << "sides of 16 pixels";
        }
        EXPECT_GT(seen, 1000);
        if (curved)
            EXPECT_GT(differ, seen / 2);
        else
            EXPECT_EQ(differ, 0);
    }
}

/// Coarse geometry is as good as fine: what a hemisphere of 64 rays sees of a ball, as its form factor.
TEST(RayLevels, OcclusionOfASphereIsItsFormFactor) {
    double sum[2] = {}, expected = 0;
    for (const int levels : {0, 1}) {
        Case c;
        c.options = kMiddle + (levels ? kLevels : "Format 256 256 1 ");
        c.things = "Surface \"constant\" Sphere 12 -12 12 360 ";
        c.asker = "Translate 0 0 25 ";
        const Image image = c.render(
            "vector w = point(0, 0, 0) - P; float d = length(w);"
            "Ci = color(occlusion(P, normal(0, 0, -1), 256), 144 / (d * d) * -zcomp(normalize(w)), 1);");
        for (const Pixel& p : pixels(image)) sum[levels] += p.red, expected += p.green / 2;
    }
    EXPECT_NEAR(sum[0] / expected, 1, .002);
    EXPECT_NEAR(sum[1] / expected, 1, .002);
    EXPECT_NE(sum[0], sum[1]) << "levels are used";
}

}  // namespace
}  // namespace trapeze::testing
