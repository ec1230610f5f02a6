/// What tev is sent, by viewers of pictures that are made of numbers, and what a tev that misbehaves changes.
#include "pipeline/preview/tev_viewer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>

#include "pipeline/preview/mock_tev_harness.h"
#include "pipeline/preview/preview_harness.h"

namespace trapeze {
namespace {

using testing::make_preview_picture;
using testing::MockTev;
using testing::NumberedPicture;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
}

/// What a viewer has to say.
struct Reports {
    std::mutex mutex;
    std::vector<std::string> lines;

    size_t count() {
        const std::lock_guard lock(mutex);
        return lines.size();
    }
    auto taker() {
        return [this](const std::string& line) {
            const std::lock_guard lock(mutex);
            lines.push_back(line);
        };
    }
};

/// Begins a picture, and puts its tiles.
std::shared_ptr<PreviewPicture> make_tiles(PreviewBoard& board, const std::string& name,
                                           const NumberedPicture& numbers, int width, int height) {
    const auto picture = make_preview_picture(numbers.window, name, width, height);
    board.begin_picture({0, picture, {}, 0});
    for (int y = 0; y < height; y += 16)
        for (int x = 0; x < width; x += 16) {
            picture->put(intersection({x, y, x + 16, y + 16}, numbers.window), numbers.source());
            board.note_change();
        }
    return picture;
}

/// Puts a picture's tiles, then ends it.
void make_picture(PreviewBoard& board, const std::string& name, const NumberedPicture& numbers, int width,
                  int height, bool is_whole = true) {
    const auto picture = make_tiles(board, name, numbers, width, height);
    if (is_whole)
        picture->finish(numbers.source());
    else
        picture->close();
    board.note_change();
}

/// Whether an image has the numbers in their window, and nothing elsewhere.
void expect_numbers(const testing::TevImage& image, const NumberedPicture& numbers) {
    const char* names[] = {"R", "G", "B", "A", "Z"};
    ASSERT_EQ(image.channels.size(), 5u);
    for (size_t c = 0; c < 5; ++c) {
        size_t at = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                ASSERT_EQ(image.channels.at(names[c])[static_cast<size_t>(y * image.width + x)],
                          numbers.window.contains(x, y) ? numbers.values[c][at++] : 0)
                    << names[c] << " " << x << " " << y;
    }
}

TEST(TevViewer, TevHasEveryPictureInTheEnd) {
    MockTev tev;
    Reports reports;
    const NumberedPicture first({5, 3, 60, 45}, 5), second({0, 0, 33, 17}, 5, 0.5f), third({0, 0, 16, 16}, 5);
    {
        PreviewBoard board;
        TevViewer viewer(board, "127.0.0.1", tev.port(), reports.taker());
        make_picture(board, "a.exr", first, 64, 48);
        make_picture(board, "b.exr", second, 33, 17);
        make_picture(board, "c.exr", third, 16, 16, false);
        board.end();
        viewer.finish();
    }
    const testing::TevImages& shown = tev.stop();
    EXPECT_EQ(shown.created, (std::vector<std::string>{"a.exr", "b.exr", "c.exr"}));
    expect_numbers(shown.images.at("a.exr"), first);
    expect_numbers(shown.images.at("b.exr"), second);
    expect_numbers(shown.images.at("c.exr"), third);
    EXPECT_EQ(tev.connections(), 1);
    EXPECT_TRUE(reports.lines.empty());
}

TEST(TevViewer, IsSentTilesWhileOthersAreStillToCome) {
    MockTev tev(2);  // a picture and a tile: then it hangs up
    Reports reports;
    PreviewBoard board;
    TevViewer viewer(board, "127.0.0.1", tev.port(), reports.taker());
    const NumberedPicture numbers({0, 0, 32, 16}, 5);
    const auto picture = make_preview_picture(numbers.window, "a.exr", 32, 16);
    board.begin_picture({0, picture, {}, 0});
    picture->put({0, 0, 16, 16}, numbers.source());
    board.note_change();
    tev.stop();  // returns, though the picture is not finished
    picture->finish(numbers.source());
    board.end();
    viewer.finish();
}

TEST(TevViewer, NobodyThereIsSaidOnce) {
    int port = 0;
    {
        MockTev gone;
        port = gone.port();
    }
    Reports reports;
    PreviewBoard board;
    TevViewer viewer(board, "127.0.0.1", port, reports.taker());
    const NumberedPicture numbers({0, 0, 32, 16}, 5);
    for (int i = 0; i < 3; ++i) make_picture(board, "a.exr", numbers, 32, 16);
    board.end();
    viewer.finish();
    ASSERT_EQ(reports.lines.size(), 1u);
    EXPECT_NE(reports.lines[0].find("tev at 127.0.0.1:" + std::to_string(port) + " shows nothing: "),
              std::string::npos)
        << reports.lines[0];
}

TEST(TevViewer, OneThatWasQuitAndIsThereAgainHasEverything) {
    MockTev tev(3);
    Reports reports;
    // Many tiles: sending fails only some time after the other side has hung up.
    const NumberedPicture first({0, 0, 640, 480}, 5), second({0, 0, 64, 48}, 5, 0.5f);
    {
        PreviewBoard board;
        TevViewer viewer(board, "127.0.0.1", tev.port(), reports.taker());
        const auto picture = make_tiles(board, "a.exr", first, 640, 480);
        while (!tev.has_hung_up()) std::this_thread::yield();
        picture->finish(first.source());
        make_picture(board, "b.exr", second, 64, 48);
        board.end();
        viewer.finish();
    }
    const testing::TevImages& shown = tev.stop();
    EXPECT_EQ(shown.created, (std::vector<std::string>{"a.exr", "a.exr", "b.exr"}));
    expect_numbers(shown.images.at("a.exr"), first);
    expect_numbers(shown.images.at("b.exr"), second);
    EXPECT_EQ(tev.connections(), 2);
    EXPECT_EQ(reports.lines.size(), 1u);
}

TEST(TevViewer, OneThatIsStartedLaterHasThePicture) {
    int port = 0;
    {
        MockTev gone;
        port = gone.port();
    }
    Reports reports;
    const NumberedPicture numbers({0, 0, 32, 16}, 5);
    const auto picture = make_preview_picture(numbers.window, "a.exr", 32, 16);
    PreviewBoard board;
    TevViewer viewer(board, "127.0.0.1", port, reports.taker());
    board.begin_picture({0, picture, {}, 0});
    picture->put({0, 0, 16, 16}, numbers.source());
    while (reports.count() == 0) std::this_thread::yield();
    MockTev tev(MockTev::kAll, MockTev::Reads::Packets, port);
    while (tev.connections() == 0) std::this_thread::yield();
    picture->finish(numbers.source());
    board.end();
    viewer.finish();
    const testing::TevImages& shown = tev.stop();
    expect_numbers(shown.images.at("a.exr"), numbers);
    EXPECT_EQ(reports.count(), 1u);
}

TEST(TevViewer, OneThatHungUpBetweenPicturesMissesNone) {
    MockTev tev(3);
    Reports reports;
    PreviewBoard board;
    TevViewer viewer(board, "127.0.0.1", tev.port(), reports.taker());
    const NumberedPicture numbers({0, 0, 32, 16}, 5);
    make_picture(board, "a.exr", numbers, 32, 16);
    while (!tev.has_hung_up()) std::this_thread::yield();
    make_picture(board, "b.exr", numbers, 32, 16);
    board.end();
    viewer.finish();
    const testing::TevImages& shown = tev.stop();
    expect_numbers(shown.images.at("b.exr"), numbers);
}

/// It would take a quarter of a minute for the picture.
TEST(TevViewer, OneThatTakesLittleAtATimeIsLeftWhenTimeIsOver) {
    MockTev tev(MockTev::kAll, MockTev::Reads::LittleByLittle);
    Reports reports;
    const NumberedPicture numbers({0, 0, 2560, 1920}, 5);
    {
        PreviewBoard board(~size_t{0}, std::chrono::milliseconds(300));
        TevViewer viewer(board, "127.0.0.1", tev.port(), reports.taker());
        make_picture(board, "a.exr", numbers, 2560, 1920);
        board.end();
        viewer.finish();
    }
    EXPECT_EQ(reports.lines.size(), 1u);  // it has not been sent all
    tev.stop();
}

TEST(TevViewer, OneThatTakesNothingHoldsNobodyUp) {
    MockTev tev(0, MockTev::Reads::Nothing);
    Reports reports;
    PreviewBoard board;
    TevViewer viewer(board, "127.0.0.1", tev.port(), reports.taker());
    const NumberedPicture numbers({0, 0, 1280, 960}, 5);  // 24 MB, more than sockets keep
    const auto begun = Clock::now();
    make_picture(board, "a.exr", numbers, 1280, 960);
    // Who makes pictures has not waited: it did nothing but copy.
    EXPECT_TRUE(reports.lines.empty());
    board.end();
    viewer.finish();
    EXPECT_LT(seconds_since(begun), 30);  // a second of patience; the rest is for machines that are busy
    EXPECT_EQ(reports.lines.size(), 1u);
    tev.stop();
}

}  // namespace
}  // namespace trapeze
