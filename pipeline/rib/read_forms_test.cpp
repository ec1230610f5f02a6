/// The freedom that RIB leaves in how values are written, and checks that only whole requests allow.
#include "core/motion_keys_harness.h"
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kSquare = " \"P\" [0 0 0 1 0 0 1 1 0 0 1 0] ";

const std::vector<SubdivisionMesh::Tag>& tags(const ReadOutcome& outcome, size_t i = 0) {
    return std::get<SubdivisionMesh>(outcome.primitive(i).shape().topology).tags;
}

TEST(ReadForms, BracketsAreOptionalRoundFixedNumbersOfValues) {
    const ReadOutcome bare = read_text(
        "Format 320 240 1 Clipping 0.1 100 Shutter 0 0.5 PixelSamples 3 4 PixelFilter \"box\" 2 3 Exposure 2 "
        "1\n"
        "DepthOfField 2 1 5 WorldBegin Color 1 0.5 0 ShadingRate 4 Hyperboloid 0 0 0 1 1 1 360\n"
        "Surface \"plastic\" \"Kd\" 0.25 \"specularcolor\" 0 1 0 Sphere 1 -1 1 360 WorldEnd\n");
    const ReadOutcome bracketed = read_text(
        "Format [320 240 1] Clipping [0.1 100] Shutter [0 0.5] PixelSamples [3 4] PixelFilter \"box\" [2 3]\n"
        "Exposure [2 1] DepthOfField [2 1 5] WorldBegin Color [1 0.5 0] ShadingRate [4]\n"
        "Hyperboloid [0 0 0] [1 1 1] 360 Surface \"plastic\" \"Kd\" [0.25] \"specularcolor\" [0 1 0]\n"
        "Sphere [1 -1 1 360] WorldEnd\n");
    for (const ReadOutcome* outcome : {&bare, &bracketed}) {
        EXPECT_THAT(outcome->messages, IsEmpty());
        const Options& o = outcome->scene().options;
        EXPECT_EQ(o.width, 320);
        EXPECT_EQ(o.far_clip, 100);
        EXPECT_EQ(o.shutter_close, 0.5f);
        EXPECT_EQ(o.samples_y, 4);
        EXPECT_EQ(o.filter.width_y, 3);
        EXPECT_EQ(o.exposure_gain, 2);
        EXPECT_EQ(o.focal_distance, 5);
        ASSERT_EQ(outcome->count(), 2u);
        EXPECT_EQ(std::get<Quadric>(outcome->primitive(0).shape().topology).values[5], 1);
        EXPECT_THAT(outcome->attributes(1).surface->parameters.find("specularcolor")->floats,
                    ElementsAre(0, 1, 0));
    }
}

TEST(ReadForms, WhatDoesNotTurnNeedsNoAxis) {
    const ReadOutcome r = read_text("WorldBegin Translate 1 2 3 Rotate 0 0 0 0 Sphere 1 -1 1 360 WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    EXPECT_EQ(r.primitive().camera_from_object[0].translation(), V3f(1, 2, 3));
    EXPECT_THAT(read_text("WorldBegin Rotate 5 0 0 0 WorldEnd").messages,
                ElementsAre(HasSubstr("the axis is 0")));
}

TEST(ReadForms, PinholesAreWrittenInManyWays) {
    for (const char* lens : {"", "\"-\"", "1e38 0 0", "1e+38 1 1", "22 0 0"}) {
        const ReadOutcome r =
            read_text("DepthOfField 2 1 5 DepthOfField " + std::string(lens) + " WorldBegin WorldEnd");
        EXPECT_THAT(r.messages, IsEmpty()) << lens;
        EXPECT_EQ(r.scene().options.f_stop, kInfinity) << lens;
    }
    EXPECT_EQ(read_text("DepthOfField 0 1 5 WorldBegin WorldEnd").messages.size(), 1u);
}

TEST(ReadForms, FiltersThatNobodyKnowsBecomeGaussian) {
    const ReadOutcome outcome = read_text("PixelFilter \"wobbly\" 3 3\nWorldBegin WorldEnd\n");
    EXPECT_EQ(outcome.scene().options.filter.name, "gaussian");
    EXPECT_THAT(outcome.messages,
                ElementsAre(HasSubstr("a.rib:1:1: warning: PixelFilter: \"wobbly\" is not known")));
    EXPECT_EQ(
        read_text("PixelFilter \"blackman-harris\" 3 3 WorldBegin WorldEnd").scene().options.filter.name,
        "blackman-harris");
}

TEST(ReadForms, ShadersKnowUndeclaredParameters) {
    const ReadOutcome outcome =
        read_world("Surface \"wood\" \"grain\" 5 \"tint\" [0.5 0.25 0] \"map\" [\"a.tif\"]\n" + kSphere +
                   "Surface \"wood\" \"grain\" 6 " + kSphere + "Sphere 1 -1 1 360 \"tint\" [1 0 0]");
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("Sphere: \"tint\" is not declared; left out")));
    const ParameterList& list = outcome.attributes().surface->parameters;
    EXPECT_THAT(list.find("grain")->floats, ElementsAre(5));
    EXPECT_EQ(list.find("tint")->declaration.array_length, 3);
    EXPECT_THAT(list.find("map")->strings, ElementsAre("a.tif"));
    EXPECT_EQ(outcome.primitive(2).shape().variables.find("tint"), nullptr);
}

TEST(ReadForms, ShaderParametersHaveOneValue) {
    const ReadOutcome outcome =
        read_world("Surface \"plastic\" \"Kd\" [0.5 0.5] \"Ks\" [0.5] \"float[2] x\" [1 2]\n" + kSphere);
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("Surface: \"Kd\" has 2 values, needs 1; left out")));
    const ParameterList& list = outcome.attributes().surface->parameters;
    EXPECT_EQ(list.find("Kd"), nullptr);
    EXPECT_NE(list.find("Ks"), nullptr);
    EXPECT_THAT(list.find("x")->floats, ElementsAre(1, 2));
}

TEST(ReadForms, OfParametersGivenTwiceTheFirstCounts) {
    const ReadOutcome outcome = read_world(
        "Surface \"plastic\" \"Kd\" 0.5 \"uniform float Kd\" 0.25\nAttribute \"user\" \"float a\" 1 "
        "\"float a\" 2 Surface \"plastic\" \"float[2] z\" [3] \"float[2] z\" [4 5]\n" +
        kSphere);
    ASSERT_EQ(outcome.messages.size(), 2u) << "one of the kind, and a wrong value";
    EXPECT_THAT(outcome.messages[0],
                HasSubstr("a.rib:2:28: warning: Surface: \"Kd\" is given twice; the first counts"));
    EXPECT_THAT(outcome.messages[1], HasSubstr("\"z\" has 1 values, needs a multiple of 2; left out"));
    EXPECT_EQ(outcome.attributes().user.float_or("user", "a", 0), 1);
    EXPECT_EQ(outcome.attributes().surface->parameters.float_or("z", 0), 4) << "of those that are right";
    const ReadOutcome plastic = read_world("Surface \"plastic\" \"Kd\" 0.5 \"Kd\" 0.25\n" + kSphere);
    EXPECT_EQ(plastic.attributes().surface->parameters.float_or("Kd", 0), 0.5f);
}

TEST(ReadForms, TagsMayBeEmptyOrOneWithoutBrackets) {
    const std::string mesh = "SubdivisionMesh \"catmull-clark\" [4] [0 1 2 3] ";
    const ReadOutcome outcome =
        read_world(mesh + kSquare + mesh + "[] [] [] []" + kSquare + mesh + "[] [] [] [] []" + kSquare +
                   mesh + "\"interpolateboundary\" [0 0] [] []" + kSquare);
    EXPECT_THAT(outcome.messages, IsEmpty());
    ASSERT_EQ(outcome.count(), 4u);
    for (const size_t i : {0, 1, 2}) EXPECT_THAT(tags(outcome, i), IsEmpty());
    ASSERT_THAT(tags(outcome, 3), SizeIs(1));
    EXPECT_EQ(tags(outcome, 3)[0].name, "interpolateboundary");
}

TEST(ReadForms, TagsThatDoNotFitTheMeshAreLeftOut) {
    const std::string mesh = "SubdivisionMesh \"catmull-clark\" [4] [0 1 2 3] ";
    const auto only_message = [&](const std::string& text) {
        const ReadOutcome outcome = read_world(mesh + text + kSquare);
        EXPECT_EQ(outcome.count(), 1u) << text;
        EXPECT_THAT(tags(outcome), IsEmpty()) << text;
        return outcome.messages.size() == 1 ? outcome.messages[0] : std::to_string(outcome.messages.size());
    };
    EXPECT_THAT(only_message("[\"crease\"] [2 1] [0 4] [1]"),
                HasSubstr("tag \"crease\" names vertex 4 of 4; the tag is left out"));
    EXPECT_THAT(only_message("[\"crease\"] [1 1] [0] [1]"), HasSubstr("needs two vertices"));
    EXPECT_THAT(only_message("[\"crease\"] [3 3] [0 1 2] [1 1 1]"), HasSubstr("has 3 floats, needs 1 or 2"));
    EXPECT_THAT(only_message("[\"corner\"] [1 1] [-1] [1]"), HasSubstr("vertex -1"));
    EXPECT_THAT(only_message("[\"hole\"] [1 0] [1] []"), HasSubstr("names face 1 of 1"));
    EXPECT_THAT(tags(read_world(mesh + "[\"crease\" \"hole\"] [3 2 1 0] [0 1 2 0] [1 2]" + kSquare)),
                SizeIs(2));
}

TEST(ReadForms, ParaboloidsNeedAHeight) {
    EXPECT_THAT(read_world("Paraboloid 1 0 0 360").messages,
                ElementsAre(HasSubstr("Paraboloid: zmax is 0; primitive skipped")));
}

TEST(ReadForms, PosesMayNameTheirVariablesInAnyOrder) {
    const ReadOutcome outcome = read_text(
        "Shutter 0 1 WorldBegin MotionBegin [0 0.5 1]\n"
        "Polygon \"P\" [0 0 0 1 0 0 0 1 0] \"varying float x\" [0 0 0]\n"
        "Polygon \"varying float x\" [2 2 2] \"P\" [0 0 4 1 0 4 0 1 4]\n"
        "Polygon \"varying float x\" [6 6 6] \"P\" [0 0 8 1 0 8 0 1 8]\nMotionEnd WorldEnd\n");
    EXPECT_THAT(outcome.messages, IsEmpty());
    ASSERT_THAT(outcome.primitive().shape_keys, SizeIs(3));
    EXPECT_EQ(outcome.primitive().shape_keys[1]->variables.find("P")->floats[2], 4);
    EXPECT_EQ(outcome.primitive().shape_keys[2]->variables.find("x")->floats[0], 6);
    // Between given poses, too.
    const ReadOutcome between = read_text(
        "Shutter 0 0.5 WorldBegin MotionBegin [0 1]\nPolygon \"P\" [0 0 0 1 0 0 0 1 0] \"varying float x\" "
        "[0 0 0]\n"
        "Polygon \"varying float x\" [6 6 6] \"P\" [0 0 8 1 0 8 0 1 8]\nMotionEnd WorldEnd\n");
    EXPECT_EQ(between.primitive().shape_keys.back()->variables.find("x")->floats[0], 3);
    EXPECT_EQ(between.primitive().shape_keys.back()->variables.find("P")->floats[2], 4);
}

TEST(ReadForms, MotionsThatMultiplyGetKeysWhereTheyBend) {
    // A point at distance d moves as (1 + 3 t) (d + 6 t): two keys would be off by 4.5 in the middle.
    const ReadOutcome outcome = read_text(
        "Shutter 0 1 WorldBegin MotionBegin [0 1] Scale 1 1 1 Scale 4 4 4 MotionEnd\n"
        "MotionBegin [0 1] Translate 0 0 0 Translate 6 0 0 MotionEnd Sphere 1 -1 1 360 WorldEnd\n");
    const SharedPoses& keys = outcome.primitive().camera_from_object;
    ASSERT_TRUE(is_key_count(static_cast<int>(keys.size())));
    ASSERT_GT(keys.size(), 2u);
    for (size_t k = 0; k + 1 < keys.size(); ++k) {
        const float t = (static_cast<float>(k) + 0.5f) / static_cast<float>(keys.size() - 1);
        EXPECT_NEAR((keys[k][3][0] + keys[k + 1][3][0]) / 2, (1 + 3 * t) * 6 * t, 0.1f);
    }
    // Straight motions that add need no more than two.
    EXPECT_THAT(
        read_text("Shutter 0 1 WorldBegin MotionBegin [0 1] Translate 0 0 0 Translate 4 0 0 MotionEnd\n"
                  "MotionBegin [0 1] Translate 0 0 0 Translate 6 0 0 MotionEnd Sphere 1 -1 1 360 WorldEnd\n")
            .primitive()
            .camera_from_object,
        SizeIs(2));
}

TEST(ReadForms, CommasAndSemicolonsAreSpace) {
    const ReadOutcome outcome = read_text(
        "Projection \"perspective\"; Translate 0,0, 5;\nWorldBegin; Color [1;0;0];\nSphere 1 -1 1 360;Sphere "
        "2 -1 1;360\n"
        "WorldEnd;");
    EXPECT_THAT(outcome.messages, IsEmpty());
    ASSERT_EQ(outcome.count(), 2u);
    EXPECT_EQ(outcome.attributes().color, V3f(1, 0, 0));
}

TEST(ReadForms, StringsMayStandInSingleQuotes) {
    const ReadOutcome outcome =
        read_text("Display \"a.tif\" 'file' 'rgba'\nWorldBegin\nSurface['matte']" + kSphere + "\nWorldEnd");
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(outcome.scene().options.displays.at(0).type, "file");
    EXPECT_EQ(outcome.attributes().surface->name, "matte");
    // An apostrophe is none.
    EXPECT_THAT(read_text("WorldBegin\n' " + kSphere + "\nSphere 1 -1 1 360 # it's\nWorldEnd").messages,
                ElementsAre(HasSubstr("characters that RIB does not have")));
}

TEST(ReadForms, ShapesWithoutPointsAreNoErrors) {
    const ReadOutcome outcome = read_world(
        "PointsPolygons [] [] \"P\" []\nPoints \"vertex point P\" [] \"constantwidth\" [1]\n"
        "Curves \"cubic\" [] \"nonperiodic\" \"P\" []\nPointsPolygons [] [] \"P\" [] \"st\" []\n" +
        kSphere);
    EXPECT_EQ(outcome.count(), 1u);
    EXPECT_THAT(outcome.messages,
                ElementsAre(HasSubstr("warning: PointsPolygons: \"P\" is empty; there is nothing to draw"),
                            HasSubstr("warning: Points: \"P\" is empty"),
                            HasSubstr("warning: Curves: \"P\" is empty")));
}

TEST(ReadForms, TextsOfDosEndWithTheirSign) {
    const ReadOutcome outcome = read_text("WorldBegin\r\n" + kSphere + "\r\nWorldEnd\r\n\x1A");
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_EQ(outcome.count(), 1u);
}

}  // namespace
}  // namespace trapeze::testing
