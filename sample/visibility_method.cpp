#include "sample/visibility_method.h"

#include <algorithm>

namespace trapeze {
namespace {

constexpr VisibilityMethod kVisibilityMethods[] = {
    {"raytrace", prepare_raytrace},
    {"raytrace:bundle=off", prepare_raytrace_without_bundles},
    {"bruteforce", prepare_brute_force},
};

}  // namespace

std::span<const VisibilityMethod> visibility_methods() {
    return kVisibilityMethods;
}

const VisibilityMethod* find_visibility_method(std::string_view name) {
    const auto* found = std::find_if(std::begin(kVisibilityMethods), std::end(kVisibilityMethods),
                                     [name](const VisibilityMethod& method) { return method.name == name; });
    return found == std::end(kVisibilityMethods) ? nullptr : found;
}

}  // namespace trapeze
