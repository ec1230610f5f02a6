#include "shade/lights/light_categories.h"

#include <algorithm>

namespace trapeze {
namespace {

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r\n";
    const size_t first = std::min(text.find_first_not_of(kBlanks), text.size());
    return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

/// Whether one of the parts of a text, between separators, fulfils something.
template <typename Fulfils>
bool any_part(std::string_view text, char separator, Fulfils fulfils) {
    for (size_t at = 0; at <= text.size();) {
        const size_t end = std::min(text.find(separator, at), text.size());
        if (fulfils(trimmed(text.substr(at, end - at)))) return true;
        at = end + 1;
    }
    return false;
}

bool lists(std::string_view names, std::string_view name) {
    return any_part(names, ',', [&](std::string_view part) { return part == name; });
}

/// Takes the "-" off the front of a text, and the blanks after it.
bool take_minus(std::string_view& text) {
    if (!text.starts_with('-')) return false;
    text = trimmed(text.substr(1));
    return true;
}

}  // namespace

bool LightCategories::has(std::string_view name) const {
    if (lists(named, name)) return true;
    const bool is_diffuse = name == "diffuse", is_specular = name == "specular";
    if (!is_diffuse && !is_specular && name != "ambient") return false;
    if (lists(named, "diffuse") || lists(named, "specular") || lists(named, "ambient")) return false;
    return is_diffuse ? diffuse && !ambient : is_specular ? specular && !ambient : ambient;
}

bool LightCategories::fit(std::string_view wanted) const {
    wanted = trimmed(wanted);
    if (wanted.empty()) return true;
    const bool has_and = wanted.find('&') != std::string_view::npos;
    const bool excluded = !has_and && take_minus(wanted);
    const auto fails = [&](std::string_view name) {
        const bool negated = has_and && take_minus(name);
        return has(name) == negated;
    };
    const auto term_fits = [&](std::string_view term) { return !any_part(term, '&', fails); };
    return any_part(wanted, ',', term_fits) != excluded;
}

bool names_ambient(std::string_view wanted) {
    if (wanted.empty()) return false;
    wanted = trimmed(wanted);
    if (wanted.find('&') == std::string_view::npos && wanted.starts_with('-')) return false;
    const auto is_ambient = [](std::string_view name) { return name == "ambient"; };
    return any_part(wanted, ',', [&](std::string_view term) { return any_part(term, '&', is_ambient); });
}

}  // namespace trapeze
