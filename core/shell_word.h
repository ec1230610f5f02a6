#pragma once

#include <string>

namespace trapeze {

/// A text within single quotes: a word that any shell reads as this text.
inline std::string shell_word(const std::string& text) {
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
    return word + "'";
}

}  // namespace trapeze
