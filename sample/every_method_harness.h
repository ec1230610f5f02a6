/// Every visibility method in every form, out of the table that the program offers them from: what tests that
/// speak of "every method" go through, so that a new row or option is in all of them.
#pragma once

#include <string>
#include <vector>

#include "sample/visibility.h"

namespace trapeze::testing {

/// A method as a user names it, and the pattern that it was made for.
struct MethodForm {
    std::string name, pattern;
};

struct WhichForms {
    bool exact_only = true;  ///< without those whose hits are not brute force's
    /// Of raytrace's options that are numbers, as levels=9|12|15, one other value alone: for what depends on
    /// no number, and where each form costs several builds.
    bool few_numbers = false;
    /// Of raytrace's trees each as it is by default: what their options choose between is compiled once, for
    /// all instruction sets.
    bool one_of_each_tree = false;
};

/// The forms of all methods of the table: each row as it is by default, and with each of its options at each
/// other value; two options in all combinations, more of them one at a time, but with what they are for
/// (raytrace's with tree=paper).
inline std::vector<MethodForm> every_method(WhichForms which = {}) {
    std::vector<MethodForm> forms;
    const auto add = [&](const std::string& name) {
        std::string error;
        const auto sampler = choose_sampler(name, "", &error);
        if (!sampler) return false;
        const VisibilityMethod* row = find_named(visibility_methods(), sampler->method.name);
        forms.push_back({sampler->name(), row->natural_pattern(sampler->method)});
        return true;
    };
    for (const VisibilityMethod& method : visibility_methods()) {
        if (which.exact_only && !method.is_exact) continue;
        const std::string name(method.name);
        add(name);
        std::vector<std::string> bases{name + ":"};
        for (const SpecOption& option : method.options) {
            const std::vector<std::string> before = bases;
            const auto is_number = [](std::string_view value) {
                return value.find_first_not_of("0123456789.") == std::string_view::npos;
            };
            const bool one_of_many =
                which.few_numbers && method.options.size() > 2 && is_number(option.values.back());
            const size_t values = one_of_many ? 2 : option.values.size();
            for (size_t i = 1; i < values; ++i) {
                const std::string choice = std::string(option.name) + "=" + std::string(option.values[i]);
                if (which.exact_only && choice == method.wrong_choice) continue;
                // Where it does not go with the defaults, it does with one of the forms before.
                for (const std::string& base : before) {
                    if (which.one_of_each_tree && base.find("tree=") != base.npos) continue;
                    if (!add(base + choice)) continue;
                    bases.push_back(base + choice + ",");
                    if (method.options.size() > 2) break;
                }
            }
        }
    }
    return forms;
}

}  // namespace trapeze::testing
