/// What is said and counted of the request that is being carried out.
#pragma once

#include <atomic>
#include <set>
#include <string>

#include "core/diagnostics.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze::rib {

/// Messages of one reading, which name their request and its place, and the reading's summary. A file that is
/// wrong in one place is mostly wrong alike in thousands: messages have a kind, of which the first is shown
/// and the others are counted (Diagnostics), and from some number of kinds on new ones are only counted too.
class RequestReport {
  public:
    /// `cancelled` may be null; see ReadOptions.
    RequestReport(Diagnostics& diagnostics, const std::atomic<bool>* cancelled)
        : diagnostics_(diagnostics), cancelled_(cancelled) {}
    RequestReport(const RequestReport&) = delete;
    RequestReport& operator=(const RequestReport&) = delete;

    /// The request that messages are about from now on.
    void set_request(SourceLocation at, std::string_view name) {
        own_name_ = name;
        set_known_request(at, own_name_);
    }
    /// Likewise, of a name that outlives this: nothing is copied.
    void set_known_request(SourceLocation at, const std::string& name) { at_ = at, name_ = &name; }
    SourceLocation at() const { return at_; }
    const std::string& name() const { return *name_; }

    /// An error of the current request, or a warning under ErrorHandler "ignore". Its kind is its text
    /// without the numbers.
    void error(const std::string& text) { error(at_, text); }
    /// Reports an error at a place within the request; line 0 stands for the request's own place.
    void error(SourceLocation at, const std::string& text);
    /// A warning whose kind is told: texts with names from the file in them would all be different.
    void warn_once(const std::string& text, const std::string& kind);
    void note(SourceLocation at, const std::string& text, const std::string& kind = {}) {
        diagnostics_.note(at, text, kind);
    }
    /// A limit of this renderer is reached (ReadOptions): an error under any ErrorHandler.
    void error_of_limit(const std::string& text, const std::string& kind);
    /// Any message about the current request, whose name is put before the text.
    void say(Severity severity, SourceLocation at, const std::string& text, const std::string& kind);
    /// The current request is none; `name` is all of what stands there, which may be long.
    void report_unknown_request(const std::string& name);

    /// The request was understood as one that is not honoured.
    void count_unsupported() { ++summary_.unsupported[name()]; }
    /// Counts the request as understood, but without effect; `what` follows the request's name.
    void count_without_effect(const std::string& what = {}) { ++summary_.without_effect[name() + what]; }
    /// Counts the request as not needed, since it asks for what is so in any case; `what` says why.
    void count_not_needed(const std::string& what) { ++summary_.not_needed[name() + what]; }

    /// ErrorHandler (RISpec 3): Print is the default. Ignore turns errors into warnings, but for limits of
    /// this renderer; Abort ends the reading before the next request.
    enum class OnError { Print, Ignore, Abort };
    void set_error_handler(OnError handler);
    /// Whether reading ends here: it was cancelled, or ErrorHandler "abort" has met an error, which is said
    /// once.
    bool must_stop();
    /// What must_stop() found last, without a look at what has happened since.
    bool has_stopped() const { return has_stopped_; }

    ReadSummary& summary() { return summary_; }
    Diagnostics& diagnostics() { return diagnostics_; }

  private:
    /// As ErrorHandler has asked last; the handler holds from where it stands in the file.
    Severity severity_of_errors() const {
        return on_error_ == OnError::Ignore ? Severity::Warning : Severity::Error;
    }

    Diagnostics& diagnostics_;
    const std::atomic<bool>* const cancelled_;
    ReadSummary summary_;
    SourceLocation at_;
    std::string own_name_;  ///< of a request that is none of the table's
    const std::string* name_ = &own_name_;
    std::set<std::string> kinds_, unknown_requests_;  ///< of messages, and of names, that were shown
    OnError on_error_ = OnError::Print;
    uint64_t errors_before_abort_ = 0;  ///< when ErrorHandler "abort" was read
    bool has_stopped_ = false;
};

/// Messages are about another request until the end of the scope.
class OtherRequest {
  public:
    OtherRequest(RequestReport& report, SourceLocation at, std::string_view name) : OtherRequest(report) {
        report.set_request(at, name);
    }
    /// About requests that are yet to be set.
    explicit OtherRequest(RequestReport& report) : report_(report), at_(report.at()), name_(report.name()) {}
    ~OtherRequest() { report_.set_request(at_, name_); }
    OtherRequest(const OtherRequest&) = delete;
    OtherRequest& operator=(const OtherRequest&) = delete;

  private:
    RequestReport& report_;
    const SourceLocation at_;
    const std::string name_;
};

}  // namespace trapeze::rib
