/// What calls that send rays are given, by name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shade/rsl/analysis/analysis_harness.h"

namespace trapeze::rsl {
namespace {

using testing::in_surface;
using testing::said;

TEST(Analysis, ArgumentsOfRaysAreChecked) {
    const auto traced = [](const std::string& given) {
        return in_surface("Ci = trace(P, N, " + given + ");");
    };
    EXPECT_TRUE(traced("\"smaples\", 3").starts_with("warning 1:84: trace() knows no \"smaples\", which "));
    EXPECT_EQ(
        traced("\"samples\", color(1, 2, 3)"),
        "warning 1:84: \"samples\" of trace() takes a float, not a triple of floats: it changes nothing\n");
    EXPECT_EQ(traced("\"label\", 3"),
              "warning 1:84: \"label\" of trace() takes a string, not a float: it changes nothing\n");
    EXPECT_EQ(
        traced("\"hitsides\", \"sideways\""),
        "warning 1:84: \"hitsides\" of trace() knows \"front\", \"back\", \"both\", not \"sideways\"\n");
    EXPECT_NE(in_surface("gather(\"x\", P, N, .1, 4, \"distribution\", \"gaussian\") ;"), "");
    EXPECT_NE(in_surface("Ci = environment(\"raytrace\", N, \"smaples\", 4);"), "");
    EXPECT_EQ(traced("\"excludesubset\", \"a\", \"hitsides\", \"\", \"othreshold\", color(1)"), "");
    EXPECT_EQ(in_surface("float d = 0; Ci = occlusion(P, N, 4, \"minsamples\", 9, \"hitdist\", d);"), "");
    // Hints of quality ask for no more than is so.
    EXPECT_EQ(traced("\"maxpixeldist\", 20, \"maxvariation\", .1, \"maxerror\", .1, \"adaptive\", 1"), "");
}

/// Of PRMan, and of maps: what is wanted would change the picture, and is not made.
TEST(Analysis, ArgumentsOfRaysWithoutEffectAreNamed) {
    const auto traced = [](const std::string& given) {
        return in_surface("Ci = trace(P, N, " + given + ");");
    };
    EXPECT_EQ(traced("\"maxhits\", 3"), "warning 1:84: \"maxhits\" of trace() has no effect\n");
    EXPECT_EQ(traced("\"raytype\", \"diffuse\", \"weight\", Cs"),
              "warning 1:84: \"raytype\" of trace() has no effect\n"
              "warning 1:106: \"weight\" of trace() has no effect\n");
    for (const char* output : {"radiosity", "surfacecolor", "occlusion", "environmentdir"})
        EXPECT_EQ(traced("\"" + std::string(output) + "\", Ci"),
                  "warning 1:84: \"" + std::string(output) + "\" of trace() has no effect\n");
    EXPECT_NE(in_surface("gather(\"x\", P, N, .1, 4, \"weight\", 1) ;"), "");
    const auto reflected = [](const std::string& given) {
        return in_surface("Ci = environment(\"raytrace\", N, " + given + ");");
    };
    EXPECT_EQ(reflected("\"sblur\", .1"),
              "warning 1:99: \"sblur\" of environment() has no effect on rays, which \"blur\" spreads\n");
    EXPECT_NE(reflected("\"tblur\", u"), "");
    EXPECT_EQ(reflected("\"sblur\", 0, \"width\", 2, \"blur\", u"), "");
    EXPECT_EQ(
        in_surface("Ci = transmission(P, P + N, \"blur\", .1) * shadow(\"raytrace\", P, \"blur\", .1);"), "");
    EXPECT_EQ(in_surface("Ci = environment(\"a\", N, \"blur\", .1, \"x\", 1);"), "");
}

/// The others of a name would be deaf to it.
TEST(Analysis, ArgumentsOfRaysAreThoseOfTheirCall) {
    const auto deaf = [](const std::string& call, const std::string& names) {
        std::string said = in_surface("color c = 0; float d = 0; " + call);
        std::string heard;
        for (size_t at; (at = said.find(": \"")) != std::string::npos;) {
            said.erase(0, at + 3);
            heard += said.substr(0, said.find('"')) + " ";
        }
        EXPECT_EQ(heard, names) << call;
    };
    const std::string all =
        ", \"blur\", .1, \"samplecone\", .1, \"coneangle\", 1, \"distribution\", \"uniform\", \"environmentmap\", \"a\", "
        "\"environmentspace\", \"world\", \"falloff\", 1, \"falloffmode\", 1, \"pointbased\", 0, \"filename\", "
        "\"\", \"coordsystem\", \"\", \"maxsolidangle\", 1, \"clamp\", 1, \"hitdist\", d, \"occlusion\", d, "
        "\"transmission\", c, \"samples\", 4, \"bias\", 0, \"label\", \"x\", \"othreshold\", color(0))";
    const std::string of_sky = "pointbased filename coordsystem maxsolidangle clamp ";
    deaf("c = trace(P, N" + all + ";", "coneangle distribution falloff falloffmode " + of_sky + "occlusion ");
    deaf("c = transmission(P, P + N" + all + ";",
         "coneangle distribution environmentmap environmentspace falloff falloffmode " + of_sky +
             "hitdist occlusion transmission ");
    deaf("c = occlusion(P, N, 4" + all + ";", "blur samplecone transmission ");
    deaf("c = indirectdiffuse(P, N, 4" + all + ";", "blur samplecone transmission ");
    deaf("c = environment(\"raytrace\", N" + all + ";",
         "coneangle distribution falloff falloffmode " + of_sky + "hitdist occlusion transmission ");
    deaf("d = shadow(\"raytrace\", P" + all + ";",
         "coneangle distribution environmentmap environmentspace falloff falloffmode " + of_sky +
             "hitdist occlusion transmission ");
    deaf("gather(\"\", P, N, .1, 4" + all + " ;",
         "blur samplecone environmentmap environmentspace falloff falloffmode " + of_sky +
             "hitdist occlusion transmission ");
    EXPECT_NE(in_surface("Ci = transmission(P, P + N, \"x\", 1);").find("\"maxdist\", \"othreshold\""),
              std::string::npos);
}

TEST(Analysis, TraceSetsADistance) {
    EXPECT_EQ(
        in_surface("float d = 0, a[2] = {1, 2}; color c = 0; Ci = trace(P, N, d); d = trace(P, N, a[1], "
                   "\"samples\", 4, \"transmission\", c); Ci *= trace(P, N, d, \"transmission\", d);"),
        "");
    // What cannot be set is none.
    EXPECT_NE(in_surface("Ci = trace(P, N, 5);"), "");
    EXPECT_NE(in_surface("Ci = trace(P, N, Cs, \"samples\", 4);"), "");
}

TEST(Analysis, GatherSendsValuesToHits) {
    const auto sends = [](const std::string& name, const std::string& value) {
        return in_surface("float k[2] = 1; gather(\"x\", P, N, 1, 4, " + name + ", " + value + ") ;");
    };
    for (const char* kind : {"surface", "displacement", "volume", "atmosphere"})
        for (const char* value : {"s", "Cs", "P", "matrix 1", "\"text\"", "k"})
            EXPECT_EQ(sends("\"send:" + std::string(kind) + ":x\"", value), "");
    EXPECT_EQ(sends("\"send:surface:\"", "s"),
              "error 1:107: \"send:surface:\" of gather names no parameter\n");
    EXPECT_EQ(sends("\"send:volume:x\"", "s < t"),
              "error 1:126: \"send:volume:x\" of gather has no value to send\n");
    EXPECT_EQ(sends("\"send:volume:x\"", "printf(\"\")"),
              "error 1:124: \"send:volume:x\" of gather has no value to send\n");
    for (const char* kind : {"light", "imager", "x"})
        EXPECT_THAT(sends("\"send:" + std::string(kind) + ":x\"", "s"),
                    ::testing::StartsWith("warning 1:107: gather() knows no \"send:"));
    EXPECT_THAT(in_surface("Ci = trace(P, N, \"send:surface:x\", 1);"),
                ::testing::StartsWith("warning 1:84: trace() knows no \"send:surface:x\""));
}

}  // namespace
}  // namespace trapeze::rsl
