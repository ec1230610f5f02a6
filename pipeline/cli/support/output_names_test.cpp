#include "pipeline/cli/support/output_names.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

TEST(OutputNames, HaveTheFramesNumberWhereTheySaySo) {
    EXPECT_EQ(with_frame_number("shot.####.exr", 7), "shot.0007.exr");
    EXPECT_EQ(with_frame_number("shot.#.exr", 12), "shot.12.exr");
    EXPECT_EQ(with_frame_number("shot.%04d.exr", 7), "shot.0007.exr");
    EXPECT_EQ(with_frame_number("shot.%d.exr", 12), "shot.12.exr");
    EXPECT_EQ(with_frame_number("<frame>/shot<frame>.exr", 3), "3/shot3.exr");
    EXPECT_EQ(with_frame_number("shot.%04f.%s.exr", 3), "shot.%04f.%s.exr");
    EXPECT_EQ(with_frame_number("100%", 3), "100%");
    EXPECT_EQ(with_frame_number("a%99999999999999999999d", 3).size(), 2u);
}

TEST(OutputNames, AreOfOnePictureEach) {
    OutputNames names("out.exr");
    EXPECT_FALSE(names.is_taken(1));
    EXPECT_EQ(names.take("a", 1), "out.exr");
    EXPECT_TRUE(names.is_taken(1));
    EXPECT_EQ(names.take("b", 5), "out.5.exr");
    EXPECT_EQ(names.take("c", 0), "out.2.exr");
    EXPECT_EQ(names.take("d", 5), "out.3.exr");
    OutputNames frames("out.##.exr");
    EXPECT_EQ(frames.take("a", 1), "out.01.exr");
    EXPECT_EQ(frames.take("a", 2), "out.02.exr");
    EXPECT_EQ(frames.take("b", 2), "out.02.2.exr");
}

TEST(OutputNames, OfPassesAndOfNothingAreFreeAgain) {
    OutputNames names("out.exr");
    EXPECT_EQ(names.take("nothing.exr", 1), "out.exr");
    EXPECT_EQ(names.take_back("nothing.exr"), "out.exr");
    EXPECT_EQ(names.take("pass.exr", 1), "out.exr");
    EXPECT_EQ(names.take_back("nothing.exr"), std::nullopt) << "another picture has its name";
    EXPECT_EQ(names.take_back("other.exr"), std::nullopt);
    EXPECT_EQ(names.take_back("pass.exr"), "out.exr");
    EXPECT_EQ(names.take("picture.exr", 2), "out.exr");
}

}  // namespace
}  // namespace trapeze
