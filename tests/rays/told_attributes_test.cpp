/// attribute() and option() of what holds of rays.
#include <gtest/gtest.h>

#include "tests/rays/rays_harness.h"

namespace trapeze::testing {
namespace {

/// Shaders may ask for what holds where nobody has set anything.
TEST(RayAttributes, AreToldToShaders) {
    const auto told = [](const std::string& options, const std::string& attributes, const std::string& asks,
                         const std::string& expected) {
        SCOPED_TRACE(options + attributes + asks);
        Case c;
        c.things = "Surface \"constant\" " + wall("3");
        c.options = options, c.asker = attributes;
        expect_told(c.render("float n = -1, found = " + asks + "; Ci = told(n, " + expected + ", found);"), 0,
                    64 * 64);
    };
    for (const auto& [name, expected] : {std::pair("trace:maxdiffusedepth", "1"),
                                         {"trace:maxspeculardepth", "2"},
                                         {"trace:displacements", "0"},
                                         {"trace:samplemotion", "0"},
                                         {"trace:bias", "0"},
                                         {"visibility:camera", "1"},
                                         {"visibility:diffuse", "0"},
                                         {"visibility:specular", "0"},
                                         {"visibility:transmission", "0"}})
        told("", "", "attribute(\"" + std::string(name) + "\", n)", expected);
    told("", "Attribute \"trace\" \"int maxspeculardepth\" [7] ", "attribute(\"trace:maxspeculardepth\", n)",
         "7");
    told("", "GeometricApproximation \"motionfactor\" 2 Matte 1 Matte 0 ",
         "attribute(\"GeometricApproximation:motionfactor\", n)", "2");
    told("", "", "attribute(\"matte\", n)", "0");
    told("", "", "option(\"trace:maxdepth\", n)", "10");
    told("Option \"trace\" \"int maxdepth\" [4] ", "", "option(\"trace:maxdepth\", n)", "4");
    const std::string mode =
        "string s = \"\"; float n = attribute(\"shade:transmissionhitmode\", s);"
        "Ci = told(s == \"";
    Case c;
    c.things = "Surface \"constant\" " + wall("3");
    expect_told(c.render(mode + "shader\" ? 1 : 0, 1, n);"), 0, 64 * 64);
    c.asker = "Attribute \"shade\" \"string transmissionhitmode\" [\"primitive\"] ";
    expect_told(c.render(mode + "primitive\" ? 1 : 0, 1, n);"), 0, 64 * 64);
    c.asker = "Attribute \"visibility\" \"string transmission\" [\"opaque\"] ";
    expect_told(c.render(mode + "opaque\" ? 1 : 0, 1, n);"), 0, 64 * 64);
}

/// The words of before PRMan 13, and of BMRT.
TEST(RayAttributes, OldWordsSayWhoseOpacityHides) {
    const auto through = [](const std::string& attribute, const std::string& expected) {
        SCOPED_TRACE(attribute);
        Case c;
        c.shaders["thin"] = "surface thin() { Oi = .25; Ci = 0; }";
        c.things = "Attribute " + attribute + " Opacity .5 .5 .5 Surface \"thin\" " + wall("3");
        expect_told(c.render("Ci = told(comp(transmission(P, point(0, 0, 0)), 0), " + expected + ", 1);"),
                    1e-6f, 64 * 64, 1e-6f);
    };
    const std::string seen = "\"visibility\" \"string transmission\" ",
                      casts = "\"render\" \"string casts_shadows\" ";
    for (const std::string& words : {seen, casts}) {
        through(words + "\"none\"", "1");
        through(words + "\"opaque\"", "0");
        through(words + "\"Os\"", ".5");
    }
    // Also of what is seen through something.
    Case c;
    c.shaders["haze"] = "volume haze() { Oi = 1 - .5 * (1 - Oi); }";
    c.things = "Attribute " + seen + "\"opaque\" Opacity .5 .5 .5 Surface \"constant\" Exterior \"haze\" " +
               wall("3");
    c.asker = "Exterior \"haze\" ";
    expect_told(c.render("Ci = told(comp(transmission(P, point(0, 0, 0)), 0), 0, 1);"), 0, 64 * 64);
    through(seen + "\"transparent\"", "1");
    through(seen + "\"shader\"", ".75");
    through(casts + "\"shade\"", ".75");
}

}  // namespace
}  // namespace trapeze::testing
