/// Which attributes are an object's own, and which are its instance's.
#include <gmock/gmock.h>

#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Attributes in words, as far as requests of the tests set them.
std::string in_words(const Attributes& a) {
    std::ostringstream words;
    const auto shader = [&](const std::shared_ptr<const ShaderInstance>& s) {
        words << (s ? s->name : "none") << ' ';
    };
    words << a.color << a.opacity << a.shading_rate << ' ' << a.smooth_shading << a.matte << a.sides << ' ';
    for (const float t : a.texture_coordinates) words << t << ' ';
    for (const auto& s : {a.surface, a.displacement, a.atmosphere, a.interior, a.exterior}) shader(s);
    for (const auto& light : a.lights) words << "light " << light->handle << ' ';
    words << a.displacement_bound << ' ' << a.name << ' ' << a.visible_to_camera << a.cull_hidden << ' ';
    const RayAttributes& r = a.rays;
    words << r.diffuse << r.specular << r.transmission << static_cast<int>(r.transmission_hits) << ' '
          << r.bias << ' ' << r.max_diffuse << r.max_specular << r.displaced << r.sample_motion << ' ';
    for (const std::string& group : r.groups) words << "group " << group << ' ';
    words << a.dice.binary << a.dice.raster_oriented << a.dice.min_length << ' ' << a.motion_factor << ' '
          << a.focus_factor;
    a.user.for_each([&](const std::string& category, const Parameter& value) {
        words << ' ' << category << ':' << value.name << '=';
        for (const float number : value.floats) words << number;
        for (const std::string& text : value.strings) words << text;
    });
    return words.str();
}

const std::string kLights =
    "AttributeBegin LightSource \"ambientlight\" 1 LightSource \"ambientlight\" 2 AttributeEnd ";

/// Of a sphere before which the text stands.
std::string inline_words(const std::string& text) {
    const ReadOutcome outcome = read_world(kLights + text + kSphere);
    EXPECT_THAT(outcome.messages, IsEmpty());
    return in_words(outcome.attributes());
}

std::string instance_words(const std::string& before, const std::string& own,
                           const std::string& at_instance) {
    const ReadOutcome outcome = read_world(kLights + before + "ObjectBegin 1 " + own + kSphere +
                                           "ObjectEnd " + at_instance + "ObjectInstance 1");
    EXPECT_THAT(outcome.messages, IsEmpty());
    return in_words(outcome.attributes());
}

/// What an object says, and what stands before its instance.
struct OwnAndOther {
    std::string own, other;
};

/// The object's own are mostly what they would be without: a reader that looks for changes does not see them.
const std::vector<OwnAndOther> kCases = {
    {"Color [1 1 1] ", "Color [1 0 0] "},
    {"Opacity [1 1 1] ", "Opacity [.5 .5 .5] "},
    {"TextureCoordinates 0 0 1 0 0 1 1 1 ", "TextureCoordinates 0 1 1 1 0 0 1 0 "},
    {"ShadingRate 1 ", "ShadingRate 30 "},
    {"ShadingRate 1 ", "Attribute \"dice\" \"micropolygonlength\" 3 "},
    {"Attribute \"dice\" \"micropolygonlength\" 1 ", "ShadingRate 30 "},
    {"ShadingInterpolation \"constant\" ", "ShadingInterpolation \"smooth\" "},
    {"Matte 0 ", "Matte 1 "},
    {"Sides 2 ", "Sides 1 "},
    {"Surface \"matte\" ", "Surface \"metal\" "},
    {"Surface \"\" ", "Surface \"metal\" "},
    {"Displacement \"null\" ", "Displacement \"bumpy\" "},
    {"Atmosphere \"null\" ", "Atmosphere \"fog\" "},
    {"Interior \"null\" ", "Interior \"smoke\" "},
    {"Exterior \"null\" ", "Exterior \"smoke\" "},
    {"GeometricApproximation \"motionfactor\" 0 ", "GeometricApproximation \"motionfactor\" 2 "},
    {"GeometricApproximation \"focusfactor\" 0 ", "GeometricApproximation \"focusfactor\" 2 "},
    {"Attribute \"identifier\" \"name\" \"a\" ", "Attribute \"identifier\" \"name\" \"b\" "},
    {"Attribute \"displacementbound\" \"sphere\" 0 ", "Attribute \"displacementbound\" \"sphere\" .3 "},
    {"Attribute \"visibility\" \"int camera\" 1 ", "Attribute \"visibility\" \"int camera\" 0 "},
    {"Attribute \"cull\" \"int hidden\" 1 ", "Attribute \"cull\" \"int hidden\" 0 "},
    {"Attribute \"visibility\" \"int diffuse\" 0 ", "Attribute \"visibility\" \"int trace\" 1 "},
    {"Attribute \"trace\" \"float bias\" .02 ", "Attribute \"visibility\" \"int specular\" 1 "},
    {"Attribute \"trace\" \"int maxdiffusedepth\" 1 ", "Attribute \"trace\" \"int maxdiffusedepth\" 4 "},
    {"Attribute \"visibility\" \"string transmission\" \"Os\" "
     "Attribute \"visibility\" \"int transmission\" 1 ",
     "Attribute \"shade\" \"transmissionhitmode\" \"shader\" "},
    {"Attribute \"light\" \"shadows\" \"on\" Attribute \"light\" \"shadows\" \"off\" ",
     "Attribute \"visibility\" \"int transmission\" 0 "},
    {"Attribute \"grouping\" \"membership\" \"+a\" Attribute \"grouping\" \"membership\" \"+b\" ",
     "Attribute \"grouping\" \"membership\" \"c\" "},
    {"Attribute \"grouping\" \"membership\" \"+c\" Attribute \"grouping\" \"membership\" \"b\" ",
     "Attribute \"grouping\" \"membership\" \"c\" "},
    {"Attribute \"dice\" \"int binary\" 0 ", "Attribute \"dice\" \"int binary\" 1 \"float minlength\" 3 "},
    {"Attribute \"user\" \"float x\" 1 ", "Attribute \"user\" \"float x\" .5 \"float y\" 2 "},
    {"Attribute \"Ri\" \"int Matte\" 0 ", "Matte 1 "},
    {"Illuminate 1 0 ", "Illuminate 1 1 Illuminate 2 1 "},
    {"Illuminate 2 1 ", "Illuminate 1 1 "},
};

TEST(ReadObjects, WhatADefinitionSetsIsItsOwn) {
    for (const auto& [own, other] : kCases) {
        const std::string expected = inline_words(other + own);
        EXPECT_EQ(instance_words("", own, other), expected) << own << other;
        EXPECT_NE(inline_words(other), expected) << "tests nothing: " << own << other;
    }
}

TEST(ReadObjects, WhatADefinitionSetsToWhatItIsAlreadyIsItsOwn) {
    for (const auto& [own, other] : kCases)
        EXPECT_EQ(instance_words(own, own, other), inline_words(own + other + own)) << own << other;
}

TEST(ReadObjects, WhatADefinitionDoesNotSetIsTheInstances) {
    for (const auto& [own, other] : kCases)
        EXPECT_EQ(instance_words(own, "ReverseOrientation ", other), inline_words(own + other))
            << own << other;
}

/// The inner object's own stays its own, and the outer one's is heeded where the inner one says nothing.
TEST(ReadObjects, ObjectsInObjectsKeepTheirOwn) {
    const ReadOutcome outcome =
        read_world("ObjectBegin 1 Color [1 1 1] " + kSphere +
                   "ObjectEnd ObjectBegin 2 Opacity [1 1 1] Color [0 1 0] Attribute \"user\" \"float x\" 1 "
                   "ObjectInstance 1 ObjectEnd Color [1 0 0] Opacity [.5 .5 .5] Sides 1 ObjectInstance 2");
    EXPECT_THAT(outcome.messages, IsEmpty());
    ASSERT_EQ(outcome.count(), 1u);
    EXPECT_EQ(outcome.attributes().color, V3f(1, 1, 1));
    EXPECT_EQ(outcome.attributes().opacity, V3f(1, 1, 1));
    EXPECT_EQ(outcome.attributes().sides, 1);
    EXPECT_EQ(outcome.attributes().user.float_or("user", "x", 0), 1);
}

TEST(ReadObjects, BlocksEndWhatADefinitionHasOfItsOwn) {
    const ReadOutcome outcome =
        read_world("ObjectBegin 1 AttributeBegin Color [1 1 1] AttributeEnd Sides 2 " + kSphere +
                   "ObjectEnd Color [1 0 0] Sides 1 ObjectInstance 1");
    EXPECT_EQ(outcome.attributes().color, V3f(1, 0, 0));
    EXPECT_EQ(outcome.attributes().sides, 2);
}

/// A state from outside of the definition is set as a whole, and its shader stays where it was. One that the
/// definition has saved has of its own what it had then.
TEST(ReadObjects, RestoredStatesAreTheirOwn) {
    const std::string save = "Resource \"r\" \"attributes\" \"string operation\" \"save\" ",
                      restore =
                          "Resource \"r\" \"attributes\" \"string operation\" \"restore\" "
                          "\"string subset\" \"shading\" ";
    const ReadOutcome outcome = read_world(
        "ResourceBegin AttributeBegin Sides 1 Translate 0 7 0 Surface \"metal\" " + save +
        "AttributeEnd ObjectBegin 1 " + restore + kSphere + "ObjectEnd ObjectBegin 2 Sides 2 " + save +
        "Color 0 1 0 " + restore + kSphere +
        "ObjectEnd ResourceEnd Color [1 0 0] Sides 1 Translate 0 0 5 ObjectInstance 1 ObjectInstance 2");
    EXPECT_THAT(outcome.messages, IsEmpty());
    ASSERT_EQ(outcome.count(), 2u);
    EXPECT_EQ(outcome.attributes(0).color, V3f(1, 1, 1));
    EXPECT_EQ(outcome.attributes(0).sides, 1);
    EXPECT_EQ(outcome.attributes(0).surface->name, "metal");
    EXPECT_EQ(outcome.attributes(0).surface->camera_from_shader.translation(), V3f(0, 7, 0));
    EXPECT_EQ(outcome.attributes(1).color, V3f(1, 0, 0));
    EXPECT_EQ(outcome.attributes(1).sides, 2);
}

/// An area light that stands before an instance shines from it, unless the object says that it does not.
TEST(ReadObjects, AreaLightsAreTheInstancesToo) {
    const auto shines = [](const std::string& own) {
        const ReadOutcome outcome = read_world("ObjectBegin 1 " + own + "Color 0 1 0 " + kSphere +
                                               "ObjectEnd AreaLightSource \"arealight\" 1 ObjectInstance 1");
        EXPECT_THAT(outcome.messages, IsEmpty());
        return outcome.primitive().emitter != nullptr;
    };
    EXPECT_TRUE(shines(""));
    EXPECT_FALSE(shines("AreaLightSource \"null\" 2 "));
}

/// The bound is the instance's, which is placed: the range chooses by the object's own.
TEST(ReadObjects, RangesOfDetailAreTheirOwn) {
    const auto count = [](const std::string& own) {
        return read_world("ObjectBegin 1 " + own + kSphere +
                          "ObjectEnd Detail [-.1 .1 -.1 .1 0 1] DetailRange [0 0 1 1] ObjectInstance 1")
            .count();
    };
    EXPECT_EQ(count(""), 0u);
    EXPECT_EQ(count("DetailRange [0 0 1e38 1e38] "), 1u);
}

}  // namespace
}  // namespace trapeze::testing
