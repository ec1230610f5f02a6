/// What stands between the preprocessor and the parser: values of numbers and strings.
#pragma once

#include "shade/rsl/syntax/reporter.h"
#include "shade/rsl/syntax/token.h"

namespace trapeze::rsl {

/// Letters of a name beyond which it is reported and cut, so that no message or table has to hold more.
inline constexpr size_t kLongestName = 1000;

/// Gives numbers their values and strings theirs (escapes read, strings beside each other joined). Reports
/// what is no word of the language, and leaves it out.
void read_values(TokenStream& stream, Reporter& reporter);

}  // namespace trapeze::rsl
