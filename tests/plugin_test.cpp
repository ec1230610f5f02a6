/// The plugin of docs/examples, built as its page says, against the installed headers alone: its hits are
/// brute force's. And files that are no plugins.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "core/grids_harness.h"
#include "sample/frame_harness.h"
#include "sample/load_plugin.h"
#include "tests/command_line/command_line_harness.h"

namespace trapeze {
namespace {

using testing::GridMaker;
using testing::TestFrame;

std::string error_of(const std::string& file) {
    std::string error;
    EXPECT_FALSE(load_plugin(file, &error)) << file;
    EXPECT_NE(error.find("\"" + file + "\""), std::string::npos) << error;
    return error;
}

void load_cells() {
    std::string error;
    ASSERT_TRUE(load_plugin(TRAPEZE_CELLS_PLUGIN, &error)) << error;
}

/// Bent sheets of all sizes that move through the frame, behind the eye, too; every other one half
/// transparent.
GridMaker moving_sheets(uint32_t seed) {
    GridMaker maker;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int n = 0; n < 60; ++n) {
        const V3f at(8 * unit(random) - 4, 8 * unit(random) - 4, 12 * unit(random) - 1);
        const V3f way(2 * unit(random) - 1, 2 * unit(random) - 1, unit(random));
        const float size = n % 7 == 0 ? 4 : unit(random), bend = unit(random);
        maker.opaque = n % 2 == 0;
        maker.facing = n % 5 == 0 ? Facing::PositiveOnly : Facing::Both;
        maker.add(1 + n % 9, 1 + n % 5, n % 3 + 1, [=](int i, int j, float time) {
            const float u = static_cast<float>(i) / 9, v = static_cast<float>(j) / 5;
            return at + way * (time * (1 + bend * time)) + V3f(size * u, size * v, bend * u * v);
        });
    }
    return maker;
}

/// The hits of a method, tile by tile.
std::vector<HitBuffer> hits_of(const std::string& method, const TestFrame& frame, const Grids& grids) {
    std::string error;
    const auto sampler = choose_sampler(method, "stratified", &error);
    EXPECT_TRUE(sampler) << error;
    const auto pattern = sampler->make_pattern(frame.context);
    const auto visibility = sampler->prepare(frame.context, grids);
    std::vector<HitBuffer> all;
    SampleScratch scratch;
    SampleStats stats;
    SampleTile samples;
    for (const PixelRect& pixels : testing::tiles_of({-2, -3, 66, 67})) {  // beyond the picture, too
        pattern->make_tile(pixels, samples);
        visibility->resolve(samples, all.emplace_back(), scratch, stats);
    }
    return all;
}

TEST(Plugin, TheExampleGivesTheHitsOfBruteForce) {
    load_cells();
    for (const uint32_t seed : {1u, 2u, 3u}) {
        const GridMaker maker = moving_sheets(seed);
        const TestFrame frame(64, 64, 3, seed != 2, seed != 3);
        const auto truth = hits_of("bruteforce", frame, maker.grids());
        size_t count = 0;
        for (const HitBuffer& tile : truth) count += tile.hits.size();
        EXPECT_GT(count, 10'000u);
        for (const char* form : {"cells", "cells:side=4", "cells:side=16"})
            EXPECT_EQ(hits_of(form, frame, maker.grids()), truth) << form << ", scene " << seed;
    }
}

TEST(Plugin, IsARowOfTheTableOnce) {
    load_cells();
    load_cells();
    const auto& table = visibility_methods();
    EXPECT_EQ(std::ranges::count(table, "cells", &VisibilityMethod::name), 1);
    std::string error;
    EXPECT_FALSE(choose_sampler("cells:side=5", "", &error));
    EXPECT_NE(error.find("4"), std::string::npos) << error;
}

TEST(Plugin, SaysWhatIsWrongWithAFile) {
    EXPECT_NE(error_of("no/such/file.so").find("there is no such file"), std::string::npos);
    EXPECT_NE(error_of(TRAPEZE_SOURCE_DIR).find("it is no file"), std::string::npos);
    const testing::WorkFolder folder;
    folder.write("text.so", "no shared object\n"), folder.write("empty.so", "");
    for (const char* file : {"text.so", "empty.so"})
        EXPECT_NE(error_of((folder / file).string()).find("it cannot be loaded: "), std::string::npos)
            << file;
    EXPECT_NE(error_of(TRAPEZE_NO_PLUGIN).find("it is no plugin of Trapeze"), std::string::npos);
    const std::string old = error_of(TRAPEZE_OLD_PLUGIN);
    EXPECT_NE(old.find("it was built for Trapeze 0.0.1, this is "), std::string::npos) << old;
    EXPECT_NE(error_of(TRAPEZE_OTHER_PLUGIN).find("with other headers"), std::string::npos);
    EXPECT_NE(error_of(TRAPEZE_TAKEN_PLUGIN).find("\"raytrace\" already"), std::string::npos);
}

/// A row that lacks something is not taken.
TEST(Plugin, RowsAreWhole) {
    const size_t rows = visibility_methods().size();
    VisibilityMethod row = *find_named(visibility_methods(), "bruteforce");
    for (const char* name : {"", "a b", "a:b", "raytrace"}) {
        std::string error;
        row.name = name;
        EXPECT_FALSE(add_visibility_method(row, &error)) << name;
        EXPECT_FALSE(error.empty());
    }
    std::string error;
    row.name = "whole", row.prepare = nullptr;
    EXPECT_FALSE(add_visibility_method(row, &error));
    EXPECT_EQ(visibility_methods().size(), rows);
}

TEST(Plugin, TheProgramRendersAndComparesWithIt) {
    const testing::WorkFolder folder;
    const std::string scene = TRAPEZE_SOURCE_DIR "/scenes/tiny/defocus_motion.rib -r 48x32 ",
                      plugin = " --plugin " TRAPEZE_CELLS_PLUGIN " ";
    const auto rendered =
        testing::run_program(folder, "render " + scene + plugin + "--sampler cells:side=4 -o cells.exr");
    EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "cells.exr"));
    const auto compared = testing::run_program(
        folder, "compare " + scene + plugin +
                    "--samplers 'raytrace cells' --samples 2x2 --repeat 1 --reference 2 --json c.json");
    EXPECT_EQ(compared.exit_code, 0) << compared.err;
    const auto results = nlohmann::json::parse(testing::file_text(folder / "c.json"))["results"];
    ASSERT_EQ(results.size(), 2u);
    EXPECT_EQ(results[1]["method"], "cells");
    for (const char* figure : {"hits", "rmse", "flip"})
        EXPECT_EQ(results[1][figure], results[0][figure]) << figure;
    EXPECT_GT(results[0]["hits"], 500);
    EXPECT_NE(testing::file_text(folder / "c.json").find(TRAPEZE_CELLS_PLUGIN), std::string::npos);
    EXPECT_EQ(testing::run_program(folder, "compare --replay c.json").exit_code, 3)
        << "plugins are not in it";
    EXPECT_EQ(testing::run_program(folder, "compare --replay c.json" + plugin).exit_code, 0);
    const auto wrong = testing::run_program(folder, "render " + scene + "--plugin nothing.so");
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_NE(wrong.err.find("--plugin: \"nothing.so\": there is no such file"), std::string::npos)
        << wrong.err;
}

}  // namespace
}  // namespace trapeze
