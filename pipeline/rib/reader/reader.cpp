#include "pipeline/rib/reader/reader.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "pipeline/rib/state/recognised_names.h"
#include "pipeline/rib/syntax/search_path.h"
#include "pipeline/rib/syntax/source_text.h"

namespace trapeze::rib {
namespace {

std::shared_ptr<const AttributeState> default_attributes() {
    auto state = std::make_shared<AttributeState>();
    state->u_basis = state->v_basis = M44f(-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0);  // bezier
    return state;
}

/// Exporters write objects without points as shapes of an empty "P".
bool has_no_points(const RequestText& text) {
    for (size_t i = 0; i + 1 < text.arguments.size(); ++i) {
        const Argument& name = text.arguments[i];
        const Argument& value = text.arguments[i + 1];
        if (value.kind == Argument::Kind::Array && value.strings.empty() && value.floats.empty() &&
            name.kind == Argument::Kind::String &&
            (name.strings[0] == "P" || name.strings[0].ends_with(" P")))
            return true;
    }
    return false;
}

/// Of requests that are kept for archives that are read again.
constexpr uint64_t kMostReadyBytes = uint64_t{256} << 20;

// What is no RIB at all has a mistake of its own in each word.
constexpr size_t kMostKinds = 200;
constexpr size_t kMostUnknownRequests = 20;

/// A message without its numbers: files that are wrong in one place are wrong alike in many.
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

Reader::Reader(const ReadOptions& options, Diagnostics& diagnostics,
               const std::function<void(Scene&&)>& on_world)
    : read_options_(options),
      access_(options.access ? *options.access : everything_),
      diagnostics_(diagnostics),
      on_world_(on_world),
      ready_bytes_left_(std::min(kMostReadyBytes, options.most_scene_bytes / 8)) {
    state_.attributes = default_attributes();
}

void Reader::error(SourceLocation at, const std::string& text) {
    const std::string whole = request_name_ + ": " + text;
    report(severity_of_errors(), at.line ? at : at_, whole, kind_of(severity_of_errors(), whole));
}

void Reader::warn_once(const std::string& text, const std::string& kind) {
    report(Severity::Warning, at_, request_name_ + ": " + text, kind);
}

void Reader::report(Severity severity, SourceLocation at, const std::string& text, const std::string& kind) {
    if (kinds_.size() < kMostKinds) kinds_.insert(kind);
    if (kinds_.contains(kind))
        diagnostics_.report(severity, at, text, kind);
    else
        diagnostics_.report(severity, at, text + " (further messages of other kinds are only counted)",
                            severity == Severity::Error ? "error-further-kinds" : "warning-further-kinds");
}

void Reader::report_unknown(const std::string& request) {
    if (unknown_requests_.size() < kMostUnknownRequests) unknown_requests_.insert(request);
    if (!unknown_requests_.contains(request)) {
        report(severity_of_errors(), at_,
               request_name_ + ": no such request; further unknown names are only counted",
               "error-further-unknown-requests");
        return;
    }
    const std::string like = suggestion_for(request);
    error("no such request" + (like.empty() ? "" : " (did you mean " + like + "?)") +
          "; skipped to the next one");
}

AttributeState& Reader::change_attributes() {
    if (state_.attributes.use_count() > 1)
        state_.attributes = std::make_shared<AttributeState>(*state_.attributes);
    return const_cast<AttributeState&>(*state_.attributes);
}

/// What is known of an archive that is a file as it was, or is to be known from now on; null for a scene's
/// own files, which are read once.
std::shared_ptr<ReadyArchive> Reader::ready_archive(const std::string& path) {
    if (open_files_.empty()) return nullptr;
    const std::optional<FileStamp> stamp = stamp_of(path);
    if (!stamp) return nullptr;
    KnownFile& file = known_files_[path];
    if (!file.ready || file.stamp != *stamp)
        file = {*stamp, std::make_shared<ReadyArchive>(&ready_bytes_left_)};
    return file.ready;
}

void Reader::read_file(const std::string& path, const Access& access) {
    const std::shared_ptr<ReadyArchive> ready = ready_archive(path);
    if (ready && ready->is_complete()) {
        const uint32_t id = diagnostics_.add_source(path, at_);
        ++summary_.files;
        open_files_.push_back(path);
        read_again(*ready, id);
        open_files_.pop_back();
        return;
    }
    std::string problem;
    auto source = read_source(path, read_options_.max_source_bytes, &problem, access);
    if (!source) {
        const std::string text = "cannot read " + in_quotes(path) + ": " + problem;
        if (open_files_.empty())
            diagnostics_.error({}, text);
        else
            error(text + "; nothing read");
        return;
    }
    const uint32_t id =
        diagnostics_.add_source(path == "-" ? "<stdin>" : path, open_files_.empty() ? SourceLocation{} : at_);
    if (!source->problem.empty()) {
        diagnostics_.error({id, 0, 0}, source->problem);
        if (ready) ready->give_up();
    }
    ++summary_.files;
    open_files_.push_back(path);
    read_text(source->text, {id, 1, 1}, {}, ready.get());
    open_files_.pop_back();
}

void Reader::read_memory(std::string_view text, const std::string& name) {
    const uint32_t id = diagnostics_.add_source("<" + name + ">", {});
    open_files_.push_back("<" + name + ">");
    read_text(text, {id, 1, 1});
    open_files_.pop_back();
}

/// Requests come from somewhere else for a while.
template <class Read>
void Reader::in_stream(ReadyArchive* ready, Read&& read) {
    const SourceLocation at = at_;
    const std::string name = request_name_;
    const size_t outer_conditionals = first_conditional_;
    const auto outer_place = std::exchange(place_, {ready, 0, 0});
    first_conditional_ = conditionals_.size();
    read();
    if (!stopped_) close_conditionals();
    conditionals_.resize(first_conditional_);
    first_conditional_ = outer_conditionals;
    place_ = outer_place;
    at_ = at, request_name_ = name;
}

/// The next request, which the archive keeps. One of whose text something was said is read as text again, so
/// that it is said again.
bool Reader::reads_next(Lexer& lexer, RequestText& request, ReadyArchive* ready) {
    if (!ready || ready->is_given_up()) return read_request(lexer, request, is_request, diagnostics_);
    const auto said = [this] {
        return diagnostics_.count(Severity::Error) + diagnostics_.count(Severity::Warning);
    };
    const uint64_t before = said();
    const bool is_there = read_request(lexer, request, is_request, diagnostics_);
    if (said() != before || (is_there && request.name == "ArchiveBegin"))
        ready->give_up();
    else if (is_there)
        ready->add(request);
    return is_there;
}

void Reader::read_text(std::string_view text, SourceLocation first, EncodedNames names, ReadyArchive* ready) {
    summary_.bytes += text.size();
    if (ready && ready->size() > 0) ready = nullptr;  // from when reading was broken off
    Lexer lexer(text, first, std::move(names));
    RequestText request;
    in_stream(ready, [&] {
        for (; !is_stopped() && reads_next(lexer, request, ready); ++place_.request) {
            place_.shapes = 0;
            if (is_skipping() && !is_conditional(request.name)) continue;
            if (request.name == std::string_view("ArchiveBegin"))
                record_archive(request, lexer, text);
            else
                execute(request);
        }
    });
    if (ready && !stopped_) ready->complete(text.size());
}

void Reader::read_again(ReadyArchive& ready, uint32_t source) {
    summary_.bytes += ready.text_bytes();
    RequestText request;
    in_stream(&ready, [&] {
        for (; !is_stopped() && place_.request < ready.size(); ++place_.request) {
            place_.shapes = 0;
            if (is_skipping() && !is_conditional(ready.name(place_.request))) continue;
            ready.copy(place_.request, source, request);
            execute(request);
        }
    });
}

void Reader::execute(RequestText& text) {
    at_ = text.at;
    if (text.name != last_request_.name || !last_request_.request) {
        last_request_ = {text.name, find_request(text.name), nullptr};
        if (last_request_.request) last_request_.count = &summary_.requests[text.name];
    }
    const Request* const request = last_request_.request;
    if (!request) {
        request_name_ = clipped(text.name);
        report_unknown(text.name);
        return;
    }
    request_name_ = text.name;
    ++*last_request_.count;
    if (!request->handler && text.problem.empty()) hands_on(text);
    if (!request->handler) {
        ++summary_.unsupported[text.name];
        diagnostics_.warning(at_, text.name + " is not supported yet; skipped", "unsupported-" + text.name);
        return;
    }
    if (!text.problem.empty()) {
        // A stray character must not take a whole block with it.
        const bool is_block = request->group == RequestGroup::Structure && text.arguments.empty();
        error(text.problem_at, text.problem + (is_block ? "; ignored" : "; request skipped"));
        if (!is_block) return;
    }
    try {
        substitute(text);
        if (!hands_on(text)) return;
        if (motion_ && (request->group == RequestGroup::Attribute || request->group == RequestGroup::Option))
            hold_in_motion(std::move(text));
        else
            carry_out(*request, text);
    } catch (const RequestError& problem) {
        const bool is_shape = request->group == RequestGroup::Geometry;
        error(problem.at, problem.text + (is_shape ? "; primitive skipped" : "; request skipped"));
    }
}

void Reader::carry_out(const Request& request, RequestText& text) {
    if (request.group == RequestGroup::Geometry && has_no_points(text)) {
        warn_once("\"P\" is empty; there is nothing to draw", "empty-" + text.name);
        return;
    }
    ArgumentCursor cursor(text);
    request.handler(*this, cursor);
    if (!cursor.done()) error(cursor.peek()->at, "more arguments than the request has; the rest is ignored");
}

/// Whether the request is to be carried out.
bool Reader::hands_on(const RequestText& text) {
    if (!read_options_.on_request || is_conditional(text.name) || !frame_wanted_) return true;
    return read_options_.on_request(text);
}

std::string Reader::current_file() const {
    for (size_t i = open_files_.size(); i-- > 0;)
        if (open_files_[i] != "-" && open_files_[i][0] != '<') return open_files_[i];
    return {};
}

std::string Reader::current_folder() const {
    return std::filesystem::path(current_file()).parent_path().string();
}

void Reader::set_search_path(const std::string& category, const std::string& path) {
    std::vector<std::string>& folders = scope_.options.search_paths[category];
    // What the user's own text reads is no longer that text.
    const bool is_users = trusted_ && open_files_.size() == 1;
    std::vector<std::string> closed;
    folders = expand_search_path(path, folders, current_folder(), is_users ? kEverything : access_, &closed);
    if (is_users)
        for (const std::string& folder : folders) access_.allow_reading_below(folder);
    for (const std::string& folder : closed)
        warn_once("the folder " + in_quotes(folder) + " " + Access::kClosed + "; not searched",
                  "closed-folder " + folder);
}

void Reader::set_error_handler(OnError handler) {
    on_error_ = handler;
    errors_before_abort_ = diagnostics_.count(Severity::Error);
}

bool Reader::is_stopped() {
    stopped_ = stopped_ || (read_options_.cancelled && *read_options_.cancelled);
    if (stopped_ || on_error_ != OnError::Abort) return stopped_;
    stopped_ = diagnostics_.count(Severity::Error) > errors_before_abort_;
    if (stopped_) diagnostics_.error(at_, "reading ends at the first error, as ErrorHandler \"abort\" asks");
    return stopped_;
}

void Reader::finish() {
    if (stopped_) return;  // what is open is not delivered
    while (!blocks_.empty()) {
        at_ = blocks_.back().at, request_name_ = block_name(blocks_.back().kind);
        error("never closed; closed at the end of the input");
        close_block();
    }
    report_homeless();
}

}  // namespace trapeze::rib

namespace trapeze {

ReadSummary read_rib(std::span<const std::string> files, const ReadOptions& options, Diagnostics& diagnostics,
                     const std::function<void(Scene&&)>& on_world) {
    rib::Reader reader(options, diagnostics, on_world);
    reader.set_trusted(true);
    if (!options.defaults_file.empty()) reader.read_file(options.defaults_file, kEverything);
    for (const ReadOptions::Text& text : options.first_texts) reader.read_memory(text.rib, text.name);
    reader.set_trusted(false);
    for (const std::string& file : files) reader.read_file(file, kEverything);
    reader.finish();
    return std::move(reader.summary());
}

ReadSummary read_rib_text(std::string_view text, const std::string& name, const ReadOptions& options,
                          Diagnostics& diagnostics, const std::function<void(Scene&&)>& on_world) {
    rib::Reader reader(options, diagnostics, on_world);
    reader.read_memory(text, name);
    reader.finish();
    return std::move(reader.summary());
}

}  // namespace trapeze
