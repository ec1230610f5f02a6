/// `trapeze cat`: what it writes describes the same scenes, in ASCII and binary, packed or not.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "pipeline/rib/write/cat_rib.h"
#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze {
namespace {

std::vector<Scene> scenes_of(const std::string& path) {
    std::vector<Scene> scenes;
    Diagnostics diagnostics([](const Diagnostic&) {});
    const std::vector<std::string> files{path};
    read_rib(files, ReadOptions{}, diagnostics, [&](Scene&& scene) { scenes.push_back(std::move(scene)); });
    return scenes;
}

void expect_same(const ParameterList& a, const ParameterList& b) {
    ASSERT_EQ(a.values.size(), b.values.size());
    for (size_t i = 0; i < a.values.size(); ++i) {
        EXPECT_EQ(a.values[i].name, b.values[i].name);
        EXPECT_EQ(a.values[i].declaration, b.values[i].declaration);
        EXPECT_EQ(a.values[i].floats, b.values[i].floats);
        EXPECT_EQ(a.values[i].strings, b.values[i].strings);
    }
}

void expect_same(const std::shared_ptr<const ShaderInstance>& a,
                 const std::shared_ptr<const ShaderInstance>& b) {
    ASSERT_EQ(a == nullptr, b == nullptr);
    if (!a) return;
    EXPECT_EQ(a->name, b->name);
    EXPECT_EQ(a->camera_from_shader, b->camera_from_shader);
    expect_same(a->parameters, b->parameters);
    EXPECT_EQ(a->earlier_layers.size(), b->earlier_layers.size());
}

void expect_same(const Attributes& a, const Attributes& b) {
    EXPECT_EQ(a.color, b.color);
    EXPECT_EQ(a.opacity, b.opacity);
    EXPECT_EQ(a.texture_coordinates, b.texture_coordinates);
    EXPECT_EQ(a.shading_rate, b.shading_rate);
    EXPECT_EQ(a.sides, b.sides);
    EXPECT_EQ(a.matte, b.matte);
    EXPECT_EQ(a.reverse_orientation, b.reverse_orientation);
    EXPECT_EQ(a.displacement_bound, b.displacement_bound);
    expect_same(a.surface, b.surface);
    expect_same(a.displacement, b.displacement);
    expect_same(a.atmosphere, b.atmosphere);
    ASSERT_EQ(a.lights.size(), b.lights.size());
    for (size_t i = 0; i < a.lights.size(); ++i) {
        EXPECT_EQ(a.lights[i]->shader.name, b.lights[i]->shader.name);
        EXPECT_EQ(a.lights[i]->shader.camera_from_shader, b.lights[i]->shader.camera_from_shader);
        expect_same(a.lights[i]->shader.parameters, b.lights[i]->shader.parameters);
    }
}

void expect_same(const Scene& a, const Scene& b) {
    EXPECT_EQ(a.options.width, b.options.width);
    EXPECT_EQ(a.options.fov, b.options.fov);
    EXPECT_EQ(a.options.f_stop, b.options.f_stop);
    EXPECT_EQ(a.options.shutter_close, b.options.shutter_close);
    EXPECT_EQ(a.options.filter.name, b.options.filter.name);
    EXPECT_EQ(a.options.displays.size(), b.options.displays.size());
    EXPECT_EQ(a.camera_from_world, b.camera_from_world);
    EXPECT_EQ(a.camera_from_named, b.camera_from_named);
    EXPECT_EQ(a.solids.size(), b.solids.size());
    ASSERT_EQ(a.primitives.size(), b.primitives.size());
    for (size_t i = 0; i < a.primitives.size(); ++i) {
        const Primitive &p = a.primitives[i], &q = b.primitives[i];
        EXPECT_EQ(p.camera_from_object, q.camera_from_object);
        EXPECT_EQ(p.solid, q.solid);
        expect_same(*p.attributes, *q.attributes);
        ASSERT_EQ(p.shape_keys.size(), q.shape_keys.size());
        for (size_t k = 0; k < p.shape_keys.size(); ++k) {
            EXPECT_EQ(p.shape_keys[k]->topology.index(), q.shape_keys[k]->topology.index());
            expect_same(p.shape_keys[k]->variables, q.shape_keys[k]->variables);
        }
    }
}

void cat(const std::string& from, const rib::CatOptions& options, const std::string& to) {
    Diagnostics diagnostics([](const Diagnostic&) {});
    const std::vector<std::string> files{from};
    std::ofstream file(to, std::ios::binary);
    rib::cat_rib(files, options, diagnostics, [&](std::string_view bytes) {
        file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    });
}

class CatOfTinyScene : public ::testing::TestWithParam<std::string> {};

TEST_P(CatOfTinyScene, DescribesTheSameScenes) {
    const std::string path = testing::tiny_scene_path(GetParam());
    const std::vector<Scene> scenes = scenes_of(path);
    const testing::WorkFolder folder;
    const std::string written = folder / "a.rib";
    for (const auto encoding : {rib::RibEncoding::Ascii, rib::RibEncoding::Binary})
        for (const bool gzip : {false, true}) {
            cat(path, {encoding, gzip, false}, written);
            const std::vector<Scene> again = scenes_of(written);
            ASSERT_EQ(again.size(), scenes.size());
            for (size_t i = 0; i < scenes.size(); ++i) expect_same(scenes[i], again[i]);
        }
}

INSTANTIATE_TEST_SUITE_P(All, CatOfTinyScene, ::testing::ValuesIn(testing::tiny_scenes()),
                         testing::test_name);

TEST(Cat, ArchivesMayStay) {
    const testing::WorkFolder folder;
    folder.write("ball.rib", "Sphere 1 -1 1 360\n");
    folder.write("scene.rib", "WorldBegin\nIfBegin \"1\"\nReadArchive \"ball.rib\"\nIfEnd\nWorldEnd\n");
    cat(folder / "scene.rib", {rib::RibEncoding::Ascii, false, true}, folder / "kept.rib");
    cat(folder / "scene.rib", {}, folder / "read.rib");
    const std::string head = "##RenderMan RIB-Structure 1.1\nWorldBegin\n";
    EXPECT_EQ(testing::file_text(folder / "kept.rib"), head + "  ReadArchive \"ball.rib\"\nWorldEnd\n");
    EXPECT_EQ(testing::file_text(folder / "read.rib"), head + "  Sphere 1 -1 1 360\nWorldEnd\n");
}

TEST(Cat, TheProgramWritesWholeFilesOrStandardOutput) {
    const testing::WorkFolder folder;
    folder.write("scene.rib", "WorldBegin\nSphere 1 -1 1 360\nWorldEnd\n");
    const auto to_stdout = testing::run_program(folder, "cat scene.rib");
    EXPECT_EQ(to_stdout.exit_code, 0);
    const std::string text = "##RenderMan RIB-Structure 1.1\nWorldBegin\n  Sphere 1 -1 1 360\nWorldEnd\n";
    EXPECT_EQ(to_stdout.out, text) << "and nothing else";
    EXPECT_EQ(testing::run_program(folder, "cat --binary scene.rib -o packed.rib.gz").exit_code, 0);
    EXPECT_EQ(testing::run_program(folder, "cat packed.rib.gz").out, text);
    EXPECT_EQ(testing::run_program(folder, "cat scene.rib -o no/where.rib").exit_code, 6);
    EXPECT_EQ(testing::run_program(folder, "cat nothing.rib").exit_code, 3);
}

}  // namespace
}  // namespace trapeze
