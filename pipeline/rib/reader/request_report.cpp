#include "pipeline/rib/reader/request_report.h"

#include "pipeline/rib/reader/known_requests.h"

namespace trapeze::rib {
namespace {

// What is no RIB at all (a picture, a program) has a mistake of its own in each word: its reader is helped by
// the first of them, not by a million.
constexpr size_t kMostKinds = 200;
constexpr size_t kMostUnknownRequests = 20;

/// A message without its numbers: files that are wrong in one place are wrong alike in many. Runs of digits
/// become one mark, as numbers differ in length too.
std::string kind_of(Severity severity, const std::string& text) {
    std::string kind = severity == Severity::Error ? "error-" : "warning-";
    for (const char c : text)
        if (c < '0' || c > '9')
            kind += c;
        else if (!kind.ends_with('#'))
            kind += '#';
    return kind;
}

}  // namespace

/// The kind has the request's name in it, so that a mistake in Color does not hide the same one in Opacity.
void RequestReport::error(SourceLocation at, const std::string& text) {
    const Severity severity = severity_of_errors();
    say(severity, at.line ? at : at_, text, kind_of(severity, name() + ": " + text));
}

void RequestReport::warn_once(const std::string& text, const std::string& kind) {
    say(Severity::Warning, at_, text, kind);
}

/// Shown once for each kind; what is over the limit is left out without further words.
void RequestReport::error_of_limit(const std::string& text, const std::string& kind) {
    diagnostics_.error(at_, name() + ": " + text, kind);
}

/// Kinds beyond the most are counted together as "further kinds", with the first of them shown.
void RequestReport::say(Severity severity, SourceLocation at, const std::string& text,
                        const std::string& kind) {
    const std::string whole = name() + ": " + text;
    if (kinds_.size() < kMostKinds) kinds_.insert(kind);
    if (kinds_.contains(kind))
        diagnostics_.report(severity, at, whole, kind);
    else
        diagnostics_.report(severity, at, whole + " (further messages of other kinds are only counted)",
                            severity == Severity::Error ? "error-further-kinds" : "warning-further-kinds");
}

/// A name is remembered whole, and reported each time it comes, until there have been too many different
/// ones: such a file is no RIB, or of another kind of renderer.
void RequestReport::report_unknown_request(const std::string& name) {
    if (unknown_requests_.size() < kMostUnknownRequests) unknown_requests_.insert(name);
    if (!unknown_requests_.contains(name)) {
        say(severity_of_errors(), at_, "no such request; further unknown names are only counted",
            "error-further-unknown-requests");
        return;
    }
    const std::string like = suggestion_for(name);
    error("no such request" + (like.empty() ? "" : " (did you mean " + like + "?)") +
          "; skipped to the next one");
}

/// Errors before the request that asks for "abort" do not end the reading.
void RequestReport::set_error_handler(OnError handler) {
    on_error_ = handler;
    errors_before_abort_ = diagnostics_.count(Severity::Error);
}

/// Asked before each request. The error that ends the reading was said before, so this adds why nothing
/// follows.
bool RequestReport::must_stop() {
    has_stopped_ = has_stopped_ || (cancelled_ && *cancelled_);
    if (has_stopped_ || on_error_ != OnError::Abort) return has_stopped_;
    has_stopped_ = diagnostics_.count(Severity::Error) > errors_before_abort_;
    if (has_stopped_)
        diagnostics_.error(at_, "reading ends at the first error, as ErrorHandler \"abort\" asks");
    return has_stopped_;
}

}  // namespace trapeze::rib
