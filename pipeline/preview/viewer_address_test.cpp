#include "pipeline/preview/viewer_address.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

using Kind = ViewerAddress::Kind;

void expect_address(std::string_view text, Kind kind, const std::string& host, int port) {
    const auto address = parse_viewer(text);
    ASSERT_TRUE(address) << text;
    EXPECT_EQ(address->kind, kind) << text;
    EXPECT_EQ(address->host, host) << text;
    EXPECT_EQ(address->port, port) << text;
}

TEST(ParseViewer, KnowsTevAndTheWeb) {
    expect_address("tev", Kind::Tev, "127.0.0.1", 14158);
    expect_address("tev:9000", Kind::Tev, "127.0.0.1", 9000);
    expect_address("tev:studio-7:9000", Kind::Tev, "studio-7", 9000);
    expect_address("tev:[::1]:9000", Kind::Tev, "::1", 9000);
    expect_address("web", Kind::Web, "", 0);
    expect_address("web:65535", Kind::Web, "", 65535);
}

TEST(ParseViewer, RefusesWhatIsNeither) {
    for (const char* text : {"", "tevs", "tev:", "tev::9000", "tev:[]:9000", "tev:host", "tev:host:", "tev:0",
                             "tev:65536", "tev:9 ", "tev:-1", "web:", "web:0", "web:host:80", "web:8a", "Web",
                             "it", "tev:a:99999999999999999999"})
        EXPECT_FALSE(parse_viewer(text)) << text;
}

}  // namespace
}  // namespace trapeze
