#include "pipeline/compare/report/png_bytes.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

namespace trapeze {
namespace {

TEST(PngBytes, AreAPngOfThosePixels) {
    const std::vector<uint8_t> rgb{255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3, 128, 128, 128, 9, 8, 7};
    std::vector<unsigned char> bytes = png_bytes(3, 2, rgb);
    ASSERT_GT(bytes.size(), 8u);
    EXPECT_EQ(bytes[1], 'P');
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    const auto in = OIIO::ImageInput::open("x.png", nullptr, &memory);
    ASSERT_TRUE(in) << OIIO::geterror();
    EXPECT_EQ(in->spec().width, 3);
    EXPECT_EQ(in->spec().height, 2);
    std::vector<uint8_t> read(rgb.size());
    ASSERT_TRUE(in->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, read.data()));
    EXPECT_EQ(read, rgb);
}

}  // namespace
}  // namespace trapeze
