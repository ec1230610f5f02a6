/// Whether a test runs under the address sanitizer, which takes memory of its own.
#pragma once

namespace trapeze::testing {

#if defined(__has_feature)
#define TRAPEZE_HAS_FEATURE(name) __has_feature(name)
#else
#define TRAPEZE_HAS_FEATURE(name) 0
#endif
inline constexpr bool kSanitized =
#if defined(__SANITIZE_ADDRESS__) || TRAPEZE_HAS_FEATURE(address_sanitizer)
    true;
#else
    false;
#endif

}  // namespace trapeze::testing
