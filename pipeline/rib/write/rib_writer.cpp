#include "pipeline/rib/write/rib_writer.h"

#include <bit>
#include <charconv>
#include <cmath>

#include "pipeline/rib/syntax/arguments.h"
#include "pipeline/rib/syntax/encoding_bytes.h"

namespace trapeze::rib {
namespace {

/// Bytes are handed on in pieces of about so many.
constexpr size_t kFlushBytes = size_t{1} << 16;
/// ASCII: columns; a number or string may reach beyond.
constexpr size_t kLineWidth = 110;

/// How many bytes a number takes: 1 to 4.
int bytes_of(uint64_t value) {
    int bytes = 1;
    while (bytes < 4 && value >> (8 * bytes) != 0) ++bytes;
    return bytes;
}

/// Whether it is the same number as a float: then that has the shorter text.
bool is_float(double value) {
    return static_cast<double>(static_cast<float>(value)) == value;
}

/// Blocks are told by the name alone, so that those of other renderers are indented too.
bool ends_block(std::string_view name) {
    return name.ends_with("End") && name != "End";
}
bool begins_block(std::string_view name) {
    return name.ends_with("Begin");
}

}  // namespace

RibWriter::RibWriter(RibEncoding encoding, std::function<void(std::string_view)> write)
    : encoding_(encoding), write_(std::move(write)) {}

/// What was begun ends its line: more may be written after it.
void RibWriter::flush() {
    if (in_line_) put('\n'), in_line_ = false;
    if (!buffer_.empty()) write_(buffer_);
    buffer_.clear();
    line_start_ = 0;
}

/// Begins a line in ASCII. Bytes are handed on here, where the line before is whole.
void RibWriter::begin_line() {
    if (in_line_) put('\n');
    if (buffer_.size() > kFlushBytes) {
        write_(buffer_);
        buffer_.clear();
    }
    line_start_ = buffer_.size();
    in_line_ = true;
}

/// In binary the first use of a name defines a code for it, while there are codes: 256. Indentation ends at
/// 20 levels, so that damaged files of open blocks alone stay readable.
void RibWriter::request(std::string_view name) {
    if (ends_block(name) && depth_ > 0) --depth_;
    if (encoding_ == RibEncoding::Ascii) {
        begin_line();
        buffer_.append(static_cast<size_t>(std::min(depth_, 20)) * 2, ' ');
        buffer_ += name;
    } else {
        if (buffer_.size() > kFlushBytes) flush();
        auto code = codes_.find(name);
        if (code == codes_.end() && codes_.size() < 256) {
            code = codes_.emplace(name, static_cast<uint8_t>(codes_.size())).first;
            put(static_cast<char>(kDefineRequestByte)), put(static_cast<char>(code->second));
            string(name);
        }
        if (code != codes_.end()) {
            put(static_cast<char>(kRequestByte)), put(static_cast<char>(code->second));
        } else {
            buffer_ += name;
            put(' ');
        }
    }
    if (begins_block(name)) ++depth_;
}

/// ASCII only. Long lists are broken, and go on indented. The width is a wish: a line is broken behind the
/// argument that went beyond it.
void RibWriter::space() {
    if (encoding_ == RibEncoding::Binary) return;
    if (buffer_.size() - line_start_ > kLineWidth) {
        put('\n');
        line_start_ = buffer_.size();
        buffer_.append(static_cast<size_t>(std::min(depth_, 20)) * 2 + 4, ' ');
    } else if (!buffer_.empty() && buffer_.back() != '[' && buffer_.back() != ' ') {
        put(' ');
    }
}

/// The most significant byte first, as all of RISpec's encoding has it.
void RibWriter::append_bytes(uint64_t value, int bytes) {
    for (int i = bytes; i-- > 0;) put(static_cast<char>(value >> (8 * i) & 0xff));
}

/// The shortest text that reads back as the same number; in binary an integer of as many bytes as it wants, a
/// float, or a double.
void RibWriter::append_number(double value) {
    if (encoding_ == RibEncoding::Ascii) {
        char text[40];
        const auto end = is_float(value) ? std::to_chars(text, text + sizeof text, static_cast<float>(value))
                                         : std::to_chars(text, text + sizeof text, value);
        buffer_.append(text, end.ptr);
        return;
    }
    if (value == std::floor(value) && value >= 0 && value < 0x7fffffff && !std::signbit(value)) {
        const auto integer = static_cast<uint64_t>(value);
        const int bytes = bytes_of(integer << 1);  // the first bit is the sign
        put(static_cast<char>(kIntegerByte + bytes - 1));
        append_bytes(integer, bytes);
    } else if (is_float(value)) {
        put(static_cast<char>(kFloatByte));
        append_bytes(std::bit_cast<uint32_t>(static_cast<float>(value)), 4);
    } else {
        put(static_cast<char>(kDoubleByte));
        append_bytes(std::bit_cast<uint64_t>(value), 8);
    }
}

void RibWriter::number(double value) {
    space();
    append_number(value);
}

/// Binary strings are bytes as they are; in text, quotes and backslashes are escaped. Bytes beyond ASCII are
/// written as they are: within quotes the reader takes them for characters and not for encoded values.
void RibWriter::string(std::string_view text) {
    if (encoding_ == RibEncoding::Binary) {
        if (text.size() < 16) {
            put(static_cast<char>(kShortStringByte + text.size()));
        } else {
            const int bytes = bytes_of(text.size());
            put(static_cast<char>(kLongStringByte + bytes - 1));
            append_bytes(text.size(), bytes);
        }
        buffer_ += text;
        return;
    }
    space();
    put('"');
    for (const char c : text) {
        if (c == '\n') {
            buffer_ += "\\n";
            continue;
        }
        if (c == '"' || c == '\\') put('\\');
        put(c);
    }
    put('"');
}

/// Binary arrays of floats are four bytes each, exact; in text each has its shortest form.
void RibWriter::numbers(std::span<const float> values) {
    if (encoding_ == RibEncoding::Binary) {
        const int bytes = bytes_of(values.size());
        put(static_cast<char>(kFloatsByte + bytes - 1));
        append_bytes(values.size(), bytes);
        for (const float value : values) append_bytes(std::bit_cast<uint32_t>(value), 4);
        return;
    }
    space();
    put('[');
    for (const float value : values) number(value);
    put(']');
}

/// Arrays of floats would round large indices: each number is encoded by itself, in binary in as few bytes as
/// it needs.
void RibWriter::integers(std::span<const int> values) {
    space();
    put('[');
    for (const int value : values) number(value);
    put(']');
}

void RibWriter::strings(std::span<const std::string> values) {
    space();
    put('[');
    for (const std::string& value : values) string(value);
    put(']');
}

/// Binary RIB may hold comments between requests, and begins with one.
void RibWriter::comment(std::string_view text) {
    // Binary RIB may hold ASCII, and a comment ends with its line.
    if (encoding_ == RibEncoding::Ascii) begin_line();
    buffer_ += text;
    put('\n');
    in_line_ = false;
    line_start_ = buffer_.size();
}

/// Integers that are no floats are written as they were read.
void RibWriter::append_array(const Argument& argument) {
    if (!argument.strings.empty()) return strings(argument.strings);
    if (argument.large_integers.empty()) return numbers(argument.floats);
    space();
    put('[');
    size_t large = 0;
    for (size_t i = 0; i < argument.floats.size(); ++i) {
        const bool is_large =
            large < argument.large_integers.size() && argument.large_integers[large].first == i;
        number(is_large ? argument.large_integers[large++].second : double{argument.floats[i]});
    }
    put(']');
}

void RibWriter::append_argument(const Argument& argument) {
    switch (argument.kind) {
        case Argument::Kind::Number:
            return number(argument.number);
        case Argument::Kind::String:
            return string(argument.strings.front());
        case Argument::Kind::Array:
            return append_array(argument);
    }
}

void RibWriter::write(const RequestText& text) {
    request(text.name);
    for (const Argument& argument : text.arguments) append_argument(argument);
}

}  // namespace trapeze::rib
