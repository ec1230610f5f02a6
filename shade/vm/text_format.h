/// printf's and format's texts (RISpec 3.2, section 15.5): %f %g %e %d number, %p point, vector or normal, %c
/// colour, %m matrix, %s string; with C's flags, widths and precisions. Other values than the letter asks for
/// are written as what they are.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trapeze::vm {

/// An argument: a string, or floats.
struct TextValue {
    std::string_view text;
    bool is_text = false;
    std::vector<float> floats;
};

/// Missing values leave their field empty, further ones are not written.
std::string format_text(std::string_view format, std::span<const TextValue> values);

/// Whether a part of the subject matches the pattern (POSIX extended regular expressions). Bad patterns, and
/// such as are longer than kMaxPattern, match nothing; of a subject the first kMaxSubject characters count.
inline constexpr size_t kMaxPattern = 256, kMaxSubject = 1024;

/// A pattern that is wrong, or too long, matches nothing.
bool matches(std::string_view pattern, std::string_view subject);

}  // namespace trapeze::vm
