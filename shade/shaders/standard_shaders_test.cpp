#include "shade/shaders/standard_shaders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

#include "core/files/file_text_harness.h"
#include "shade/vm/compile_shader.h"

namespace trapeze {
namespace {

/// A shader's kind and the parameters that files set by name, with RISpec 3.2's defaults (its appendix A).
struct Expected {
    const char* name;
    const char* kind;
    std::vector<const char*> parameters;
};

const std::vector<Expected> kExpected = {
    {"constant", "surface", {}},
    {"matte", "surface", {"Ka = 1", "Kd = 1"}},
    {"metal", "surface", {"Ka = 1", "Ks = 1", "roughness = 0.1"}},
    {"shinymetal", "surface", {"Ka = 1", "Ks = 1", "Kr = 1", "roughness = 0.1", "texturename = \"\""}},
    {"plastic", "surface", {"Ka = 1", "Kd = 0.5", "Ks = 0.5", "roughness = 0.1", "specularcolor = 1"}},
    {"paintedplastic",
     "surface",
     {"Ka = 1", "Kd = 0.5", "Ks = 0.5", "roughness = 0.1", "specularcolor = 1", "texturename = \"\""}},
    {"ambientlight", "light", {"intensity = 1", "lightcolor = 1"}},
    {"arealight", "light", {"intensity = 1", "lightcolor = 1", "traceshadows = 1"}},
    {"distantlight",
     "light",
     {"intensity = 1", "lightcolor = 1", "from = point \"shader\" (0, 0, 0)",
      "to = point \"shader\" (0, 0, 1)"}},
    {"pointlight", "light", {"intensity = 1", "lightcolor = 1", "from = point \"shader\" (0, 0, 0)"}},
    {"spotlight",
     "light",
     {"intensity = 1", "lightcolor = 1", "from = point \"shader\" (0, 0, 0)",
      "to = point \"shader\" (0, 0, 1)", "coneangle = radians(30)", "conedeltaangle = radians(5)",
      "beamdistribution = 2"}},
    {"depthcue", "volume", {"mindistance = 0", "maxdistance = 1", "background = 0"}},
    {"fog", "volume", {"distance = 1", "background = 0"}},
    {"bumpy", "displacement", {"Km = 1", "texturename = \"\""}},
    {"background", "imager", {"background = 1", "bgcolor", "bgalpha = 1"}},
    {"clamptoalpha", "imager", {}},
    {"null", "surface", {}},
    {"defaultsurface", "surface", {"Ka = 0.2", "Kd = 0.8"}},
    {"glass", "surface", {"eta = 1.5"}},
    {"mirror", "surface", {"Kr = 1"}},
    {"wood", "surface", {"ringscale", "lightwood", "darkwood"}},
    {"marble", "surface", {"roughness"}},
    {"granite", "surface", {"roughness"}},
    {"brick", "surface", {"brickwidth", "brickheight", "mortarthickness"}},
    {"dented", "displacement", {"Km = 1", "amplitude = 0.1", "frequency = 1", "octaves = 3"}},
    {"sinewaves", "displacement", {"amplitude = 0.1", "frequency = 1"}},
    {"fractal", "displacement", {"amplitude"}},
    {"shadowspot", "light", {"shadowname = \"\"", "samples = 16", "width = 1", "coneangle = radians(30)"}},
    {"shadowdistant", "light", {"shadowname = \"\"", "samples = 16", "width = 1"}},
    {"shadowpoint", "light", {"sfpx = \"\"", "sfnz = \"\"", "samples = 16", "width = 1"}},
    {"occlusionlight", "light", {"intensity = 1", "lightcolor = 1", "envname = \"\"", "samples = 64"}},
    {"rislight", "light", {"intensity = 1", "lightcolor = 1", "coneangle = 90", "traceshadows = 1"}},
    {"rislightsurface", "surface", {"radiance = 1", "focus = 0", "coneangle = 90", "conesoftness = 0"}},
    {"rissurface", "surface", {"specularcolor = 0", "emission = 0", "opacity = 1", "bounce = 0.15"}},
    {"standinlight",
     "light",
     {"intensity = 1", "lightcolor = 1", "spot = 0", "falloff = 0", "shadowname = \"\""}},
    {"uberlight",
     "light",
     {"lighttype = \"spot\"", "cuton", "cutoff", "width", "height", "wedge", "hedge", "roundness",
      "slidename", "shadowmap", "nonspecular = 0"}}};

TEST(StandardShaders, AllAreThereByKindAndParameters) {
    for (const Expected& expected : kExpected) {
        SCOPED_TRACE(expected.name);
        const std::string text(standard_shader(expected.name));
        ASSERT_FALSE(text.empty());
        const std::regex head(std::string("(^|\n)") + expected.kind + "\\s+" + expected.name +
                              "\\s*\\(([^{]*)\\)\\s*\\{");
        std::smatch found;
        ASSERT_TRUE(std::regex_search(text, found, head));
        for (const char* parameter : expected.parameters)
            EXPECT_NE(found[2].str().find(parameter), std::string::npos) << parameter;
    }
}

TEST(StandardShaders, TheListIsWholeAndSorted) {
    std::vector<std::string> expected;
    for (const Expected& shader : kExpected) expected.emplace_back(shader.name);
    EXPECT_THAT(standard_shader_names(), ::testing::UnorderedElementsAreArray(expected));
    EXPECT_TRUE(std::ranges::is_sorted(standard_shader_names()));
}

TEST(StandardShaders, TextsAreTheFilesUnchanged) {
    for (const std::string_view name : standard_shader_names()) {
        const std::string path =
            std::string(TRAPEZE_SOURCE_DIR "/shade/shaders/") + std::string(name) + ".sl";
        EXPECT_EQ(standard_shader(name), testing::file_text(path)) << name;
    }
}

TEST(StandardShaders, AllCompileWithoutAWord) {
    for (const Expected& expected : kExpected) {
        SCOPED_TRACE(expected.name);
        std::string messages;
        Diagnostics diagnostics([&](const Diagnostic& d) { messages += to_string(d) + "\n"; });
        const auto unit =
            rsl::compile_front({expected.name, std::string(standard_shader(expected.name))}, {}, diagnostics);
        ASSERT_TRUE(unit) << messages;
        ASSERT_EQ(unit->shaders.size(), 1u);
        const auto program = vm::compile_program(*unit->shaders[0], diagnostics);
        ASSERT_TRUE(program) << messages;
        EXPECT_EQ(program->name, expected.name);
        EXPECT_EQ(messages, "");
    }
}

TEST(StandardShaders, OthersAreEmpty) {
    EXPECT_TRUE(standard_shader("nosuchshader").empty());
    EXPECT_TRUE(standard_shader("").empty());
    EXPECT_TRUE(standard_shader("matte.sl").empty());
}

}  // namespace
}  // namespace trapeze
