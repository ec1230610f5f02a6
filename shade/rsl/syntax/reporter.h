/// The errors and warnings of one compilation.
#pragma once

#include <string>

#include "core/diagnostics.h"

namespace trapeze::rsl {

/// Passes messages on until there are too many: then says so once, and is full(). What one mistake brings
/// with it is of no use to the reader, and a file that is no shader would bring a message for each of its
/// lines. One for a compilation, passed by reference through all its stages; what stages do after an error is
/// theirs to decide by failed() and full().
class Reporter {
  public:
    static constexpr int kMostErrors = 50;
    static constexpr int kMostWarnings = 50;

    explicit Reporter(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    /// Reports an error; of several at one place only the first is shown.
    void error(SourceLocation at, std::string text);
    void warning(SourceLocation at, std::string text);
    /// Belongs to the error before it, and is shown if that was.
    void note(SourceLocation at, std::string text);

    /// Errors alone: a source with warnings is compiled.
    bool failed() const { return errors_ > 0; }
    /// Nothing more is shown; passes may stop.
    bool full() const { return errors_ > kMostErrors; }

    Diagnostics& diagnostics() { return diagnostics_; }

  private:
    Diagnostics& diagnostics_;
    int errors_ = 0, warnings_ = 0;
    bool last_shown_ = false;
    SourceLocation last_error_;
};

}  // namespace trapeze::rsl
