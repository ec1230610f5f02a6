#include "shade/materials/unknown_parameters.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace trapeze {
namespace {

using ::testing::ElementsAre;

TEST(UnknownParameters, AreNamedWithTheirShaderAndTheNearest) {
    rsl::Program program;
    for (const char* name : {"Ka", "Kd", "roughness", "texturename"})
        program.parameters.emplace_back().name = name;
    ShaderInstance instance;
    instance.name = "paint";
    for (const char* name : {"Kd", "roughnes", "roughnes", "wetness", "texturename"})
        instance.parameters.values.push_back({name, {}, {1}, {}});
    std::vector<std::string> messages;
    Diagnostics diagnostics([&](const Diagnostic& diagnostic) { messages.push_back(to_string(diagnostic)); });
    instance.location = {diagnostics.add_source("a.rib"), 3, 4};
    report_unknown_parameters(instance, program, diagnostics);
    EXPECT_THAT(
        messages,
        ElementsAre("a.rib:3:4: warning: shader \"paint\" has no parameter \"roughnes\" (did you mean "
                    "\"roughness\"?)",
                    "a.rib:3:4: warning: shader \"paint\" has no parameter \"wetness\""));
}

}  // namespace
}  // namespace trapeze
