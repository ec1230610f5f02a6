#include "sample/patterns/magic_square.h"

#include <cstddef>

namespace trapeze {
namespace {

/// Siamese method: up and right, down when taken. From the middle of the top row; columns and rows wrap. All
/// values from 0 to n^2 - 1, with equal sums in rows, columns and diagonals.
std::vector<uint32_t> odd_square(int n) {
    std::vector<uint32_t> square(static_cast<size_t>(n) * n);
    int row = 0, column = n / 2;
    for (uint32_t value = 0; value < square.size(); ++value) {
        square[static_cast<size_t>(row) * n + column] = value;
        if ((value + 1) % static_cast<uint32_t>(n) == 0) {
            row = (row + 1) % n;
        } else {
            row = (row + n - 1) % n, column = (column + 1) % n;
        }
    }
    return square;
}

/// Counting up, with the cells on the diagonals of each 4 x 4 block counting down. For n a multiple of 4: a
/// value and its complement add up to the same everywhere, and each row and column has as many of one as of
/// the other.
std::vector<uint32_t> doubly_even_square(int n) {
    std::vector<uint32_t> square(static_cast<size_t>(n) * n);
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            const auto value = static_cast<uint32_t>(row * n + column);
            const int r = row % 4, c = column % 4;
            square[value] = r == c || r + c == 3 ? static_cast<uint32_t>(n * n - 1) - value : value;
        }
    return square;
}

/// LUX: each cell of an odd square becomes 2 x 2 cells, walked in the shape of a letter. For n = 4 k + 2,
/// from 6 on (Conway's method): each cell's four values take consecutive numbers.
std::vector<uint32_t> singly_even_square(int n) {
    constexpr uint32_t kLetters[3][4] = {{3, 0, 1, 2}, {0, 3, 1, 2}, {0, 3, 2, 1}};  // L U X, row by row
    const int half = n / 2, middle = half / 2;  // rows 0..middle are L, then one of U, then X
    const std::vector<uint32_t> odd = odd_square(half);
    std::vector<uint32_t> square(static_cast<size_t>(n) * n);
    for (int row = 0; row < half; ++row)
        for (int column = 0; column < half; ++column) {
            int letter = row <= middle ? 0 : (row == middle + 1 ? 1 : 2);
            if (column == middle && row == middle) letter = 1;      // the central L and the U below it
            if (column == middle && row == middle + 1) letter = 0;  // change places
            const uint32_t base = 4 * odd[static_cast<size_t>(row) * half + column];
            for (int cell = 0; cell < 4; ++cell)
                square[static_cast<size_t>(2 * row + cell / 2) * n + 2 * column + cell % 2] =
                    base + kLetters[letter][cell];
        }
    return square;
}

}  // namespace

/// Numbers count from 0, where the classical squares count from 1: sums are smaller by n, and equal all the
/// same.
std::vector<uint32_t> magic_square(int n) {
    if (n % 2 == 1) return odd_square(n);
    return n % 4 == 0 ? doubly_even_square(n) : singly_even_square(n);
}

}  // namespace trapeze
