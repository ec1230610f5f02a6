/// The words of a source text.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "shade/rsl/syntax/source_text.h"

namespace trapeze::rsl {

/// One word of the source. Cheap to copy: its text is a view, and the TokenStream keeps what it views.
struct Token {
    enum class Kind : uint8_t {
        End,
        NewLine,  ///< within the preprocessor alone
        Name,
        Number,
        Text,     ///< a string; after read_values() `text` is its value
        Mark,     ///< operators and punctuation
        Unknown,  ///< a byte that means nothing, or a string without its end
    };
    Kind kind = Kind::End;
    bool space_before = false;
    bool line_start = false;  ///< the first of its line
    bool painted = false;     ///< a macro's name met in its own expansion: never expanded again
    std::string_view text;    ///< as written
    SourceLocation at;
    float number = 0;  ///< set by read_values()

    /// A string of the same text is not meant: "if" in quotation marks is no word.
    bool is(std::string_view mark_or_name) const {
        return (kind == Kind::Mark || kind == Kind::Name) && text == mark_or_name;
    }
};

/// Tokens and the texts that they point into. It must outlive whatever holds its tokens: the parser copies
/// texts into the tree, and needs it no longer than that.
struct TokenStream {
    std::vector<Token> tokens;  ///< the last one is an End
    /// Files in the order read. Deques, since what tokens view must not move.
    std::deque<SourceText> sources;
    std::deque<std::string> made;  ///< texts that stand in no source
};

}  // namespace trapeze::rsl
