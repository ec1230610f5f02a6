/// TRAPEZE_SAFE in the environment confines what a program renders.
#include "pipeline/ri/ri_harness.h"

namespace trapeze::ri {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::Not;

class RiSafe : public Ri {
  protected:
    RiSafe() {
        std::ofstream(path("leak.rib")) << "LeakedSecret 1\n";
        setenv("TRAPEZE_SAFE", "1", 1);
    }
    ~RiSafe() override { unsetenv("TRAPEZE_SAFE"); }

    /// A picture, and an archive, in a folder that is not the working folder.
    void render() {
        const std::string picture = path("a.exr"), archive = path("leak.rib");
        RiBegin(RI_NULL);
        RiFormat(8, 6, 1);
        RiDisplay(picture.data(), "exr", RI_RGBA, RI_NULL);
        RiWorldBegin();
        RiReadArchive(archive.data(), nullptr, RI_NULL);
        RiWorldEnd();
        RiEnd();
    }
    static auto says(const char* text) { return Contains(Field(&Reported::text, HasSubstr(text))); }
};

TEST_F(RiSafe, FilesElsewhereAreClosed) {
    render();
    EXPECT_EQ(files(), std::vector<std::string>{"leak.rib"});
    EXPECT_THAT(reported(), says("it lies outside of the working folder"));
    EXPECT_THAT(reported(), says("lies outside of the folders that are open to scenes"));
    EXPECT_THAT(reported(), Not(says("LeakedSecret")));
}

TEST_F(RiSafe, IsOffForNothingAnd0) {
    for (const char* off : {"", "0"}) {
        reported().clear();
        setenv("TRAPEZE_SAFE", off, 1);
        render();
        EXPECT_EQ(files(), (std::vector<std::string>{"a.exr", "leak.rib"}));
        EXPECT_THAT(reported(), says("LeakedSecret"));
    }
}

}  // namespace
}  // namespace trapeze::ri
