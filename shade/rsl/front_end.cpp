#include "shade/rsl/front_end.h"

#include "shade/rsl/analysis/analysis.h"
#include "shade/rsl/syntax/flatten_structs.h"
#include "shade/rsl/syntax/parser.h"
#include "shade/rsl/syntax/preprocessor.h"
#include "shade/rsl/syntax/reporter.h"
#include "shade/rsl/syntax/token_values.h"

namespace trapeze::rsl {
namespace {

/// Preprocessor, values of numbers and strings, parser. The tree is of use only if nothing has failed.
/// Nothing is parsed once the preprocessor has reported too much: tokens of a file that is no shader would
/// bring an error each.
std::unique_ptr<TranslationUnit> parse_with(const Source& source, const CompileOptions& options,
                                            Reporter& reporter) {
    TokenStream stream = preprocess(source, options, reporter);
    if (reporter.full()) return nullptr;
    read_values(stream, reporter);
    return parse_tokens(stream, reporter);
}

}  // namespace

/// The tree as the source has it, before anything has a type.
std::unique_ptr<TranslationUnit> parse(const Source& source, const CompileOptions& options,
                                       Diagnostics& diagnostics) {
    Reporter reporter(diagnostics);
    std::unique_ptr<TranslationUnit> unit = parse_with(source, options, reporter);
    return reporter.failed() ? nullptr : std::move(unit);
}

/// Null after any error, reported; never a tree that is half analysed. Warnings do not count.
std::unique_ptr<TranslationUnit> compile_front(const Source& source, const CompileOptions& options,
                                               Diagnostics& diagnostics) {
    Reporter reporter(diagnostics);
    std::unique_ptr<TranslationUnit> unit = parse_with(source, options, reporter);
    // What the parser lost would be missed again.
    if (reporter.failed()) return nullptr;
    flatten_structs(*unit, reporter);
    if (reporter.failed()) return nullptr;
    analyse(*unit, reporter);
    return reporter.failed() ? nullptr : std::move(unit);
}

}  // namespace trapeze::rsl
