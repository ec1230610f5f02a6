/// What displays are told in whatever letters.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace trapeze {

inline std::string in_small_letters(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

}  // namespace trapeze
