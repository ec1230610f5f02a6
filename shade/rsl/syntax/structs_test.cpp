/// Structs of RSL 2: what they become, and what is said of wrong ones.
#include <gtest/gtest.h>

#include <string>

#include "shade/rsl/analysis/analysis_harness.h"

namespace trapeze::rsl {
namespace {

using testing::said;

const std::string kFloat2 = "struct Float2 { float x = 0, y = 1; }\n";

std::string in_surface_with_struct(const std::string& body) {
    return said(kFloat2 + "surface t() {\n" + body + "}");
}

TEST(Structs, StandWhereFunctionsDo) {
    EXPECT_EQ(said("struct A { float x = 1; }; surface t() { A a; Ci = a->x; }"), "");
    EXPECT_EQ(said("surface t() { struct A { float x = 1; } A a; Ci = a->x; }"), "");
    EXPECT_EQ(said("class t() { struct A { float x = 1; } A a; A b = A(3);\n"
                   "public void surface(output color Ci, Oi) { Ci = a->x * sum(b); }\n"
                   "public void displacement(output point P; output normal N) { P += a->x; }\n"
                   "float sum(A of) { return of->x; } }"),
              "");
    // "struct" and names of structs are names elsewhere.
    EXPECT_EQ(said("surface t() { float struct = 2; Ci = struct; }"), "");
    EXPECT_EQ(said(kFloat2 + kFloat2 + "surface t() { Float2 a; float Float2 = 2; Ci = Float2 + a->y; }"),
              "");
}

TEST(Structs, TellWhatIsWrongWithThem) {
    EXPECT_EQ(said(kFloat2 + "struct Float2 { float x = 0; } surface t() {}"),
              "error 2:8: struct \"Float2\" has been defined otherwise\n");
    EXPECT_EQ(said("struct A { float x = 1; color x = 2; } surface t() {}"),
              "error 1:31: member \"x\" is there twice\n");
    EXPECT_EQ(said("struct A { A a; } surface t() {}"),
              "error 1:12: expected a member of the struct, not \"A\"\n");
    EXPECT_EQ(said(kFloat2 + "surface t(Float2 a;) {}"),
              "error 2:18: a shader's parameter cannot be a struct\n");
    EXPECT_EQ(in_surface_with_struct("Float2 a[3];"), "error 3:9: arrays of structs are not supported\n");
    std::string nested = "struct S0 { float x = 1; }\n";
    for (int i = 1; i < 20; ++i)
        nested += "struct S" + std::to_string(i) + " { S" + std::to_string(i - 1) + " a, b; }\n";
    EXPECT_NE(said(nested + "surface t() { S19 s; }").find("has too many members with those in them\n"),
              std::string::npos);
    std::string many = "struct A { float x[60000]; } surface t() {\n";
    for (int i = 0; i < 5; ++i) many += "A a" + std::to_string(i) + ";";
    EXPECT_EQ(said(many + "}"), "error 2:18: the structs of this file have too many members together\n");
}

TEST(Structs, MembersAreNamedBehindVariables) {
    EXPECT_EQ(in_surface_with_struct("Float2 a; Ci = a->z;"),
              "error 3:17: struct \"Float2\" has no member \"z\"\n");
    EXPECT_EQ(in_surface_with_struct("float a; Ci = a->x;"),
              "error 3:16: \"->\" stands behind variables that are structs\n");
    EXPECT_EQ(in_surface_with_struct("Float2 a; float a = 2; Ci = a;"),
              "warning 3:17: \"a\" is declared twice: this one hides the other\n");
    EXPECT_EQ(in_surface_with_struct("Float2 a; Ci = 2 * a;"),
              "error 3:20: \"a\" is a struct; one of its members is wanted here\n");
    EXPECT_EQ(in_surface_with_struct("Float2 a; if (a == a) Ci = 2;"),
              "error 3:15: \"a\" is a struct; one of its members is wanted here\n"
              "error 3:20: \"a\" is a struct; one of its members is wanted here\n");
    EXPECT_EQ(
        said(kFloat2 + "struct B { Float2 in; } surface t() { B b; Ci = b->in + b->in->x + b->in->x->y; }"),
        "error 2:50: \"b->in\" is a struct; one of its members is wanted here\n"
        "error 2:76: \"->\" stands behind variables that are structs\n");
}

TEST(Structs, MethodsSeeMembersAndOneAnother) {
    const std::string structs =
        "struct A { varying float x = 1; float once() { return x; } float twice() { return 2 * once(); } }\n"
        "struct B : A { float y = 2; float once() { return A::once() + twice() + y; }\n"
        "    void set(float x) { y = x; } }\n";
    // The header of a header is included twice.
    EXPECT_EQ(
        said(structs + structs + "surface t() { B b; b->x = 3; b->set(4); Ci = b->once() + b->twice(); }"),
        "");
    EXPECT_EQ(said(structs + "surface t() { A a;\nCi = a->thrice(); }"),
              "error 5:7: there is no method \"thrice\" of this struct\n");
    EXPECT_EQ(said(structs + "surface t() { float a;\nCi = a->once(); }"),
              "error 5:7: methods are called of structs; co-shaders of RSL 2 are not supported\n");
    EXPECT_EQ(said("struct A : B { float x = 1; } surface t() {}"), "error 1:12: there is no struct \"B\"\n");
    EXPECT_EQ(
        said(
            "struct A { float f() { return g(); } float g() { return f(); } } surface t() { A a; Ci = a->f(); }"),
        "error 1:57: function \"A->f\" calls itself, directly or through others\n");
    EXPECT_EQ(said("struct A { float f() { return z; } } surface t() { A a; Ci = a->f(); }"),
              "error 1:31: there is no variable \"z\"\n");
}

/// The members that stand in front of a method's parameters are not shown.
TEST(Structs, MethodsHaveDefaultValues) {
    EXPECT_EQ(said("struct A { float x = 1; void init(color cc; uniform float q = 3) { x = q; } }\n"
                   "surface t() { A a; a->init(Cs); a->init(Cs, \"q\", 2);\na->init(Cs, Cs);\na->init(); }"),
              "error 3:13: argument 2 of A->init is a color, a float is wanted\n"
              "note 3:13: void A->init(color, float = 3)\n"
              "error 4:2: no A->init takes ()\n"
              "note 4:2: there is void A->init(color, float = 3)\n");
}

TEST(Structs, ValuesFit) {
    EXPECT_EQ(in_surface_with_struct("Float2 a = Float2(1, 2, 3);"),
              "error 3:12: struct \"Float2\" has 2 members, not 3\n");
    EXPECT_EQ(in_surface_with_struct("Float2 a = 2;"), "error 3:12: a struct \"Float2\" is wanted here\n");
    EXPECT_EQ(in_surface_with_struct("Float2 a; a += a;"),
              "error 3:13: structs are assigned by \"=\" only\n");
    EXPECT_EQ(in_surface_with_struct("Float2 a = Float2(\"z\", 1);"),
              "error 3:19: a float is wanted here, not a string\n");
    EXPECT_EQ(in_surface_with_struct("Ci = Float2(1, 2);"),
              "error 3:6: a struct is made here, which goes to a variable or a function only\n");
    EXPECT_EQ(in_surface_with_struct("struct B { float x = 0, y = 1; } B b; Float2 a = b; a = B(1);"),
              "error 3:50: this is a struct \"B\", a \"Float2\" is wanted\n"
              "error 3:57: this is a struct \"B\", a \"Float2\" is wanted\n");
    EXPECT_EQ(
        said(kFloat2 + "float f(Float2 a) { return a->x; } surface t() { Float2 a; Ci = f(a) + f(1); }"),
        "error 2:72: no f takes (float)\nnote 2:72: there is float f(float, float)\n");
    EXPECT_EQ(
        said(kFloat2 + "void f(Float2 a) { a->x = 2; } surface t() { Float2 a; f(a); }"),
        "warning 2:21: parameter \"a->x\" is assigned to, and is not output: the caller sees no change\n");
}

}  // namespace
}  // namespace trapeze::rsl
