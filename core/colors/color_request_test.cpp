#include "core/colors/color_request.h"

#include <gtest/gtest.h>

namespace trapeze {
namespace {

Parameter ocio_value(const char* name, const char* text) {
    return {name, {StorageClass::Uniform, ValueType::String, 1}, {}, {text}};
}

TEST(ColorRequest, IsWhatTheOptionSays) {
    Options options;
    EXPECT_FALSE(color_request_of(options).asks());
    options.user.set("ocio", ocio_value("config", "studio.ocio"));
    options.user.set("ocio", ocio_value("workingspace", "acescg"));
    const ColorRequest request = color_request_of(options);
    EXPECT_TRUE(request.asks());
    EXPECT_EQ(request.config, "studio.ocio");
    EXPECT_EQ(request.working_space, "acescg");
    EXPECT_EQ(request.display + request.view + request.look, "");
}

TEST(ColorRequest, AsksByEachOfItsNames) {
    EXPECT_TRUE((ColorRequest{.config = "c"}.asks()));
    EXPECT_TRUE((ColorRequest{.display = "d"}.asks()));
    EXPECT_TRUE((ColorRequest{.view = "v"}.asks()));
    EXPECT_TRUE((ColorRequest{.look = "l"}.asks()));
    EXPECT_TRUE((ColorRequest{.working_space = "w"}.asks()));
}

TEST(ColorRequest, IsReplacedWithWhatBelongsToIt) {
    const ColorRequest scenes{"c", "d", "v", "l", "w"};
    const auto text = [&](const ColorRequest& stronger) {
        const ColorRequest r = replaced(scenes, stronger);
        return r.config + "," + r.display + "," + r.view + "," + r.look + "," + r.working_space;
    };
    EXPECT_EQ(text({}), "c,d,v,l,w");
    EXPECT_EQ(text({.config = "C"}), "C,,,,");
    EXPECT_EQ(text({.display = "D"}), "c,D,,,w");
    EXPECT_EQ(text({.view = "V"}), "c,d,V,,w");
    EXPECT_EQ(text({.look = "L"}), "c,d,v,L,w");
    EXPECT_EQ(text({.config = "C", .view = "V", .working_space = "W"}), "C,,V,,W");
}

}  // namespace
}  // namespace trapeze
