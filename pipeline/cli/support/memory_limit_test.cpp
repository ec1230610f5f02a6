#include "pipeline/cli/support/memory_limit.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <vector>

#include "core/sanitizer_harness.h"
#include "pipeline/cli/support/exit_codes.h"

namespace trapeze {
namespace {

using testing::kSanitized;

/// As an allocation fails in what must not throw. The process is a copy without the threads of libraries, for
/// which std::exit() would wait.
void take(size_t bytes) noexcept {
    const std::vector<char> taken(bytes, 'x');
    _exit(taken.back() == 'x' ? kExitOk : kExitErrors);
}

TEST(LimitMemory, EndsTheProcessThatTakesMore) {
    if (kSanitized) GTEST_SKIP() << "the sanitizer's own memory counts";
    constexpr size_t kMebibyte = size_t{1} << 20;
    EXPECT_EXIT((limit_memory(16 * kMebibyte), take(64 * kMebibyte)), ::testing::ExitedWithCode(kExitOk), "");
    EXPECT_EXIT((limit_memory(16 * kMebibyte), take(1200 * kMebibyte)),
                ::testing::ExitedWithCode(kExitNoMemory), "out of memory");
}

}  // namespace
}  // namespace trapeze
