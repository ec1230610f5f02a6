/// Figures as people read them.
#pragma once

#include <string>

namespace trapeze {

/// "0.412 ms", "41.2 ms", "4.12 s": three digits.
std::string seconds_text(double seconds);
/// Three digits, without exponents between a thousandth and ten million.
std::string number_text(double value);
/// A figure that some methods do not count: number_text(), but 0 is "-".
std::string counted_text(double value);
/// A count in words: "1.31 million".
std::string count_text(double count);

}  // namespace trapeze
