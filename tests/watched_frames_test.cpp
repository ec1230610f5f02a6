/// Pictures that are watched while they are made: viewers have the same bits in the end, and nothing of the
/// pictures changes.
#include <gtest/gtest.h>

#include <cstring>
#include <new>

#include "pipeline/preview/mock_tev_harness.h"
#include "pipeline/preview/preview.h"
#include "pipeline/preview/preview_channels.h"
#include "pipeline/preview/tev_viewer.h"
#include "tests/scene_harness.h"

namespace trapeze::testing {
namespace {

/// Hands all that the frame says on to a preview, and keeps what was shown.
class KeptBoard final : public FilmWatcher {
  public:
    explicit KeptBoard(Preview& preview) : preview_(preview) {}
    void begin(const Film& film, const RenderContext& context) noexcept override {
        preview_.begin(film, context);
        ++begun;
    }
    void end() noexcept override {
        ++ended;
        preview_.end();
        const PreviewEntry entry = preview_.board().status().entry;
        if (entry.picture) tiles += entry.picture->changes_after(0).pixels.size();
    }
    void show(const Image& image, const RenderContext& context) override {
        preview_.show(image, context);
        ++shown;
    }
    size_t begun = 0, ended = 0, tiles = 0, shown = 0;

  private:
    Preview& preview_;
};

/// Whether a viewer's image has the picture's channels, bit for bit, and 0 outside of its window.
void expect_image(const TevImage& shown, const Image& image, const RenderContext& context) {
    const std::vector<std::string> names = preview_channels(image, context);
    const PixelSource source = preview_source(image, context);
    ASSERT_EQ(shown.width, image.width);
    ASSERT_EQ(shown.height, image.height);
    ASSERT_EQ(shown.channels.size(), names.size());
    for (size_t c = 0; c < names.size(); ++c) {
        const std::vector<float>& values = shown.channels.at(names[c]);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                const auto [first, stride] = source.channels[c];
                const float expected = image.window.contains(x, y) ? first[stride * image.index(x, y)] : 0.0f;
                const float value = values[static_cast<size_t>(y) * static_cast<size_t>(image.width) +
                                           static_cast<size_t>(x)];
                ASSERT_EQ(std::memcmp(&expected, &value, sizeof value), 0)
                    << names[c] << " " << x << " " << y << ": " << value << " for " << expected;
            }
    }
}

/// Renders each world of a scene unwatched, then watched by a tev that reassembles it. Returns the tiles that
/// were finished before the picture was.
size_t expect_same_when_watched(const std::string& path, const std::string& first_rib = {},
                                RenderSettings settings = {}) {
    Diagnostics diagnostics;
    ReadOptions options;
    if (!first_rib.empty()) options.first_texts.push_back({"test", first_rib});
    const std::vector<std::string> files{path};
    size_t tiles = 0;
    read_rib(files, options, diagnostics, [&](Scene&& scene) {
        const RenderContext context = make_context(scene, settings, diagnostics);
        const auto alone = render_frame(context, settings);
        ASSERT_TRUE(alone);
        MockTev tev;
        {
            Preview preview;
            preview.add(std::make_unique<TevViewer>(preview.board(), "127.0.0.1", tev.port(),
                                                    [](const std::string& line) { ADD_FAILURE() << line; }));
            KeptBoard board(preview);
            settings.watcher = &board;
            const auto watched = render_frame(context, settings);
            settings.watcher = nullptr;
            ASSERT_TRUE(watched);
            EXPECT_TRUE(same_bits(alone->image, watched->image)) << path;
            EXPECT_EQ(board.shown, 1u);
            tiles += board.tiles;
        }
        const TevImages& shown = tev.stop();
        if (alone->image.window.empty()) return;
        ASSERT_EQ(shown.created.size(), 1u);
        expect_image(shown.images.at(shown.created.front()), alone->image, context);
    });
    return tiles;
}

TEST(WatchedFrames, EveryTinySceneIsTheSameBitsToItsViewer) {
    size_t tiles = 0;
    for (const std::string& name : tiny_scenes_without_maps())
        tiles += expect_same_when_watched(tiny_scene_path(name));
    EXPECT_GT(tiles, 500u);
}

TEST(WatchedFrames, CropsMarginsAndVariablesAreTheSameBits) {
    for (const std::string rib :
         {"CropWindow .2 .71 .3 .9", "PixelSamples 6 6 PixelVariance .001", "PixelFilter \"sinc\" 21 17",
          "Option \"glow\" \"float radius\" [9] \"float strength\" [.5]", "Exposure 2 2.2",
          "Imager \"background\" \"color background\" [.2 .3 .4]",
          "Display \"a.exr\" \"openexr\" \"rgba\" Display \"+z.exr\" \"openexr\" \"varying float __depth\" "
          "Display \"+n.exr\" \"openexr\" \"varying normal N\""}) {
        EXPECT_GT(expect_same_when_watched(tiny_scene_path("defocus_motion.rib"), "Format 160 112 1 " + rib),
                  0u)
            << rib;
    }
}

TEST(WatchedFrames, EveryMethodIsTheSameBits) {
    for (const std::string& method : methods_beside_ray_tracing()) {
        RenderSettings settings;
        settings.sampler = method;
        settings.regions_at_least = 3;
        EXPECT_GT(
            expect_same_when_watched(tiny_scene_path("defocus_motion.rib"), "Format 160 112 1 ", settings),
            0u);
    }
}

/// Where memory runs out, nobody reads on in a film that is gone.
TEST(WatchedFrames, AFrameWithoutMemoryIsReadNoLonger) {
    Preview preview;
    KeptBoard board(preview);
    RenderSettings settings;
    settings.watcher = &board;
    settings.on_progress = [](double part) {
        if (part > 0.5) throw std::bad_alloc();
    };
    Diagnostics diagnostics;
    ReadOptions options;
    options.first_texts.push_back({"test", "Format 320 224 1"});
    const std::vector<std::string> files{tiny_scene_path("defocus_motion.rib")};
    read_rib(files, options, diagnostics, [&](Scene&& scene) {
        EXPECT_THROW(render_frame(make_context(scene, settings, diagnostics), settings), std::bad_alloc);
        EXPECT_EQ(board.begun, 1u);
        EXPECT_EQ(board.ended, 1u);
        EXPECT_EQ(board.shown, 0u);
        EXPECT_GT(board.tiles, 0u);
    });
}

/// A picture that is broken off stays as far as it came.
TEST(WatchedFrames, ACancelledFrameIsClosed) {
    Preview preview;
    RenderSettings settings;
    settings.watcher = &preview;
    std::atomic<bool> cancelled{false};
    settings.cancelled = &cancelled;
    settings.on_progress = [&](double part) {
        if (part > 0.5) cancelled = true;
    };
    Diagnostics diagnostics;
    ReadOptions options;
    options.first_texts.push_back({"test", "Format 320 224 1"});
    const std::vector<std::string> files{tiny_scene_path("defocus_motion.rib")};
    read_rib(files, options, diagnostics, [&](Scene&& scene) {
        EXPECT_FALSE(render_frame(make_context(scene, settings, diagnostics), settings));
        const std::shared_ptr<PreviewPicture> broken = preview.board().status().entry.picture;
        ASSERT_TRUE(broken);
        EXPECT_FALSE(broken->is_closed());
        cancelled = false, settings.on_progress = nullptr;
        EXPECT_TRUE(render_frame(make_context(scene, settings, diagnostics), settings));
        EXPECT_TRUE(broken->is_closed());
        EXPECT_FALSE(broken->is_finished());
        EXPECT_TRUE(preview.board().status().entry.picture->is_finished());
        EXPECT_EQ(preview.board().status().entry.number, 2);
    });
}

}  // namespace
}  // namespace trapeze::testing
