#include "pipeline/rib/state/declarations.h"

#include <gtest/gtest.h>

namespace trapeze::rib {
namespace {

TEST(Declarations, WhatIsForgottenWasDeclaredBefore) {
    Declarations declarations;
    declarations.declare("wobble", *parse_declaration("uniform float"));
    declarations.forget("wobble");
    EXPECT_FALSE(declarations.resolve("wobble"));
    declarations.forget("nobody knows");
    declarations.forget("P");
    EXPECT_TRUE(declarations.resolve("P"));
}

TEST(Declarations, ClassTypeAndLength) {
    EXPECT_EQ(parse_declaration("uniform color"), (Declaration{StorageClass::Uniform, ValueType::Color, 1}));
    EXPECT_EQ(parse_declaration("float"), (Declaration{StorageClass::Uniform, ValueType::Float, 1}));
    EXPECT_EQ(parse_declaration(" vertex  hpoint "),
              (Declaration{StorageClass::Vertex, ValueType::HPoint, 1}));
    EXPECT_EQ(parse_declaration("facevarying float[2]"),
              (Declaration{StorageClass::FaceVarying, ValueType::Float, 2}));
    EXPECT_EQ(parse_declaration("constant string [3]"),
              (Declaration{StorageClass::Constant, ValueType::String, 3}));
    EXPECT_EQ(parse_declaration("integer [ 2.0 ]"),
              (Declaration{StorageClass::Uniform, ValueType::Integer, 2}));
    EXPECT_EQ(parse_declaration("vertex mpoint"), (Declaration{StorageClass::Vertex, ValueType::Matrix, 1}));
    EXPECT_EQ(parse_declaration("reference color[2]"),
              (Declaration{StorageClass::Uniform, ValueType::String, 2}));
    EXPECT_EQ(parse_declaration("int"), (Declaration{StorageClass::Uniform, ValueType::Integer, 1}));
    EXPECT_EQ(parse_declaration("matrix")->floats_per_item(), 16);
}

TEST(Declarations, WhatIsNone) {
    for (const char* text : {"", "uniform", "reference", "colour", "uniform colour", "float[0]", "float[-1]",
                             "float[99999999999]", "float[2", "float[]", "float[2x]", "float[2.5]",
                             "float[2.", "float x y", "varying uniform float"})
        EXPECT_EQ(parse_declaration(text), std::nullopt) << text;
}

TEST(Declarations, InlineOnesCarryTheName) {
    const Declarations declarations;
    const auto resolved = declarations.resolve("varying color[2] tint");
    ASSERT_TRUE(resolved);
    EXPECT_EQ(resolved->first, "tint");
    EXPECT_EQ(resolved->second, (Declaration{StorageClass::Varying, ValueType::Color, 2}));
    EXPECT_FALSE(declarations.resolve("varying colour tint"));
    EXPECT_FALSE(declarations.resolve("tint"));
    EXPECT_FALSE(declarations.resolve(""));
}

TEST(Declarations, PredeclaredNamesMayHaveSpaces) {
    EXPECT_EQ(Declarations().resolve("enable lerp")->first, "enable lerp");
    EXPECT_EQ(Declarations().resolve("enable gaussian")->second.type, ValueType::Float);
}

TEST(Declarations, DeclareReplaces) {
    Declarations declarations;
    declarations.declare("tint", *parse_declaration("varying color"));
    EXPECT_EQ(declarations.resolve("tint")->second.type, ValueType::Color);
    declarations.declare("tint", *parse_declaration("float"));
    EXPECT_EQ(declarations.resolve("tint")->second.type, ValueType::Float);
    EXPECT_TRUE(declarations.find("Kd")->is_predeclared);
    declarations.declare("Kd", *parse_declaration("string"));
    EXPECT_FALSE(declarations.find("Kd")->is_predeclared);
    EXPECT_FALSE(declarations.find("tint")->is_predeclared);
}

/// RISpec appendix A: the parameters of the standard shaders need no declaration.
TEST(Declarations, ParametersOfTheStandardShadersAreKnown) {
    const Declarations declarations;
    const auto expect = [&](std::initializer_list<const char*> names, ValueType type) {
        for (const char* name : names) {
            const auto resolved = declarations.resolve(name);
            ASSERT_TRUE(resolved) << name;
            EXPECT_EQ(resolved->second.type, type) << name;
        }
    };
    expect({"Ka", "Kd", "Ks", "Kr", "Km", "roughness", "intensity", "coneangle", "conedeltaangle",
            "beamdistribution", "mindistance", "maxdistance", "distance", "amplitude", "fov"},
           ValueType::Float);
    expect({"specularcolor", "lightcolor", "background"}, ValueType::Color);
    expect({"from", "to", "P"}, ValueType::Point);
    expect({"texturename"}, ValueType::String);
    expect({"N", "Np"}, ValueType::Normal);
    expect({"Cs", "Os"}, ValueType::Color);
    EXPECT_EQ(declarations.resolve("P")->second.storage, StorageClass::Vertex);
    EXPECT_EQ(declarations.resolve("Np")->second.storage, StorageClass::Uniform);
    EXPECT_EQ(declarations.resolve("st")->second.floats_per_item(), 2);
}

}  // namespace
}  // namespace trapeze::rib
