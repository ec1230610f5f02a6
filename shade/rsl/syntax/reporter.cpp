#include "shade/rsl/syntax/reporter.h"

namespace trapeze::rsl {

/// A second error at the place of the last one is dropped: it is most likely a consequence. Places without a
/// line (line 0) are not compared.
void Reporter::error(SourceLocation at, std::string text) {
    const bool same_place = errors_ > 0 && at.line > 0 && at.source == last_error_.source &&
                            at.line == last_error_.line && at.column == last_error_.column;
    last_shown_ = !same_place && !full();
    if (!last_shown_) return;
    last_error_ = at;
    if (++errors_ <= kMostErrors) {
        diagnostics_.error(at, std::move(text));
    } else {
        diagnostics_.note(at, "more than " + std::to_string(kMostErrors) + " errors; the rest is not shown");
        last_shown_ = false;
    }
}

/// Further ones are dropped without a word: warnings are no reason to stop.
void Reporter::warning(SourceLocation at, std::string text) {
    if (++warnings_ <= kMostWarnings) diagnostics_.warning(at, std::move(text));
}

/// A note explains the error before it, and is of no use where that was dropped.
void Reporter::note(SourceLocation at, std::string text) {
    if (last_shown_) diagnostics_.note(at, std::move(text));
}

}  // namespace trapeze::rsl
