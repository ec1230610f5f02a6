/// Every primitive, valid and with arrays of the wrong lengths.
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kQuad = "\"P\" [0 0 0 1 0 0 1 1 0 0 1 0] ";

std::string some_points(int count) {
    std::string text = "\"P\" [";
    for (int i = 0; i < count; ++i) text += std::to_string(i) + " 0 0 ";
    return text + "] ";
}

TEST(ReadGeometry, QuadricsTakeTheirNumbers) {
    const ReadOutcome r = read_world(
        "Sphere 1 -1 1 360 Cone 2 1 180 Cylinder [1 -1 1 90] Hyperboloid 1 0 0 1 0 1 360 "
        "Hyperboloid [1 0 0] [1 0 1] 360 Paraboloid 1 0 1 360 Disk 0 1 360 "
        "Torus 2 .5 0 360 270 \"Cs\" [1 0 0 0 1 0 0 0 1 1 1 1] \"uniform float k\" 3");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 8u);
    const int counts[] = {4, 3, 4, 7, 7, 4, 3, 5};
    for (size_t i = 0; i < 8; ++i)
        EXPECT_EQ(std::get<Quadric>(r.primitive(i).shape().topology).value_count, counts[i]);
    EXPECT_EQ(std::get<Quadric>(r.primitive(7).shape().topology).theta_max(), 270);
    EXPECT_EQ(r.primitive(7).shape().variables.find("Cs")->floats.size(), 12u);
}

TEST(ReadGeometry, PolygonsOfEveryKind) {
    const ReadOutcome r = read_world("Polygon " + kQuad + "GeneralPolygon [4 3] " + some_points(7) +
                                     "PointsPolygons [3 3] [0 1 2 0 2 3] " + kQuad +
                                     "\"uniform color c\" [1 0 0 0 1 0] "
                                     "\"facevarying float f\" [1 2 3 4 5 6] \"constant float k\" [1] "
                                     "PointsGeneralPolygons [2 1] [4 3 3] [0 1 2 3 4 5 6 0 1 2] " +
                                     some_points(7));
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 4u);
    const auto& general = std::get<PolygonMesh>(r.primitive(1).shape().topology);
    EXPECT_THAT(general.loops_per_polygon, ElementsAre(2));
    EXPECT_THAT(general.vertices, ElementsAre(0, 1, 2, 3, 4, 5, 6));
    EXPECT_EQ(r.primitive(2).shape().variables.values.size(), 4u);
    EXPECT_THAT(std::get<PolygonMesh>(r.primitive(3).shape().topology).loops_per_polygon, ElementsAre(2, 1));
    EXPECT_EQ(r.summary.faces, 6u);
    EXPECT_EQ(r.summary.points, 4u + 7 + 4 + 7);
}

TEST(ReadGeometry, SubdivisionMeshesAndTheFormsOfTags) {
    const std::string mesh = "[4] [0 1 2 3] ";
    const ReadOutcome r = read_world(
        "SubdivisionMesh \"catmull-clark\" " + mesh + kQuad + "SubdivisionMesh \"bilinear\" " + mesh +
        "[\"interpolateboundary\"] [0 0] [] [] " + kQuad + "SubdivisionMesh \"catmull-clark\" " + mesh +
        "[\"crease\" \"corner\" \"hole\"] [3 1 1 1 1 0] [0 1 2 3 0] [2 4] " + kQuad +
        "SubdivisionMesh \"catmull-clark\" " + mesh +
        "[\"creasemethod\" \"interpolateboundary\"] [0 0 1 1 0 0] "
        "[2] [] [\"chaikin\"] " +
        kQuad + "SubdivisionMesh \"loop\" [3] [0 1 2] [] [] [] [] " + some_points(3));
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 5u);
    const auto tags = [&](size_t i) {
        return std::get<SubdivisionMesh>(r.primitive(i).shape().topology).tags;
    };
    EXPECT_TRUE(tags(0).empty());
    EXPECT_EQ(tags(1)[0].name, "interpolateboundary");
    EXPECT_THAT(tags(2)[0].ints, ElementsAre(0, 1, 2));
    EXPECT_THAT(tags(2)[1].floats, ElementsAre(4));
    EXPECT_THAT(tags(2)[2].ints, ElementsAre(0));
    EXPECT_THAT(tags(3)[0].strings, ElementsAre("chaikin"));
    EXPECT_THAT(tags(3)[1].ints, ElementsAre(2));
}

TEST(ReadGeometry, PatchesOfEveryBasisStepAndWrap) {
    const std::pair<const char*, int> bases[] = {{"bezier", 3},      {"b-spline", 1}, {"bspline", 1},
                                                 {"catmull-rom", 1}, {"hermite", 2},  {"power", 4}};
    for (const auto& [name, step] : bases) {
        const std::string basis = std::string("Basis \"") + name + "\" " + std::to_string(step) + " \"" +
                                  name + "\" " + std::to_string(step) + " ";
        const int nu = 4 + 2 * step, nv = 4 * step;  // three patches along u, four round v
        const ReadOutcome r =
            read_world(basis + "Patch \"bicubic\" " + some_points(16) + "PatchMesh \"bicubic\" " +
                       std::to_string(nu) + " \"nonperiodic\" " + std::to_string(nv) + " \"periodic\" " +
                       some_points(nu * nv) + "\"varying float a\" [" +
                       [] {
                           std::string zeros;
                           for (int i = 0; i < 16; ++i) zeros += "0 ";
                           return zeros;
                       }() +
                       "] \"uniform float b\" [1 2 3 4 5 6 7 8 9 10 11 12]");
        EXPECT_THAT(r.messages, IsEmpty()) << name;
        ASSERT_EQ(r.count(), 2u) << name;
        const auto& mesh = std::get<PatchMesh>(r.primitive(1).shape().topology);
        EXPECT_EQ(mesh.patches_u(), 3);
        EXPECT_EQ(mesh.patches_v(), 4);
        EXPECT_TRUE(mesh.v_wraps && !mesh.u_wraps);
        EXPECT_EQ(mesh.u_step, step);
        // Weights sum to one, except where control points are tangents or coefficients.
        if (std::string_view(name) == "hermite" || std::string_view(name) == "power") continue;
        for (int i = 0; i < 4; ++i) {
            const auto* row = mesh.u_basis[i];
            EXPECT_NEAR(row[0] + row[1] + row[2] + row[3], i == 3, 1e-6) << name;
        }
    }
}

TEST(ReadGeometry, BilinearMeshesAndBasesOfOnesOwn) {
    const ReadOutcome r =
        read_world("PatchMesh \"bilinear\" 3 \"periodic\" 2 \"nonperiodic\" " + some_points(6) +
                   "Basis [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1] 2 \"bezier\" 3 Patch \"bicubic\" " +
                   some_points(16) + "Patch \"bilinear\" " + some_points(4));
    EXPECT_THAT(r.messages, IsEmpty());
    EXPECT_EQ(std::get<PatchMesh>(r.primitive(0).shape().topology).patches_u(), 3);
    const auto& patch = std::get<PatchMesh>(r.primitive(1).shape().topology);
    EXPECT_EQ(patch.u_basis, M44f());
    EXPECT_EQ(patch.u_step, 2);
    EXPECT_EQ(patch.patches_u(), 1);
}

TEST(ReadGeometry, MeshesOfUnknownWrapsAreOpen) {
    const ReadOutcome r = read_world("PatchMesh \"bilinear\" 3 \"nowrap\" 2 \"periodic\" " + some_points(6));
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("a.rib:2:1: warning: PatchMesh: \"nowrap\" is neither "
                                                  "periodic nor nonperiodic; taken as nonperiodic")));
    ASSERT_EQ(r.count(), 1u);
    EXPECT_FALSE(std::get<PatchMesh>(r.primitive().shape().topology).u_wraps);
    EXPECT_TRUE(std::get<PatchMesh>(r.primitive().shape().topology).v_wraps);
}

TEST(ReadGeometry, OfVariablesGivenTwiceTheFirstCounts) {
    const auto s_of = [](const std::string& variables) {
        const ReadOutcome r = read_world("Polygon " + kQuad + variables);
        EXPECT_THAT(r.messages, ElementsAre(HasSubstr("warning: Polygon: \"s\" is given twice")))
            << variables;
        return r.primitive().shape().variables.find("s")->floats.at(0);
    };
    EXPECT_EQ(s_of("\"s\" [1 1 1 1] \"varying float s\" [2 2 2 2]"), 1);
    EXPECT_EQ(s_of("\"s\" [1 1 1 1] \"st\" [2 2 2 2 2 2 2 2]"), 1);
    EXPECT_EQ(s_of("\"st\" [2 2 2 2 2 2 2 2] \"s\" [1 1 1 1]"), 2);
}

TEST(ReadGeometry, TextureCoordinatesComeApart) {
    const ReadOutcome r = read_world("Polygon " + kQuad + "\"st\" [0 1 2 3 4 5 6 7]");
    const ParameterList& variables = r.primitive().shape().variables;
    EXPECT_EQ(variables.find("st"), nullptr);
    EXPECT_THAT(variables.find("s")->floats, ElementsAre(0, 2, 4, 6));
    EXPECT_THAT(variables.find("t")->floats, ElementsAre(1, 3, 5, 7));
}

TEST(ReadGeometry, FormsOfPoints) {
    const ReadOutcome r = read_world(
        "Patch \"bilinear\" \"Pz\" [5 6 7 8] Patch \"bilinear\" \"Pw\" [0 0 0 1 2 0 0 2 0 1 0 1 1 1 0 1] "
        "Polygon \"Pw\" [2 0 0 2 0 1 0 1 0 0 1 1]");
    EXPECT_THAT(r.messages, IsEmpty());
    EXPECT_THAT(r.primitive(0).shape().variables.find("P")->floats,
                ElementsAre(0, 0, 5, 1, 0, 6, 0, 1, 7, 1, 1, 8));
    EXPECT_EQ(r.primitive(1).shape().variables.find("Pw")->floats.size(), 16u);
    EXPECT_THAT(r.primitive(2).shape().variables.find("P")->floats, ElementsAre(1, 0, 0, 0, 1, 0, 0, 0, 1));
    EXPECT_EQ(r.primitive(2).shape().variables.find("Pw"), nullptr);
}

TEST(ReadGeometry, LargeIndicesAreExact) {
    const ReadOutcome r = read_world("PointsPolygons [3] [0 1 16777217] " + kQuad);
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("vertex 16777217 is outside")));
}

/// What makes a whole primitive invalid; the next one is read.
TEST(ReadGeometry, InvalidPrimitivesAreSkipped) {
    const std::vector<std::string> invalid = {
        "Sphere 1 -1 1",
        "Sphere [1 -1 1 360 5]",
        "Sphere 0 -1 1 360",
        "Cone 1 1",
        "Cylinder 1 1 1",
        "Hyperboloid 1 0 0 1 0 1",
        "Paraboloid [1]",
        "Disk 1 360",
        "Torus 1 1 1 1",
        "Polygon " + some_points(2),
        "Polygon",
        "Polygon \"Cs\" [1 1 1]",
        "Polygon \"vertex string P\" [\"a\" \"b\" \"c\"]",
        "GeneralPolygon [4 3] " + kQuad,
        "GeneralPolygon [2 2] " + kQuad,
        "GeneralPolygon [] " + kQuad,
        "PointsPolygons [4 3] [0 1 2 3] " + kQuad,
        "PointsPolygons [3] [0 1 4] " + kQuad,
        "PointsPolygons [3] [0 1 -1] " + kQuad,
        "PointsPolygons [3] [0 1 1.5] " + kQuad,
        "PointsPolygons [2] [0 1] " + kQuad,
        "PointsPolygons [] [] " + kQuad,
        "PointsPolygons [3] [0 1 2]",
        "PointsPolygons [\"a\"] [0 1 2] " + kQuad,
        "PointsPolygons [3000000000] [0 1 2] " + kQuad,
        "PointsGeneralPolygons [2] [3] [0 1 2] " + kQuad,
        "PointsGeneralPolygons [1] [3] [0 1] " + kQuad,
        "PointsGeneralPolygons [0] [] [] " + kQuad,
        "SubdivisionMesh \"butterfly\" [4] [0 1 2 3] " + kQuad,
        "SubdivisionMesh \"loop\" [4] [0 1 2 3] " + kQuad,
        "SubdivisionMesh \"catmull-clark\" [4] [0 1 2] " + kQuad,
        "SubdivisionMesh \"catmull-clark\" [4] [0 1 2 3] [\"crease\"] [2 1 1 1] [0 1] [2] " + kQuad,
        "Patch \"bilinear\" " + some_points(3),
        "Patch \"bicubic\" " + some_points(15),
        "Patch \"quadratic\" " + kQuad,
        "Patch \"bilinear\"",
        "Patch \"bilinear\" \"Pw\" [0 0 0 1 2 0 0 0 0 1 0 1 1 1 0 1]",
        "PatchMesh \"bilinear\" 1 \"nonperiodic\" 4 \"nonperiodic\" " + kQuad,
        "PatchMesh \"bilinear\" -2 \"nonperiodic\" -2 \"nonperiodic\" " + kQuad,
        "PatchMesh \"bilinear\" 1000000 \"nonperiodic\" 1000000 \"nonperiodic\" " + kQuad,
        "PatchMesh \"bicubic\" 5 \"nonperiodic\" 4 \"nonperiodic\" " + some_points(20),
        "PatchMesh \"bicubic\" 4 \"periodic\" 4 \"nonperiodic\" " + some_points(16)};
    for (const std::string& text : invalid) {
        const ReadOutcome r = read_world("AttributeBegin\n" + text + "\nAttributeEnd\n" + kSphere);
        ASSERT_FALSE(r.messages.empty()) << text;
        EXPECT_THAT(r.messages.back(), HasSubstr("; primitive skipped")) << text;
        EXPECT_THAT(r.messages.back(), HasSubstr("a.rib:3:")) << text;
        EXPECT_THAT(r.messages.back(), HasSubstr("error: " + text.substr(0, text.find(' ')) + ": ")) << text;
        EXPECT_EQ(r.count(), 1u) << text;
    }
}

/// What is left out of a primitive that stays.
/// What is too much of a mesh costs no more than itself.
TEST(ReadGeometry, WhatIsTooMuchIsLeftOut) {
    const ReadOutcome extra = read_world("PointsPolygons [4] [0 1 2 3 0 1] " + kQuad);
    EXPECT_THAT(extra.messages, ElementsAre(HasSubstr("has 6 numbers, needs 4; the rest is left out")));
    EXPECT_EQ(std::get<PolygonMesh>(extra.primitive().shape().topology).vertices,
              (std::vector<int>{0, 1, 2, 3}));
    const auto tags = [](const ReadOutcome& r) {
        return std::get<SubdivisionMesh>(r.primitive().shape().topology).tags.size();
    };
    for (const char* counts : {"[2 -1 0 0]", "[9 1 0 0]"}) {
        const ReadOutcome few = read_world(
            "SubdivisionMesh \"catmull-clark\" [4] [0 1 2 3] "
            "[\"interpolateboundary\" \"crease\" \"hole\"] [0 0 " +
            std::string(counts + 1) + " [0 1] [2] " + kQuad);
        EXPECT_THAT(few.messages,
                    ElementsAre(HasSubstr("wants more arguments than there are; it and those after it "
                                          "are left out")));
        EXPECT_EQ(tags(few), 1u) << counts;
    }
    const ReadOutcome none = read_world(
        "SubdivisionMesh \"catmull-clark\" [4] [0 1 2 3] [\"interpolateboundary\"] [] [] [] " + kQuad);
    EXPECT_TRUE(none.messages.empty());
    EXPECT_EQ(tags(none), 1u);
}

TEST(ReadGeometry, WrongVariablesAreLeftOut) {
    for (const char* variable :
         {"\"Cs\" [1 0]", "\"N\" [0 0 1 0 0 1 0 0 1]", "\"st\" [0 0 1 1]", "\"facevarying float f\" [1 2 3]",
          "\"varying string N\" [\"a\"]", "\"vertex color s\" [1 0 0 1 0 0 1 0 0 1 0 0]", "\"Pz\" [1 2 3 4]",
          "\"unknown\" [1]", "\"constant string c\" [1]", "\"float k\" [\"x\"]", "\"float[3] k\" [1 2]"}) {
        const ReadOutcome r = read_world("Polygon " + kQuad + variable);
        ASSERT_EQ(r.messages.size(), 1u) << variable;
        EXPECT_THAT(r.messages[0], HasSubstr("left out")) << variable;
        ASSERT_EQ(r.count(), 1u) << variable;
        EXPECT_EQ(r.primitive().shape().variables.values.size(), 1u) << variable;
    }
}

/// As many values as another class wants, and values beyond those wanted.
TEST(ReadGeometry, VariablesOfAnotherNumberAreFitted) {
    const struct {
        std::string variable;
        StorageClass storage;
        size_t floats;
        size_t warnings = 1;
    } cases[] = {
        {"\"Cs\" [1 0 0]", StorageClass::Constant, 3},
        {"\"Cs\" [1 0 0 0]", StorageClass::Constant, 3, 2},
        {"\"Cs\" [1 0 0 0 1 0]", StorageClass::Uniform, 6},
        {"\"uniform float f\" [1 2 3 4 5 6 7 8]", StorageClass::FaceVarying, 8},
        {"\"uniform float f\" [1 2 3 4 5 6]", StorageClass::Vertex, 6},
        {"\"uniform float f\" [1 2 3]", StorageClass::Uniform, 2},
        {"\"float f\" [1 2 3 4 5 6 7]", StorageClass::Uniform, 2},
        {"\"st\" [0 0 1 0 1 1 0 1 0 0 1 0 1]", StorageClass::Varying, 6},  // of s
    };
    for (const auto& c : cases) {
        const ReadOutcome r =
            read_world("PointsPolygons [4 4] [0 1 4 3 1 2 5 4] " + some_points(6) + c.variable);
        ASSERT_EQ(r.messages.size(), c.warnings) << c.variable;
        EXPECT_THAT(r.messages[0], HasSubstr("a.rib:2:")) << c.variable;
        EXPECT_THAT(r.messages[0], HasSubstr("warning: PointsPolygons: ")) << c.variable;
        ASSERT_EQ(r.count(), 1u) << c.variable;
        const Parameter& p = r.primitive().shape().variables.values.at(1);
        EXPECT_EQ(p.declaration.storage, c.storage) << c.variable;
        EXPECT_EQ(p.floats.size(), c.floats) << c.variable;
    }
}

/// A bicubic patch's sixteen colours are of its points, whatever the class of Cs.
TEST(ReadGeometry, PointsOfPolygonsMayBeTooMany) {
    const ReadOutcome r = read_world("Polygon \"P\" [0 0 0 1 0 0 1 1 0 0 1]");
    ASSERT_EQ(r.messages.size(), 1u);
    EXPECT_THAT(r.messages[0], HasSubstr("\"P\" has 11 values, no multiple of 3; the rest is left over"));
    ASSERT_EQ(r.count(), 1u);
    EXPECT_EQ(r.primitive().shape().variables.find("P")->floats.size(), 9u);
    const ReadOutcome patch = read_world("Patch \"bicubic\" " + some_points(16) + "\"Cs\" [" + [] {
        std::string colors;
        for (int i = 0; i < 48; ++i) colors += "1 ";
        return colors;
    }() + "]");
    ASSERT_EQ(patch.count(), 1u);
    EXPECT_EQ(patch.primitive().shape().variables.find("Cs")->declaration.storage, StorageClass::Vertex);
}

TEST(ReadGeometry, SingularAndOverflowingSpacesAreReported) {
    for (const char* transform : {"Scale 1 0 1", "Scale 1e30 1e30 1e30 Scale 1e30 1e30 1e30"}) {
        const ReadOutcome r = read_world("AttributeBegin " + std::string(transform) + " " + kSphere +
                                         "AttributeEnd " + kSphere);
        EXPECT_THAT(r.messages, ElementsAre(HasSubstr("is singular; primitive skipped")));
        EXPECT_EQ(r.count(), 1u);
    }
}

TEST(ReadGeometry, ThingsMayGrowFromNothingAndVanish) {
    const auto moving = [](const std::string& text) {
        return read_text("Shutter 0 1 WorldBegin MotionBegin [0 1] " + text + " WorldEnd");
    };
    for (const std::string keys :
         {"Scale 0 0 0 Scale 1 1 1", "Scale 1 1 1 Scale 0 0 0", "Scale 0 1 1 Scale 1 1 1"}) {
        const ReadOutcome r = moving(keys + " MotionEnd " + kSphere);
        EXPECT_THAT(r.messages, IsEmpty()) << keys;
        ASSERT_EQ(r.count(), 1u) << keys;
        EXPECT_NE(M44d(r.primitive().camera_from_object.front()).determinant(), 0) << keys;
    }
    for (const std::string keys : {"Sphere 0 0 0 360 Sphere 1 -1 1 360", "Sphere 1 -1 1 360 Sphere 0 0 0 360",
                                   "Paraboloid 1 0 0 360 Paraboloid 1 0 1 360"}) {
        const ReadOutcome r = moving(keys + " MotionEnd");
        EXPECT_THAT(r.messages, IsEmpty()) << keys;
        ASSERT_EQ(r.count(), 1u) << keys;
        EXPECT_EQ(r.primitive().shape_keys.size(), 2u) << keys;
    }
    EXPECT_EQ(read_world("Sphere 0 0 0 360").count(), 0u);
}

/// RISpec, table 5.1: the normal of a face. "N" says more where both are given.
TEST(ReadGeometry, PlanarNormalsAreNormals) {
    const ReadOutcome r = read_world("Polygon " + kQuad + "\"Np\" [0 .6 .8] Polygon " + kQuad +
                                     "\"Np\" [0 .6 .8] \"N\" [0 0 1 0 0 1 0 0 1 0 0 1]");
    EXPECT_THAT(r.messages, IsEmpty());
    const Parameter* alone = r.primitive(0).shape().variables.find("N");
    ASSERT_NE(alone, nullptr);
    EXPECT_EQ(alone->floats, (std::vector<float>{0, .6f, .8f}));
    EXPECT_EQ(alone->declaration.storage, StorageClass::Uniform);
    EXPECT_EQ(r.primitive(1).shape().variables.find("N")->floats.size(), 12u);
    EXPECT_EQ(r.primitive(1).shape().variables.find("Np"), nullptr);
}

}  // namespace
}  // namespace trapeze::testing
