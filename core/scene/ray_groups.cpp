#include "core/scene/ray_groups.h"

#include <algorithm>

namespace trapeze {
namespace {

constexpr std::string_view kBetween = ", \t\n";

/// Calls use(name, sign) for each name of a list; a sign is that of the last name that had one, or 0.
template <class Use>
void for_each_name(std::string_view names, const Use& use) {
    char sign = 0;
    while (true) {
        const size_t first = names.find_first_not_of(kBetween);
        if (first == std::string_view::npos) return;
        names.remove_prefix(first);
        if (names[0] == '+' || names[0] == '-') {
            sign = names[0];
            names.remove_prefix(1);
            continue;
        }
        const size_t length = std::min(names.find_first_of(kBetween), names.size());
        use(std::string(names.substr(0, length)), sign);
        names.remove_prefix(length);
    }
}

bool contains(const std::vector<std::string>& list, const std::string& name) {
    return std::ranges::find(list, name) != list.end();
}

}  // namespace

void change_membership(std::string_view names, std::vector<std::string>& groups) {
    const size_t first = names.find_first_not_of(kBetween);
    const bool changes = first != std::string_view::npos && (names[first] == '+' || names[first] == '-');
    if (!changes) groups.clear();
    for_each_name(names, [&](const std::string& name, char sign) {
        if (sign == '-')
            std::erase(groups, name);
        else if (!contains(groups, name))
            groups.push_back(name);
    });
}

RaySubset::RaySubset(std::string_view names) {
    for_each_name(names,
                  [&](std::string name, char sign) { (sign == '-' ? out : in).push_back(std::move(name)); });
}

bool RaySubset::has(const std::vector<std::string>& groups) const {
    const auto is_member = [&](const std::string& name) { return contains(groups, name); };
    return (in.empty() || std::ranges::any_of(in, is_member)) && std::ranges::none_of(out, is_member);
}

}  // namespace trapeze
