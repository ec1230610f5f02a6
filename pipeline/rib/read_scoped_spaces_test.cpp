/// Coordinate systems that hold for a part of a world, and what shaders know of them.
#include <gmock/gmock.h>

#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::string kScoped = "ScopedCoordinateSystem \"s\" ", kNamed = "CoordinateSystem \"s\" ",
                  kMatte = "Surface \"matte\" ";

/// Where the surface of primitive i finds the origin of "s".
V3f origin_of_s(const ReadOutcome& outcome, size_t i = 0) {
    const auto& scoped = outcome.attributes(i).surface->camera_from_scoped;
    if (scoped)
        if (const auto space = scoped->find("s"); space != scoped->end()) return space->second.translation();
    const auto& named = outcome.scene().camera_from_named;
    const auto space = named.find("s");
    return space == named.end() ? V3f(-99) : space->second.translation();
}

std::string translated(float x, const std::string& text) {
    return "AttributeBegin Translate " + std::to_string(x) + " 0 0 " + text + "AttributeEnd ";
}

/// A surface is given to many primitives: each sees what holds where the primitive stands.
TEST(ReadScopedSpaces, ShadersSeeWhatHoldsWhereThePrimitiveStands) {
    const ReadOutcome r = read_text(
        "Translate 0 0 5 WorldBegin " + kMatte + translated(1, kScoped + kSphere) +
        translated(2, kScoped + kSphere + translated(3, kScoped + kSphere) + kSphere) + kSphere + "WorldEnd");
    EXPECT_THAT(r.messages, IsEmpty());
    ASSERT_EQ(r.count(), 5u);
    EXPECT_EQ(origin_of_s(r, 0), V3f(1, 0, 5));
    EXPECT_EQ(origin_of_s(r, 1), V3f(2, 0, 5));
    EXPECT_EQ(origin_of_s(r, 2), V3f(5, 0, 5));
    EXPECT_EQ(origin_of_s(r, 3), V3f(2, 0, 5));
    EXPECT_EQ(origin_of_s(r, 4), V3f(1, 0, 5));  // of another block; there the first stands for all
}

TEST(ReadScopedSpaces, AllKindsOfShadersAndTheirLayersSeeThem) {
    const ReadOutcome r = read_world(
        translated(1, kScoped) +
        translated(2, kScoped +
                          "ShaderLayer \"surface\" \"matte\" \"a\" ShaderLayer \"surface\" \"matte\" \"b\" "
                          "Displacement \"d\" Atmosphere \"fog\" Interior \"i\" Exterior \"e\" " +
                          kSphere));
    const Attributes& a = r.attributes();
    ASSERT_EQ(a.surface->earlier_layers.size(), 1u);
    for (const auto& shader :
         {a.surface, a.surface->earlier_layers[0], a.displacement, a.atmosphere, a.interior, a.exterior}) {
        ASSERT_TRUE(shader->camera_from_scoped) << shader->name;
        EXPECT_EQ(shader->camera_from_scoped->at("s").translation(), V3f(2, 0, 0));
    }
}

/// Names that hold for all hide none that are scoped, whichever comes first.
TEST(ReadScopedSpaces, ScopedNamesHideOthers) {
    for (const bool later : {false, true}) {
        const std::string named = translated(7, kNamed), scoped = translated(1, kScoped + kSphere);
        const ReadOutcome r = read_world(kMatte + (later ? scoped + named : named + scoped) + kSphere);
        EXPECT_EQ(origin_of_s(r, 0), V3f(1, 0, 0)) << later;
        EXPECT_EQ(origin_of_s(r, 1), V3f(7, 0, 0)) << later;
    }
}

TEST(ReadScopedSpaces, ShadersAreSharedWhereNamesAreGivenOnce) {
    const ReadOutcome r = read_world(kMatte + translated(1, kScoped + kSphere) +
                                     translated(2, "ScopedCoordinateSystem \"t\" " + kSphere) + kSphere);
    EXPECT_EQ(r.attributes(0).surface, r.attributes(2).surface);
    EXPECT_EQ(r.attributes(1).surface, r.attributes(2).surface);
    EXPECT_EQ(r.scene().camera_from_named.at("t").translation(), V3f(2, 0, 0));
}

/// Those of an object stand where each instance does, also in objects that hold instances of it.
TEST(ReadScopedSpaces, ObjectsHaveTheirOwnInEachInstance) {
    for (const std::string& name : {kScoped, kNamed}) {
        const ReadOutcome r = read_world(
            "Translate 0 4 0 ObjectBegin 1 Translate 1 0 0 " + name + kMatte + kSphere +
            "ObjectEnd ObjectBegin 2 Translate 0 1 0 ObjectInstance 1 ObjectEnd Translate 0 -4 0 " +
            translated(10, "ObjectInstance 1 ") + translated(20, "ObjectInstance 1 ObjectInstance 2 ") +
            kMatte + kSphere);
        EXPECT_THAT(r.messages, IsEmpty());
        ASSERT_EQ(r.count(), 4u);
        EXPECT_EQ(origin_of_s(r, 0), V3f(11, 0, 0));
        EXPECT_EQ(origin_of_s(r, 1), V3f(21, 0, 0));
        EXPECT_EQ(origin_of_s(r, 2), V3f(21, 1, 0));
        EXPECT_EQ(r.attributes(3).surface->camera_from_scoped, nullptr);
        EXPECT_FALSE(r.scene().camera_from_named.contains("s"));
    }
}

TEST(ReadScopedSpaces, NamesOfAnObjectHideTheInstancesAndOthersDoNot) {
    const std::string object = "ObjectBegin 1 " + kMatte + "AttributeBegin Translate 1 0 0 " + kNamed +
                               "AttributeEnd " + kSphere + translated(2, kScoped + kSphere) + "ObjectEnd ";
    const ReadOutcome r = read_world(
        translated(5, kNamed) + object + translated(10, kScoped + "ObjectInstance 1 ") + "ObjectBegin 2 " +
        kSphere + "ObjectEnd " + kMatte + translated(30, kScoped + "ObjectInstance 2 ") + "ObjectInstance 2");
    ASSERT_EQ(r.count(), 4u);
    EXPECT_EQ(origin_of_s(r, 0), V3f(11, 0, 0));
    EXPECT_EQ(origin_of_s(r, 1), V3f(12, 0, 0));
    EXPECT_EQ(origin_of_s(r, 2), V3f(30, 0, 0));
    EXPECT_EQ(origin_of_s(r, 3), V3f(5, 0, 0));  // named outside of the object, which did not overwrite it
}

TEST(ReadScopedSpaces, BoundsOfDisplacementsAreMeasuredInThem) {
    const std::string bound =
        "Attribute \"displacementbound\" \"sphere\" 1 \"coordinatesystem\" \"s\" Displacement \"d\" ";
    const ReadOutcome r = read_world("ObjectBegin 1 Scale 2 2 2 " + kScoped + bound + kSphere +
                                     "ObjectEnd Scale 3 3 3 ObjectInstance 1");
    EXPECT_THAT(r.messages, IsEmpty());
    EXPECT_NEAR(r.attributes().displacement_bound, 6, 1e-5);
}

TEST(ReadScopedSpaces, ThereIsAnEndOfThem) {
    ReadOptions options;
    options.most_scene_bytes = 1 << 20;
    std::string text = kMatte;
    for (int i = 0; i < 200; ++i)
        text += "ScopedCoordinateSystem \"s" + std::to_string(i) + "\" " + kSphere + "\n";
    const ReadOutcome r = read_world(text, options);
    EXPECT_LT(r.count(), 200u);
    EXPECT_THAT(r.messages, ElementsAre(::testing::HasSubstr("which is the limit")));
}

}  // namespace
}  // namespace trapeze::testing
