/// The include rule of the rooms, read from the sources themselves: stages never include each other, what
/// they exchange is a type in core; each heavy library is confined to one room.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
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

/// Beginnings of library includes, and the rooms that may have them.
const std::map<std::string, Names> kConfinedLibraries = {
    {"opensubdiv/", {"tessellate"}},
    {"OpenImageIO/", {"shade", "composite"}},
    {"OpenEXR/", {"composite"}},
    {"OpenColorIO/", {"composite"}},
    {"embree3/", {"sample"}},
    {"nlohmann/", {"pipeline"}},
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

TEST(Layering, LibrariesStayInTheirRooms) {
    for (const auto& [room, unused] : kMayInclude)
        for_each_include(room, [&, &in = room](const fs::path& file, const std::string& included) {
            if (is_test(file)) return;  // tests may read what another room's library writes
            for (const auto& [library, rooms] : kConfinedLibraries)
                EXPECT_TRUE(!included.starts_with(library) || rooms.count(in))
                    << file << " includes " << included;
        });
}

}  // namespace
