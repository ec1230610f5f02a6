/// Closed rooms that we are in, seen by the rays that their own walls send: nothing of what is outside comes
/// in, also while they move.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

const std::string kStands, kGoes = "MotionBegin [0 1] Translate 0 0 0 Translate .3 .2 .1 MotionEnd ",
                           kRoomTurns = "MotionBegin [0 1] Rotate 0 1 2 3 Rotate 30 1 2 3 MotionEnd ";

/// The box, its corners moved by a matrix.
std::string box(const M44f& moved) {
    std::string corners;
    for (int i = 0; i < 8; ++i) {
        const V3f corner = V3f(i & 1 ? 2 : -2, i & 2 ? 2 : -2, i & 4 ? 2 : -2) * moved;
        for (int k = 0; k < 3; ++k) corners += std::to_string(corner[k]) + " ";
    }
    return "PointsPolygons [4 4 4 4 4 4] [0 1 3 2 5 4 6 7 1 0 4 5 2 3 7 6 0 2 6 4 3 1 5 7] \"P\" [" +
           corners + "] ";
}

/// Boxes that deform: into a leaning one, and into one that has turned by half a radian.
std::string leaning_box() {
    return "MotionBegin [0 1] " + box(M44f()) +
           box(M44f(1, 0, 0, 0, .2f, 1, 0, 0, 0, .15f, 1, 0, 0, 0, 0, 1)) + "MotionEnd ";
}
std::string turning_box() {
    M44f turn;
    turn.rotate(V3f(0, 0, .5f));
    return "MotionBegin [0 1] " + box(M44f()) + box(turn) + "MotionEnd ";
}

/// The mean of a picture from within a box of 4 by 4 by 4, all of whose walls have a shader s(). `before`:
/// requests.
double mean_of_room(const std::string& shaders, const std::string& before, const std::string& camera = "",
                    const std::string& room = box(M44f())) {
    const WorkFolder folder;
    const size_t light = shaders.find("light l("), bumps = shaders.find("displacement bumps(");
    folder.write("s.sl", shaders.substr(0, std::min(light, bumps)));
    if (bumps != shaders.npos) folder.write("bumps.sl", shaders.substr(bumps, light - bumps));
    if (light != shaders.npos) folder.write("l.sl", shaders.substr(light));
    folder.write(
        "a.rib",
        "Format 64 64 1 PixelSamples 1 1 PixelFilter \"box\" 1 1 Projection \"perspective\" \"fov\" 70\n"
        "Shutter 0 1 " +
            camera +
            " WorldBegin ShadingInterpolation \"smooth\"\n"
            "Attribute \"visibility\" \"int diffuse\" 1 \"int transmission\" 1\n"
            "Attribute \"trace\" \"int samplemotion\" 1\n" +
            before + "Surface \"s\" Translate 0 0 1 Rotate 30 1 2 0 " + room + "\nWorldEnd\n");
    const auto frames = render_scene((folder / "a.rib").string(), RenderSettings());
    double sum = 0;
    for (size_t i = 0; !frames.empty() && i < frames.front().image.rgba.size(); i += 4)
        sum += frames.front().image.rgba[i];
    return sum / (64 * 64);
}

/// All that the walls see is walls.
TEST(Rooms, WallsSeeNothingButWalls) {
    const std::string source =
        "surface s() { normal n = faceforward(normalize(N), I); Ci = 1 - occlusion(P, n, 16); Oi = 1; }";
    for (const std::string& motion : {kStands, kGoes, kRoomTurns})
        for (const std::string& camera : {kStands, kRoomTurns})
            EXPECT_LT(mean_of_room(source, motion, camera), 3e-4) << motion << camera;
    for (const std::string& room : {leaning_box(), turning_box()})
        for (const std::string& motion : {kStands, kRoomTurns})
            EXPECT_LT(mean_of_room(source, motion, kStands, room), 3e-4) << motion << room;
}

/// Rooms of two primitives that meet in circles, with sharp creases.
const std::string kConeRoom = "Rotate -70 1 0 0 Translate 0 0 -1 Cone 4 2.5 360 Disk 0 2.5 360 ";
const std::string kDrumRoom = "Rotate 60 1 0 0 Cylinder 1.5 -2 2 360 Disk 2 1.5 360 Disk -2 1.5 360 ";

/// Smooth walls of some pixels' sides: rays along them come back to them.
TEST(Rooms, RoundWallsSeeNothingButWalls) {
    const std::string source =
        "surface s() { normal n = faceforward(normalize(N), I); Ci = 1 - occlusion(P, n, 64); Oi = 1; }";
    const std::string creased =
        "SubdivisionMesh \"catmull-clark\" [4 4 4 4 4 4] [0 1 3 2 5 4 6 7 1 0 4 5 2 3 7 6 0 2 6 4 3 1 5 7] "
        "[\"crease\"] [5 1] [0 1 3 2 0] [2.5] \"P\" [-2 -2 -2 2 -2 -2 -2 2 -2 2 2 -2 -2 -2 2 2 -2 2 -2 2 2 2 2 2] ";
    for (const char* rate : {"ShadingRate 1 ", "ShadingRate 25 ", "ShadingRate 100 "}) {
        EXPECT_EQ(mean_of_room(source, rate, "", "Sphere 2 -2 2 360 "), 0) << rate;
        EXPECT_LT(mean_of_room(source, rate, "", creased), 3e-5) << rate;
        EXPECT_LT(mean_of_room(source, rate, "", "Translate 3 0 0 Torus 3 2 0 360 360 "), 3e-5) << rate;
        // Their micropolygons do not end in one line.
        EXPECT_LT(mean_of_room(source, rate, "", kConeRoom), 1e-4) << rate;
        EXPECT_LT(mean_of_room(source, rate, "", kDrumRoom), 1e-4) << rate;
    }
}

/// The box with walls of so many squares along each side, each of two triangles; walls share vertices at the
/// creases.
std::string box_of_triangles(int along) {
    std::map<std::array<int, 3>, int> numbers;
    std::string faces, corners, points;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [found, is_new] = numbers.try_emplace(at, static_cast<int>(numbers.size()));
        for (int k = 0; is_new && k < 3; ++k) points += fmt::format("{} ", 4.0 * at[k] / along - 2);
        return found->second;
    };
    for (int wall = 0; wall < 6; ++wall)
        for (int i = 0; i < along; ++i)
            for (int j = 0; j < along; ++j) {
                std::array<int, 4> square;  // going round
                for (int c = 0; c < 4; ++c) {
                    std::array<int, 3> at;
                    at[wall / 2] = wall % 2 == 0 ? 0 : along;
                    at[(wall / 2 + 1) % 3] = i + (c == 1 || c == 2 ? 1 : 0);
                    at[(wall / 2 + 2) % 3] = j + (c >= 2 ? 1 : 0);
                    square[c] = vertex(at);
                }
                faces += "3 3 ";
                corners += fmt::format("{} {} {} {} {} {} ", square[0], square[1], square[2], square[0],
                                       square[2], square[3]);
            }
    return "PointsPolygons [" + faces + "] [" + corners + "] \"P\" [" + points + "] ";
}

/// Who asks how far it is alone is told of walls, too.
TEST(Rooms, DistancesAreThoseOfWalls) {
    const std::string source =
        "surface s() { normal n = faceforward(normalize(N), I); float far = 0, d = 0;"
        "if (trace(P, reflect(I, n)) > 9) far += .5;"
        "gather(\"illuminance\", P, reflect(I, n), 0, 1, \"ray:length\", d) { if (d > 9) far += .5; } else { far += .5; }"
        "Ci = far; Oi = 1; }";
    const std::string seen = "Attribute \"visibility\" \"int specular\" 1 ";
    for (const std::string& room : {box(M44f()), std::string("Sphere 2 -2 2 360 "), box_of_triangles(5)})
        EXPECT_LT(mean_of_room(source, seen, "", room), 3e-5) << room;
}

/// Triangles of about a micropolygon: many of their grids' vertices are in one place. Of 16 rays one may go
/// along a crease; half of all did from vertices that were not moved away from it, .0016 and more of the sky.
TEST(Rooms, WallsOfSmallTrianglesSeeNothingButWalls) {
    const std::string source =
        "surface s() { normal n = faceforward(normalize(N), I); Ci = 1 - occlusion(P, n, 16); Oi = 1; }";
    for (const int along : {5, 10, 24})
        for (const char* rate : {"ShadingRate 10 ", "ShadingRate 100 "})
            EXPECT_LT(mean_of_room(source, rate, "", box_of_triangles(along)), 1e-3) << along << ' ' << rate;
}

/// Lights all around outside, each 1: at the creases the walls are thinner than a pixel.
TEST(Rooms, LightsOutsideDoNotShineIn) {
    const std::string lights =
        "LightSource \"l\" 1 \"from\" [0 0 9] LightSource \"l\" 2 \"from\" [9 4 3] LightSource \"l\" 3 \"from\" [-7 -7 2] ";
    for (const std::string ends : {"Ps, from", "from, Ps"}) {
        const std::string source =
            "surface s() { normal n = faceforward(normalize(N), I); Ci = 0; Oi = 1; illuminance(P, n, PI / 2) Ci += Cl; }\n"
            "light l(point from = 0;) { illuminate(from) Cl = transmission(" +
            ends + "); }";
        for (const std::string& motion : {kStands, kGoes, kRoomTurns})
            EXPECT_LT(mean_of_room(source, motion + lights), 4e-3) << ends << ' ' << motion;
        for (const std::string& room : {leaning_box(), turning_box()})
            EXPECT_LT(mean_of_room(source, lights, "", room), 4e-3) << ends << ' ' << room;
    }
}

/// Closed walls with bumps of up to .1, as rough as their pixels: a sphere, and a box with creases that may
/// deform.
std::string bumpy_ball(double bumps) {
    return "Displacement \"bumps\" \"bumps\" " + std::to_string(bumps) + " Sphere 2 -2 2 360 ";
}
std::string bumpy_mesh(const std::string& corners) {
    return "SubdivisionMesh \"catmull-clark\" [4 4 4 4 4 4] [0 1 3 2 5 4 6 7 1 0 4 5 2 3 7 6 0 2 6 4 3 1 5 7] "
           "[\"crease\" \"crease\" \"corner\"] [5 1 3 1 1 1] [0 1 3 2 0 5 7 6 4] [2.5 1.2 2] \"P\" [" +
           corners + "] ";
}
std::string displaced_room(const std::string& room) {
    return "Attribute \"trace\" \"int displacements\" 1 Attribute \"displacementbound\" \"sphere\" [.2] " +
           room;
}
std::vector<std::string> displaced_rooms() {
    const std::string mesh = bumpy_mesh(
        "-2.5 -2.5 -2.5 2.5 -2.5 -2.5 -2.5 2.5 -2.5 2.5 2.5 -2.5 -2.5 -2.5 2.5 2.5 -2.5 2.5 -2.5 2.5 2.5 2.5 2.5 2.5");
    const std::string other = bumpy_mesh(
        "-2.2 -2.7 -2.5 2.9 -2.5 -2.5 -2.5 2.5 -2.5 2.5 2.9 -2.5 -2.5 -2.5 2.9 2.5 -2.5 2.2 -2.2 2.5 2.9 2.5 2.5 2.5");
    std::vector<std::string> rooms;
    for (const double bumps : {0, 8}) rooms.push_back(displaced_room(bumpy_ball(bumps)));
    rooms.push_back(displaced_room("Displacement \"bumps\" " + mesh));
    rooms.push_back(
        displaced_room("Displacement \"bumps\" MotionBegin [0 1] " + mesh + other + "MotionEnd "));
    rooms.push_back("MotionBegin [0 1] " + mesh + other + "MotionEnd ");
    return rooms;
}
const std::string kBumps =
    "\ndisplacement bumps(float bumps = 4;) {"
    "  P += .2 * (noise(bumps * transform(\"object\", P)) - .5) * normalize(N); N = calculatenormal(P); }";

/// Rays begin on what they meet: none of a million is lost.
TEST(Rooms, DisplacedWallsSeeNothingButWalls) {
    const std::string source =
        "surface s() { normal n = faceforward(normalize(N), I); Ci = 1 - occlusion(P, n, 16); Oi = 1; }" +
        kBumps;
    for (const std::string& room : displaced_rooms())
        for (const std::string& motion : {kStands, kRoomTurns})
            EXPECT_EQ(mean_of_room(source, motion, kStands, room), 0) << motion << room;
}

TEST(Rooms, LightsOutsideDoNotShineThroughDisplacedWalls) {
    const std::string lights =
        "LightSource \"l\" 1 \"from\" [0 0 9] LightSource \"l\" 2 \"from\" [9 4 3] LightSource \"l\" 3 \"from\" [-7 -7 2] ";
    for (const std::string ends : {"Ps, from", "from, Ps"}) {
        const std::string source =
            "surface s() { normal n = faceforward(normalize(N), I); Ci = 0; Oi = 1; illuminance(P, n, PI / 2) Ci += Cl; }" +
            kBumps + "\nlight l(point from = 0;) { illuminate(from) Cl = transmission(" + ends + "); }";
        for (const std::string& room : displaced_rooms())
            for (const std::string& motion : {kStands, kRoomTurns})
                EXPECT_EQ(mean_of_room(source, motion + lights, kStands, room), 0) << ends << motion << room;
    }
}

/// A sheet that turns over before a lamp has its light on one side for half of the time, and on the other for
/// the rest. What light shines through does not hide itself wholly, nor does what no ray meets.
TEST(Rooms, SheetsThatTurnOverHideThemselvesByTheirOpacity) {
    const auto lit = [](const std::string& attributes, const std::string& light) {
        const WorkFolder folder;
        folder.write("s.sl", "surface s() { Ci = 0; Oi = 1; illuminance(P, N, PI) Ci += Cl; }");
        folder.write("l.sl", light);
        folder.write(
            "a.rib",
            "Format 16 16 1 PixelSamples 4 4 PixelFilter \"box\" 1 1 Projection \"orthographic\" Shutter 0 1\n"
            "WorldBegin ShadingInterpolation \"smooth\" LightSource \"l\" 1\n"
            "Attribute \"trace\" \"int samplemotion\" 1 " +
                attributes +
                "Translate 0 0 5 MotionBegin [0 1] Rotate 0 0 1 0 Rotate 180 0 1 0 MotionEnd Surface \"s\"\n"
                "Polygon \"P\" [-.9 -1 0 -.9 1 0 .9 1 0 .9 -1 0]\nWorldEnd\n");
        const auto frames = render_scene((folder / "a.rib").string(), RenderSettings());
        const size_t middle = 4 * (8 * 16 + 8);
        if (frames.empty() || !(frames.front().image.rgba[middle + 3] > 0)) return -1.0f;
        return frames.front().image.rgba[middle] / frames.front().image.rgba[middle + 3];
    };
    const std::string met = "Attribute \"visibility\" \"int transmission\" 1 ";
    for (
        const std::string light :
        {"light l() { point from = point \"world\" (0, 0, -9); illuminate(from) Cl = transmission(Ps, from, \"samples\", 64); }",
         "light l() { point from = point \"world\" (0, 0, -9); illuminate(from) Cl = transmission(from, Ps, \"samples\", 64); }",
         "light l() { solar(vector \"world\" (0, 0, 1), 0) Cl = 1 - shadow(\"raytrace\", Ps, \"samples\", 64); }"}) {
        EXPECT_NEAR(lit(met, light), .5f, .04f) << light;
        EXPECT_NEAR(lit(met + "Opacity .5 .5 .5 ", light), .75f, .04f) << light;
        EXPECT_NEAR(lit("", light), 1, 1e-3f) << light;
    }
}

}  // namespace
}  // namespace trapeze::testing
