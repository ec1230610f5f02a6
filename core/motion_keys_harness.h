/// What holds for the numbers of keys that anything has.
#pragma once

#include "core/motion_keys.h"

namespace trapeze::testing {

/// Whether a number of keys is 1 or 2^m + 1, so that coarser keys are a part of finer ones.
constexpr bool is_key_count(int n) {
    return n == 1 || (n >= 2 && n <= kMaxKeyCount && ((n - 1) & (n - 2)) == 0);
}

}  // namespace trapeze::testing
