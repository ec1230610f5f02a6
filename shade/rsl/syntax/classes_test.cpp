/// Classes of RSL 2: what they become, and what is said of wrong ones.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shade/rsl/analysis/analysis_harness.h"
#include "shade/rsl/front_end.h"
#include "shade/rsl/syntax/parser.h"
#include "shade/rsl/syntax/printer.h"

namespace trapeze::rsl {
namespace {

using testing::said;

/// Kinds and names of the shaders of a source, which has no errors.
std::vector<std::string> shaders_of(const std::string& text) {
    Diagnostics diagnostics;
    const auto unit = compile_front({"t.sl", text}, {}, diagnostics);
    std::vector<std::string> shaders;
    EXPECT_TRUE(unit) << said(text);
    if (!unit) return shaders;
    for (const auto& shader : unit->shaders)
        shaders.push_back(std::string(name_of(shader->kind)) + ' ' + shader->name +
                          (shader->displaces ? " that displaces" : ""));
    return shaders;
}

using Names = std::vector<std::string>;

TEST(Classes, BecomeWhatTheirMethodsSay) {
    EXPECT_EQ(shaders_of("class a { public void surface(output color Ci, Oi) { Ci = 1; Oi = Os; } }"),
              Names{"surface a"});
    EXPECT_EQ(shaders_of("class a() { public void lighting(output color Ci, Oi) { Ci = diffuse(N); } }"),
              Names{"surface a"});
    EXPECT_EQ(shaders_of("class a() { public void light(output vector L; output color Cl;) "
                         "{ illuminate(point (0, 0, 0)) Cl = 1 / (L . L); } }"),
              Names{"light a"});
    EXPECT_EQ(shaders_of("class a() { public void volume(output color Ci, Oi) { Ci *= length(I); } }"),
              Names{"volume a"});
    EXPECT_EQ(shaders_of("class a() { public void imager(output color Ci, Oi) { Ci *= 2; } }"),
              Names{"imager a"});
    EXPECT_EQ(shaders_of("class a() { public void displacement(output point P; output normal N) "
                         "{ P += N; N = calculatenormal(P); } }"),
              Names{"displacement a"});
}

/// What displaces need not name what only surfaces have, nor the other way round.
TEST(Classes, ThatShadeAndDisplaceAreTwoShaders) {
    const char* text =
        "class both(float Km = 1;) {\n"
        "    varying normal n = 0;\n"
        "    public void begin() { n = normalize(N); }\n"
        "    public void displacement(output point P; output normal N) { P += high() * n; }\n"
        "    private float high() { return Km; }\n"
        "    public void surface(output color Ci, Oi) { Oi = Os; Ci = Oi * lit(); }\n"
        "    private color lit() { return Cs * diffuse(n); }\n"
        "}\n"
        "surface other() { Ci = Cs; }\n";
    EXPECT_EQ(said(text), "");
    EXPECT_EQ(shaders_of(text), (Names{"surface both that displaces", "displacement both", "surface other"}));
}

/// The printer writes the calls that the renderer would make: construct, begin, and the parts of shading in
/// their order, wherever they stand.
TEST(Classes, MethodsAreCalledInTheRenderersOrder) {
    Diagnostics diagnostics;
    const auto unit =
        compile_front({"t.sl",
                       "class a() {\n"
                       "    public void postlighting(output color Ci, Oi) { Ci *= 2; }\n"
                       "    public void lighting(output color c; output color o) { c = Cs; o = Os; }\n"
                       "    public void opacity(output color Oi) { Oi = 1; }\n"
                       "    public void prelighting(output color Ci, Oi) { Ci = 0; }\n"
                       "    public void begin() {} public void construct() {}\n"
                       "}\n"},
                      {}, diagnostics);
    ASSERT_TRUE(unit);
    const std::string text = print(*unit);
    size_t at = 0;
    for (const char* call :
         {"construct()", "begin()", "opacity()", "prelighting()", "lighting(Ci, Oi)", "postlighting()"}) {
        const size_t next = text.rfind(call);
        ASSERT_NE(next, std::string::npos) << call << text;
        EXPECT_GE(next, at) << call << text;
        at = next;
    }
}

TEST(Classes, MethodsSeeMembersParametersAndOneAnother) {
    EXPECT_EQ(said("class a(float Kd = .5; output varying color o = 0;) {\n"
                   "    constant float two = 2;\n"
                   "    uniform float many[3] = {1, 2, 3};\n"
                   "    color base = Cs;\n"
                   "    public void surface(output color Ci, Oi) { shade(Ci); Oi = Os; o = base; }\n"
                   "    void shade(output color c) { c = base * Kd * twice(many[1]); }\n"
                   "    float twice(float x) { return two * x; }\n"
                   "}\n"),
              "");
}

TEST(Classes, MethodsHaveDefaultValues) {
    EXPECT_EQ(
        said("class a() {\n"
             "    public void init(color cc; uniform float q = 3;) { }\n"
             "    public void surface(output color Ci, Oi) { init(Cs); init(Cs, \"q\", 2); Ci = Oi = 1; }\n"
             "}\n"),
        "");
}

TEST(Classes, ErrorsHaveAPlaceAndTheRestIsRead) {
    EXPECT_EQ(said("class a() { public void surface(output color Ci, Oi) { Ci = x; y = 1; } }"),
              "error 1:61: there is no variable \"x\"\nerror 1:64: there is no variable \"y\"\n");
    EXPECT_EQ(said("class a() { float 1; public void surface(output color Ci, Oi) { Ci = ; } }"),
              "error 1:19: expected a variable's name, not \"1\"\n"
              "error 1:70: expected an expression, not \";\"\n");
    EXPECT_NE(said("class a() { float x; }\nsurface t() { Ci = z; }").find("co-shaders"), std::string::npos);
    EXPECT_EQ(said("class a() { public void surface(output color Ci, Oi) { Ci = 1; }"),
              "error 1:65: expected \"}\" after the class's members\n");
}

/// Functions do not recurse.
TEST(Classes, MethodsThatCallOneAnotherInACircleAreRefused) {
    const std::string text = said(
        "class a() { public void surface(output color Ci, Oi) { Ci = f(1); }\n"
        "float f(float x) { return g(x); } float g(float x) { return f(x); } }");
    EXPECT_EQ(text, "error 2:61: there is no function \"f\"\n");
}

TEST(Classes, OneNameIsOneClass) {
    const std::string a = "class a() { public void surface(output color Ci, Oi) { Ci = 1; } }\n";
    EXPECT_NE(said(a + a).find("two shaders"), std::string::npos);
}

}  // namespace
}  // namespace trapeze::rsl
