#include "pipeline/cli/support/json_lines.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace trapeze {
namespace {

using json = nlohmann::json;

TEST(JsonLines, AMessageHasItsPlaceInParts) {
    const json line = json::parse(
        json_line({Severity::Warning, "two\nlines \"here\"", "my scene:2.rib:12:5", {"a.rib:1:1"}, {}, {}}));
    EXPECT_EQ(line["severity"], "warning");
    EXPECT_EQ(line["file"], "my scene:2.rib");
    EXPECT_EQ(line["line"], 12);
    EXPECT_EQ(line["column"], 5);
    EXPECT_EQ(line["message"], "two\nlines \"here\"");
    EXPECT_EQ(line["included_from"], json::array({"a.rib:1:1"}));
}

TEST(JsonLines, WhatIsNotKnownIsNull) {
    const json line = json::parse(json_line({Severity::Error, "text", {}, {}, {}, {}}));
    for (const char* key : {"file", "line", "column"}) EXPECT_TRUE(line.at(key).is_null()) << key;
    EXPECT_EQ(json::parse(json_line({Severity::Error, "text", "a.rib", {}, {}, {}}))["file"], "a.rib");
    EXPECT_TRUE(json::parse(json_line(Work{"a.exr", "trace", 3}, 0, 1)).at("estimate").is_null());
    // No frame, or not yet.
    EXPECT_TRUE(json::parse(json_line(Work{"a.rib", "read"}, 0, 1)).at("frame").is_null());
}

TEST(JsonLines, ProgressSaysWhatIsLeft) {
    const json line = json::parse(json_line(Work{"a.exr", "trace", 3}, 0.25, 2));
    EXPECT_EQ(line, json::parse(R"({"frame": 3, "file": "a.exr", "stage": "trace", "fraction": 0.25,
                                    "seconds": 2.0, "estimate": 6.0})"));
}

TEST(JsonLines, AreOneLineOfUtf8WhateverFilesAreCalled) {
    const std::string line = json_line({Severity::Error, "text", "\xff\n.rib", {}, {}, {}});
    EXPECT_EQ(line.find('\n'), line.size() - 1);
    EXPECT_EQ(json::parse(line)["file"], "\xef\xbf\xbd\n.rib");
}

}  // namespace
}  // namespace trapeze
