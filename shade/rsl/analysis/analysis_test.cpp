#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "shade/rsl/analysis/analysis_harness.h"
#include "shade/rsl/analysis/builtins.h"
#include "shade/rsl/analysis/globals.h"
#include "shade/rsl/analysis/signature.h"

namespace trapeze::rsl {
namespace {

using testing::compiled;
using testing::Heard;
using testing::in_surface;
using testing::said;

/// The letters of builtins.h for a type, and b for a truth.
char letter(const Type& type) {
    static constexpr char kLetters[] = "wbfcpvnms";
    return kLetters[static_cast<int>(type.base)];
}

/// A tree with each operand's type: calls as name:result(arguments), implicit casts as {type operand}.
std::string typed(const Expression& e) {
    static const char* kMarks[] = {
        "", "+", "-", "*", "/", ".", "^", "<", "<=", ">", ">=", "==", "!=", "&&", "||", "-", "!"};
    std::string children;
    for (const ExpressionPtr& child : e.children) children += (children.empty() ? "" : " ") + typed(*child);
    const std::string mark = kMarks[static_cast<int>(e.op)];
    const std::string type(1, letter(e.type));
    switch (e.kind) {
        case Expression::Kind::Cast:
            return e.implicit ? "{" + type + " " + children + "}" : "<" + type + " " + children + ">";
        case Expression::Kind::Number:
        case Expression::Kind::Text:
            return print(e);
        case Expression::Kind::Variable:
            return e.text;
        case Expression::Kind::Call:
            return e.text + ":" + type + "(" + children + ")";
        case Expression::Kind::Assignment:
            return "(" + mark + "= " + children + ")";
        case Expression::Kind::Triple:
            return type + "(" + children + ")";
        case Expression::Kind::Conditional:
            return "(?" + type + " " + children + ")";
        case Expression::Kind::Element:
            return "([]" + type + " " + children + ")";
        default:
            return "(" + mark + type + " " + children + ")";
    }
}

/// The last statement's expression of a surface with some variables.
std::string tree(const std::string& statement) {
    Heard heard;
    const auto unit = compiled(
        "float f(float x) { return x; } color f(color x) { return x; }\n"
        "surface t() { float a, b; color c; point p; vector v; normal n; matrix m; string s1; float "
        "arr[4]; " +
            statement + " }",
        heard);
    if (!unit) return heard.all();
    return typed(*unit->shaders[0]->body->children.back()->expressions[0]);
}

TEST(Analysis, ShadersAreRight) {
    for (const char* folder : {"/shade/shaders", "/shade/rsl/test_shaders"})
        for (const auto& path : testing::shaders_in(std::string(TRAPEZE_SOURCE_DIR) + folder)) {
            Heard heard;
            const auto unit =
                compile_front({path.string(), trapeze::testing::file_text(path)}, {}, heard.diagnostics);
            EXPECT_TRUE(unit) << path << "\n" << heard.all();
            // These use what is ignored, or missing.
            static const std::map<std::string, size_t> kWarnings{{"dialects.sl", 6}};
            const auto expected = kWarnings.find(path.filename());
            EXPECT_EQ(heard.lines.size(), expected == kWarnings.end() ? 0 : expected->second) << path << "\n"
                                                                                              << heard.all();
        }
}

TEST(Analysis, TheResultWantedChoosesTheOverload) {
    EXPECT_EQ(tree("a = noise(P);"), "(= a noise:f(P))");
    EXPECT_EQ(tree("c = noise(P);"), "(= c noise:c(P))");
    EXPECT_EQ(tree("p = noise(P);"), "(= p noise:p(P))");
    EXPECT_EQ(tree("n = noise(P);"), "(= n {n noise:v(P)})");  // there is none for normals
    EXPECT_EQ(tree("p = point noise(s, t);"), "(= p <p noise:p(s t)>)");
    EXPECT_EQ(tree("a = float noise(P) * 2;"), "(= a (*f <f noise:f(P)> 2))");
    EXPECT_EQ(tree("c = Cs * texture(\"x\");"), "(= c (*c Cs texture:c(\"x\")))");
    EXPECT_EQ(tree("c = a * texture(\"x\");"), "(= c (*c a texture:c(\"x\")))");
    EXPECT_EQ(tree("c *= texture(\"x\");"), "(*= c texture:c(\"x\"))");
    EXPECT_EQ(tree("p += a * noise(P) * n;"), "(+= p (*n (*f a noise:f(P)) n))");
    EXPECT_EQ(tree("if (noise(P) > .5) ;"), "(>b noise:f(P) 0.5)");
    EXPECT_EQ(tree("c = a > 0 ? Cs : texture(\"x\");"), "(= c (?c (>b a 0) Cs texture:c(\"x\")))");
    EXPECT_EQ(tree("c = mix(Cs, texture(\"x\"), noise(P));"), "(= c mix:c(Cs texture:c(\"x\") noise:f(P)))");
    EXPECT_EQ(tree("c = Cs * min(a, b);"), "(= c (*c Cs min:f(a b)))");
    EXPECT_EQ(tree("c = max(Cs, 0);"), "(= c max:c(Cs {c 0}))");
    EXPECT_EQ(tree("a = f(a); c = f(c);"), "(= c f:c(c))");
    EXPECT_EQ(tree("c = f(noise(P));"), "(= c f:c(noise:c(P)))");
    EXPECT_EQ(tree("a = noise(a, b) + noise(a) + noise(p, a);"),
              "(= a (+f (+f noise:f(a b) noise:f(a)) noise:f(p a)))");
    EXPECT_EQ(tree("c = spline(a, Cs, Cs, Cs, Cs, Cs);"), "(= c spline:c(a Cs Cs Cs Cs Cs))");
    EXPECT_EQ(tree("a = spline(\"linear\", a, arr);"), "(= a spline:f(\"linear\" a arr))");
}

TEST(Analysis, PowersOfTriplesAreALastResort) {
    EXPECT_EQ(tree("c = pow(Cs, a);"), "(= c pow:c(Cs a))");
    EXPECT_EQ(tree("c = a * pow(Cs, Os);"), "(= c (*c a pow:c(Cs Os)))");
    EXPECT_EQ(tree("c = pow(noise(P), 2);"), "(= c {c pow:f(noise:f(P) 2)})");
    EXPECT_EQ(tree("c = Cs * pow(noise(P), 2);"), "(= c (*c Cs pow:f(noise:f(P) 2)))");
}

TEST(Analysis, ColoursAndVectorsAreAssignedToEachOtherWithAWarning) {
    EXPECT_EQ(in_surface("color c = N; Ci = c;"),
              "warning 1:77: a normal becomes a color here: its three numbers are taken as they are\n");
    EXPECT_EQ(in_surface("vector v; v = 2 * Cs; Ci = xcomp(v);"),
              "warning 1:83: a color becomes a vector here: its three numbers are taken as they are\n");
    EXPECT_EQ(in_surface("color f(color x;) { return x; } Ci = f(N);"),
              "warning 1:106: a normal becomes a color here: its three numbers are taken as they are\n");
    EXPECT_EQ(in_surface("float f(vector x;) { return x.x; } Ci = f(2 * Cs);"),
              "warning 1:111: a color becomes a vector here: its three numbers are taken as they are\n");
    // What fits comes first: another function of the name, and a built-in one.
    EXPECT_EQ(in_surface("color f(color x;) { return x; } color f(normal n;) { return 1; } Ci = f(N);"), "");
    EXPECT_EQ(in_surface("float length(color x;) { return 1; } Ci = length(N);"), "");
    EXPECT_EQ(
        in_surface("float f(output color x;) { x = 1; return 1; } vector v = 0; Ci = f(v);").substr(0, 5),
        "error");
    EXPECT_EQ(in_surface("Ci = Cs + N;"), "error 1:75: \"+\" does not go with a color and a normal\n");
    EXPECT_EQ(in_surface("Ci += N;"), "error 1:70: a normal cannot be combined by \"+=\" with a color\n");
}

TEST(Analysis, TriplesAreWhatIsWanted) {
    EXPECT_EQ(tree("c = (1, 0, a);"), "(= c c(1 0 a))");
    EXPECT_EQ(tree("p = (1, 0, a);"), "(= p p(1 0 a))");
    EXPECT_EQ(tree("c = Cs * (1, 0, 0);"), "(= c (*c Cs c(1 0 0)))");
    EXPECT_EQ(tree("v = v ^ (0, 0, 1);"), "(= v (^v v v(0 0 1)))");
    EXPECT_EQ(tree("a = length((1, 0, 0));"), "(= a length:f(v(1 0 0)))");
    EXPECT_EQ(tree("v = vector \"world\" (0, 0, 1);"), "(= v <v v(0 0 1)>)");
    EXPECT_EQ(tree("p = P + (0, 0, 1);"), "(= p (+p P v(0 0 1)))");
    EXPECT_EQ(tree("c = a > 1 ? (1, 0, 0) : color 0;"), "(= c (?c (>b a 1) c(1 0 0) <c 0>))");
}

TEST(Analysis, ConversionsAreMadeExplicit) {
    EXPECT_EQ(tree("c = 1;"), "(= c {c 1})");
    EXPECT_EQ(tree("c = a * Cs;"), "(= c (*c a Cs))");  // stays a float beside the colour
    EXPECT_EQ(tree("m = 1;"), "(= m {m 1})");
    EXPECT_EQ(tree("m = m * 2;"), "(= m (*m m {m 2}))");
    EXPECT_EQ(tree("a = v . 1;"), "(= a (.f v {v 1}))");
    EXPECT_EQ(tree("v = N;"), "(= v {v N})");
    EXPECT_EQ(tree("v = P - E;"), "(= v (-v P E))");
    EXPECT_EQ(tree("p = P + v;"), "(= p (+p P v))");
    EXPECT_EQ(tree("p = P - v;"), "(= p (-p P v))");
    EXPECT_EQ(tree("n = N + N;"), "(= n (+n N N))");
    EXPECT_EQ(tree("a = a > b;"), "(= a {f (>b a b)})");
    EXPECT_EQ(tree("if (a) ;"), "{b a}");
    EXPECT_EQ(tree("if (a && b > 1) ;"), "(&&b {b a} (>b b 1))");
    EXPECT_EQ(tree("if (Cs == 0) ;"), "(==b Cs {c 0})");
    EXPECT_EQ(tree("if ((a > b) == (b > a)) ;"), "(==b {f (>b a b)} {f (>b b a)})");
    EXPECT_EQ(tree("if (s1 == \"x\") ;"), "(==b s1 \"x\")");
    EXPECT_EQ(tree("c = color (P);"), "(= c <c P>)");
    EXPECT_EQ(tree("c = color \"hsv\" a;"), "(= c <c {c a}>)");
    EXPECT_EQ(tree("a = arr[a] + PI;"), "(= a (+f ([]f arr a) 3.1415927))");
    EXPECT_EQ(tree("a = P[1] + m[2][3];"), "(= a (+f comp:f({v P} 1) comp:f(m 2 3)))");
    EXPECT_EQ(tree("c += a;"), "(+= c a)");
    EXPECT_EQ(tree("a = xcomp(P);"), "(= a xcomp:f({v P}))");
    EXPECT_EQ(tree("setxcomp(P, 1);"), "setxcomp:w(P 1)");
    EXPECT_EQ(tree("arr[1] += 2;"), "(+= ([]f arr 1) 2)");
    EXPECT_EQ(tree("c = texture(\"x\"[1]);"), "(= c texture:c(([]s \"x\" 1)))");
    EXPECT_EQ(tree("a = texture(s1[1], s, t, \"width\", 2);"), "(= a texture:f(([]s s1 1) s t \"width\" 2))");
}

TEST(Analysis, WrongTypesAreSaid) {
    EXPECT_EQ(in_surface("Kd = \"x\";"),
              "warning 1:67: parameter \"Kd\" is assigned to, and is not output\n"
              "error 1:70: a string cannot be assigned to a float\n");
    EXPECT_EQ(in_surface("float a = P;"), "error 1:77: a float is wanted here, not a point\n");
    EXPECT_EQ(in_surface("float a = 1 + \"x\";"),
              "error 1:79: \"+\" does not go with a float and a string\n");
    EXPECT_EQ(in_surface("Ci = Cs * N;"), "error 1:75: \"*\" does not go with a color and a normal\n");
    EXPECT_EQ(in_surface("if (P) ;"), "error 1:71: a condition is wanted here, not a point\n");
    EXPECT_EQ(
        in_surface("float a = float P;"),
        "error 1:77: a point cannot become a float (xcomp, ycomp, zcomp and comp take one component)\n");
    EXPECT_EQ(in_surface("float a = printf(\"x\");"), "error 1:77: this has no value, a float is wanted\n");
    EXPECT_EQ(in_surface("Ci = Kd > 0 ? Cs : \"x\";"),
              "error 1:79: one value of \"?\" is a color, the other a string\n");
    EXPECT_EQ(in_surface("float a[2]; Kd = a + 1;").substr(0, 74),
              "error 1:84: this is an array; one of its elements is wanted here\nwarning 1");
}

TEST(Analysis, WrongArgumentsListWhatThereIs) {
    EXPECT_EQ(in_surface("float a = sin(P);"),
              "error 1:81: argument 1 of sin is a point, a float is wanted\n"
              "note 1:81: float sin(float)\n");
    EXPECT_EQ(in_surface("float a = pow(2);"),
              "error 1:77: no pow takes (float)\n"
              "note 1:77: there is float pow(float, float)\n");
    EXPECT_EQ(in_surface("setcomp(Cs * 2, 0, 1);"),
              "error 1:67: no setcomp takes (color, float, float)\n"
              "note 1:67: there is void setcomp(output color, float, float)\n"
              "note 1:67: there is void setcomp(output point, float, float)\n"
              "note 1:67: there is void setcomp(output matrix, float, float, float)\n");
    EXPECT_EQ(in_surface("float r, q; fresnel(I, N, 1, r, 2);"),
              "error 1:99: argument 5 of fresnel is written to, and must be a variable\n"
              "note 1:99: void fresnel(vector, vector, float, output float, output float)\n");
    EXPECT_EQ(in_surface("float x = noise(\"a\");").substr(0, 46),
              "error 1:77: no noise takes (string)\nnote 1:77:");
    EXPECT_EQ(said("float f(float a[2]) { return a[0]; } surface t() { float b[3]; float c = f(b); }"),
              "error 1:76: argument 1 of f is a float[3], a float[2] is wanted\n"
              "note 1:76: float f(float[2])\n");
}

TEST(Analysis, UnknownNamesGetSuggestions) {
    EXPECT_EQ(in_surface("Ci = Kb;"), "error 1:72: there is no variable \"Kb\"\n");
    EXPECT_EQ(in_surface("Ci = tnit;"),
              "error 1:72: there is no variable \"tnit\" (did you mean \"tint\"?)\n");
    EXPECT_EQ(in_surface("Ci = cs;"), "error 1:72: there is no variable \"cs\" (did you mean \"Cs\"?)\n");
    EXPECT_EQ(in_surface("vector V = normalise(I);"),
              "error 1:78: there is no function \"normalise\" (did you mean \"normalize\"?)\n");
    EXPECT_EQ(in_surface("Ci = blinn(N, I);"),
              "error 1:72: function \"blinn\" of later renderers is not supported\n");
    EXPECT_EQ(in_surface("Ci = photonmap(\"x\", P, N); Ci = photonmap(\"y\", P, N, \"C\", Ci);"),
              "warning 1:72: function \"photonmap\" of later renderers is not there, and does nothing\n");
    EXPECT_EQ(
        said("displacement t() { P += Ci; }"),
        "error 1:25: there is no variable \"Ci\"; surface shaders have one, this is a displacement shader\n");
}

TEST(Analysis, OutputsAreSetByName) {
    const std::string output = "output varying color gloss = 0";
    const auto in = [&](const std::string& body) {
        return said(
            "void f() { outputchannel(\"gloss\", 1); } void g(color gloss) { outputchannel(\"gloss\", 1); "
            "} surface t(" +
            output + "; color Ks = 1) { " + body + " }");
    };
    EXPECT_EQ(in("outputchannel(\"gloss\", Cs); f();"), "");
    EXPECT_EQ(in("outputchannel(\"gloss\", 3); outputchannel(\"Ks\", Cs);"),
              "warning 1:177: the shader has no output \"Ks\" here: outputchannel() does nothing\n");
    EXPECT_EQ(in("g(Ks);"),
              "warning 1:63: the shader has no output \"gloss\" here: outputchannel() does nothing\n");
    EXPECT_EQ(in("string n = \"gloss\"; outputchannel(n, Cs);"),
              "warning 1:170: outputchannel() without a text for a name does nothing\n");
    EXPECT_EQ(in_surface("float r = 0; getvar(null, \"x\", r); readprimvar(\"x\", r);"), "");
}

TEST(Analysis, GlobalsAreMadeWhenNamed) {
    Heard heard;
    const auto unit = compiled("surface t() { normal Nf = faceforward(normalize(N), I); Ci = Cs; }", heard);
    ASSERT_TRUE(unit) << heard.all();
    std::string names;
    for (const auto& variable : unit->shaders[0]->globals) {
        EXPECT_EQ(variable->kind, Variable::Kind::Global);
        names += variable->name + " ";
    }
    EXPECT_EQ(names, "N I Ng Ci Cs ");  // faceforward of two reads Ng
    const GlobalVariable* e = find_global(ShaderKind::Surface, "E");
    ASSERT_TRUE(e);
    EXPECT_EQ(e->storage, Storage::Uniform);
    EXPECT_TRUE(find_global(ShaderKind::Surface, "Ps"));
    EXPECT_FALSE(find_global(ShaderKind::Displacement, "Ps"));
    EXPECT_TRUE(find_global(ShaderKind::Imager, "alpha"));
}

TEST(Analysis, ReadOnlyVariablesAreCopied) {
    const std::string in_surfaces =
        " is not to be assigned to in surface shaders: only this one sees the change\n";
    EXPECT_EQ(in_surface("P += N; N = calculatenormal(P); Ci = 1; Oi = 1;"), "");
    EXPECT_EQ(in_surface("Cs = 1; Cs = 2;"), "warning 1:67: \"Cs\"" + in_surfaces);
    EXPECT_EQ(in_surface("fresnel(I, N, 1, s, t);"),
              "warning 1:84: \"s\"" + in_surfaces + "warning 1:87: \"t\"" + in_surfaces);
    EXPECT_EQ(
        said("light t() { Cl = 1; P = 0; }"),
        "warning 1:21: \"P\" is not to be assigned to in light shaders: only this one sees the change\n");
    EXPECT_EQ(in_surface("illuminance(P) { L = normalize(L); Cl *= 2; }"), "");
    Heard heard;
    const auto unit = compiled("surface t() { Cs = 1; Ci = Cs + s; }", heard);
    for (const auto& variable : unit->shaders[0]->globals)
        EXPECT_EQ(variable->copied, variable->name == "Cs") << variable->name;
}

TEST(Analysis, ExternMeansTheShadersVariables) {
    EXPECT_EQ(said("float f(float x) { extern float Kd; extern normal N; return x * Kd * xcomp(N); }\n"
                   "surface t(float Kd = 1) { Ci = f(2); }"),
              "");
    EXPECT_EQ(
        said(
            "surface t() { float q = 1; float f(float x) { extern float q; q += x; return q; } Ci = f(2); }"),
        "");
    EXPECT_EQ(
        said("float f(float x) { extern float Kq; return x * Kq; } surface t(float Kd = 1) { Ci = f(2); }"),
        "error 1:33: there is no variable \"Kq\" outside, in surface shader \"t\"\n");
    EXPECT_EQ(said("float f(float x) { return x * Kd; } surface t(float Kd = 1) { Ci = f(2); }"),
              "error 1:31: \"Kd\" is a variable of the shader: functions name those as \"extern\" first\n");
    EXPECT_EQ(said("float f() { extern color Kd; return 1; } surface t(float Kd = 1) { Ci = f(); }"),
              "error 1:26: extern \"Kd\" is a float outside, not a color\n");
    // Each shader has its own.
    Heard heard;
    const auto unit = compiled(
        "float f() { extern float Kd; return Kd; }\n"
        "surface a(float Kd = 1) { Ci = f() + f(); } surface b(float Kd = 2) { Ci = f(); }",
        heard);
    ASSERT_TRUE(unit) << heard.all();
    ASSERT_EQ(unit->functions.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        const Statement& body = *unit->functions[i]->body;
        EXPECT_TRUE(body.children[0]->variables.empty());
        EXPECT_EQ(body.children[1]->expressions[0]->variable, unit->shaders[i]->parameters[0].get());
    }
    const Expression& call = *unit->shaders[1]->body->children[0]->expressions[0]->children[1]->children[0];
    EXPECT_EQ(call.function, unit->functions[1].get());
}

TEST(Analysis, ArraysAreAssignedWhole) {
    EXPECT_EQ(in_surface("float a[3] = {1, 2, 3}, b[3] = a, c[2] = 5; b = a; c = {6, 7}; a = b = {1};"), "");
    EXPECT_EQ(in_surface("float a[3], b[2]; a = b;"),
              "error 1:87: an array is assigned an array of its type and length, or values in braces\n");
    EXPECT_EQ(in_surface("float a[3]; color b[3]; a = b;"),
              "error 1:93: an array is assigned an array of its type and length, or values in braces\n");
    EXPECT_EQ(in_surface("float a[2]; a += a;"),
              "error 1:81: an array is assigned an array of its type and length, or values in braces\n");
    EXPECT_EQ(in_surface("float a[2]; a = {1, 2, 3};"),
              "error 1:83: 3 values for the 2 elements of an array\n");
    EXPECT_EQ(in_surface("float a[2]; float x = arraylength(a) + arraylength(Kd);"),
              "error 1:118: argument 1 of arraylength is a float, an array is wanted\n"
              "note 1:118: float arraylength(any array)\n");
}

TEST(Analysis, ComponentsAreAssigned) {
    EXPECT_EQ(in_surface("vector v; v[0] = 1; v[1] += 2; matrix m; m[0][1] = 3; color c[2]; c[1][0] = 4;"),
              "");
    EXPECT_EQ(in_surface("(P + P)[0] = 1;"), "error 1:74: this cannot be assigned to\n");
}

TEST(Analysis, SplinesHaveFourKnots) {
    EXPECT_EQ(in_surface("Ci = spline(s, color 0, color 1);"),
              "error 1:72: a spline has at least four knots, not 2\n");
    EXPECT_EQ(in_surface("Ci = spline(\"linear\", s, 1, 2, 3);"),
              "error 1:72: a spline has at least four knots, not 3\n");
    EXPECT_EQ(in_surface("float k[3] = 1; float x = spline(s, k);"),
              "error 1:93: a spline has at least four knots, not 3\n");
    EXPECT_EQ(in_surface("float k[4] = 1; float x = spline(\"bezier\", s, k) + spline(s, 1, 2, 3, 4, 5);"),
              "");
}

TEST(Analysis, OptionsOfLightBlocksAreIgnored) {
    EXPECT_EQ(in_surface("illuminance(\"a\", P, N, 1, \"lightcache\", \"reuse\") ;"), "")
        << "which changes nothing";
    EXPECT_EQ(in_surface("float b; illuminance(P, \"send:surface:x\", Kd, \"light:b\", b) ;"),
              "warning 1:91: \"send:surface:x\" of illuminance is ignored\n");
    EXPECT_THAT(in_surface("illuminance(P, \"light:b\", 1) ;"), ::testing::HasSubstr("must be a variable"));
    EXPECT_EQ(said("light t() { illuminate(P, N, 1, \"inshadows\", 1) Cl = 1; }"),
              "warning 1:33: \"inshadows\" of illuminate is ignored\n");
    EXPECT_EQ(said("light t() { solar(\"x\", 1) Cl = 1; }"), "warning 1:19: \"x\" of solar is ignored\n");
    EXPECT_EQ(in_surface("illuminance(\"a\", P) ;"), "");
}

TEST(Analysis, IlluminanceSendsValuesToLights) {
    EXPECT_EQ(
        in_surface("float k[2] = 1; string q = \"reuse\"; illuminance(\"a\", P, N, 1, \"send:light:x\", Kd,"
                   " \"lightcache\", q, \"send:light:y\", k, \"send:light:z\", noise(P)) ;"),
        "");
    EXPECT_EQ(in_surface("illuminance(P, \"send:light:\", 1) ;"),
              "error 1:82: \"send:light:\" of illuminance names no parameter\n");
    EXPECT_EQ(in_surface("illuminance(P, \"send:light:x\", s < t) ;"),
              "error 1:100: \"send:light:x\" of illuminance has no value to send\n");
    EXPECT_EQ(in_surface("illuminance(P, \"send:light:x\", printf(\"\")) ;"),
              "error 1:98: \"send:light:x\" of illuminance has no value to send\n");
    EXPECT_EQ(in_surface("illuminance(P, \"send:light:x\", nothing) ;"),
              "error 1:98: there is no variable \"nothing\"\n");
    EXPECT_EQ(in_surface("illuminance(P, \"lightcache\", \"never\") ;"),
              "warning 1:96: \"lightcache\" of illuminance knows \"refresh\" and \"reuse\", not \"never\"\n");
    EXPECT_THAT(in_surface("illuminance(P, \"lightcache\", P) ;"), ::testing::HasSubstr("error 1:96: "));
}

/// As shaders for 3Delight, BMRT and PRMan have it.
TEST(Analysis, FormsOfOtherRenderers) {
    EXPECT_EQ(in_surface("print(s); print(P); print(\"x\"); print(Cs); print(N * 2);"), "");
    EXPECT_EQ(said("void print(float x) {} surface t() { print(1); }"), "");
    EXPECT_THAT(in_surface("print(1, 2);"), ::testing::HasSubstr("there is no function \"print\""));
    EXPECT_EQ(in_surface("Ci = specularstd(N, -I, .1); P = mix(P, P + 1, Cs); N = mix(N, N, N);"), "");
    EXPECT_EQ(
        in_surface("float k = shadow(\"m\", P, \"source\", P, P + 1, P + 2, P + 3, \"samples\", 4);"),
        "warning 1:92: a \"source\" of several points is not supported: shadows are those of a point\n");
    EXPECT_EQ(in_surface("float k = shadow(\"m\", P, P, P, P, \"samples\", 4) + shadow(\"source\", P);"), "");
    EXPECT_EQ(in_surface("gather(\"pointcloud:a.ptc\", P, N, 1, 4) ;"),
              "warning 1:74: gather() of \"pointcloud:a.ptc\" is not supported: it traces rays\n");
    EXPECT_EQ(
        in_surface("color c; float w; gather(\"environment:a.tx\", 0, 0, 0, 4, \"environment:color\", c,"
                   " \"environment:solidangle\", w) ;"),
        "");
    EXPECT_EQ(said("plugin \"ptex\"; surface t() { Ci = 1; }\x1a"),
              "warning 1:1: plugins are not supported: functions of \"ptex\" are not there\n");
}

TEST(Analysis, ManyIndicesTakeNoTime) {
    std::string deep = "P";
    for (int i = 0; i < 60; ++i) deep = "(P * (" + deep + ")[0])";
    EXPECT_EQ(in_surface("point p = " + deep + ";"), "");
}

TEST(Builtins, HaveReadableSignatures) {
    EXPECT_EQ(print(signature_of(builtins_named("texture")[0])),
              "float texture(string, \"name\", value, ...)");
    EXPECT_EQ(print(signature_of(builtins_named("min")[1])), "color min(color, color, ...)");
    EXPECT_EQ(print(signature_of(builtins_named("surface")[0])), "float surface(string, output any type)");
    EXPECT_EQ(builtins_named("noise").size(), 16u);
    EXPECT_TRUE(builtins_named("nothing").empty());
    size_t together = 0;
    std::string_view last;
    for (const Builtin& builtin : builtins()) {
        if (builtin.name != last) together += builtins_named(builtin.name).size();
        last = builtin.name;
    }
    EXPECT_EQ(together, builtins().size());  // overloads of a name stand together
}

/// Functions of the source come first, but not where a float would have to become a colour for them, nor in
/// their own bodies.
TEST(Analysis, FunctionsOfTheSourceStandBesideThoseOfTheLanguage) {
    const std::string exponential =
                          "color exp(color c) { return color (exp(c[0]), exp(c[1]), exp(c[2])); }\n",
                      mixed = "color mix(color a, b, k) { return a * (1 - k) + b * k; }\n",
                      sloping = "float smoothstep(float a, b, x) { return 7; }\n";
    EXPECT_EQ(said(exponential + "surface a() { Ci = exp(-Cs) + exp(2); float f = exp(1); }"), "");
    EXPECT_EQ(
        said(mixed + "surface a() { float f = mix(1.0, 3.0, .5); Ci = mix(Cs, Cs, Cs) + mix(Cs, Cs, f); }"),
        "");
    EXPECT_EQ(said(sloping + "surface a() { Ci = smoothstep(0, 1, s); }"), "");
    EXPECT_THAT(said("color twice(color c) { return twice(c); } surface a() { Ci = twice(Cs); }"),
                ::testing::HasSubstr("calls itself"));
}

}  // namespace
}  // namespace trapeze::rsl
