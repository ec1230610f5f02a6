#include "shade/rsl/front_end.h"

#include "shade/rsl/analysis/analysis.h"
#include "shade/rsl/syntax/messages.h"
#include "shade/rsl/syntax/parser.h"
#include "shade/rsl/syntax/preprocessor.h"
#include "shade/rsl/syntax/token_values.h"

namespace trapeze::rsl {
namespace {

std::unique_ptr<TranslationUnit> parse_with(const Source& source, const CompileOptions& options,
                                            Messages& messages) {
    TokenStream stream = preprocess(source, options, messages);
    if (messages.full()) return nullptr;
    read_values(stream, messages);
    return parse_tokens(stream, messages);
}

}  // namespace

std::unique_ptr<TranslationUnit> parse(const Source& source, const CompileOptions& options,
                                       Diagnostics& diagnostics) {
    Messages messages(diagnostics);
    std::unique_ptr<TranslationUnit> unit = parse_with(source, options, messages);
    return messages.failed() ? nullptr : std::move(unit);
}

std::unique_ptr<TranslationUnit> compile_front(const Source& source, const CompileOptions& options,
                                               Diagnostics& diagnostics) {
    Messages messages(diagnostics);
    std::unique_ptr<TranslationUnit> unit = parse_with(source, options, messages);
    // What the parser lost would be missed again.
    if (messages.failed()) return nullptr;
    analyse(*unit, messages);
    return messages.failed() ? nullptr : std::move(unit);
}

}  // namespace trapeze::rsl
