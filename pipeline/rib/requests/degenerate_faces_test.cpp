/// Meshes with faces that are none: the rest of them is drawn.
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kPoints = "\"P\" [0 0 0 1 0 0 1 1 0 0 1 0] ";

const PolygonMesh& polygons(const ReadOutcome& r) {
    return std::get<PolygonMesh>(r.primitive().shape().topology);
}

TEST(WholeFaces, EdgesAndPointsAmongPolygonsAreLeftOut) {
    const ReadOutcome r =
        read_world("PointsPolygons [1 3 2 0 4] [0 0 1 2 1 2 0 1 2 3] " + kPoints +
                   "\"uniform float f\" [1 2 3 4 5] "
                   "\"facevarying float[2] g\" [0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19] "
                   "\"vertex float h\" [1 2 3 4] \"constant float k\" 1");
    EXPECT_THAT(
        r.messages,
        ElementsAre(HasSubstr("warning: PointsPolygons: 3 of the faces and holes have fewer than 3")));
    ASSERT_EQ(r.count(), 1u);
    EXPECT_THAT(polygons(r).loops_per_polygon, ElementsAre(1, 1));
    EXPECT_THAT(polygons(r).vertices_per_loop, ElementsAre(3, 4));
    EXPECT_THAT(polygons(r).vertices, ElementsAre(0, 1, 2, 0, 1, 2, 3));
    EXPECT_EQ(polygons(r).vertex_count, 4);
    const ParameterList& variables = r.primitive().shape().variables;
    EXPECT_THAT(variables.find("f")->floats, ElementsAre(2, 5));
    EXPECT_THAT(variables.find("g")->floats, ElementsAre(2, 3, 4, 5, 6, 7, 12, 13, 14, 15, 16, 17, 18, 19));
    EXPECT_EQ(variables.find("h")->floats.size(), 4u);
    EXPECT_EQ(r.summary.faces, 2u);
}

TEST(WholeFaces, APolygonLosesItsHoleOrWithItsOutlineAll) {
    const ReadOutcome r =
        read_world("PointsGeneralPolygons [2 2 0] [4 2 1 3] [0 1 2 3 0 1 3 0 1 2] " + kPoints +
                   "\"uniform string label\" [\"a\" \"b\" \"c\"] "
                   "\"facevarying float f\" [0 1 2 3 4 5 6 7 8 9]");
    EXPECT_EQ(r.messages.size(), 1u);
    ASSERT_EQ(r.count(), 1u);
    EXPECT_THAT(polygons(r).loops_per_polygon, ElementsAre(1));
    EXPECT_THAT(polygons(r).vertices_per_loop, ElementsAre(4));
    EXPECT_THAT(polygons(r).vertices, ElementsAre(0, 1, 2, 3));
    const ParameterList& variables = r.primitive().shape().variables;
    EXPECT_THAT(variables.find("f")->floats, ElementsAre(0, 1, 2, 3));
    EXPECT_THAT(variables.find("label")->strings, ElementsAre("a"));
    const ReadOutcome general =
        read_world("GeneralPolygon [4 2] \"P\" [0 0 0 1 0 0 1 1 0 0 1 0 .2 .2 0 .3 .3 0]");
    ASSERT_EQ(general.count(), 1u);
    EXPECT_THAT(polygons(general).vertices, ElementsAre(0, 1, 2, 3));
}

TEST(WholeFaces, FacesOfVerticesThatAreNotThereAreLeftOut) {
    const ReadOutcome r = read_world("PointsPolygons [3 3 3] [0 1 2 1 2 9 -1 0 1] " + kPoints);
    EXPECT_THAT(
        r.messages,
        ElementsAre(HasSubstr("error: PointsPolygons: vertex 9 is outside of the 4 points of \"P\"; faces")));
    ASSERT_EQ(r.count(), 1u);
    EXPECT_THAT(polygons(r).vertices, ElementsAre(0, 1, 2));
}

TEST(WholeFaces, HolesOfSubdivisionMeshesKeepTheirFaces) {
    const ReadOutcome r = read_world(
        "SubdivisionMesh \"catmull-clark\" [2 4 1 3] [0 1 0 1 2 3 2 0 2 1] [\"hole\"] [3 0] [0 1 3] [] " +
        kPoints + "\"uniform float f\" [1 2 3 4]");
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("2 of the faces and holes have fewer than 3 vertices")));
    ASSERT_EQ(r.count(), 1u);
    const auto& mesh = std::get<SubdivisionMesh>(r.primitive().shape().topology);
    EXPECT_THAT(mesh.vertices_per_face, ElementsAre(4, 3));
    EXPECT_THAT(mesh.vertices, ElementsAre(0, 1, 2, 3, 0, 2, 1));
    EXPECT_THAT(mesh.tags.at(0).ints, ElementsAre(0, 1));
    EXPECT_THAT(r.primitive().shape().variables.find("f")->floats, ElementsAre(2, 4));
}

TEST(WholeFaces, WithoutAWholeFaceThereIsNoMesh) {
    for (const char* request : {"PointsPolygons [2 1] [0 1 2] ", "SubdivisionMesh \"loop\" [2] [0 1] ",
                                "PointsGeneralPolygons [1 0] [1] [0] ", "PointsPolygons [3] [0 1 4] "}) {
        const ReadOutcome r = read_world(request + kPoints + kSphere);
        ASSERT_EQ(r.messages.size(), 1u) << request;
        EXPECT_THAT(r.messages[0], HasSubstr("error: ")) << request;
        EXPECT_THAT(r.messages[0], HasSubstr("; primitive skipped")) << request;
        EXPECT_EQ(r.count(), 1u) << request;
    }
}

}  // namespace
}  // namespace trapeze::testing
