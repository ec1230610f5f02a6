/// Text as it stands in a file, made ready for the lexer.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trapeze::rsl {

/// A file whose lines end with \n alone, and whose lines that end with a backslash are joined with the next.
/// Held in a deque by TokenStream, since tokens are views of `text`. as_written is shared with Diagnostics,
/// which shows lines as the author has them.
struct SourceText {
    std::string text;
    std::vector<size_t> joints;  ///< where in `text` lines were joined, ascending
    std::shared_ptr<const std::string> as_written;
};

/// Takes the text of a file with any line ends (\n, \r\n, \r), with or without a byte order mark.
SourceText joined_lines(std::string as_written);

/// A file of at most `most_bytes`; nothing when it cannot be read or is larger.
std::optional<std::string> read_file_from_disk(const std::string& path, size_t most_bytes);

}  // namespace trapeze::rsl
