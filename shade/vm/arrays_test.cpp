// Arrays that are resized, and structs, which may hold them: where all lanes do the same and where they part,
// with and without the optimiser. s runs over 0, 1/3, 2/3, 1 and t over 0, 1/2, 1; the expected values are
// worked out by hand.
#include "shade/materials/shader_folder_harness.h"
#include "shade/vm/run_shader_harness.h"

namespace trapeze::vm {
namespace {

using testing::expect_values;
using testing::ShaderFolder;
using testing::ShaderRun;
using testing::ShadingScene;

TEST(Arrays, GrowAndShrink) {
    expect_values(
        "float a[]; r = arraylength(a); push(a, 5 + s); push(a, 7); r += 10 * arraylength(a) + a[0];",
        [](float s, float) { return 25 + s; }, 1e-5f);
    expect_values("float a[] = {1, 2, 3}; float x = pop(a); r = 100 * x + 10 * arraylength(a) + a[1];",
                  [](float, float) { return 322; });
    expect_values(
        "color a[] = {color (1, 2, 3)}; resize(a, 3); a[2] = t; resize(a, 2); resize(a, 3); "
        "r = comp(a[0], 1) + comp(a[2], 0) + 10 * arraylength(a);",
        [](float, float) { return 32; });
    expect_values("float a[]; resize(a, 2.9); r = arraylength(a); resize(a, -3); r += 10 * arraylength(a);",
                  [](float, float) { return 2; });
}

/// Elements keep their values as memory is got in larger pieces.
TEST(Arrays, KeepWhatTheyHaveAsTheyGrow) {
    expect_values(
        "float a[], i; for (i = 0; i < 100; i += 1) push(a, i + t); "
        "for (i = 0; i < 100; i += 1) r += a[i]; r += 10000 * arraylength(a);",
        [](float, float t) { return 4950 + 100 * t + 1e6f; });
    expect_values(
        "uniform vector a[]; uniform float i; for (i = 0; i < 100; i += 1) push(a, vector (i, 1, 2 * i)); "
        "for (i = 0; i < 100; i += 1) r += zcomp(a[i]) - xcomp(a[i]);",
        [](float, float) { return 4950; });
}

TEST(Arrays, IndicesMayVary) {
    expect_values("float a[]; push(a, 1); push(a, 10); push(a, 100); r = a[2 * t];", [](float, float t) {
        return t == 0 ? 1 : t == 0.5f ? 10 : 100;
    });
    expect_values("float a[] = {1, 2, 3}; push(a, 4); a[3 * s] += 10; r = a[0] + 100 * a[3];",
                  [](float s, float) { return (s == 0 ? 11 : 1) + 100 * (s == 1 ? 14 : 4); });
    // What lies outside is the nearest element; an empty array has none, and 0 is read.
    expect_values("float a[] = {1, 2}; push(a, 3); a[-4] = 7; r = a[-1] + 10 * a[9];",
                  [](float, float) { return 37; });
    expect_values("float a[]; a[0] = 5; a[s] = 6; r = a[0] + a[1 + t] + pop(a) + arraylength(a);",
                  [](float, float) { return 0; });
}

TEST(Arrays, MayHaveOtherLengthsAtOtherVertices) {
    expect_values(
        "float a[]; push(a, 1); if (s > 0.5) { push(a, t); push(a, 3); } r = 10 * arraylength(a) + a[1];",
        [](float s, float t) { return s > 0.5f ? 30 + t : 11; });
    expect_values(
        "float a[], i; for (i = 0; i < 4 * t; i += 1) push(a, s); if (s > 0.5) r = 100 + pop(a); "
        "r += arraylength(a);",
        [](float s, float t) { return 4 * t + (s > 0.5f ? 100 + (t > 0 ? s - 1 : 0) : 0); }, 1e-5f);
    expect_values(
        "float a[] = {1, 2, 3, 4}; if (s > 0.5) resize(a, 2); else { float b[] = {9}; a = b; } "
        "r = 10 * arraylength(a) + a[1];",
        [](float s, float) { return s > 0.5f ? 22 : 19; });
    expect_values("float a[] = {0, 1, 2, 3, 4, 5}; if (s > 0.5) pop(a); r = spline(1, a);",
                  [](float s, float) { return s > 0.5f ? 3 : 4; });
}

TEST(Arrays, AreAssignedWhole) {
    expect_values(
        "float a[], b[]; push(b, s); push(b, 2); a = b; push(a, 3); r = 10 * arraylength(a) + a[0] + arraylength(b);",
        [](float s, float) { return 32 + s; }, 1e-5f);
    expect_values(
        "float a[] = {1, 2}; a = {a[1], a[0], t}; r = 100 * a[0] + 10 * a[1] + a[2] + 1000 * arraylength(a);",
        [](float, float t) { return 3210 + t; });
    expect_values(
        "float a[] = {4, 5, 6}; push(a, 7); float b[3] = a; pop(a); pop(a); a[0] = 1; b = a; r = b[0] + 10 * b[1] + 100 * b[2];",
        [](float, float) { return 651; });
    expect_values(
        "float a[3] = {1, 2, 3}; float b[] = a; b = {}; r = arraylength(b); b = a; r += 10 * arraylength(b) + b[2];",
        [](float, float) { return 33; });
}

TEST(Arrays, ArePassedToFunctions) {
    const std::string functions =
        "void fill(output float a[]; float n) { float i; for (i = 0; i < n; i += 1) push(a, i * i); } "
        "float sum(float a[]) { float i, all = 0; for (i = 0; i < arraylength(a); i += 1) all += a[i]; "
        "return all; } ";
    expect_values(
        "float a[] = {7}; fill(a, 4); r = sum(a) + 100 * arraylength(a);",
        [](float, float) { return 7 + 14 + 500; }, 0, functions);
    expect_values(
        "float a[]; if (t > 0.25) fill(a, 3); fill(a, 2); r = sum(a) + 100 * arraylength(a);",
        [](float, float t) { return t > 0.25f ? 506 : 201; }, 0, functions);
    expect_values(
        "float a[2] = {3, 4}; r = sum(a);", [](float, float) { return 7; }, 0, functions);
}

TEST(Arrays, OfTexts) {
    expect_values(
        "string a[] = {\"x\"}; push(a, \"y\"); string b[]; b = a; resize(b, 3); b[2] = \"z\"; "
        "string last = pop(a); if (last == b[1] && b[2] == \"z\" && a[0] == \"x\" && a[4] == \"x\") r = 10; "
        "r += arraylength(a) + 100 * arraylength(b);",
        [](float, float) { return 311; });
    expect_values("string a[]; if (a[0] == \"\") r = 1; a[0] = \"x\"; if (a[0] == \"x\") r = 2;",
                  [](float, float) { return 1; });
}

TEST(Arrays, AreMembersOfClasses) {
    ShaderRun run(
        "class test(output varying float r = 0;) { float all[]; uniform float few[] = {1, 2}; "
        "void add(float x) { push(all, x); } "
        "public void begin() { add(s); push(few, 3); } "
        "public void surface(output color Ci, Oi) { add(1); add(2); "
        "r = all[0] + 10 * arraylength(all) + 100 * arraylength(few); } }");
    run.run();
    EXPECT_EQ(run.messages(), "");
    for (size_t i = 0; i < run.vertices(); ++i) EXPECT_NEAR(run.at("r", i), 330 + run.grid().s[i], 1e-4f);
}

TEST(Arrays, StartAnewInEachRun) {
    ShaderRun run(
        "surface test(output varying float r = 0;) { float a[]; push(a, 2); push(a, s); "
        "r = 10 * arraylength(a) + a[0]; }");
    run.run();
    run.run();
    for (size_t i = 0; i < run.vertices(); ++i) EXPECT_EQ(run.at("r", i), 22);
}

/// Nobody's shader takes all memory: further elements are lost, and the run goes on.
TEST(Arrays, AreBounded) {
    const auto said = [](const std::string& body) {
        ShaderRun run("surface test(output varying float r = 0;) { " + body + " r = arraylength(a); }");
        run.run();
        EXPECT_GT(run.at("r", 0), 0);
        const std::string messages = run.messages();
        return messages.substr(0, messages.find('\n') + 1);
    };
    const std::string too_large =
        "the arrays of shader \"test\" have grown too large: together they have at most 65536 numbers, or 4096 "
        "texts; further elements are lost\n";
    EXPECT_EQ(said("float a[]; resize(a, 65536); r = a[s];"), "");
    EXPECT_EQ(said("float a[]; resize(a, 70000); r = a[s];"), "test.sl:1:56: error: " + too_large);
    EXPECT_EQ(said("float a[]; resize(a, 65536); push(a, 1); r = a[s];"),
              "test.sl:1:74: error: " + too_large);
    EXPECT_EQ(said("color a[]; resize(a, 65536); r = comp(a[s], 0);"), "test.sl:1:56: error: " + too_large);
    EXPECT_EQ(said("float a[], b[]; resize(a, 60000); resize(b, 1e30); r = a[s] + b[s];"),
              "test.sl:1:79: error: " + too_large);
    EXPECT_EQ(said("string a[]; resize(a, 5000); if (a[0] == \"x\") r = 1;"),
              "test.sl:1:57: error: " + too_large);
    EXPECT_EQ(said("uniform matrix a[]; uniform float i; for (i = 0; i < 4100; i += 1) push(a, 1); "
                   "r = comp(a[4096], 0, 0);"),
              "test.sl:1:112: error: " + too_large);
}

const std::string kStructs =
    "struct Float2 { float x = 0, y = 2; }; "
    "struct Layer { varying color c = 1; float few[2] = {3, 4}; Float2 at; string name = \"n\"; varying float "
    "grown[]; } "
    "Float2 swapped(Float2 a) { return Float2(a->y, a->x); } "
    "Float2 either(float i) { Float2 a = Float2(1, 2); if (i > 1) return a; return Float2(3); } "
    "Float2 again(Float2 a) { return swapped(a); } "
    "void change(output Layer l; Float2 by) { l->at->x += by->x; l->few[1] *= 2; push(l->grown, by->y); } ";

TEST(Structs, HaveDefaultsAndAreConstructed) {
    expect_values(
        "Float2 a, b = Float2(5), c = Float2(6, 7), d = Float2(\"y\", 8); "
        "r = a->x + a->y + 10 * (b->x + b->y) + 100 * (c->x * c->y) + 10000 * (d->x + d->y);",
        [](float, float) { return 84272; }, 0, kStructs);
    expect_values(
        "Layer l = Layer(color (s, 1, 2), {8, 9}, Float2(4)); if (l->name == \"n\") r = 1; "
        "r += 10 * l->few[1] + 100 * l->at->x + 1000 * l->at->y + comp(l->c, 0);",
        [](float s, float) { return 2491 + s; }, 1e-3f, kStructs);
    expect_values(
        "Float2 k = Float2(1, 2); k = Float2(); r = k->x + 10 * k->y;", [](float, float) { return 20; }, 0,
        kStructs);
}

TEST(Structs, AreAssigned) {
    expect_values(
        "Float2 a = Float2(1, 2), b = a; a = Float2(a->y, a->x); b->x += 4; r = a->x + 10 * a->y + 100 * b->x;",
        [](float, float) { return 512; }, 0, kStructs);
    expect_values(
        "Layer a, b; b->few[0] = 7; push(b->grown, s); b->at = Float2(5, 6); a = b; b->few[0] = 8; "
        "r = a->few[0] + 10 * a->at->y + 100 * arraylength(a->grown) + a->grown[0];",
        [](float s, float) { return 167 + s; }, 1e-4f, kStructs);
    expect_values(
        "varying Float2 a; if (s > 0.5) a = Float2(3, t); r = a->x + 10 * a->y;",
        [](float s, float t) { return s > 0.5f ? 3 + 10 * t : 20; }, 0, kStructs);
}

TEST(Structs, GoToFunctionsAndComeBack) {
    expect_values(
        "Layer l; Float2 by = Float2(4, 5); change(l, by); change(l, Float2(\"x\", 6)); "
        "r = l->at->x + 100 * l->few[1] + 10000 * l->grown[0] + 100000 * l->grown[1];",
        [](float, float) { return 251610; }, 0, kStructs);
    expect_values(
        "Float2 a = Float2(1, 2); a = swapped(a); Float2 b = again(a); swapped(b); r = a->x + 10 * b->x;",
        [](float, float) { return 12; }, 0, kStructs);
    expect_values(
        "Float2 a = either(2), b = either(0); r = a->x + 10 * a->y + 100 * b->x + 1000 * b->y;",
        [](float, float) { return 2321; }, 0, kStructs);
}

TEST(Structs, HaveMethods) {
    const std::string effects =
        "struct Field { varying float k = 1; float n = 2; void begin() { k = 3 * n; } "
        "float twice(float x) { return 2 * x; } } "
        "struct Effect : Field { varying color tint = 1; private varying float e = 0; Float2 at; varying float all[]; "
        "public void begin() { Field::begin(); e = k; at = Float2(at->y, at->x); push(all, 7); } "
        "float field(float f) { return twice(e * f) + other(); } "
        "float field(float f; color c) { return e * f * comp(c, 0); } "
        "float other() { return at->x; } Float2 where() { return at; } } ";
    // k = 6, at = (2, 0): 12 s + 2, and 6 * 2.
    expect_values(
        "Effect m; m->begin(); Float2 w = m->where(); w = m->where(); "
        "r = m->field(s) + 100 * m->field(1, color (2)) + 10000 * w->x + 100000 * m->all[0];",
        [](float s, float) { return 721202 + 12 * s; }, 0.1f, kStructs + effects);
    expect_values(
        "Effect m, n; m->n = 5; m->begin(); n->begin(); r = m->k + 100 * n->k;",
        [](float, float) { return 615; }, 0, kStructs + effects);
}

TEST(Structs, AreMembersOfClasses) {
    ShaderRun run(
        kStructs +
        "class test(output varying float r = 0;) { Layer l; Float2 m = Float2(3, 4); "
        "public void begin() { l->c = s; m = swapped(m); } "
        "public void surface(output color Ci, Oi) { r = comp(l->c, 1) + 10 * m->x + 100 * sum(m); } "
        "float sum(Float2 a) { return a->x + a->y; } }");
    run.run();
    EXPECT_EQ(run.messages(), "");
    for (size_t i = 0; i < run.vertices(); ++i) EXPECT_NEAR(run.at("r", i), 740 + run.grid().s[i], 1e-4f);
}

/// Parameters without a length have as many elements as the scene gives.
TEST(Arrays, OfTheScene) {
    const auto shaded = [](std::vector<Parameter> given) {
        ShadingScene scene;
        const ShaderFolder folder;
        folder.write("ramp",
                     "surface ramp(uniform float knots[] = {}; uniform color c[] = {1, color (1, 2, 3)}) "
                     "{ Ci = color (arraylength(knots), knots[4], comp(c[1], 1)) + arraylength(c); }");
        scene.scene.options.search_paths["shader"] = {folder.path()};
        scene.surface("ramp", std::move(given));
        const V3f Ci = scene.shaded().Ci.at(0);
        EXPECT_TRUE(scene.reported.empty());
        return Ci;
    };
    EXPECT_EQ(shaded({}), V3f(2, 2, 4));
    EXPECT_EQ(shaded({Parameter{"knots", {StorageClass::Uniform, ValueType::Float, 5}, {1, 2, 3, 4, 9}, {}}}),
              V3f(7, 11, 4));
    EXPECT_EQ(shaded({Parameter{
                  "c", {StorageClass::Uniform, ValueType::Color, 3}, {0, 0, 0, 4, 5, 6, 7, 8, 9}, {}}}),
              V3f(3, 3, 8));
}

}  // namespace
}  // namespace trapeze::vm
