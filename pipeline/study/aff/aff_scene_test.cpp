#include "pipeline/study/aff/aff_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "pipeline/study/aff/aff_harness.h"

namespace trapeze {
namespace {

using testing::AffFolder;
using testing::expect_near;

using Corners = std::vector<V3f>;

constexpr const char* kTriangle = "p 3  0 0 0  1 0 0  0 1 0\n";
const Corners kTriangleCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

void expect_corners(const Corners& found, const Corners& wanted) {
    ASSERT_EQ(found.size(), wanted.size());
    for (size_t i = 0; i < found.size(); ++i) expect_near(V3d(found[i]), V3d(wanted[i]));
}

/// Keys of a translation along x by as much as the time is, from -2 to 12.
std::string slide(const std::string& name, const std::string& more = {}) {
    std::string keys;
    for (const char* time : {"-3", "-2", "0", "5", "10", "12", "13"})
        keys += std::string(time) + " " + time + " 0 0  0 0 0\n";
    return "k " + name + " {\n transl 7\n" + keys + more + "}\n";
}

TEST(AffScene, PolygonsAreFans) {
    const AffFolder folder;
    const Corners fan = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 0, 0}, {2, 1, 0}, {0, 1, .5}};
    EXPECT_EQ(folder.scene("p 4\n0 0 0\n2 0 0\n2 1 0\n0 1 .5").triangles_at(0), fan);
    EXPECT_EQ(folder.scene("pp 4  0 0 0 9 9 9  2 0 0 9 9 9  2 1 0 9 9 9  0 1 5e-1 9 9 9").triangles_at(0),
              fan);
}

TEST(AffScene, TexturedTrianglesAreTriangles) {
    const AffFolder folder;
    const AffScene scene = folder.scene(
        "tt wood.ppm  0 0 0 .5 .5  1 0 0 .5 .5  0 1 0 .5 .5\n"
        "ttp wood.ppm  0 0 0 9 9 9 .5 .5  1 0 0 9 9 9 .5 .5  0 1 0 9 9 9 .5 .5\n");
    Corners two = kTriangleCorners;
    two.insert(two.end(), kTriangleCorners.begin(), kTriangleCorners.end());
    EXPECT_EQ(scene.triangles_at(0), two);
}

TEST(AffScene, MeshesAreTriangles) {
    const AffFolder folder;
    const std::string vertices = "m\nvertices 4  0 0 0  1 0 0  0 1 0  0 0 1\n";
    const Corners corners = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}};
    EXPECT_EQ(folder.scene(vertices + "triangles 2  1 2 3  0 3 2").triangles_at(0), corners);
    EXPECT_EQ(
        folder.scene(vertices + "normals 1 0 0 1 triangles 2  1 2 3 0 0 0  0 3 2 0 0 0").triangles_at(0),
        corners);
    EXPECT_EQ(folder.scene(vertices + "texturecoords 1 wood.ppm .5 .5 triangles 2  1 2 3 0 0 0  0 3 2 0 0 0")
                  .triangles_at(0),
              corners);
    EXPECT_EQ(folder
                  .scene(vertices + "normals 1 0 0 1 texturecoords 1 wood.ppm .5 .5\n"
                                    "triangles 2  1 2 3 0 0 0 0 0 0  0 3 2 0 0 0 0 0 0")
                  .triangles_at(0),
              corners);
}

TEST(AffScene, MovingTrianglesAreStraightBetweenTheirKeys) {
    const AffFolder folder;
    const AffScene scene = folder.scene(
        "tpa 3\n 1  0 0 0 9 9 9  1 0 0 9 9 9  0 1 0 9 9 9\n 3  0 0 2 9 9 9  1 0 4 9 9 9  0 1 0 9 9 9\n"
        " 4  8 8 8 9 9 9  8 8 8 9 9 9  8 8 8 9 9 9\n");
    for (const double before : {-1.0, 1.0}) EXPECT_EQ(scene.triangles_at(before), kTriangleCorners);
    EXPECT_EQ(scene.triangles_at(2), (Corners{{0, 0, 1}, {1, 0, 2}, {0, 1, 0}}));
    EXPECT_EQ(scene.triangles_at(3), (Corners{{0, 0, 2}, {1, 0, 4}, {0, 1, 0}}));
    EXPECT_EQ(scene.triangles_at(3.5), (Corners{{4, 4, 5}, {4.5, 4, 6}, {4, 4.5, 4}}));
    for (const double after : {4.0, 99.0}) EXPECT_EQ(scene.triangles_at(after), Corners(3, V3f(8, 8, 8)));
    EXPECT_THAT(scene.moving(), ::testing::ElementsAre(true));
    EXPECT_THAT(folder.scene("tpa 1 0  0 0 0 9 9 9  1 0 0 9 9 9  0 1 0 9 9 9").moving(),
                ::testing::ElementsAre(false));
}

TEST(AffScene, SpheresAreClosedAndConesAreOpenAtTheirEnds) {
    const AffFolder folder;
    const auto lonely_edges = [](const Corners& corners) {
        size_t lonely = 0;
        std::vector<std::pair<V3f, V3f>> edges;
        for (size_t i = 0; i < corners.size(); ++i)
            edges.emplace_back(corners[i], corners[i % 3 == 2 ? i - 2 : i + 1]);
        for (const auto& [a, b] : edges)
            if (std::ranges::count(edges, std::pair(b, a)) != 1) ++lonely;
        return lonely;
    };
    const Corners sphere = folder.scene("s 1 2 3 -2").triangles_at(0);
    EXPECT_EQ(sphere.size(), 3 * 48);
    for (const V3f& corner : sphere) EXPECT_NEAR((corner - V3f(1, 2, 3)).length(), 2, 1e-5);
    EXPECT_EQ(lonely_edges(sphere), 0);
    for (size_t i = 0; i < sphere.size(); i += 3) {
        const V3f normal = (sphere[i + 1] - sphere[i]).cross(sphere[i + 2] - sphere[i]);
        EXPECT_GT(normal.dot(sphere[i] - V3f(1, 2, 3)), 0);  // outwards, counterclockwise from outside
    }
    const Corners cone = folder.scene("c 0 0 0 2  0 3 0 1").triangles_at(0);
    EXPECT_EQ(cone.size(), 3 * 24);
    for (const V3f& corner : cone) EXPECT_NEAR(V2f(corner.x, corner.z).length(), corner.y > 1 ? 1 : 2, 1e-5);
    EXPECT_EQ(lonely_edges(cone), 2 * 12);
    for (size_t i = 0; i < cone.size(); i += 3) {
        const V3f normal = (cone[i + 1] - cone[i]).cross(cone[i + 2] - cone[i]);
        EXPECT_GT(normal.dot(cone[i] - V3f(0, 1, 0)), 0);
    }
}

TEST(AffScene, WhatHasNoPlaceIsReadOver) {
    const AffFolder folder;
    const std::string rest =
        "# a comment { p 3\nb 0 0 1 % another\nl 1 2 3\nl 1 2 3  .5 .5 .5\nla lamp 1 2 3 1 1 1\nam 1 1 1\n"
        "f 1 1 1 .5 .5 10 0 1\nfm 1 1 1 1 1 1 1 1 1  10 0 1\r\n";
    EXPECT_EQ(folder.scene(rest + kTriangle + rest).triangles_at(0), kTriangleCorners);
    EXPECT_TRUE(folder.scene(rest).triangles_at(0).empty());
}

TEST(AffScene, StaticTransformsScaleThenRotateThenTranslate) {
    const AffFolder folder;
    const AffScene scene =
        folder.scene("xs 2 3 4  0 0 1 90  10 20 30\n{" + std::string(kTriangle) + "}\n" + kTriangle);
    // (1, 0, 0) is scaled to (2, 0, 0), turned to (0, 2, 0).
    expect_corners(scene.triangles_at(0),
                   {{10, 20, 30}, {10, 22, 30}, {7, 20, 30}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    EXPECT_THAT(scene.moving(), ::testing::ElementsAre(false, false));
    const AffScene nested =
        folder.scene("xs 2 2 2  0 0 0 0  1 0 0 { xs 1 1 1  0 0 2 90  5 0 0{" + std::string(kTriangle) + "}}");
    expect_corners(nested.triangles_at(0), {{11, 0, 0}, {11, 2, 0}, {9, 0, 0}});
}

TEST(AffScene, AnimatedTransformsFollowTheirKeys) {
    const AffFolder folder;
    const AffScene scene = folder.scene(
        std::string(kTriangle) + "x box { xs 1 1 1 1 0 0 0 0 0 7 { " + kTriangle + "} }\n" + slide("other") +
        slide("box",
              "scale 4\n 0 1 2 1 0 0 0\n 1 1 2 1 0 0 0\n 9 1 2 1 0 0 0\n 10 1 2 1 0 0 0\n"
              "rot 4\n 0 0 0 1 90 0 0 0\n 1 0 0 1 90 0 0 0\n 9 0 0 1 90 0 0 0\n 10 0 0 1 90 0 0 0\n"));
    EXPECT_THAT(scene.moving(), ::testing::ElementsAre(false, true));
    for (const float time : {0.f, 2.5f, 10.f, 12.f}) {
        const Corners corners = scene.triangles_at(time);
        expect_corners({corners.begin(), corners.begin() + 3}, kTriangleCorners);
        expect_corners({corners.begin() + 3, corners.end()}, {{time, 0, 7}, {time, 1, 7}, {time - 2, 0, 7}});
    }
    expect_corners(folder.scene("x nobody { " + std::string(kTriangle) + "}").triangles_at(3),
                   kTriangleCorners);
    EXPECT_THAT(folder.scene("x nobody { " + std::string(kTriangle) + "}").moving(),
                ::testing::ElementsAre(false));
}

TEST(AffScene, OfKeyframesOfTheSameNameTheLastHold) {
    const AffFolder folder;
    const AffScene scene =
        folder.scene("k box { visibility 1 0 0 }\n x box { " + std::string(kTriangle) + "}\n" + slide("box"));
    expect_corners(scene.triangles_at(5), {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}});
}

TEST(AffScene, InvisibleThingsAreWhereTheyWereAtTheNearestVisibleTime) {
    const AffFolder folder;
    const std::string tpa =
        "tpa 2 0  0 0 0 9 9 9  1 0 0 9 9 9  0 1 0 9 9 9\n 10  0 0 10 9 9 9  1 0 0 9 9 9  0 1 0 9 9 9\n";
    const AffScene scene =
        folder.scene("x outer { x inner { " + tpa + "} " + kTriangle + "}\n" +
                     slide("outer", "visibility 2  8 0  9 1\n") + "k inner { visibility 2  2 0  6 1 }");
    const auto places = [&](double time) {
        const Corners corners = scene.triangles_at(time);
        return std::pair(corners[0], corners[3]);
    };
    const auto expect = [&](double time, double inner, double outer) {
        const auto& [found_inner, found_outer] = places(time);
        const double z = std::clamp(inner, 0.0, 10.0);
        expect_near(V3d(found_inner), V3d(inner, 0, z));
        expect_near(V3d(found_outer), V3d(outer, 0, 0));
    };
    expect(1, 1, 1);
    expect(3, 2, 3);
    expect(5, 6, 5);
    expect(7, 7, 7);
    expect(8.25, 8, 8);
    expect(8.75, 9, 9);
    expect(11, 11, 11);
}

TEST(AffScene, IncludesAreRelativeToTheirFileAndUpToTheLevelOfDetail) {
    const AffFolder folder;
    std::filesystem::create_directory(folder.file("parts"));
    folder.write("parts/a.aff", "i 0 b.aff");
    folder.write("parts/b.aff", kTriangle);
    const std::string twice = "xs 1 1 1 0 0 0 0 0 0 5 { i 0 parts/a.aff }\ni 1 parts/b.aff i 2 missing.aff\n";
    expect_corners(folder.scene(twice).triangles_at(0), {{0, 0, 5}, {1, 0, 5}, {0, 1, 5}});
    EXPECT_EQ(folder.scene("d 1 " + twice).triangles_at(0).size(), 6);
}

TEST(AffScene, HasTimesAndACamera) {
    const AffFolder folder;
    const std::string view = "v from 1 2 3\nat 4 5 6\nup 0 0 1\nangle 40\nhither 0.01\nresolution 320 200\n";
    const AffScene scene = folder.scene(view + "a -1.5 20 800\n");
    EXPECT_EQ(scene.first_time(), -1.5);
    EXPECT_EQ(scene.last_time(), 20);
    EXPECT_EQ(scene.frame_count(), 800);
    const AffCamera camera = scene.camera_at(7);
    EXPECT_EQ(camera.from, V3f(1, 2, 3));
    EXPECT_EQ(camera.at, V3f(4, 5, 6));
    EXPECT_EQ(camera.up, V3f(0, 0, 1));
    EXPECT_EQ(camera.angle, 40);
    EXPECT_EQ(camera.hither, .01f);
    EXPECT_EQ(camera.width, 320);
    EXPECT_EQ(camera.height, 200);
    EXPECT_EQ(
        folder.scene("v from 1 2 3 at 4 5 6 up 0 0 1 angle 4 hither 0 resolution 3 2").camera_at(0).hither,
        1);
    // Moved alone, it looks into the same direction.
    const AffScene moved = folder.scene(view + slide("camera"));
    expect_near(V3d(moved.camera_at(5).from), V3d(5, 0, 0));
    expect_near(V3d(moved.camera_at(5).at), V3d(8, 3, 3));
    // By 90 degrees about y, the negative z-axis is turned to the negative x-axis.
    const AffCamera turned =
        folder
            .scene(view + slide("camera",
                                "rot 4\n0 0 1 0 90 0 0 0\n1 0 1 0 90 0 0 0\n2 0 1 0 90 0 0 0\n"
                                "3 0 1 0 90 0 0 0\n"))
            .camera_at(5);
    expect_near(V3d(turned.at), V3d(4, 0, 0));
    expect_near(V3d(turned.up), V3d(0, 1, 0));
}

TEST(AffScene, CornersAreFiniteWhateverTheScales) {
    const AffFolder folder;
    std::string text;
    for (int i = 0; i < 60; ++i) text += "xs 1e18 1e18 -1e18 0 0 1 45 1e18 1 1 {";
    text += "p 3  1e18 0 0  0 1e18 0  0 0 1";
    for (int i = 0; i < 60; ++i) text += "}";
    EXPECT_EQ(folder.scene(text).triangles_at(0), Corners(3, V3f(0, 0, 0)));
}

}  // namespace
}  // namespace trapeze
