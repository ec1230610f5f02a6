/// The tiny scenes, and small pictures of the gallery's, against their reference pictures (tests/references,
/// made by tests/update_references after looking at them), with idiff's thresholds. What may differ between
/// machines is the last place of libraries' floats.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "tests/program_harness.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kReferences = TRAPEZE_SOURCE_DIR "/tests/references";

/// What a run has left in its folder, beside those of the same names in a folder of references.
void expect_like_references(const WorkFolder& folder, const fs::path& references) {
    int pictures = 0;
    for (const auto& entry : fs::directory_iterator(folder.path())) {
        const std::string file = entry.path().filename();
        // What is in a point cloud, the picture that is made from it shows.
        if (file.starts_with(".std") || file.ends_with(".ptc")) continue;
        ++pictures;
        const OIIO::ImageBuf made(entry.path().string()), wanted((references / file).string());
        ASSERT_TRUE(wanted.has_error() == false && wanted.spec().width > 0) << "no reference for " << file;
        ASSERT_EQ(made.spec().nchannels, wanted.spec().nchannels) << file;
        ASSERT_EQ(OIIO::get_roi(made.spec()), OIIO::get_roi(wanted.spec())) << file;
        // A pixel fails beyond 0.01; a handful may, where a sample falls on the other side of an edge.
        const auto result = OIIO::ImageBufAlgo::compare(made, wanted, 0.01f, 0.002f);
        const double pixels = static_cast<double>(made.spec().width) * made.spec().height;
        EXPECT_LE(static_cast<double>(result.nfail), pixels * 0.002)
            << file << ": largest error " << result.maxerror;
        EXPECT_LE(static_cast<double>(result.nwarn), pixels * 0.01) << file;
    }
    EXPECT_GT(pictures, 0);
}

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    return files;
}

class TinyPicture : public ::testing::TestWithParam<std::string> {};

TEST_P(TinyPicture, LooksLikeItsReference) {
    WorkFolder folder;
    const Outcome outcome = run_program(folder, "render '" + tiny_scene_path(GetParam()) + "'");
    EXPECT_EQ(outcome.exit_code, is_wrong_on_purpose(GetParam()) ? 1 : 0) << outcome.err;
    expect_like_references(folder, kReferences);
}

INSTANTIATE_TEST_SUITE_P(All, TinyPicture, ::testing::ValuesIn(tiny_scenes()), test_name);

/// As tests/update_references makes them: the picture alone, not the maps that a scene makes for it.
class GalleryPicture : public ::testing::TestWithParam<std::string> {};

TEST_P(GalleryPicture, LooksLikeItsReference) {
    WorkFolder folder;
    const Outcome outcome = run_program(folder, "render '" TRAPEZE_SOURCE_DIR "/scenes/gallery/" +
                                                    GetParam() + ".rib' -r 96x54 --samples 2x2");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    for (const fs::path& file : files_in(folder.path()))
        if (file.filename() != GetParam() + ".exr") fs::remove(file);
    expect_like_references(folder, kReferences / "gallery");
}

INSTANTIATE_TEST_SUITE_P(All, GalleryPicture,
                         ::testing::Values("car", "hair", "spot", "still_life", "studio"));

}  // namespace
}  // namespace trapeze::testing
