#include "shade/named_values.h"

#include "shade/materials/shader_folder_harness.h"
#include "shade/shading_harness.h"

namespace trapeze {
namespace {

using Numbers = std::vector<float>;
using Texts = std::vector<std::string>;

/// What the body of a surface shader leaves in red, which must be the same at all vertices.
float shaded(testing::ShadingScene& scene, const std::string& body) {
    testing::ShaderFolder folder;
    folder.write("probe",
                 "surface probe(string mine[2] = {\"left\", \"right\"}) { Oi = 1; Ci = 0; " + body + " }");
    folder.write("asking",
                 "light asking(string names[3] = {\"a\", \"bc\", \"def\"}) { string told[2] = {\"\", \"\"};"
                 " solar(vector (0, 0, 1), 0) { Cl = surface(\"mine\", told);"
                 " if (told[0] == \"left\" && told[1] == \"right\") Cl += 10; } }");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.attributes->lights.clear();
    scene.light("asking");
    scene.surface("probe");
    const ShadingGrid grid = scene.shaded();
    for (const Diagnostic& d : scene.reported) ADD_FAILURE() << to_string(d);
    for (const float red : grid.Ci.c[0]) EXPECT_EQ(red, grid.Ci.c[0][0]);
    return grid.Ci.c[0][0];
}

Parameter texts(std::string name, Texts values) {
    const int length = static_cast<int>(values.size());
    return {std::move(name), {StorageClass::Uniform, ValueType::String, length}, {}, std::move(values)};
}

TEST(NamedValues, ArraysOfTextsComeWhole) {
    testing::ShadingScene scene;
    scene.attributes->user.set("user", texts("words", {"this", "should", "work"}));
    scene.scene.options.user.set("user", texts("names", {"one", "two"}));
    const std::string three = "string w[3] = {\"x\", \"y\", \"z\"}; ", two = "string w[2] = {\"x\", \"y\"}; ";
    EXPECT_EQ(shaded(scene, three + "Ci = attribute(\"user:words\", w); if (w[0] == \"this\" && w[1] == "
                                    "\"should\" && w[2] == \"work\") Ci += 10;"),
              11);
    EXPECT_EQ(shaded(scene, two + "Ci = option(\"user:names\", w); if (w[0] == \"one\" && w[1] == \"two\") "
                                  "Ci += 10;"),
              11);
    // As with numbers, more than there are is not there.
    EXPECT_EQ(shaded(scene, three + "Ci = option(\"user:names\", w); if (w[0] == \"x\" && w[2] == \"z\") Ci "
                                    "+= 10;"),
              10);
    EXPECT_EQ(shaded(scene, three + "illuminance(P) { Ci = lightsource(\"names\", w); if (w[0] == \"a\" && "
                                    "w[1] == \"bc\" && w[2] == \"def\") Ci += 10; }"),
              11);
    EXPECT_EQ(shaded(scene, "illuminance(P) Ci += Cl;"), 11);
}

/// Two grids in a run: each has its own values, and uniform ones beside varying ones.
TEST(NamedValues, VariablesOfThePrimitiveByName) {
    testing::ShadingScene scene;
    testing::ShaderFolder folder;
    folder.write(
        "probe",
        "surface probe() { float w = -1, none = 5; color c = 0; string k = \"\"; Oi = 1;"
        " Ci = color (getvar(null, \"weight\", w) + 10 * readprimvar(\"tint\", c) + 100 * getvar(\"kind\", "
        "k), getvar(\"none\", none) + getvar(\"weight\", c) + none, w + 10 * comp(c, 1) + (k == \"oak\" ? "
        "100 : 0)); }");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.surface("probe");
    std::vector<ShadingGrid> grids{scene.grid(), scene.grid(2, 1)};
    for (size_t g = 0; g < grids.size(); ++g) {
        std::vector<float> weights(grids[g].vertex_count());
        for (size_t i = 0; i < weights.size(); ++i) weights[i] = static_cast<float>(i + 50 * g) / 100;
        const float green = g == 0 ? 0.25f : 0.5f;
        grids[g].variables = {
            {"weight", {StorageClass::Varying, ValueType::Float, 1}, false, {weights}, {}},
            {"tint", {StorageClass::Uniform, ValueType::Color, 1}, true, {{0}, {green}, {1}}, {}},
            {"kind", {StorageClass::Constant, ValueType::String, 1}, true, {}, {"oak"}}};
        grids[g].ordinal = g;
    }
    const Shading shading(scene.context);
    ShadeScratch scratch;
    ShadeStats stats;
    shading.shade(std::vector{&grids[0], &grids[1]}, scratch, stats);
    for (const Diagnostic& d : scene.reported) ADD_FAILURE() << to_string(d);
    for (size_t g = 0; g < grids.size(); ++g)
        for (size_t i = 0; i < grids[g].vertex_count(); ++i) {
            const V3f Ci = grids[g].Ci.at(i);
            EXPECT_EQ(Ci.x, 111);
            EXPECT_EQ(Ci.y, 5);
            EXPECT_NEAR(Ci.z, static_cast<float>(i + 50 * g) / 100 + (g == 0 ? 2.5f : 5) + 100, 1e-4f);
        }
}

/// Grids of two primitives of the same attributes, one of which has the variable.
TEST(NamedValues, VariablesOfOnePrimitiveAreNoOthers) {
    testing::ShadingScene scene;
    testing::ShaderFolder folder;
    folder.write("probe", "surface probe() { Oi = 1; Ci = 0; illuminance(P) Ci += Cl; }");
    folder.write("asking",
                 "light asking() { float w = 7; solar(vector (0, 0, 1), 0) { Cl = 10 * getvar(null, "
                 "\"w\", w) + w; } }");
    scene.scene.options.search_paths["shader"] = {folder.path()};
    scene.surface("probe");
    scene.light("asking");
    scene.scene.primitives.push_back(scene.scene.primitives[0]);
    std::vector<ShadingGrid> grids{scene.grid(), scene.grid()};
    for (uint32_t g = 0; g < 2; ++g)
        grids[g].ordinal = g, grids[g].primitive_index = g, grids[g].primitive = &scene.scene.primitives[g];
    grids[1].variables = {{"w", {StorageClass::Uniform, ValueType::Float, 1}, true, {{3}}, {}}};
    const Shading shading(scene.context);
    ShadeScratch scratch;
    ShadeStats stats;
    shading.shade(std::vector{&grids[0], &grids[1]}, scratch, stats);
    for (const Diagnostic& d : scene.reported) ADD_FAILURE() << to_string(d);
    for (const float red : grids[0].Ci.c[0]) EXPECT_EQ(red, 7);
    for (const float red : grids[1].Ci.c[0]) EXPECT_EQ(red, 13);
}

Numbers numbers(const std::optional<NamedValue>& value) {
    return value ? value->numbers : Numbers{-1};
}
Texts texts(const std::optional<NamedValue>& value) {
    return value ? value->texts : Texts{"none"};
}

TEST(NamedValues, AttributesOfRequests) {
    Attributes attributes;
    Primitive primitive;
    primitive.camera_from_object = {M44f()};
    const auto find = [&](std::string_view name) {
        return find_attribute_value(attributes, &primitive, name);
    };
    EXPECT_EQ(texts(find("Ri:Orientation")), Texts{"outside"});
    M44f mirror;
    mirror.setScale(V3f(1, 1, -1));
    primitive.camera_from_object = {mirror};  // normals are turned over so that they stay
    EXPECT_EQ(texts(find("Ri:Orientation")), Texts{"inside"});
    attributes.reverse_orientation = true;
    EXPECT_EQ(texts(find("Ri:Orientation")), Texts{"outside"});
    EXPECT_EQ(texts(find("Ri:ShadingInterpolation")), Texts{"constant"});
    attributes.smooth_shading = true;
    EXPECT_EQ(texts(find("Ri:ShadingInterpolation")), Texts{"smooth"});
    EXPECT_EQ(numbers(find("Ri:TextureCoordinates")), (Numbers{0, 0, 1, 0, 0, 1, 1, 1}));
    EXPECT_EQ(numbers(find("dice:binary")), Numbers{0});
    EXPECT_EQ(numbers(find("dice:rasterorient")), Numbers{1});
    EXPECT_EQ(numbers(find("cull:hidden")), Numbers{1});
    EXPECT_EQ(numbers(find("derivatives:centered")), Numbers{1});
    EXPECT_FALSE(find("Ri:Nothing") || find("dice:nothing"));
}

TEST(NamedValues, OptionsOfRequestsAlsoUnderRi) {
    Options options;
    options.frame = 7;
    options.samples_x = 3, options.samples_y = 5;
    options.near_clip = 0.5f, options.far_clip = 9;
    options.exposure_gain = 2, options.exposure_gamma = 2.2f;
    options.pixel_aspect = 0.75f;
    Camera camera;
    camera.width = 64, camera.height = 48;
    camera.left = -2, camera.right = 2, camera.bottom = -1.5f, camera.top = 1.5f;
    const std::pair<const char*, Numbers> expected[] = {{"Format", {64, 48, 0.75f}},
                                                        {"FormatResolution", {64, 48}},
                                                        {"FormatPixelAspectRatio", {0.75f}},
                                                        {"FrameAspectRatio", {1}},
                                                        {"CropWindow", {0, 1, 0, 1}},
                                                        {"ScreenWindow", {-2, 2, -1.5f, 1.5f}},
                                                        {"DepthOfField", {kInfinity, 0, 0}},
                                                        {"Shutter", {0, 0}},
                                                        {"Clipping", {0.5f, 9}},
                                                        {"PixelSamples", {3, 5}},
                                                        {"Exposure", {2, 2.2f}},
                                                        {"Frame", {7}},
                                                        {"FrameBegin", {7}}};
    for (const auto& [name, values] : expected) {
        EXPECT_EQ(numbers(find_option_value(options, camera, name)), values) << name;
        EXPECT_EQ(numbers(find_option_value(options, camera, std::string("Ri:") + name)), values) << name;
    }
    EXPECT_FALSE(find_option_value(options, camera, "Ri:nothing"));
}

}  // namespace
}  // namespace trapeze
