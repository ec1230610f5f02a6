#include "pipeline/preview/tev_packets.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

using namespace std::string_literals;

/// Byte for byte as tev reads them.
TEST(TevPackets, CreateAnImage) {
    const std::vector<std::string> channels{"R", "N.X"};
    EXPECT_EQ(tev_create_image("a.exr", 640, 2, channels),
              "\x1e\0\0\0"s  // 30 bytes
              "\x04"s        // CreateImage
              "\0"s          // it does not come to the front
              "a.exr\0"s
              "\x80\x02\0\0"s
              "\x02\0\0\0"s
              "\x02\0\0\0"s
              "R\0"s
              "N.X\0"s);
}

TEST(TevPackets, PutPixelsIntoAnImage) {
    const std::vector<std::string> channels{"R", "G"};
    const std::vector<float> values{1, -2, 0.5f, 0};
    EXPECT_EQ(tev_update_image("a", channels, {3, 4, 5, 5}, values),
              "\x30\0\0\0"s  // 48 bytes
              "\x05"s        // UpdateImageV2
              "\0"s
              "a\0"s
              "\x02\0\0\0"s
              "R\0"s
              "G\0"s
              "\x03\0\0\0"s
              "\x04\0\0\0"s
              "\x02\0\0\0"s
              "\x01\0\0\0"s
              "\0\0\x80\x3f"s
              "\0\0\0\xc0"s
              "\0\0\0\x3f"s
              "\0\0\0\0"s);
}

}  // namespace
}  // namespace trapeze
