/// Levels of detail, and how geometry may be approximated.
#include <array>
#include <cmath>

#include "core/scene/level_of_detail.h"
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A picture of 100 x 100 pixels of [-1, 1] x [-1, 1], seen along z.
const std::string kView = "Format 100 100 1 Projection \"orthographic\" ";
/// 40 x 20 pixels.
const std::string kBound = "Detail [-0.4 0.4 -0.2 0.2 0 3] ";

/// Of the samples' numbers, those that see the primitive: none is {0, 0}.
std::array<float, 2> seen(const std::string& range, const std::string& options = "") {
    const ReadOutcome outcome = read_text(kView + options + "WorldBegin Opacity 0.5 0.5 1 " + kBound +
                                          "DetailRange " + range + " " + kSphere + "WorldEnd");
    EXPECT_THAT(outcome.messages, IsEmpty());
    if (outcome.count() == 0) return {0, 0};
    EXPECT_EQ(outcome.attributes().opacity, V3f(0.5f, 0.5f, 1));
    const SeenNumbers numbers = seen_numbers(outcome.attributes());
    return {numbers.from, numbers.to};
}

TEST(ReadDetail, TheAreaOnThePictureCounts) {
    EXPECT_THAT(seen("[0 0 1e38 1e38]"), ElementsAre(0, 1));
    EXPECT_THAT(seen("[799 799 801 801]"), ElementsAre(0, 1));
    EXPECT_THAT(seen("[0 0 799 799]"), ElementsAre(0, 0));
    EXPECT_THAT(seen("[801 801 1e38 1e38]"), ElementsAre(0, 0));
}

TEST(ReadDetail, TransitionsShareOutTheSamples) {
    EXPECT_THAT(seen("[700 1100 1e38 1e38]"), ElementsAre(0, FloatNear(0.25f, 1e-4f)));
    EXPECT_THAT(seen("[0 0 700 1100]"), ElementsAre(FloatNear(0.25f, 1e-4f), 1));
    EXPECT_THAT(seen("[0 100 600 1000]", "RelativeDetail 1.125 "), ElementsAre(FloatNear(0.75f, 1e-4f), 1));
    EXPECT_THAT(seen("[0 0 10 20]", "RelativeDetail 0 "), ElementsAre(0, 1));
}

TEST(ReadDetail, LevelsThatPassIntoEachOtherAddUpToTheBit) {
    for (const char* range : {"700 1100", "1 801", "799.9 800.3", "3.7 1e6"}) {
        const std::string transition(range);
        EXPECT_EQ(seen("[" + transition + " 1e38 1e38]")[1], seen("[0 0 " + transition + "]")[0]) << range;
    }
}

TEST(ReadDetail, PerspectiveMakesFarThingsSmall) {
    const auto seen = [](const std::string& range) {
        return read_text(
                   "Format 100 100 1 Projection \"perspective\" \"fov\" [90] WorldBegin "
                   "Translate 0 0 4 Detail [-1 1 -1 1 0 0] DetailRange " +
                   range + " " + kSphere + "WorldEnd")
                   .count() == 1;
    };
    // At z = 4 the picture is 8 wide: 25 x 25 pixels.
    EXPECT_TRUE(seen("[624 624 626 626]"));
    EXPECT_FALSE(seen("[626 626 1e38 1e38]"));
}

TEST(ReadDetail, BoundsAroundTheEyeAreLarge) {
    const ReadOutcome outcome = read_text(
        "Projection \"perspective\" WorldBegin Detail [-1 1 -1 1 -1 1] DetailRange [1e20 1e20 1e38 1e38] " +
        kSphere + "WorldEnd");
    EXPECT_EQ(outcome.count(), 1u);
}

TEST(ReadDetail, WithoutABoundDetailIsInfinite) {
    EXPECT_EQ(read_world("DetailRange [0 0 100 100] " + kSphere).count(), 0u);
    EXPECT_EQ(read_world("DetailRange [5 10 1e38 1e38] " + kSphere).count(), 1u);
}

TEST(ReadDetail, BlocksRestoreItAndInstancesTakeIt) {
    const ReadOutcome outcome =
        read_text(kView + "WorldBegin ObjectBegin 1 " + kSphere + "ObjectEnd AttributeBegin " + kBound +
                  "DetailRange [0 0 10 10] ObjectInstance 1 DetailRange [0 0 700 1100] "
                  "ObjectInstance 1 AttributeEnd ObjectInstance 1 WorldEnd");
    ASSERT_EQ(outcome.count(), 2u);
    EXPECT_NEAR(seen_numbers(outcome.attributes(0)).from, 0.25f, 1e-4f);
    EXPECT_EQ(seen_numbers(outcome.attributes(1)).from, 0);
}

TEST(ReadDetail, WrongOnesAreSaid) {
    const ReadOutcome outcome = read_world(
        "DetailRange [3 2 1 0]\nDetail [1 0 0 1 0 1]\nBound [0 1 0 1]\n"
        "ObjectBegin 1 Detail [0 1 0 1 0 1] ObjectEnd " +
        kSphere);
    EXPECT_THAT(outcome.messages,
                ElementsAre(HasSubstr("DetailRange: needs minvisible <= lowertransition"),
                            HasSubstr("Detail: the bound is empty"),
                            HasSubstr("Bound: the bound has 4 numbers, needs 6"),
                            HasSubstr("Detail: inside an object definition is not supported")));
    EXPECT_EQ(outcome.count(), 1u);
}

TEST(ReadApproximation, FactorsAndDiceBecomeAttributes) {
    const ReadOutcome outcome = read_world(
        "GeometricApproximation \"motionfactor\" 1.5 GeometricApproximation \"focusfactor\" [2] "
        "GeometricApproximation \"flatness\" 0.5 GeometricRepresentation \"smooth\" Bound [0 1 0 1 0 1] "
        "Attribute \"dice\" \"int binary\" [1] \"rasterorient\" [0] \"int hair\" [1] "
        "\"float minlength\" [3] " +
        kSphere);
    EXPECT_THAT(outcome.messages, IsEmpty());
    const Attributes& a = outcome.attributes();
    EXPECT_EQ(a.motion_factor, 1.5f);
    EXPECT_EQ(a.focus_factor, 2);
    EXPECT_TRUE(a.dice.binary);
    EXPECT_FALSE(a.dice.raster_oriented);
    EXPECT_EQ(a.dice.min_length, 3);
}

TEST(ReadAttributes, VisibilityHasManyForms) {
    const auto visible = [](const std::string& attribute) {
        const ReadOutcome outcome = read_world("Attribute " + attribute + kSphere);
        EXPECT_THAT(outcome.messages, IsEmpty());
        return outcome.attributes().visible_to_camera;
    };
    EXPECT_TRUE(visible("\"visibility\" \"int camera\" [1] "));
    EXPECT_FALSE(visible("\"visibility\" \"int camera\" [0] "));
    EXPECT_FALSE(visible("\"visibility\" \"camera\" 0 "));
    EXPECT_FALSE(visible("\"visibility\" \"string camera\" [\"off\"] "));
    EXPECT_TRUE(visible("\"visibility\" \"string camera\" [\"on\"] "));
    EXPECT_TRUE(visible("\"visibility\" \"string transmission\" [\"transparent\"] "));
    EXPECT_TRUE(visible("\"render\" \"integer visibility\" [7] "));
    EXPECT_FALSE(visible("\"render\" \"integer visibility\" [6] "));
}

TEST(ReadAttributes, OldFilesBoundDisplacementsToo) {
    const ReadOutcome outcome = read_world("Scale 2 2 2 Attribute \"bound\" \"displacement\" 0.1 " + kSphere);
    EXPECT_THAT(outcome.messages, IsEmpty());
    EXPECT_NEAR(outcome.attributes().displacement_bound, 0.2f, 1e-6f);
    EXPECT_THAT(outcome.summary.without_effect, IsEmpty());
}

TEST(ReadApproximation, ObjectsKeepTheirOwn) {
    const ReadOutcome outcome = read_world(
        "ObjectBegin 1 GeometricApproximation \"motionfactor\" 2 "
        "Attribute \"dice\" \"int binary\" [1] " +
        kSphere + "ObjectEnd ObjectInstance 1");
    EXPECT_EQ(outcome.attributes().motion_factor, 2);
    EXPECT_TRUE(outcome.attributes().dice.binary);
}

TEST(ReadApproximation, UnknownOrNegativeOnesAreSaid) {
    const ReadOutcome outcome = read_world(
        "GeometricApproximation \"motionfactor\" -1\n"
        "GeometricApproximation \"wobble\" 1 GeometricApproximation "
        "\"wobble\" 1 " +
        kSphere);
    EXPECT_THAT(outcome.messages, ElementsAre(HasSubstr("the factor must not be negative"),
                                              HasSubstr("\"wobble\" is not known; ignored")));
}

}  // namespace
}  // namespace trapeze::testing
