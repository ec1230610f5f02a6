#include "shade/rsl/syntax/source_text.h"

#include <filesystem>
#include <fstream>

namespace trapeze::rsl {
namespace {

/// If `at` is a backslash with only blanks before the line's end, the offset of the next line; otherwise 0.
size_t next_line_after_backslash(std::string_view text, size_t at) {
    size_t i = at + 1;
    while (i < text.size() && (text[i] == ' ' || text[i] == '\t')) ++i;
    if (i == text.size() || (text[i] != '\n' && text[i] != '\r')) return 0;
    return i + (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n' ? 2 : 1);
}

}  // namespace

/// Where lines were joined is kept aside, so that the lexer counts lines as they are in the file. A last line
/// without an end gets one.
SourceText joined_lines(std::string as_written) {
    SourceText source;
    source.as_written = std::make_shared<const std::string>(std::move(as_written));
    const std::string_view raw = *source.as_written;
    source.text.reserve(raw.size() + 1);
    size_t i = raw.starts_with("\xef\xbb\xbf") ? 3 : 0;
    while (i < raw.size()) {
        if (const size_t next = raw[i] == '\\' ? next_line_after_backslash(raw, i) : 0) {
            source.joints.push_back(source.text.size());
            i = next;
        } else if (raw[i] == '\r') {
            source.text += '\n';
            i += i + 1 < raw.size() && raw[i + 1] == '\n' ? 2 : 1;
        } else {
            source.text += raw[i++];
        }
    }
    if (source.text.empty() || source.text.back() != '\n') source.text += '\n';
    return source;
}

/// Regular files alone: a named pipe or device would make the compiler wait for ever. Nothing too where it is
/// larger than the bound: half a file would only make wrong errors. A file that shrinks meanwhile is taken as
/// it was read.
std::optional<std::string> read_file_from_disk(const std::string& path, size_t most_bytes) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return {};
    std::ifstream file(path, std::ios::binary);
    if (!file) return {};
    std::string text;
    // Piece by piece, so that a file that has no end is given up at the bound.
    char buffer[1 << 16];
    while (file.read(buffer, sizeof buffer) || file.gcount() > 0) {
        text.append(buffer, static_cast<size_t>(file.gcount()));
        if (text.size() > most_bytes) return {};
    }
    return text;
}

}  // namespace trapeze::rsl
