/// What viewers find on the board: pictures as long as they are kept, and the time that is left.
#include "pipeline/preview/preview_board.h"

#include <gtest/gtest.h>

#include <thread>

#include "pipeline/preview/preview_harness.h"

namespace trapeze {
namespace {

using testing::make_preview_picture;

void begin_pictures(PreviewBoard& board, int count) {
    for (int i = 0; i < count; ++i)
        board.begin_picture({0, make_preview_picture({0, 0, 16, 16}, "a.exr", 16, 16), {}, i});
}

/// The numbers of the pictures that are kept.
std::vector<int> kept(const PreviewBoard& board, int count) {
    std::vector<int> numbers;
    for (int number = 1; number <= count; ++number)
        if (board.picture(number).number == number) numbers.push_back(number);
    return numbers;
}

TEST(PreviewBoard, KeepsTheLastPictures) {
    PreviewBoard board;
    begin_pictures(board, 6);
    EXPECT_EQ(kept(board, 7), (std::vector{3, 4, 5, 6}));
    EXPECT_EQ(board.wait_for_picture_after(1).number, 3);
    EXPECT_EQ(board.wait_for_picture_after(5).number, 6);
}

TEST(PreviewBoard, KeepsNoMoreThanFitAndTheLastInAnyCase) {
    const size_t bytes = make_preview_picture({0, 0, 16, 16}, "a.exr", 16, 16)->bytes();
    EXPECT_EQ(bytes, size_t{16} * 16 * 5 * sizeof(float));
    PreviewBoard board(bytes);
    begin_pictures(board, 3);
    EXPECT_EQ(kept(board, 3), (std::vector{2, 3}));
    board.begin_picture({0, make_preview_picture({0, 0, 32, 32}, "b.exr", 32, 32), {}, 0});
    EXPECT_EQ(kept(board, 4), (std::vector{3, 4}));
    begin_pictures(board, 1);
    EXPECT_EQ(kept(board, 5), (std::vector{5}));
}

TEST(PreviewBoard, ViewersHaveTimeUntilSomeTimeAfterTheEnd) {
    PreviewBoard board;
    EXPECT_EQ(board.time_for_viewers(), PreviewBoard::kLongestEnd);
    board.end();
    board.end();
    const auto left = board.time_for_viewers();
    EXPECT_LE(left, PreviewBoard::kLongestEnd);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_LE(board.time_for_viewers(), left - std::chrono::milliseconds(19));
}

}  // namespace
}  // namespace trapeze
