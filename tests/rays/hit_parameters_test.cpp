/// u, v, s and t where rays hit: what the surface says there, also on the borders of grids and faces.
#include <gtest/gtest.h>

#include "tests/rays/every_micropolygon_harness.h"
#include "tests/rays/herd_harness.h"

namespace trapeze::testing {
namespace {

/// Points of a net of 3 x 3, u first: bent, and none of its four faces is flat.
constexpr float kNet[9][3] = {{-1, -1, 0},      {.1f, -1.1f, .3f}, {1.1f, -.9f, -.2f},
                              {-.9f, .1f, .4f}, {0, 0, -.1f},      {1, -.1f, .3f},
                              {-1.1f, 1, -.3f}, {-.1f, .9f, .2f},  {.9f, 1.1f, 0}};

V3f net_point(int i, int j) {
    const float* const P = kNet[3 * j + i];
    return {P[0], P[1], P[2]};
}

V3f bilinear(const V3f& p00, const V3f& p10, const V3f& p01, const V3f& p11, float u, float v) {
    return (p00 * (1 - u) + p10 * u) * (1 - v) + (p01 * (1 - u) + p11 * u) * v;
}

/// Of the whole net.
V3f place_on_net(float s, float t) {
    const int i = s < .5f ? 0 : 1, j = t < .5f ? 0 : 1;
    return bilinear(net_point(i, j), net_point(i + 1, j), net_point(i, j + 1), net_point(i + 1, j + 1),
                    2 * s - static_cast<float>(i), 2 * t - static_cast<float>(j));
}

V3f place_on_plane(float s, float t) {
    return {2 * s - 1, 1.8f * t - 1, .5f * s + .25f * t};
}

/// A surface by its parameters, from 0 to 1.
using Place = V3f (*)(float, float);

/// A surface's points at the corners of 2 x 2 faces, with their s and t.
std::string points_of(Place place) {
    std::string points = "\"P\" [", st = "\"st\" [";
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
            points += text(place(.5f * static_cast<float>(i), .5f * static_cast<float>(j)));
            st += std::to_string(i * .5) + ' ' + std::to_string(j * .5) + ' ';
        }
    return points + "] " + st + "] ";
}

/// Meets a surface on the borders of its grids, and within some roundings beside these, from all around. What
/// is told is the place of the point that is shaded, and where the ray came, within a hundredth of a
/// micropolygon's side, though vertices of a border lie on those of a coarser neighbour. Corners of grids may
/// lie on a point that is not of their face: a `share` of the rays is told within a micropolygon.
void expect_told_is_the_place(const std::string& things, bool by_st, Place place, double share) {
    SCOPED_TRACE(things);
    constexpr float kSide = 1.0f / 32;
    const RayWorldScene scene(things, "Format 64 64 1 ");
    const EveryMicropolygon all(scene);
    RayNumbers number;
    ShadingGrid grid;
    int met = 0, off = 0;
    for (int i = 0; i < 5000; ++i) {  // of flat faces many borders are the rim
        V3f target = all.some_border(number, 0);
        for (int k = 0; k < 3; ++k)
            for (int away = static_cast<int>(number(-2.99f, 2.99f)); away != 0; away -= away < 0 ? -1 : 1)
                target[k] = std::nextafter(target[k], away < 0 ? -kInfinity : kInfinity);
        const V3f from = target + number.in_cube(1).normalized() * number(.5f, 3);
        const RaySegment ray = ray_to(from, target - from, 0);
        const std::optional<RaySurfaceHit> hit = scene.world().closest(ray, RayKind::Diffuse);
        if (!hit) continue;  // at the rim
        ++met;
        const auto vertex = static_cast<size_t>(scene.world().dice(*hit, grid));
        const V3f told =
            by_st ? place(grid.s[vertex], grid.t[vertex]) : place(grid.u[vertex], grid.v[vertex]);
        const float away = (told - (from + ray.direction * hit->distance)).length();
        ASSERT_LT(away, kSide) << told;
        ASSERT_LT((grid.P[0].at(vertex) - told).length(), kSide / 1000) << told;
        off += away > kSide / 100;
    }
    EXPECT_GT(met, 3000);
    EXPECT_LE(off, share * met);
}

TEST(HitParameters, AreThoseOfABilinearPatchOnTheBordersOfGrids) {
    const std::string patch = "Patch \"bilinear\" \"P\" [" + text(net_point(0, 0)) + text(net_point(2, 0)) +
                              text(net_point(0, 2)) + text(net_point(2, 2)) + "] ";
    for (const bool by_st : {false, true})  // without other wishes they are the same
        expect_told_is_the_place(
            patch, by_st,
            [](float u, float v) {
                return bilinear(net_point(0, 0), net_point(2, 0), net_point(0, 2), net_point(2, 2), u, v);
            },
            .003);
}

TEST(HitParameters, AreThoseOfTheMeshOnTheBordersOfFaces) {
    const std::string faces = "[4 4 4 4] [0 1 4 3 1 2 5 4 3 4 7 6 4 5 8 7] ";
    for (const Place place : {place_on_net, place_on_plane}) {
        const std::string mesh =
            "PatchMesh \"bilinear\" 3 \"nonperiodic\" 3 \"nonperiodic\" " + points_of(place);
        expect_told_is_the_place(mesh, true, place, .003);
        expect_told_is_the_place(mesh, false, place, .003);  // they run over the whole mesh
        expect_told_is_the_place("SubdivisionMesh \"bilinear\" " + faces + "[] [] [] [] " + points_of(place),
                                 true, place, .003);
    }
    // Of faces that are not flat nobody says how they are filled.
    expect_told_is_the_place("PointsPolygons " + faces + points_of(place_on_plane), true, place_on_plane,
                             .003);
}

/// What shaders are told along lines that lie on the borders of micropolygons: sides are a pixel's, a 32nd.
TEST(HitParameters, AreToldToShadersAsTheyAre) {
    // x = (2 u - 1) (5 - 2 v) / 4, y = 1 - 2 v, and z bends.
    const std::string patch = "Patch \"bilinear\" \"P\" [-1.25 1 0 1.25 1 1 -.75 -1 1.5 .75 -1 .5] ";
    const std::string borders =
        "float x = round(32 * xcomp(P)) / 32, y = round(32 * ycomp(P)) / 32;"
        "float v0 = (1 - y) / 2, u0 = (4 * x / (5 - 2 * v0) + 1) / 2;"
        "float sure = u0 > 0 && u0 < 1 && v0 > 0 && v0 < 1 ? 1 : 0; point from = point(x, y, 5);";
    constexpr float kSide = 1.0f / 64;  // in u and v, about
    Case told;
    told.things = "Surface \"constant\" " + patch;
    expect_told(told.render(borders + "float a = -1, b = -1;"
                                      "gather(\"\", from, vector(0, 0, -1), 0, 1, \"primitive:u\", a,"
                                      "  \"primitive:t\", b) {}"
                                      "Ci = told(max(abs(a - u0), abs(b - v0)), 0, sure);"),
                kSide / 20, 3000, kSide);
    Case shaded;
    shaded.shaders["parameters"] = "surface parameters() { Ci = color(u, v, s - u + t - v); Oi = 1; }";
    shaded.things = "Surface \"parameters\" " + patch;
    expect_told(shaded.render(borders + "color c = trace(from, vector(0, 0, -1));"
                                        "Ci = told(max(abs(comp(c, 0) - u0), abs(comp(c, 1) - v0)) +"
                                        "  abs(comp(c, 2)), 0, sure);"),
                kSide / 20, 3000, kSide);
}

}  // namespace
}  // namespace trapeze::testing
