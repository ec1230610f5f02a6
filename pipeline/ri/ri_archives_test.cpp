/// RiReadArchive's callback.
#include <cstdarg>
#include <cstdio>
#include <filesystem>

#include "pipeline/ri/ri_harness.h"

namespace trapeze::ri {
namespace {

std::vector<std::string> heard;

RtVoid hear(RtToken type, char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    char text[200];
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    heard.push_back(std::string(type) + ": " + text);
    if (std::string(type) == RI_STRUCTURE) RiArchiveRecord(type, "%s", text);
}

TEST_F(Ri, ArchivesCommentsGoToTheCallback) {
    std::filesystem::create_directory(path("parts"));
    const auto write = [&](const std::string& name, const std::string& text) {
        std::ofstream(path(name), std::ios::binary) << text;
        return path(name);
    };
    // Not comments: what stands in strings, and in binary strings (two bytes after \222).
    std::string archive =
        write("tree.rib", std::string("##RenderMan RIB\n#by hand, 100% so\nAttribute \"user\" \"string s\" "
                                      "[\"#no\"] # and this\n\222#!\r\n  ##CameraOrientation 0 0 1\n#") +
                              "\n");
    write("parts/leaf.rib", "Sphere 1 -1 1 360 # a leaf");
    std::string parts = path("parts");
    heard.clear();
    const std::string rib = rib_of([&] {
        RiReadArchive(archive.data(), hear, RI_NULL);
        RtString folders = parts.data();
        RiOption("searchpath", "archive", &folders, RI_NULL);
        RiReadArchive("leaf.rib", hear, RI_NULL);
        RiReadArchive(archive.data(), nullptr, RI_NULL);
    });
    EXPECT_THAT(heard, ::testing::ElementsAre("structure: RenderMan RIB", "comment: by hand, 100% so",
                                              "comment:  and this", "structure: CameraOrientation 0 0 1",
                                              "comment: ", "comment:  a leaf"));
    EXPECT_THAT(rib, ::testing::HasSubstr("##RenderMan RIB\n##CameraOrientation 0 0 1\n"));
    EXPECT_TRUE(reported().empty());
    heard.clear();
    rib_of([&] { RiReadArchive("no such file.rib", hear, RI_NULL); });
    EXPECT_TRUE(heard.empty());
    ASSERT_EQ(reported().size(), 1u);
    EXPECT_EQ(reported()[0].code, RIE_NOFILE);
    EXPECT_EQ(reported()[0].severity, RIE_WARNING);
}

}  // namespace
}  // namespace trapeze::ri
