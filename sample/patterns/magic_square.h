/// Magic squares, the paper's permutation of lens strata [Hou10 sec. 3.4].
#pragma once

#include <cstdint>
#include <vector>

namespace trapeze {

/// The numbers 0 .. n * n - 1 row by row, all rows, columns and both diagonals of equal sum. n >= 3: siamese
/// for odd n, complements for n divisible by 4, LUX [Conway] for other even n.
std::vector<uint32_t> magic_square(int n);

}  // namespace trapeze
