/// Displays and what they show, and the imager before them.
#include "core/colors/transfer.h"
#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The variable of `Display "+b.exr" "exr" "mode"`, after `before`.
std::optional<DisplayVariable> variable_of(const std::string& mode, const std::string& before = {}) {
    const ReadOutcome r = read_text("Display \"a.exr\" \"exr\" \"rgba\" " + before +
                                    " Display \"+b.exr\" \"exr\" \"" + mode + "\" WorldBegin WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    EXPECT_EQ(r.scene().options.displays.at(1).mode, mode);
    EXPECT_FALSE(r.scene().options.displays.at(0).variable);
    return r.scene().options.displays.at(1).variable;
}

void expect_variable(const std::optional<DisplayVariable>& variable, const char* name, ValueType type) {
    ASSERT_TRUE(variable) << name;
    EXPECT_EQ(variable->name, name);
    EXPECT_EQ(variable->type, type) << name;
}

TEST(ReadDisplays, ModesDeclareVariables) {
    expect_variable(variable_of("varying color foo"), "foo", ValueType::Color);
    expect_variable(variable_of("color foo"), "foo", ValueType::Color);
    expect_variable(variable_of("  varying   float depth_0 "), "depth_0", ValueType::Float);
    expect_variable(variable_of("uniform point foo"), "foo", ValueType::Point);
    expect_variable(variable_of("vector foo"), "foo", ValueType::Vector);
    expect_variable(variable_of("varying normal N"), "N", ValueType::Normal);
    expect_variable(variable_of("color[1] foo"), "foo", ValueType::Color);
    expect_variable(variable_of("float z"), "z", ValueType::Float);
}

TEST(ReadDisplays, ModesNameVariablesWhoseTypesAreKnown) {
    expect_variable(variable_of("N"), "N", ValueType::Normal);
    expect_variable(variable_of("color Ci"), "Ci", ValueType::Color);
    expect_variable(variable_of("s"), "s", ValueType::Float);
    expect_variable(variable_of("foo", "Declare \"foo\" \"varying vector\""), "foo", ValueType::Vector);
    expect_variable(variable_of("foo", "DisplayChannel \"varying color foo\""), "foo", ValueType::Color);
}

TEST(ReadDisplays, QuantizeMayNameTheirVariablesBeforeThem) {
    const ReadOutcome r = read_text(
        "Quantize \"foo\" 1000 0 65535 0\nQuantize \"bar\" 255 0 255 0\nDisplay \"a.tif\" \"tiff\" \"rgba\" "
        "Display \"+b.tif\" \"tiff\" \"varying color foo\" WorldBegin WorldEnd");
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("a.rib:2:1: warning: Quantize: \"bar\" is not known")));
    ASSERT_TRUE(r.scene().options.quantize.find("foo"));
    EXPECT_EQ(r.scene().options.quantize.float_or("foo", 0), 1000);
}

TEST(ReadDisplays, ColourDepthAndIdsAreNoVariables) {
    for (const char* mode : {"", "rgb", "rgba", "rgbaz", "a", "z", "az", "id"})
        EXPECT_FALSE(variable_of(mode));
}

TEST(ReadDisplays, WhatHasNotOneOrThreeNumbersIsNoVariable) {
    for (const char* mode : {"foo", "varying", "varying color", "color[2] foo", "string foo", "matrix foo",
                             "hpoint Pw", "color a-b", "color foo bar"})
        EXPECT_FALSE(variable_of(mode)) << mode;
    EXPECT_FALSE(variable_of("color " + std::string(300, 'x')));
}

TEST(ReadDisplays, ChannelsHandTheirParametersToDisplays) {
    const ReadOutcome r = read_text(
        "DisplayChannel \"float foo\" \"quantize\" [0 100 0 100] \"float dither\" [0.25]\n"
        "Display \"a.tif\" \"tiff\" \"foo\" \"dither\" [0]\n"
        "FrameBegin 1 DisplayChannel \"color bar\" FrameEnd\n"
        "Display \"+b.tif\" \"tiff\" \"bar\" WorldBegin WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    const std::vector<Display>& displays = r.scene().options.displays;
    ASSERT_EQ(displays.size(), 2u);
    expect_variable(displays[0].variable, "foo", ValueType::Float);
    ASSERT_NE(displays[0].parameters.find("quantize"), nullptr);
    EXPECT_THAT(displays[0].parameters.find("quantize")->floats, ElementsAre(0, 100, 0, 100));
    EXPECT_EQ(displays[0].parameters.float_or("dither", 1), 0);
    EXPECT_FALSE(displays[1].variable) << "a frame's channels end with it";
}

TEST(ReadDisplays, FiltersOfVariables) {
    const ReadOutcome r = read_text(
        "DisplayChannel \"point P\" \"string filter\" [\"zmin\"]\n"
        "Display \"a.exr\" \"openexr\" \"Ci,P,N\"\n"
        "Display \"+b.exr\" \"openexr\" \"color foo\" \"string filter\" [\"max\"]\n"
        "Display \"+c.exr\" \"openexr\" \"color foo\" \"string filter\" [\"median\"] WorldBegin WorldEnd");
    EXPECT_THAT(r.messages,
                ElementsAre(HasSubstr("\"median\" of a display is none of min, max, zmin and zmax")));
    const std::vector<Display>& displays = r.scene().options.displays;
    ASSERT_EQ(displays.size(), 5u);
    EXPECT_EQ(displays[1].variable->filter, VariableFilter::Nearest);
    EXPECT_EQ(displays[2].variable->filter, VariableFilter::Picture);
    EXPECT_EQ(displays[3].variable->filter, VariableFilter::Max);
    EXPECT_EQ(displays[4].variable->filter, VariableFilter::Picture);
}

TEST(ReadDisplays, ListsOfChannelsAreDisplaysOfOneFile) {
    const ReadOutcome r = read_text(
        "DisplayChannel \"color even\" \"string source\" [\"Ci\"] \"float dither\" [.25]\n"
        "Display \"a.exr\" \"openexr\" \"a, even,Ci,varying normal N,z\" \"string compression\" [\"piz\"]\n"
        "Display \"+b.exr\" \"openexr\" \"even,N\" WorldBegin WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    const std::vector<Display>& displays = r.scene().options.displays;
    ASSERT_EQ(displays.size(), 5u);
    for (size_t i = 0; i < 5; ++i) EXPECT_EQ(displays[i].name, i < 3 ? "a.exr" : "b.exr");
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(displays[i].parameters.string_or("compression", ""), "piz");
    EXPECT_EQ(displays[0].mode, "rgbaz");
    EXPECT_FALSE(displays[0].variable);
    expect_variable(displays[1].variable, "Ci", ValueType::Color);
    EXPECT_EQ(displays[1].layer, "even");
    EXPECT_EQ(displays[1].parameters.float_or("dither", 0), .25f);
    expect_variable(displays[2].variable, "N", ValueType::Normal);
    expect_variable(displays[3].variable, "Ci", ValueType::Color);
    EXPECT_FALSE(displays[0].parameters.find("dither"));
    const ReadOutcome replaced =
        read_text("Display \"a.exr\" \"exr\" \"rgb,N\" Display \"b.exr\" \"exr\" \",\" WorldBegin WorldEnd");
    ASSERT_EQ(replaced.scene().options.displays.size(), 1u);
    EXPECT_EQ(replaced.scene().options.displays[0].mode, "");
}

TEST(ReadDisplays, ChannelsMayBeOtherNamesOfVariables) {
    const ReadOutcome r = read_text(
        "DisplayChannel \"color even\" \"string source\" [\"Ci\"] \"string statistics\" [\"even\"]\n"
        "DisplayChannel \"color albedo\" \"string source\" [\"color lpe:nothruput;noinfinitecheck;C\"]\n"
        "Display \"a.exr\" \"openexr\" \"even\" Display \"+b.exr\" \"openexr\" \"albedo\"\n"
        "Display \"+c.exr\" \"openexr\" \"N\" WorldBegin WorldEnd");
    EXPECT_THAT(r.messages, ElementsAre(HasSubstr("there are no paths of light to choose from")));
    ASSERT_EQ(r.scene().options.displays.size(), 2u);
    expect_variable(r.scene().options.displays[0].variable, "Ci", ValueType::Color);
    EXPECT_EQ(r.scene().options.displays[1].name, "c.exr");
}

TEST(ReadDisplays, SourcesMayHaveTypes) {
    const ReadOutcome r = read_text(
        "DisplayChannel \"normal n\" \"string source\" [\"normal Nn\"]\n"
        "DisplayChannel \"point p\" \"string source\" [\"varying point P\"]\n"
        "Display \"c.exr\" \"openexr\" \"n,p\" WorldBegin WorldEnd\n");
    EXPECT_TRUE(r.messages.empty());
    const std::vector<Display>& displays = r.scene().options.displays;
    ASSERT_EQ(displays.size(), 2u);
    EXPECT_EQ(displays[0].variable->name, "N");
    EXPECT_EQ(displays[0].layer, "n");
    EXPECT_EQ(displays[1].variable->name, "P");
}

TEST(ReadDisplays, ChannelsOfIntegersAreFloats) {
    const ReadOutcome r =
        read_text("DisplayChannel \"int layer\" Display \"a.exr\" \"openexr\" \"layer\" WorldBegin WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    expect_variable(r.scene().options.displays[0].variable, "layer", ValueType::Float);
}

TEST(ReadDisplays, WrongChannelsAreErrors) {
    const ReadOutcome r =
        read_text("DisplayChannel \"string foo\"\nDisplayChannel \"rgb\"\nWorldBegin WorldEnd");
    EXPECT_THAT(r.messages,
                ElementsAre(HasSubstr("\"string foo\" is no float, color, point, vector or normal")));
}

TEST(ReadDisplays, ImagersAreShadersWithParameters) {
    const ReadOutcome r = read_text(
        "Translate 1 2 3 Imager \"background\" \"bgcolor\" [.1 .2 .3] \"uniform float strange\" [7]\n"
        "WorldBegin WorldEnd Imager \"null\" WorldBegin WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.worlds.size(), 2u);
    const auto& imager = r.worlds[0].options.imager;
    ASSERT_TRUE(imager);
    EXPECT_EQ(imager->name, "background");
    EXPECT_EQ(imager->location.line, 1u);
    EXPECT_EQ(imager->camera_from_shader.translation(), V3f(1, 2, 3));
    ASSERT_NE(imager->parameters.find("bgcolor"), nullptr);
    EXPECT_THAT(imager->parameters.find("bgcolor")->floats, ElementsAre(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(imager->parameters.float_or("strange", 0), 7);
    EXPECT_FALSE(r.worlds[1].options.imager);
}

TEST(ReadDisplays, UnknownTransfersAreErrorsAndChangeNothing) {
    const ReadOutcome r = read_text(
        "Option \"color\" \"string transfer\" [\"srgb\"]\nOption \"color\" \"transfer\" [\"rec709\"]\n"
        "Option \"color\" \"transfer\" [2.2]\n"
        "Display \"a.png\" \"png\" \"rgb\" \"colorspace\" \"linear\"\n"
        "Display \"+b.png\" \"png\" \"rgb\" \"colorspace\" \"rec709\" WorldBegin WorldEnd");
    EXPECT_THAT(
        r.messages,
        ElementsAre(HasSubstr("Option: \"transfer\" is \"linear\", \"srgb\" or \"auto\", not \"rec709\""),
                    HasSubstr("a.rib:3:"), HasSubstr("Display: \"colorspace\" is")));
    const Options& options = r.scene().options;
    EXPECT_EQ(transfer_of(options), Transfer::Srgb);
    ASSERT_EQ(options.displays.size(), 2u);
    EXPECT_EQ(options.displays[0].parameters.string_or("colorspace", ""), "linear");
    EXPECT_FALSE(options.displays[1].parameters.find("colorspace"));
    EXPECT_TRUE(r.summary.without_effect.empty());
}

}  // namespace
}  // namespace trapeze::testing
