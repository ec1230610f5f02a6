#include "core/diagnostics.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

/// What is shown of an error in a text.
std::string shown(const std::string& text, uint32_t line, uint32_t column, int64_t shift = 0) {
    std::string out;
    Diagnostics diagnostics([&](const Diagnostic& d) { out = to_string(d); });
    const uint32_t source =
        diagnostics.add_source("a.sl", {}, std::make_shared<const std::string>(text), shift);
    diagnostics.error({source, line, column}, "wrong");
    return out;
}

TEST(Diagnostics, ShowTheLineAndAColumn) {
    EXPECT_EQ(shown("one\ntwo three\n", 2, 5), "a.sl:2:5: error: wrong\n    two three\n        ^");
    EXPECT_EQ(shown("one\r\ntwo\rthree", 3, 1), "a.sl:3:1: error: wrong\n    three\n    ^");
    EXPECT_EQ(shown("\tx\n", 1, 2), "a.sl:1:2: error: wrong\n     x\n     ^");
    EXPECT_EQ(shown("one", 1, 99), "a.sl:1:99: error: wrong\n    one\n       ^");  // no further than the line
    EXPECT_EQ(shown("one\ntwo\n", 12, 1, 10), "a.sl:12:1: error: wrong\n    two\n    ^");
    EXPECT_EQ(shown("one\n", 7, 1), "a.sl:7:1: error: wrong");  // there is no such line
}

TEST(Diagnostics, CutLongLines) {
    const std::string line = std::string(200, 'a') + "X" + std::string(200, 'b');
    const std::string out = shown(line, 1, 201);
    EXPECT_EQ(out, "a.sl:1:201: error: wrong\n    ..." + std::string(50, 'a') + "X" + std::string(49, 'b') +
                       "...\n       " + std::string(50, ' ') + "^");
}

TEST(Diagnostics, WithoutTextThereIsNoExcerpt) {
    std::string out;
    Diagnostics diagnostics([&](const Diagnostic& d) { out = to_string(d); });
    const uint32_t outer = diagnostics.add_source("b.rib");
    const uint32_t inner = diagnostics.add_source("a.rib", {outer, 4, 1});
    diagnostics.warning({inner, 3, 5}, "odd");
    EXPECT_EQ(out, "a.rib:3:5: warning: odd\n    included from b.rib:4:1");
}

}  // namespace
}  // namespace trapeze
