/// The include rules of the rooms and of the wings in them, read from the sources themselves: stages never
/// include each other, what they exchange is a type in core; wings of a room include each other one way only;
/// each heavy library is confined to one room.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const std::map<std::string, Names> kMayInclude = {
    {"core", {"core"}},
    {"tessellate", {"tessellate", "core"}},
    {"shade", {"shade", "core"}},
    {"accel", {"accel", "core"}},
    {"sample", {"sample", "accel", "core"}},
    {"composite", {"composite", "core"}},
    {"pipeline", {"pipeline", "composite", "sample", "accel", "shade", "tessellate", "core"}},
};

/// Which other folders of its room a folder may include. Those that are not here include none of them. It has
/// no cycles, and docs/architecture.md draws it.
const std::map<std::string, Names> kWings = {
    {"accel/dynamic", {"accel", "accel/builders"}},
    {"accel/moving", {"accel", "accel/builders", "accel/paper"}},
    {"accel/paper", {"accel", "accel/builders"}},
    {"accel/wide", {"accel", "accel/builders"}},
    {"accel/wide/rays", {"accel", "accel/wide"}},
    {"composite/colors/opencolorio", {"composite/colors"}},
    {"composite/displays", {"composite", "composite/mattes"}},
    {"composite/displays/openimageio", {"composite/displays"}},
    {"composite/film", {"composite", "composite/filters", "composite/layers", "composite/mattes"}},
    {"composite/filters", {"composite"}},
    {"composite/merge", {"composite", "composite/displays"}},
    {"core", {"core/memory"}},
    {"core/colors", {"core/scene"}},
    {"core/files", {"core"}},
    {"core/scene", {"core"}},
    {"pipeline/checkpoint", {"pipeline/frame"}},
    {"pipeline/cli",
     {"pipeline/cli/commands", "pipeline/cli/laboratory", "pipeline/cli/support", "pipeline/ri"}},
    {"pipeline/cli/commands",
     {"pipeline/checkpoint", "pipeline/cli/support", "pipeline/farm", "pipeline/frame", "pipeline/frame/cost",
      "pipeline/preview", "pipeline/rib", "pipeline/rib/reader", "pipeline/rib/state", "pipeline/rib/syntax",
      "pipeline/rib/write"}},
    {"pipeline/cli/laboratory",
     {"pipeline/cli/support", "pipeline/compare", "pipeline/compare/record", "pipeline/compare/report",
      "pipeline/frame", "pipeline/rib", "pipeline/study", "pipeline/study/report", "pipeline/study/scenes"}},
    {"pipeline/cli/support",
     {"pipeline/checkpoint", "pipeline/cli/pages", "pipeline/frame", "pipeline/frame/cost",
      "pipeline/preview", "pipeline/rib", "pipeline/rib/programs", "pipeline/rib/state", "pipeline/study",
      "pipeline/study/scenes"}},
    {"pipeline/compare",
     {"pipeline/checkpoint", "pipeline/compare/record", "pipeline/frame", "pipeline/frame/cost",
      "pipeline/frame/tiles", "pipeline/rays"}},
    {"pipeline/compare/record", {"pipeline/checkpoint", "pipeline/frame"}},
    {"pipeline/compare/report", {"pipeline/compare", "pipeline/frame"}},
    {"pipeline/farm", {"pipeline/frame"}},
    {"pipeline/frame", {"pipeline/frame/cost", "pipeline/frame/tiles", "pipeline/rays", "pipeline/rib"}},
    {"pipeline/frame/tiles", {"pipeline/frame/cost"}},
    {"pipeline/preview", {"pipeline/frame"}},
    {"pipeline/preview/httplib", {"pipeline/preview"}},
    {"pipeline/ri",
     {"pipeline/frame", "pipeline/rib", "pipeline/rib/state", "pipeline/rib/syntax", "pipeline/rib/write"}},
    {"pipeline/rib/programs", {"pipeline/rib/syntax"}},
    {"pipeline/rib/reader",
     {"pipeline/rib", "pipeline/rib/programs", "pipeline/rib/ris", "pipeline/rib/state",
      "pipeline/rib/syntax"}},
    {"pipeline/rib/requests",
     {"pipeline/rib", "pipeline/rib/reader", "pipeline/rib/ris", "pipeline/rib/state",
      "pipeline/rib/syntax"}},
    {"pipeline/rib/ris", {"pipeline/rib/syntax"}},
    {"pipeline/rib/state", {"pipeline/rib/ris", "pipeline/rib/syntax"}},
    {"pipeline/rib/write", {"pipeline/rib", "pipeline/rib/syntax"}},
    {"pipeline/study",
     {"pipeline/checkpoint", "pipeline/compare", "pipeline/compare/report", "pipeline/frame",
      "pipeline/frame/cost", "pipeline/frame/tiles", "pipeline/rib", "pipeline/study/aff",
      "pipeline/study/scenes"}},
    {"pipeline/study/report",
     {"pipeline/compare", "pipeline/compare/record", "pipeline/compare/report", "pipeline/frame",
      "pipeline/study"}},
    {"pipeline/study/scenes", {"pipeline/rib/write"}},
    {"sample", {"sample/names", "sample/patterns"}},
    {"sample/dualspace", {"sample", "sample/rasterize"}},
    {"sample/embree", {"sample", "sample/raytrace"}},
    {"sample/interleave", {"sample", "sample/patterns", "sample/rasterize"}},
    {"sample/interval", {"sample", "sample/patterns", "sample/rasterize"}},
    {"sample/methods", {"sample"}},
    {"sample/patterns", {"sample/names"}},
    {"sample/rasterize", {"sample", "sample/patterns"}},
    {"sample/raytrace", {"sample"}},
    {"shade",
     {"shade/clouds", "shade/lights", "shade/maps", "shade/materials", "shade/planes", "shade/rays",
      "shade/vm"}},
    {"shade/clouds", {"shade/maps", "shade/rays", "shade/vm"}},
    {"shade/code", {"shade/operations", "shade/rsl/analysis", "shade/rsl/syntax", "shade/vm/kernels"}},
    {"shade/maps",
     {"shade/lights", "shade/maps/headers", "shade/operations", "shade/planes", "shade/vm",
      "shade/vm/kernels"}},
    {"shade/maps/openimageio", {"shade/maps"}},
    {"shade/materials",
     {"shade/code", "shade/lights", "shade/operations", "shade/rsl", "shade/rsl/analysis", "shade/rsl/syntax",
      "shade/shaders", "shade/vm", "shade/vm/kernels"}},
    {"shade/rays", {"shade/materials", "shade/operations", "shade/vm"}},
    {"shade/rsl", {"shade/rsl/analysis", "shade/rsl/syntax"}},
    {"shade/rsl/analysis", {"shade/operations", "shade/rsl/syntax"}},
    {"shade/vm",
     {"shade/code", "shade/operations", "shade/planes", "shade/rsl", "shade/rsl/syntax", "shade/vm/kernels"}},
    {"shade/vm/kernels", {"shade/operations", "shade/planes"}},
    {"tessellate", {"tessellate/measure", "tessellate/topology"}},
    {"tessellate/measure", {"tessellate/topology"}},
    {"tessellate/surfaces", {"tessellate/topology"}},
    {"tessellate/surfaces/blobby", {"tessellate/surfaces", "tessellate/topology"}},
    {"tessellate/surfaces/nurbs", {"tessellate/surfaces", "tessellate/topology"}},
    {"tessellate/surfaces/subdivision", {"tessellate/surfaces", "tessellate/topology"}},
};

/// Beginnings of library includes, and the rooms, or folders of rooms, that may have them.
const std::map<std::string, Names> kConfinedLibraries = {
    {"opensubdiv/", {"tessellate"}},
    {"OpenImageIO/", {"shade/maps/openimageio", "composite/displays/openimageio"}},
    {"OpenEXR/", {"composite", "shade/maps/headers"}},
    {"OpenColorIO/", {"composite/colors/opencolorio"}},
    {"httplib.h", {"pipeline/preview/httplib"}},
    {"embree3/", {"sample/embree"}},
    {"nlohmann/", {"composite/displays", "pipeline"}},
    {"CLI/", {"pipeline"}},
    {"tbb/", {"tessellate", "shade", "accel", "sample", "composite", "pipeline"}},
};

bool is_source(const fs::path& path) {
    const std::string extension = path.extension();
    return extension == ".h" || extension == ".cpp";
}

bool is_test(const fs::path& path) {
    return path.stem().string().ends_with("_test") || path.stem().string().ends_with("harness");
}

/// Calls visit(file, included name) for every #include line of a room.
template <class Visit>
int for_each_include(const std::string& room, Visit&& visit) {
    static const std::regex include_line(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(TRAPEZE_SOURCE_DIR) / room)) {
        if (!entry.is_regular_file() || !is_source(entry.path())) continue;
        std::ifstream file(entry.path());
        std::smatch match;
        for (std::string line; std::getline(file, line);)
            if (std::regex_search(line, match, include_line)) ++count, visit(entry.path(), match[1].str());
    }
    return count;
}

TEST(Layering, RoomsIncludeOnlyWhatTheyMay) {
    int includes = 0;
    for (const auto& [room, allowed] : kMayInclude)
        includes +=
            for_each_include(room, [&, &may = allowed](const fs::path& file, const std::string& included) {
                const std::string target = included.substr(0, included.find('/'));
                if (!kMayInclude.count(target) || included.find('/') == std::string::npos) return;
                EXPECT_TRUE(may.count(target)) << file << " includes " << included;
            });
    EXPECT_GT(includes, 100) << "the test reads no sources";
}

std::string folder_of(const std::string& path) {
    return path.substr(0, path.rfind('/'));
}

/// A source's path from the repository's root.
std::string from_root(const fs::path& file) {
    return fs::relative(file, TRAPEZE_SOURCE_DIR).generic_string();
}

TEST(Layering, WingsIncludeOnlyWhatTheyMay) {
    std::map<std::string, Names> used;
    for (const auto& [room, unused] : kMayInclude)
        for_each_include(room, [&, &in = room](const fs::path& file, const std::string& included) {
            if (is_test(file) || !included.starts_with(in + "/")) return;
            const std::string from = folder_of(from_root(file)), to = folder_of(included);
            if (from == to) return;
            used[from].insert(to);
            const auto row = kWings.find(from);
            EXPECT_TRUE(row != kWings.end() && row->second.count(to)) << file << " includes " << included;
        });
    for (const auto& [wing, others] : kWings)
        EXPECT_EQ(others, used[wing]) << wing << " includes no longer all that the table lets it";
}

/// Whether `to` can be reached from `from` along the table.
bool reaches(const std::string& from, const std::string& to) {
    const auto row = kWings.find(from);
    if (row == kWings.end()) return false;
    for (const std::string& next : row->second)
        if (next == to || reaches(next, to)) return true;
    return false;
}

TEST(Layering, WingsIncludeEachOtherOneWay) {
    for (const auto& [wing, others] : kWings)
        for (const std::string& other : others)
            ASSERT_FALSE(reaches(other, wing)) << wing << " and " << other;
}

TEST(Layering, TheDrawingIsTheTable) {
    std::ifstream page(fs::path(TRAPEZE_SOURCE_DIR) / "docs/architecture.md");
    std::map<std::string, Names> drawn;
    for (std::string line; std::getline(page, line);) {
        const size_t arrow = line.find(" -> ");
        if (arrow == std::string::npos || line.find('/') == std::string::npos) continue;
        std::istringstream others(line.substr(arrow + 4));
        for (std::string other; others >> other;) drawn[line.substr(0, arrow)].insert(other);
    }
    EXPECT_EQ(drawn, kWings);
}

TEST(Layering, LibrariesStayInTheirRooms) {
    for (const auto& [room, unused] : kMayInclude)
        for_each_include(room, [&](const fs::path& file, const std::string& included) {
            if (is_test(file)) return;  // tests may read what another room's library writes
            const std::string place = file.lexically_relative(TRAPEZE_SOURCE_DIR).string();
            for (const auto& [library, folders] : kConfinedLibraries)
                EXPECT_TRUE(
                    !included.starts_with(library) ||
                    std::any_of(folders.begin(), folders.end(),
                                [&](const std::string& folder) { return place.starts_with(folder + "/"); }))
                    << file << " includes " << included;
        });
}

}  // namespace
