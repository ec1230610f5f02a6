#include "shade/check_looks.h"

#include <gmock/gmock.h>

#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::number;
using testing::ShaderFolder;
using testing::ShadingScene;
using testing::text;

/// A scene whose surface is a shader of this text.
class CheckLooks : public ::testing::Test {
  protected:
    std::vector<std::string> said(const std::string& source, std::vector<Parameter> parameters = {}) {
        folder_.write("mine", source);
        scene_.scene.options.search_paths["shader"] = {folder_.path()};
        scene_.surface("mine", std::move(parameters));
        scene_.reported.clear();
        check_looks(scene_.context, [](std::string_view name) { return name == "made.tex"; });
        std::vector<std::string> texts;
        for (const Diagnostic& diagnostic : scene_.reported) texts.push_back(diagnostic.text);
        return texts;
    }

    ShaderFolder folder_;
    ShadingScene scene_;
};

TEST_F(CheckLooks, ShadersThatAreNotThereAreErrors) {
    scene_.surface("none");
    scene_.light("nolight");
    check_looks(scene_.context, {});
    ASSERT_EQ(scene_.reported.size(), 2u);
    for (const Diagnostic& diagnostic : scene_.reported) EXPECT_EQ(diagnostic.severity, Severity::Error);
}

TEST_F(CheckLooks, MapsAreFoundThroughParametersAndThroughText) {
    EXPECT_THAT(said("surface mine(string map = \"\") { if (map != \"\") Ci = texture(map); }"), IsEmpty());
    EXPECT_THAT(said("surface mine(string map = \"\") { if (map != \"\") Ci = texture(map); }",
                     {text("map", "lost.tex")}),
                ElementsAre("texture \"lost.tex\": is not found"));
    EXPECT_THAT(said("surface mine(string map = \"\") { if (map != \"\") Ci = texture(map); }",
                     {text("map", "made.tex")}),
                IsEmpty());
    EXPECT_THAT(said("color look(string name) { return color environment(name, N); }\n"
                     "surface mine(string map = \"lost\"; string stem = \"\") {\n"
                     "  string name = concat(map, \".env\"); Ci = look(name);\n"
                     "  if (stem == \"\") Ci *= shadow(\"lost.shd\", P); }"),
                ElementsAre("texture \"lost.env\": is not found", "texture \"lost.shd\": is not found"));
}

TEST_F(CheckLooks, PicturesThatAreThereAreNoErrorsButNoShadowMapsEither) {
    const std::string file = TRAPEZE_SOURCE_DIR "/scenes/tiny/textures/quarters.png";
    EXPECT_THAT(said("surface mine(string map = \"\") { Ci = texture(map); }", {text("map", file)}),
                IsEmpty());
    EXPECT_THAT(said("surface mine(string map = \"\") { Ci = shadow(map, P); }", {text("map", file)}),
                ElementsAre("texture \"" + file +
                            "\": is no shadow map: it has no matrices worldtocamera and worldtoscreen"));
}

TEST_F(CheckLooks, CallsThatTheInstanceRulesOutDoNotCount) {
    const std::string source =
        "surface mine(float use = 0; string map = \"lost.tex\") { if (use != 0) Ci = texture(map); }";
    EXPECT_THAT(said(source), IsEmpty());
    EXPECT_THAT(said(source, {number("use", 1)}), ElementsAre("texture \"lost.tex\": is not found"));
}

TEST_F(CheckLooks, WhatPrimitivesBringIsNotKnown) {
    scene_.declare("map", {StorageClass::Uniform, ValueType::String, 1});
    EXPECT_THAT(said("surface mine(string map = \"lost.tex\") { Ci = texture(map); }"), IsEmpty());
    EXPECT_THAT(said("surface mine() { Ci = texture(format(\"%f.tex\", 1)); }"), IsEmpty());
}

}  // namespace
}  // namespace trapeze
