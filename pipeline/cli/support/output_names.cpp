#include "pipeline/cli/support/output_names.h"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

#include "pipeline/frame/kept_pictures.h"

namespace trapeze {
namespace {

/// Digits that a number is padded to, at most.
constexpr size_t kMostDigits = 20;

/// Where a name has a frame's number.
struct Place {
    size_t length = 0;  ///< of what stands for the number; 0: nothing does
    size_t digits = 0;  ///< at least
};

/// What a name has at its beginning.
Place frame_place(std::string_view name) {
    constexpr std::string_view kWord = "<frame>";
    if (name.starts_with(kWord)) return {kWord.size(), 1};
    if (name.starts_with('#')) {
        const size_t count = std::min(name.find_first_not_of('#'), name.size());
        return {count, count};
    }
    if (!name.starts_with('%')) return {};
    const size_t end = name.find_first_not_of("0123456789", 1);
    if (end == std::string_view::npos || name[end] != 'd') return {};
    size_t digits = 1;
    std::from_chars(name.data() + 1, name.data() + end, digits);
    return {end + 1, digits};
}

}  // namespace

std::string with_frame_number(const std::string& name, int frame) {
    std::string result;
    for (size_t at = 0; at < name.size();) {
        const Place place = frame_place(std::string_view(name).substr(at));
        if (place.length > 0)
            result += fmt::format("{:0{}}", frame, std::min(place.digits, kMostDigits));
        else
            result += name[at];
        at += std::max<size_t>(place.length, 1);
    }
    return result;
}

std::string OutputNames::take(const std::string& given, int frame) {
    const std::string first = with_frame_number(output_, frame);
    std::string name = first;
    if (taken_.contains(name) && frame > 1) name = numbered(first, frame);
    for (int number = 2; taken_.contains(name); ++number) name = numbered(first, number);
    taken_.insert(name);
    std::erase_if(files_, [&](const auto& entry) { return entry.second == name; });
    files_[given] = name;
    return name;
}

std::optional<std::string> OutputNames::take_back(const std::string& given) {
    const auto found = files_.find(given);
    if (found == files_.end()) return {};
    taken_.erase(found->second);
    return found->second;
}

void OutputNames::forget(const std::string& given) {
    const auto found = files_.find(given);
    if (found != files_.end() && found->second != given) files_.erase(found);
}

}  // namespace trapeze
