/// A small lexer of its own, since it has to stop in the middle of anything: answers arrive in pieces, and a
/// piece may end within a string, an escape or an encoded value.
#include "pipeline/rib/programs/end_of_answer.h"

#include "pipeline/rib/syntax/encoded_values.h"

namespace trapeze::rib {

/// Goes on where it stopped last; what is not complete yet is looked at again with the next bytes.
std::optional<size_t> EndOfAnswer::find(std::string_view bytes) {
    while (next_ < bytes.size()) {
        const char c = bytes[next_];
        if (within_ == Within::Comment) {
            if (c == '\n' || c == '\r') within_ = Within::Text;
            ++next_;
        } else if (within_ == Within::String) {
            // An escape whose second byte has not arrived yet.
            if (c == '\\' && next_ + 1 >= bytes.size()) break;
            if (c == '"') within_ = Within::Text;
            next_ += c == '\\' ? 2 : 1;
        } else if (c == '\xff') {
            return next_;
        } else if (c == '\xc3' && next_ + 1 >= bytes.size()) {
            break;
        } else if (c == '\xc3' && bytes[next_ + 1] == '\xbf') {
            return next_;
        } else if (static_cast<unsigned char>(c) >= 0x80) {
            // A byte 0377 may be part of an encoded number or string: encoded values are stepped over whole,
            // by the length that their header tells.
            const std::string_view rest = bytes.substr(next_);
            const EncodedValue value = encoded_value(rest);
            if (value.header > rest.size() || value.length > rest.size()) break;
            next_ += static_cast<size_t>(value.length);
        } else {
            if (c == '"') within_ = Within::String;
            if (c == '#') within_ = Within::Comment;
            ++next_;
        }
    }
    return {};
}

}  // namespace trapeze::rib
