/// What the program has to say about its input: errors, warnings and notes with file, line, column and
/// include stack. Libraries report here; they never print or exit [decision 0024].
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace trapeze {

enum class Severity { Note, Warning, Error };

/// A place in a source registered with Diagnostics. Lines and columns count from 1; line 0 says "no place
/// known".
struct SourceLocation {
    uint32_t source = 0;  ///< 0: none
    uint32_t line = 0;
    uint32_t column = 0;
};

/// One message as listeners get it.
struct Diagnostic {
    Severity severity = Severity::Error;
    std::string text;                        ///< one line, without the place
    std::string place;                       ///< "file:line:col", or empty
    std::vector<std::string> included_from;  ///< places of the ReadArchives that led here, innermost first
    std::string kind;  ///< those of one kind are shown once, then counted; empty: always shown
    /// The source's line and, below, a caret at the column; empty where the text is not known. No newline at
    /// its end.
    std::string excerpt{};
};

/// "scene.rib:3:5: error: text", then the excerpt if there is one, then a line for each place it was included
/// from.
std::string to_string(const Diagnostic& diagnostic);

/// Collects what is reported, thread-safe; hands the first of each kind to the listener.
class Diagnostics {
  public:
    using Listener = std::function<void(const Diagnostic&)>;

    /// The listener is called under a lock: one message at a time, from whichever thread reports.
    explicit Diagnostics(Listener listener = {}) : listener_(std::move(listener)) {}

    /// Registers a file (or "<stdin>", an inline archive...) so that locations can refer to it.
    uint32_t add_source(std::string name, SourceLocation included_from = {});
    /// Registers a source whose lines messages shall show. Line n of `text` is called n + `line_shift`, as
    /// after a #line.
    uint32_t add_source(std::string name, SourceLocation included_from,
                        std::shared_ptr<const std::string> text, int64_t line_shift = 0);
    /// The name that a source was registered by; empty for 0.
    std::string source_name(uint32_t source) const;

    /// Reports a message; `kind`: see Diagnostic. Texts are one line and begin with the request or file at
    /// fault.
    void error(SourceLocation at, std::string text, std::string kind = {}) {
        report(Severity::Error, at, std::move(text), std::move(kind));
    }
    void warning(SourceLocation at, std::string text, std::string kind = {}) {
        report(Severity::Warning, at, std::move(text), std::move(kind));
    }
    void note(SourceLocation at, std::string text, std::string kind = {}) {
        report(Severity::Note, at, std::move(text), std::move(kind));
    }
    void report(Severity severity, SourceLocation at, std::string text, std::string kind);

    /// How many were reported, the unshown repetitions included.
    uint64_t count(Severity severity) const;

    /// All messages of one kind.
    struct KindCount {
        Severity severity;
        std::string text;  ///< that of the first of its kind
        uint64_t count;
    };
    /// The kinds reported, by name.
    std::map<std::string, KindCount> kinds() const;

  private:
    struct Source {
        std::string name;
        SourceLocation included_from;
        std::shared_ptr<const std::string> text;  ///< null: not known
        int64_t line_shift = 0;
    };
    std::string place_of(SourceLocation at) const;
    std::string excerpt_of(SourceLocation at) const;

    mutable std::mutex mutex_;
    Listener listener_;
    std::vector<Source> sources_;
    std::map<std::string, KindCount> kinds_;
    uint64_t counts_[3] = {0, 0, 0};
};

}  // namespace trapeze
