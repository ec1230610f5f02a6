/// Motion blocks round transformations, geometry and all else.
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

ReadOutcome read_shutter(const std::string& shutter, const std::string& text) {
    return read_text("Shutter " + shutter + "\nWorldBegin\n" + text + "\nWorldEnd\n");
}

std::string moving_sphere(const std::string& times, std::initializer_list<double> radii) {
    std::string text = "MotionBegin [" + times + "] ";
    for (const double radius : radii) text += "Sphere " + std::to_string(radius) + " -1 1 360 ";
    return text + "MotionEnd ";
}

std::vector<float> radii_of(const Primitive& primitive) {
    std::vector<float> radii;
    for (const auto& shape : primitive.shape_keys)
        radii.push_back(std::get<Quadric>(shape->topology).values[0]);
    return radii;
}

TEST(ReadMotion, TransformationsGetTheKeysTheyNeed) {
    const ReadOutcome r =
        read_shutter("0 1",
                     "MotionBegin [0 .25 1] Translate 0 0 0 Translate 1 0 0 Translate 2 0 0 "
                     "MotionEnd " +
                         kSphere);
    EXPECT_THAT(r.messages, IsEmpty());
    const auto& keys = r.primitive().camera_from_object;
    ASSERT_EQ(keys.size(), 5u);
    EXPECT_EQ(keys[0].translation().x, 0);
    EXPECT_EQ(keys[1].translation().x, 1);
    EXPECT_FLOAT_EQ(keys[2].translation().x, 1 + 1 / 3.0f);
    EXPECT_EQ(keys[4].translation().x, 2);
    EXPECT_EQ(r.summary.moving_primitives, 1u);
}

TEST(ReadMotion, RotationsAreSubdivided) {
    // In a picture so small that ten degrees a segment are enough (motion_paths_test.cpp has larger ones).
    const ReadOutcome r = read_text(
        "Format 16 16 1 Shutter 0 1 WorldBegin MotionBegin [0 1] Rotate 0 0 0 1 Rotate 40 0 0 1 MotionEnd "
        "Translate 1 0 0 " +
        kSphere + "WorldEnd");
    const auto& keys = r.primitive().camera_from_object;
    ASSERT_EQ(keys.size(), 5u);
    for (const M44f& key : keys) EXPECT_NEAR(key.translation().length(), 1, 1e-6);
}

TEST(ReadMotion, CamerasMoveTheWorld) {
    const ReadOutcome r = read_text(
        "Shutter 0 1 MotionBegin [0 1] Translate 0 0 1 Translate 0 0 3 MotionEnd "
        "WorldBegin MotionBegin [0 1] Translate 0 0 0 Translate 1 0 0 MotionEnd " +
        kSphere + "WorldEnd");
    ASSERT_EQ(r.primitive().camera_from_object.size(), 2u);
    EXPECT_EQ(r.primitive().camera_from_object[1].translation(), V3f(1, 0, 3));
    EXPECT_EQ(r.scene().camera_from_world.translation(), V3f(0, 0, 1));
}

TEST(ReadMotion, AClosedShutterSeesItsMoment) {
    const ReadOutcome r =
        read_shutter(".5 .5", "MotionBegin [0 1] Translate 0 0 0 Translate 2 0 0 MotionEnd " +
                                  moving_sphere("0 1", {1, 3}));
    ASSERT_EQ(r.primitive().key_count(), 1);
    EXPECT_EQ(r.primitive().camera_from_object[0].translation().x, 1);
    EXPECT_THAT(radii_of(r.primitive()), ElementsAre(2));
}

TEST(ReadMotion, ShapesAreResampledToEvenKeys) {
    EXPECT_THAT(radii_of(read_shutter("0 1", moving_sphere("0 1", {1, 3})).primitive()), ElementsAre(1, 3));
    EXPECT_THAT(radii_of(read_shutter("0 1", moving_sphere("0 .5 1", {1, 5, 6})).primitive()),
                ElementsAre(1, 5, 6));
    EXPECT_THAT(radii_of(read_shutter("0 1", moving_sphere("0 .25 1", {0 + 1, 4, 7})).primitive()),
                ElementsAre(1, 4, 5, 6, 7));
    EXPECT_THAT(radii_of(read_shutter("0 .5", moving_sphere("0 1", {1, 3})).primitive()), ElementsAre(1, 2));
    EXPECT_THAT(radii_of(read_shutter("-1 1", moving_sphere("0 1", {1, 3})).primitive()),
                ElementsAre(1, 1, 3));
    EXPECT_THAT(radii_of(read_shutter("2 3", moving_sphere("0 1", {1, 3})).primitive()), ElementsAre(3));
    // No even keys meet .3: more of them where that shows.
    EXPECT_EQ(radii_of(read_shutter("0 1", moving_sphere("0 .3 1", {1, 2, 3})).primitive()).size(), 65u);
    EXPECT_EQ(radii_of(read_shutter("0 1", moving_sphere("0 .3 1", {1, 1.3, 2})).primitive()).size(), 17u);
}

TEST(ReadMotion, PointsDeform) {
    const ReadOutcome r = read_shutter("0 1",
                                       "MotionBegin [0 1] Polygon \"P\" [0 0 0 1 0 0 0 1 0] "
                                       "Polygon \"P\" [0 0 4 1 0 4 0 1 4] MotionEnd");
    ASSERT_EQ(r.primitive().shape_keys.size(), 2u);
    EXPECT_EQ(r.primitive().shape_keys[1]->variables.find("P")->floats[2], 4);
}

TEST(ReadMotion, MovingObjectsAreResolvedOnceForAllInstances) {
    const ReadOutcome r = read_shutter("0 1", "ObjectBegin 1 " + moving_sphere("0 .25 1", {1, 2, 3}) +
                                                  "ObjectEnd ObjectInstance 1 ObjectInstance 1");
    ASSERT_EQ(r.count(), 2u);
    ASSERT_EQ(r.primitive(0).shape_keys.size(), 5u);
    EXPECT_EQ(r.primitive(0).shape_keys, r.primitive(1).shape_keys);
}

TEST(ReadMotion, ColoursAndShadersAreThoseAsTheShutterOpens) {
    const char* const text =
        "MotionBegin [0 1] Color 1 0 0 Color 0 1 0 MotionEnd "
        "MotionBegin [0 1] Surface \"matte\" Surface \"metal\" MotionEnd "
        "MotionBegin [0 .5 1] LightSource \"pointlight\" 1 \"intensity\" [0] "
        "LightSource \"pointlight\" 1 \"intensity\" [8] LightSource \"pointlight\" 1 \"intensity\" [4] "
        "MotionEnd ";
    const struct {
        const char* shutter;
        V3f color;
        float intensity;
    } rows[] = {{"0 1", {1, 0, 0}, 0},
                {"-2 1", {1, 0, 0}, 0},
                {"0.25 1", {0.75f, 0.25f, 0}, 4},
                {"0.75 1", {0.25f, 0.75f, 0}, 6},
                {"1 1", {0, 1, 0}, 4},
                {"3 4", {0, 1, 0}, 4}};
    for (const auto& row : rows) {
        const ReadOutcome r = read_shutter(row.shutter, text + kSphere);
        EXPECT_EQ(r.attributes().color, row.color) << row.shutter;
        const bool is_over = std::string_view(row.shutter) == "1 1" || row.shutter[0] == '3';
        EXPECT_EQ(r.attributes().surface->name, is_over ? "metal" : "matte") << row.shutter;
        ASSERT_EQ(r.attributes().lights.size(), 1u);
        EXPECT_EQ(r.attributes().lights[0]->shader.parameters.float_or("intensity", -1), row.intensity);
        EXPECT_THAT(r.messages,
                    ElementsAre(HasSubstr("note: Color: does not move; its values as the shutter opens"),
                                HasSubstr("note: Surface: does not move"),
                                HasSubstr("note: LightSource: does not move")));
    }
}

TEST(ReadMotion, AttributesMayStandBetweenEachOtherAndGeometry) {
    const ReadOutcome r = read_shutter("0.25 1",
                                       "MotionBegin [0 1] Color 1 0 0 Opacity 0 0 0 Sphere 1 -1 1 360 "
                                       "Color 0 1 0 Opacity 1 1 1 Sphere 5 -1 1 360 MotionEnd");
    EXPECT_THAT(r.messages,
                ElementsAre(HasSubstr("a.rib:3:19: note: Color: does not move; its values as the shutter"),
                            HasSubstr("note: Opacity: does not move")));
    EXPECT_EQ(r.attributes().color, V3f(0.75f, 0.25f, 0));
    EXPECT_EQ(r.attributes().opacity, V3f(0.25f));
    EXPECT_THAT(radii_of(r.primitive()), ElementsAre(2, 5));
    const ReadOutcome moved = read_shutter("0 1",
                                           "MotionBegin [0 1] Color 1 0 0 Translate 0 0 0 Color 0 0 1 "
                                           "Translate 1 0 0 MotionEnd " +
                                               kSphere);
    EXPECT_EQ(moved.attributes().color, V3f(1, 0, 0));
    EXPECT_EQ(moved.primitive().camera_from_object.size(), 2u);
}

/// Red and blue points, or none, in a triangle that moves by 4.
ReadOutcome read_colored_poses(const std::string& shutter, const std::string& first,
                               const std::string& second) {
    return read_shutter(shutter, "MotionBegin [0 1] Polygon \"P\" [0 0 0 1 0 0 0 1 0] " + first +
                                     " Polygon \"P\" [0 0 4 1 0 4 0 1 4] " + second + " MotionEnd");
}

TEST(ReadMotion, ColoursOfPosesAreThoseAsTheShutterOpens) {
    const std::string red = "\"Cs\" [1 0 0 1 0 0 1 0 0] ", blue = "\"Cs\" [0 0 1 0 0 1 0 0 1] ",
                      one = "\"constant color Cs\" [0 0 1] ";
    const auto color = [](const ReadOutcome& r) {
        const Parameter* const cs = r.primitive().shape().variables.find("Cs");
        return cs ? V3f(cs->floats[0], cs->floats[1], cs->floats[2]) : V3f(-1);
    };
    const struct {
        std::string shutter, first, second;
        V3f color;
    } rows[] = {{"0 1", red, blue, {1, 0, 0}},
                {"0.25 1", red, blue, {0.75f, 0, 0.25f}},
                {"0 1", red, "", {1, 0, 0}},
                {"0 1", "", blue, V3f(-1)},
                {"0 1", red, one, {1, 0, 0}}};
    for (const auto& row : rows) {
        const ReadOutcome r = read_colored_poses(row.shutter, row.first, row.second);
        EXPECT_THAT(r.messages, ElementsAre(HasSubstr("note: Polygon: its colours do not move; those as the "
                                                      "shutter opens are used")));
        EXPECT_EQ(color(r), row.color) << row.shutter;
        EXPECT_EQ(r.primitive().shape_keys.size(), 2u) << "it deforms all the same";
        EXPECT_EQ(r.primitive().shape_keys[1]->variables.find("P")->floats[2], 4);
    }
    EXPECT_THAT(read_colored_poses("0 1", red, red).messages, IsEmpty());
}

TEST(ReadMotion, WhatStaysTheSameIsNotNoted) {
    const ReadOutcome r =
        read_shutter("0 1",
                     "MotionBegin [0 1] Color 1 0 0 Color 1 0 0 MotionEnd MotionBegin [0 1] "
                     "Opacity [.5 .5 .5] Opacity .5 .5 .5 MotionEnd " +
                         std::string(kSphere));
    EXPECT_EQ(r.attributes().color, V3f(1, 0, 0));
    EXPECT_EQ(r.attributes().opacity, V3f(0.5f));
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("note: Opacity")));  // written in two ways
    const ReadOutcome few =
        read_shutter("0 1", "MotionBegin [0 1] Color 1 0 0 MotionEnd " + std::string(kSphere));
    EXPECT_EQ(few.attributes().color, V3f(1, 0, 0));
    EXPECT_THAT(few.messages, ElementsAre(HasSubstr("Color occurs 1 times for 2 times")));
    const ReadOutcome bad = read_shutter(
        "0 1", "MotionBegin [0 1] Color 1 Color 1 MotionEnd ErrorHandler 3 " + std::string(kSphere));
    EXPECT_THAT(bad.messages, Not(::testing::IsEmpty()));
    EXPECT_EQ(bad.count(), 1u);
}

TEST(ReadMotion, WrongBlocksAreReported) {
    const std::pair<const char*, const char*> cases[] = {
        {"MotionBegin [0 1] Sphere 2 -1 1 360 MotionEnd", "Sphere occurs 1 times for 2 times"},
        {"MotionBegin [0 1] Sphere 2 -1 1 360 Cone 1 1 360 Sphere 2 -1 1 360 MotionEnd",
         "this is a motion block of Sphere"},
        {"MotionBegin [1 0] MotionEnd", "times must grow"},
        {"MotionBegin [] MotionEnd", "no times"},
        {"MotionBegin [0 1] MotionBegin [0 1] MotionEnd", "do not nest"},
        {"MotionBegin [0 1] AttributeBegin MotionEnd", "inside a motion block"},
        {"MotionBegin [-3e38 3e38] MotionEnd", "too far apart"},
        {"MotionBegin [0 1] Polygon \"P\" [0 0 0 1 0 0 0 1 0] Polygon \"P\" [0 0 4 1 0 4 0 1 4 0 0 5] "
         "MotionEnd",
         "differ in topology"},
    };
    for (const auto& [text, message] : cases) {
        const ReadOutcome r = read_shutter("0 1", text + std::string("\n") + kSphere);
        ASSERT_FALSE(r.messages.empty()) << text;
        EXPECT_THAT(r.messages[0], HasSubstr(message));
        ASSERT_GE(r.count(), 1u) << text;
        EXPECT_THAT(radii_of(r.scene().primitives.back()), ElementsAre(1)) << text;
    }
}

/// Nothing of the block is taken for what stands behind it.
TEST(ReadMotion, BlocksWhoseTimesDoNotGrowStandStill) {
    for (const char* times : {"[0 0]", "[1 0]"}) {
        const std::string begin = std::string("MotionBegin ") + times + ' ';
        const ReadOutcome r = read_shutter("0 1", begin + "Translate 1 0 0 Translate 5 0 0 MotionEnd " +
                                                      begin + "Color 1 0 0 Color 0 1 0 MotionEnd " + begin +
                                                      "Sphere 2 -2 2 360 Sphere 3 -3 3 360 MotionEnd ");
        EXPECT_THAT(r.messages, ElementsAre(HasSubstr("times must grow; the first of what the block holds")));
        ASSERT_EQ(r.count(), 1u);
        EXPECT_EQ(r.primitive().key_count(), 1);
        EXPECT_EQ(r.primitive().camera_from_object[0].translation().x, 1);
        EXPECT_EQ(r.attributes().color, V3f(1, 0, 0));
        EXPECT_THAT(radii_of(r.primitive()), ElementsAre(2));
    }
}

TEST(ReadMotion, LaterShapesMayLackVariables) {
    const ReadOutcome r = read_shutter("0 1",
                                       "MotionBegin [0 1] "
                                       "Polygon \"P\" [0 0 0 1 0 0 0 1 0] \"st\" [0 0 1 0 0 1] "
                                       "Polygon \"P\" [0 0 4 1 0 4 0 1 4] MotionEnd ");
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("later shapes of the motion lack variables")));
    ASSERT_EQ(r.primitive().shape_keys.size(), 2u);
    EXPECT_EQ(r.primitive().shape_keys[1]->variables.find("P")->floats[2], 4);
    EXPECT_EQ(r.primitive().shape_keys[1]->variables.values.size(),
              r.primitive().shape().variables.values.size());
    EXPECT_GT(r.primitive().shape().variables.values.size(), 1u);
}

TEST(ReadMotion, TransformationsDoNotPileUpWithoutEnd) {
    std::string text;
    for (int i = 0; i < 1001; ++i) text += "MotionBegin [0 1] Translate 0 0 0 Translate 0 0 1 MotionEnd\n";
    const ReadOutcome r = read_shutter("0 1", text + kSphere);
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("more than 1000 motion blocks act on one transformation")));
    EXPECT_EQ(r.primitive().camera_from_object[1].translation().z, 1000);
}

}  // namespace
}  // namespace trapeze::testing
