#include "composite/colors/opencolorio/config_names.h"

#include <algorithm>
#include <cctype>

namespace trapeze {

namespace ocio = OCIO_NAMESPACE;

namespace {

/// Names that a message lists at most: configs of ACES have hundreds of colour spaces.
constexpr size_t kMostListed = 60;

bool is_same_name(const std::string& a, const std::string& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// name(0), name(1) ... name(count - 1).
template <class Name>
std::vector<std::string> names_by(int count, Name&& name) {
    std::vector<std::string> names;
    for (int i = 0; i < count; ++i) names.emplace_back(name(i));
    return names;
}

}  // namespace

std::vector<std::string> color_spaces_of(const ocio::Config& config) {
    return names_by(config.getNumColorSpaces(), [&](int i) { return config.getColorSpaceNameByIndex(i); });
}

std::vector<std::string> displays_of(const ocio::Config& config) {
    return names_by(config.getNumDisplays(), [&](int i) { return config.getDisplay(i); });
}

std::vector<std::string> views_of(const ocio::Config& config, const std::string& display) {
    return names_by(config.getNumViews(display.c_str()),
                    [&](int i) { return config.getView(display.c_str(), i); });
}

std::vector<std::string> looks_of(const ocio::Config& config) {
    return names_by(config.getNumLooks(), [&](int i) { return config.getLookNameByIndex(i); });
}

std::string listed_names(const std::vector<std::string>& names) {
    std::string text;
    for (size_t i = 0; i < std::min(names.size(), kMostListed); ++i)
        text += (i ? ", \"" : "\"") + names[i] + "\"";
    if (names.size() > kMostListed) text += " and " + std::to_string(names.size() - kMostListed) + " more";
    return text.empty() ? "none" : text;
}

std::string found_in(const std::vector<std::string>& names, const std::string& name,
                     const std::string& what) {
    auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        found = std::find_if(names.begin(), names.end(),
                             [&](const std::string& other) { return is_same_name(name, other); });
    if (found == names.end())
        throw ColorProblem("no " + what + " \"" + name + "\"; there is " + listed_names(names));
    return *found;
}

std::string color_space_named(const ocio::Config& config, const std::string& name) {
    if (const auto space = config.getColorSpace(name.c_str())) return space->getName();
    throw ColorProblem("no colour space \"" + name + "\"; there is " + listed_names(color_spaces_of(config)));
}

}  // namespace trapeze
