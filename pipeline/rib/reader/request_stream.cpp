/// Reading is recursive as files are: ReadArchive is a request like others, and its handler comes back here.
/// What belongs to the text that is read (place, conditions, current request) is put aside meanwhile by
/// in_stream().
#include "pipeline/rib/reader/request_stream.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "pipeline/rib/reader/known_requests.h"
#include "pipeline/rib/reader/request_executor.h"
#include "pipeline/rib/syntax/source_text.h"

namespace trapeze::rib {
namespace {

namespace fs = std::filesystem;

/// Deeper is a mistake, or an attack on the stack: each level is one of this program too.
constexpr size_t kDeepestInclude = 64;

/// Memory for requests of archives that are read again, in bytes; an eighth of what a scene may take, if that
/// is less.
constexpr uint64_t kMostReadyBytes = uint64_t{256} << 20;

/// One name for each file, however it is reached.
std::string canonical(const std::string& path) {
    std::error_code problem;
    const fs::path unique = fs::canonical(path, problem);
    return problem ? path : unique.string();
}

}  // namespace

/// References are kept and not used here: the executor does not exist yet when the stream is made
/// (RibReader).
RequestStream::RequestStream(const ReadOptions& options, const Access& access, RequestReport& report,
                             OpenFiles& files, FileSearch& search, ConditionalBlocks& conditions,
                             ArchivePlace& place, RequestExecutor& executor)
    : read_options_(options),
      access_(access),
      report_(report),
      files_(files),
      search_(search),
      conditions_(conditions),
      place_(place),
      executor_(executor),
      ready_bytes_left_(std::min(kMostReadyBytes, options.most_scene_bytes / 8)) {}

/// What is known of an archive that is a file as it was, or is to be known from now on; null for a scene's
/// own files, which are read once.
std::shared_ptr<ReadyArchive> RequestStream::ready_archive(const std::string& path) {
    if (files_.depth() == 0) return nullptr;
    const std::optional<FileStamp> stamp = stamp_of(path);
    if (!stamp) return nullptr;
    KnownFile& file = known_files_[path];
    if (!file.ready || file.stamp != *stamp)
        file = {*stamp, std::make_shared<ReadyArchive>(&ready_bytes_left_)};
    return file.ready;
}

/// A file that cannot be read is an error of the request that names it; one of the command's has no request.
void RequestStream::read_file(const std::string& path, const Access& access) {
    const bool is_archive = files_.depth() > 0;
    Diagnostics& diagnostics = report_.diagnostics();
    const std::shared_ptr<ReadyArchive> ready = ready_archive(path);
    if (ready && ready->is_complete()) {
        const uint32_t id = diagnostics.add_source(path, report_.at());
        ++report_.summary().files;
        const OpenFiles::Entry entry(files_, path);
        read_again(*ready, id);
        return;
    }
    std::string problem;
    auto source = read_source(path, read_options_.max_source_bytes, &problem, access);
    if (!source) {
        const std::string text = "cannot read " + in_quotes(path) + ": " + problem;
        if (is_archive)
            report_.error(text + "; nothing read");
        else
            diagnostics.error({}, text);
        return;
    }
    const uint32_t id =
        diagnostics.add_source(path == "-" ? "<stdin>" : path, is_archive ? report_.at() : SourceLocation{});
    if (!source->problem.empty()) {
        diagnostics.error({id, 0, 0}, source->problem);
        if (ready) ready->give_up();
    }
    ++report_.summary().files;
    const OpenFiles::Entry entry(files_, path);
    read_text(source->text, {id, 1, 1}, {}, ready.get());
}

/// Angle brackets keep the name apart from any file's (OpenFiles).
void RequestStream::read_memory(std::string_view text, const std::string& name) {
    const uint32_t id = report_.diagnostics().add_source("<" + name + ">", {});
    const OpenFiles::Entry entry(files_, "<" + name + ">");
    read_text(text, {id, 1, 1});
}

/// Requests come from somewhere else for a while.
template <class Read>
void RequestStream::in_stream(ReadyArchive* ready, Read&& read) {
    const OtherRequest requests_of_stream(report_);
    const ArchivePlace outer_place = std::exchange(place_, {ready, 0, 0});
    const size_t outer_conditions = conditions_.begin_stream();
    read();
    conditions_.end_stream(outer_conditions, !report_.has_stopped());
    place_ = outer_place;
}

/// The next request, which the archive keeps. One of whose text something was said is read as text again, so
/// that it is said again.
bool RequestStream::reads_next(Lexer& lexer, RequestText& request, ReadyArchive* ready) {
    Diagnostics& diagnostics = report_.diagnostics();
    if (!ready || ready->is_given_up()) return read_request(lexer, request, is_request, diagnostics);
    const auto said = [&] {
        return diagnostics.count(Severity::Error) + diagnostics.count(Severity::Warning);
    };
    const uint64_t before = said();
    const bool is_there = read_request(lexer, request, is_request, diagnostics);
    if (said() != before || (is_there && request.name == "ArchiveBegin"))
        ready->give_up();
    else if (is_there)
        ready->add(request);
    return is_there;
}

/// Requests that are skipped count for the place too: an archive that is read again has other branches taken.
void RequestStream::read_text(std::string_view text, SourceLocation first, EncodedNames names,
                              ReadyArchive* ready) {
    report_.summary().bytes += text.size();
    if (ready && ready->size() > 0) ready = nullptr;  // from when reading was broken off
    Lexer lexer(text, first, std::move(names));
    RequestText request;
    in_stream(ready, [&] {
        for (; !report_.must_stop() && reads_next(lexer, request, ready); ++place_.request) {
            place_.shapes = 0;
            if (conditions_.is_skipping() && !ConditionalBlocks::is_conditional(request.name)) continue;
            if (request.name == std::string_view("ArchiveBegin"))
                record_archive(request, lexer, text);
            else
                executor_.execute(request);
        }
    });
    if (ready && !report_.has_stopped()) ready->complete(text.size());
}

/// Carries out the requests of a text that was read before; messages are about places of `source`.
void RequestStream::read_again(ReadyArchive& ready, uint32_t source) {
    report_.summary().bytes += ready.text_bytes();
    RequestText request;
    in_stream(&ready, [&] {
        for (; !report_.must_stop() && place_.request < ready.size(); ++place_.request) {
            place_.shapes = 0;
            if (conditions_.is_skipping() && !ConditionalBlocks::is_conditional(ready.name(place_.request)))
                continue;
            ready.copy(place_.request, source, request);
            executor_.execute(request);
        }
    });
}

/// Reads past the text up to ArchiveEnd, and keeps it.
void RequestStream::record_archive(RequestText& request, Lexer& lexer, std::string_view text) {
    report_.set_request(request.at, request.name);
    ++report_.summary().requests[request.name];
    const auto tell = [&] {
        if (read_options_.tells_archives && read_options_.on_request) read_options_.on_request(request);
    };
    tell();
    std::optional<std::string> handle;
    try {
        handle = ArgumentCursor(request).handle("the archive's name");
    } catch (const RequestError& problem) {
        report_.error(problem.at, problem.text + "; the archive is read past");
    }
    const SourceLocation first = lexer.peek().at;
    const size_t begin = lexer.offset();
    EncodedNames names = lexer.encoded_names();
    size_t end = begin;
    for (int depth = 1; depth > 0;) {
        end = lexer.offset();
        if (!read_request(lexer, request, is_request, report_.diagnostics())) {
            report_.error("ArchiveEnd is missing; the archive ends with the file");
            break;
        }
        tell();
        depth += request.name == "ArchiveBegin" ? 1 : request.name == "ArchiveEnd" ? -1 : 0;
    }
    if (handle)
        inline_archives_[*handle] = {std::make_shared<const std::string>(text.substr(begin, end - begin)),
                                     first,
                                     std::move(names),
                                     {}};
}

/// Recursion is found by names: of files by the one name that each has, whichever way it is reached. The
/// limits count each reading anew, known archives included: ten archives that read the next ten times each
/// make billions of requests of a few lines.
bool RequestStream::may_read_archive(const std::string& name, const std::string& key) {
    const char* problem = nullptr;
    const auto is_same = [&](const std::string& open) {
        // Inline archives and answers, "<archive a>", are no files to be looked for.
        return open == key || (key.front() != '<' && !open.starts_with('<') && canonical(open) == key);
    };
    if (!key.empty() && std::any_of(files_.names().begin(), files_.names().end(), is_same))
        problem = " reads itself; not read again";
    else if (files_.depth() >= kDeepestInclude)
        problem = " lies in archives nested more than 64 deep; not read";
    if (problem) {
        report_.error(in_quotes(name) + problem);
        return false;
    }
    const uint64_t bytes = report_.summary().bytes;
    if (++archives_read_ <= read_options_.most_archives_read && bytes <= read_options_.most_bytes_read)
        return true;
    report_.error_of_limit("archives are read " + std::to_string(archives_read_) + " times, " +
                               std::to_string(bytes >> 20) +
                               " MiB in all, which is the limit; this and further ones are not read",
                           "archive-limit");
    return false;
}

/// Inline archives come before files of the same name: the scene itself defined them.
void RequestStream::read_archive(const std::string& name) {
    if (const auto archive = inline_archives_.find(name); archive != inline_archives_.end()) {
        const std::string key = "<archive " + name + ">";
        if (may_read_archive(name, key)) read_inline_archive(archive->second, key);
        return;
    }
    const auto path = search_.find_archive(name);
    if (!path && search_.is_closed(name))
        report_.error(in_quotes(name) + " " + Access::kClosed + "; nothing read");
    else if (!path)
        report_.error(in_quotes(name) + " is not found; nothing read");
    else if (may_read_archive(name, canonical(*path)))
        read_file(*path, access_);
}

/// Messages of an inline archive are about the file that defined it, and tell where it was read from: the
/// same place in the text gets a source of its own for each reading.
void RequestStream::read_inline_archive(InlineArchive& archive, const std::string& key) {
    if (!archive.ready) archive.ready = std::make_shared<ReadyArchive>(&ready_bytes_left_);
    // Text and requests stay while they are read, whatever is defined under their name meanwhile.
    const std::shared_ptr<const std::string> text = archive.text;
    const std::shared_ptr<ReadyArchive> ready = archive.ready;
    SourceLocation first = archive.first;
    Diagnostics& diagnostics = report_.diagnostics();
    first.source = diagnostics.add_source(diagnostics.source_name(first.source), report_.at());
    const OpenFiles::Entry entry(files_, key);
    if (ready->is_complete())
        read_again(*ready, first.source);
    else
        read_text(*text, first, archive.names, ready.get());
}

}  // namespace trapeze::rib
