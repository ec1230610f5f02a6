/// docs/examples/lamp.c, compiled as C and linked as docs/manual.md says: the picture that it renders is that
/// of the RIB that it writes.
#include <OpenImageIO/imagebuf.h>

#include <fstream>

#include "tests/program_harness.h"

namespace trapeze::testing {
namespace {

/// As a user would, in the folder.
int run_shell(const WorkFolder& folder, const std::string& command) {
    const std::string here =
        "cd '" + folder.path().string() + "' && export XDG_CONFIG_HOME=\"$PWD/.config\" && ";
    return std::system((here + command + " >.stdout 2>.stderr").c_str());
}

std::vector<float> pixels_of(const std::string& path) {
    OIIO::ImageBuf picture(path);
    std::vector<float> pixels;
    if (!picture.read(0, 0, true, OIIO::TypeDesc::FLOAT)) return pixels;
    pixels.resize(picture.spec().image_pixels() * static_cast<size_t>(picture.nchannels()));
    picture.get_pixels(OIIO::get_roi(picture.spec()), OIIO::TypeDesc::FLOAT, pixels.data());
    return pixels;
}

TEST(CInterface, AProgramInCRendersAndWritesRib) {
    const WorkFolder folder;
    ASSERT_EQ(run_shell(folder, TRAPEZE_CC
                        " -std=c99 -Wall -Wextra -Wstrict-prototypes -pedantic -Werror '" TRAPEZE_SOURCE_DIR
                        "/docs/examples/lamp.c' -o lamp $(PKG_CONFIG_PATH='" TRAPEZE_BUILD_DIR
                        "' pkg-config --cflags --libs trapeze)"),
              0)
        << file_text(folder / ".stderr");

    ASSERT_EQ(run_shell(folder, "./lamp"), 0) << file_text(folder / ".stderr");
    EXPECT_EQ(file_text(folder / ".stderr"), "");
    const std::vector<float> rendered = pixels_of((folder / "lamp.exr").string());
    ASSERT_EQ(rendered.size(), 160u * 120 * 4);
    // The shade's red corner, the table, and nothing above them: a picture of something.
    const float brightest = *std::max_element(rendered.begin(), rendered.end());
    EXPECT_GT(brightest, 0.3f);
    EXPECT_EQ(rendered[3], 0) << "the first pixel's alpha";

    for (const std::string name : {"lamp.rib", "lamp.rib.gz"}) {
        ASSERT_EQ(run_shell(folder, "./lamp " + name), 0) << file_text(folder / ".stderr");
        const Outcome outcome = run_program(folder, "render " + name + " -o again.exr");
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(pixels_of((folder / "again.exr").string()), rendered) << name;
        std::filesystem::remove(folder / "again.exr");
    }
}

}  // namespace
}  // namespace trapeze::testing
