#include "core/simd/simd_limit.h"

#include <hwy/targets.h>

#include <algorithm>

namespace trapeze {
namespace {

struct NamedTarget {
    std::string_view name;
    int64_t target;  ///< one of Highway's bits: lower ones are better
};

#if HWY_ARCH_X86
constexpr NamedTarget kTargets[] = {{"sse4", HWY_SSE4}, {"avx2", HWY_AVX2}, {"avx512", HWY_AVX3}};
#elif HWY_ARCH_ARM
constexpr NamedTarget kTargets[] = {{"neon", HWY_NEON}};
#else
constexpr NamedTarget kTargets[] = {{"scalar", HWY_SCALAR}};
#endif

constexpr std::string_view kBest = "best";

/// This file has the same options as kernels have.
bool is_compiled(const NamedTarget& known) {
    return (HWY_TARGETS & known.target) != 0;
}

/// Asking Highway for these has it choose among all that the machine has, whatever was disabled; this chooses
/// again, among what is allowed.
int64_t allowed_targets() {
    const int64_t allowed = hwy::SupportedTargets();
    hwy::GetChosenTarget().Update(allowed);
    return allowed;
}

}  // namespace

std::vector<std::string_view> simd_names() {
    std::vector<std::string_view> names = {kBest};
    for (const NamedTarget& known : kTargets) names.push_back(known.name);
    return names;
}

std::vector<std::string_view> compiled_simd_names() {
    std::vector<std::string_view> names;
    for (const NamedTarget& known : kTargets)
        if (is_compiled(known)) names.push_back(known.name);
    return names;
}

std::string_view lacking_simd() {
    for (const NamedTarget& known : kTargets)
        if ((HWY_STATIC_TARGET & known.target) && !(hwy::SupportedTargets() & known.target))
            return known.name;
    return {};
}

bool limit_simd(std::string_view name, std::string* error) {
    if (name == kBest) {
        hwy::DisableTargets(0);
        allowed_targets();
        return true;
    }
    const auto found = std::find_if(std::begin(kTargets), std::end(kTargets),
                                    [name](const NamedTarget& known) { return known.name == name; });
    if (found == std::end(kTargets)) {
        *error = "no instruction set \"" + std::string(name) + "\"; there are:";
        for (const std::string_view known : simd_names()) *error += " " + std::string(known);
        return false;
    }
    if (!is_compiled(*found)) {
        *error = "this build has no " + std::string(name) + " (`trapeze --version` says what is in)";
        return false;
    }
    const int64_t before = allowed_targets(), best_before = before & -before;
    hwy::DisableTargets(0);
    if (!(allowed_targets() & found->target)) {
        hwy::DisableTargets(best_before - 1);
        allowed_targets();
        *error = "this machine has no " + std::string(name);
        return false;
    }
    hwy::DisableTargets(found->target - 1);
    allowed_targets();
    return true;
}

std::string_view simd_limit() {
    const int64_t allowed = allowed_targets();
    for (auto known = std::rbegin(kTargets); known != std::rend(kTargets); ++known)
        if (is_compiled(*known) && (allowed & known->target)) return known->name;
    return kBest;
}

}  // namespace trapeze
