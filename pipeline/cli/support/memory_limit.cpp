#include "pipeline/cli/support/memory_limit.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <new>
#include <string_view>

#include "composite/displays/write_displays.h"
#include "pipeline/cli/support/exit_codes.h"

namespace trapeze {
namespace {

/// Bytes for everything that the budget does not cover: the program, its libraries, threads' memory.
constexpr size_t kRest = size_t{1} << 30;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

/// Libraries let failures pass through what must not throw.
[[noreturn]] void on_terminate() {
    int code = kExitInternal;
    std::string_view text = "error: internal error\n";
    try {
        if (const auto problem = std::current_exception()) std::rethrow_exception(problem);
    } catch (const std::bad_alloc&) {
        code = kExitNoMemory, text = "error: out of memory\n";
    } catch (...) {}
    remove_partial_outputs();
    static_cast<void>(!write(STDERR_FILENO, text.data(), text.size()));
    _exit(code);
}

}  // namespace

void limit_memory(size_t budget) {
    if (kSanitized) return;
    rlimit limit{};
    if (getrlimit(RLIMIT_DATA, &limit) != 0) return;
    const size_t most = std::min(budget, ~size_t{0} / 8) * 4 + kRest;
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, most);
    setrlimit(RLIMIT_DATA, &limit);
    std::set_terminate(on_terminate);
}

}  // namespace trapeze
