/// Macros, conditions and #include, within bounds that no file from a stranger can break. (See
/// [decision 0010] for why it is our own.)
#pragma once

#include "shade/rsl/syntax/reporter.h"
#include "shade/rsl/syntax/source.h"
#include "shade/rsl/syntax/token.h"

namespace trapeze::rsl {

/// A file and all that it includes, as tokens. Each stands where it was written, those of macros where the
/// macro was used. What is wrong is reported.
TokenStream preprocess(const Source& source, const CompileOptions& options, Reporter& reporter);

}  // namespace trapeze::rsl
