// Which predefined variables must hold their values when a program starts, and that those which must do.
#include "shade/vm/start_values.h"

#include "shade/vm/run_shader_harness.h"

namespace trapeze::vm {
namespace {

using testing::ShaderRun;

/// Of Ci, in a surface with this body, with and without the optimiser.
void expect_needed(const std::string& body, bool needed) {
    for (const bool optimised : {false, true}) {
        const ShaderRun run("surface test(output varying float r = 0;) {" + body + "}", optimised);
        bool found = false;
        for (const StartValue& value : start_values(run.program())) {
            if (value.variable != Predefined::Ci) continue;
            found = true;
            EXPECT_EQ(value.needed, needed) << (optimised ? "optimised " : "") << body;
        }
        EXPECT_TRUE(found) << body;
    }
}

TEST(StartValues, AreNotNeededOfWhatIsSetFirst) {
    expect_needed("Ci = Cs * s;", false);
    expect_needed("if (s > 0.5) r = 1; Ci = Cs; r += comp(Ci, 0);", false);
    expect_needed("Ci = Cs; if (s > 0.5) Ci = 0;", false);
}

TEST(StartValues, AreNeededOfWhatIsLookedAtFirst) {
    expect_needed("Ci = Ci * 2;", true);
    expect_needed("r = comp(Ci, 1); Ci = Cs;", true);
    expect_needed("Ci += Cs;", true);
}

TEST(StartValues, AreNeededOfWhatIsSetInPart) {
    expect_needed("if (s > 0.5) Ci = Cs;", true);
    expect_needed("if (s > 0.5) Ci = Cs; Ci = Ci * 2;", true);
    expect_needed("setcomp(Ci, 1, 0.5);", true);
    expect_needed("float i; for (i = 0; i < s; i += 1) Ci = Cs;", true);
    expect_needed("if (s > 0.5) return; Ci = Cs;", true);
}

/// Lanes that do not set Oi keep what the grid has; those that do not set Ci stay black.
TEST(StartValues, LanesThatDoNotRunKeepThem) {
    ShaderRun run(
        "surface test(output varying float r = 0; output varying float b = 0;) {"
        "  if (s > 0.5) { Oi = 7; Ci = 7; } r = comp(Oi, 0); b = comp(Ci, 0); }");
    run.run();
    for (size_t i = 0; i < run.vertices(); ++i) {
        EXPECT_EQ(run.at("r", i), run.grid().s[i] > 0.5f ? 7 : run.grid().Os.c[0][i]) << i;
        EXPECT_EQ(run.at("b", i), run.grid().s[i] > 0.5f ? 7 : 0) << i;
    }
}

TEST(StartValues, KnowEveryNameOfTheTables) {
    const ShaderRun run(
        "surface test(output varying float r = 0;) {"
        "  r = comp(Ci, 0) + comp(Oi, 0) + comp(Cs, 0) + comp(Os, 0) + xcomp(P) + xcomp(Ps) + xcomp(N) + "
        "xcomp(Ng);"
        "  r += xcomp(dPdu) + xcomp(dPdv) + xcomp(I) + u + v + s + t + du + dv + time + dtime + ncomps; }");
    EXPECT_TRUE(run.messages().empty()) << run.messages();
    size_t known = 0;
    for (const StartValue& value : start_values(run.program())) known += value.variable != Predefined::Other;
    EXPECT_EQ(known, 20u);
}

}  // namespace
}  // namespace trapeze::vm
