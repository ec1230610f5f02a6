#include "core/colors/transfer.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

TEST(Transfer, HasThreeNames) {
    EXPECT_EQ(transfer_named("linear"), Transfer::Linear);
    EXPECT_EQ(transfer_named("srgb"), Transfer::Srgb);
    EXPECT_EQ(transfer_named("sRGB"), Transfer::Srgb);
    EXPECT_EQ(transfer_named("auto"), Transfer::Auto);
    for (const char* other : {"", "gamma", "srgb ", "rec709"}) EXPECT_FALSE(transfer_named(other)) << other;
}

TEST(Transfer, IsLinearUntilTheOptionIsSet) {
    Options options;
    EXPECT_EQ(transfer_of(options), Transfer::Linear);
    set_transfer(options, "srgb");
    EXPECT_EQ(transfer_of(options), Transfer::Srgb);
    set_transfer(options, "auto");
    EXPECT_EQ(transfer_of(options), Transfer::Auto);
}

}  // namespace
}  // namespace trapeze
