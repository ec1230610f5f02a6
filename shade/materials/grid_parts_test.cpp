#include "shade/materials/grid_parts.h"

#include "shade/materials/shader_folder_harness.h"
#include "shade/planes/planes.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using testing::shader;
using testing::ShaderFolder;
using testing::ShadingScene;

/// A scene whose surface is this source, with lights and an atmosphere.
struct PartedScene : ShadingScene {
    ShaderFolder folder;

    explicit PartedScene(const std::string& source) {
        folder.write("test", source);
        scene.options.search_paths["shader"] = {folder.path()};
        surface("test");
        light("ambientlight");
        light("pointlight");
        attributes->atmosphere = std::make_shared<ShaderInstance>(shader("fog"));
        Display display;
        display.variable = DisplayVariable{"turns", ValueType::Float};
        scene.options.displays.push_back(display);
        declare("heat", {StorageClass::Varying, ValueType::Float, 1});
    }

    ShadingGrid heated() const {
        ShadingGrid made = grid(16, 13);
        made.variables = {{"heat", {StorageClass::Varying, ValueType::Float, 1}, false, {made.t}, {}}};
        return made;
    }
    bool can_be_parted() const { return Shading(context).can_be_parted(grid()); }
};

TEST(GridParts, AreShadedAsTheWholeIs) {
    const PartedScene scene(
        "surface test(varying float heat = 0; varying vector along = dPdu;"
        "             output varying float turns = 0;) {"
        "  point at = transform(\"shader\", P);"
        "  while (turns < 40 * s && noise(at * 3) < 0.7) { at += 0.1 * normalize(I); turns += 1; }"
        "  Ci = Cs * (turns / 40 + heat) + diffuse(normalize(N)) + color(along) + specular(N, -I, 0.1);"
        "  Oi = Os; }");
    ASSERT_TRUE(scene.can_be_parted());
    const ShadingGrid before = scene.heated(), whole = scene.shaded(before);
    EXPECT_TRUE(scene.reported.empty()) << scene.reported.front().text;
    for (const size_t parts : {1, 2, 5, 100}) {
        ShadingGrid joined = before;
        const size_t vertices = before.vertex_count(), size = part_size(vertices, parts);
        EXPECT_EQ(size % kLanes, 0u);
        for (size_t first = 0; first < vertices; first += size)
            put_part(scene.shaded(part_of(before, first, std::min(size, vertices - first))), first, joined);
        EXPECT_EQ(joined.Ci.c, whole.Ci.c) << parts;
        EXPECT_EQ(joined.Oi.c, whole.Oi.c) << parts;
        EXPECT_EQ(joined.aovs, whole.aovs) << parts;
    }
}

TEST(GridParts, AreNoneWhereShadersLookAround) {
    for (const char* body :
         {"Ci = Du(s);", "Ci = random();", "Ci = texture(\"x.tex\");", "Ci = shadow(\"x.shd\", P);",
          "Ci = area(P);", "Ci = du;", "Ci = filterstep(0.5, s);", "printf(\"%g\", s);"})
        EXPECT_FALSE(PartedScene(std::string("surface test() {") + body + "}").can_be_parted()) << body;
    EXPECT_FALSE(PartedScene("surface test(varying float a = Dv(t);) { Ci = a; }").can_be_parted());
    PartedScene displaced("surface test() { Ci = Cs; }");
    EXPECT_TRUE(displaced.can_be_parted());
    displaced.displacement("dented");
    EXPECT_FALSE(displaced.can_be_parted());
}

}  // namespace
}  // namespace trapeze
