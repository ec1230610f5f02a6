/// ArchiveBegin, ArchiveEnd, ReadArchive.
#include <algorithm>
#include <filesystem>

#include "core/files/foreign_paths.h"
#include "pipeline/rib/reader/reader.h"
#include "pipeline/rib/syntax/search_path.h"
#include "pipeline/rib/syntax/zip_archive.h"

namespace trapeze::rib {
namespace {

namespace fs = std::filesystem;

constexpr size_t kDeepestInclude = 64;

/// One name for each file, however it is reached.
std::string canonical(const std::string& path) {
    std::error_code problem;
    const fs::path unique = fs::canonical(path, problem);
    return problem ? path : unique.string();
}

/// A file, or a member of a zip archive.
bool is_readable(const std::string& path, const Access& access) {
    if (access.has_file(path)) return true;
    const auto member = zip_member_named(path);
    return member && has_zip_member(*member, access);
}

}  // namespace

/// Keeps the text up to ArchiveEnd, which is executed whenever the archive is read.
void Reader::record_archive(RequestText& request, Lexer& lexer, std::string_view text) {
    at_ = request.at, request_name_ = request.name;
    ++summary_.requests[request.name];
    std::optional<std::string> handle;
    try {
        handle = ArgumentCursor(request).handle("the archive's name");
    } catch (const RequestError& problem) {
        error(problem.at, problem.text + "; the archive is read past");
    }
    const SourceLocation first = lexer.peek().at;
    const size_t begin = lexer.offset();
    EncodedNames names = lexer.encoded_names();
    size_t end = begin;
    for (int depth = 1; depth > 0;) {
        end = lexer.offset();
        if (!read_request(lexer, request, is_request, diagnostics_)) {
            error("ArchiveEnd is missing; the archive ends with the file");
            break;
        }
        depth += request.name == "ArchiveBegin" ? 1 : request.name == "ArchiveEnd" ? -1 : 0;
    }
    if (handle)
        inline_archives_[*handle] = {std::make_shared<const std::string>(text.substr(begin, end - begin)),
                                     first,
                                     std::move(names),
                                     {}};
}

/// Beside the file that names it, along the search path, from the working folder. A file that is not found
/// there may have been named by another machine, or from its project's folder: it is looked for without its
/// leading folders, and then from the folders above.
std::optional<std::string> Reader::find_archive(const std::string& name) {
    if (const auto found = find_archive_named(name)) return found;
    const auto instead = [&](const std::string& found) {
        warn_once(in_quotes(name) + " is not found; " + in_quotes(found) + " is read",
                  "archive-elsewhere " + name);
        return found;
    };
    for (const std::string& other : other_names(name))
        if (const auto found = find_archive_named(other)) return instead(*found);
    // Exporters name files from their project's folder, and write those that name them below it.
    std::vector<std::string> names = other_names(name);
    names.insert(names.begin(), name);
    fs::path above = fs::path(current_folder());
    for (int level = 0; level < kMostFoldersAbove; ++level) {
        above /= "..";
        for (const std::string& other : names) {
            const std::string candidate = (above / other).string();
            if (fs::path(other).is_relative() && other.find('/') != std::string::npos &&
                is_readable(candidate, access_))
                return instead(candidate);
        }
    }
    for (const std::string& folder : usual_folders("archive", current_folder(), access_))
        for (const std::string& other : names)
            if (const std::string candidate = (fs::path(folder) / other).string();
                is_readable(candidate, access_))
                return instead(candidate);
    return {};
}

std::optional<std::string> Reader::find_archive_named(const std::string& name) const {
    std::error_code ignored;
    const fs::path path(name);
    if (path.is_absolute())
        return is_readable(name, access_) || (!access_.is_confined() && fs::is_fifo(path, ignored))
                   ? std::optional(name)
                   : std::nullopt;
    std::vector<std::string> folders{current_folder()};
    if (const auto paths = scope_.options.search_paths.find("archive");
        paths != scope_.options.search_paths.end())
        folders.insert(folders.end(), paths->second.begin(), paths->second.end());
    folders.push_back("");
    for (const std::string& folder : folders)
        if (const fs::path candidate = fs::path(folder) / path; is_readable(candidate.string(), access_))
            return candidate == "-" ? "./-" : candidate.string();  // a file of that name is not the input
    return {};
}

bool Reader::may_read_archive(const std::string& name, const std::string& key) {
    const char* problem = nullptr;
    if (!key.empty() && std::any_of(open_files_.begin(), open_files_.end(), [&](const std::string& open) {
            // Inline archives and answers, "<archive a>", are no files to be looked for.
            return open == key || (key.front() != '<' && !open.starts_with('<') && canonical(open) == key);
        }))
        problem = " reads itself; not read again";
    else if (open_files_.size() >= kDeepestInclude)
        problem = " lies in archives nested more than 64 deep; not read";
    if (problem) {
        error(in_quotes(name) + problem);
        return false;
    }
    if (++archives_read_ <= read_options_.most_archives_read &&
        summary_.bytes <= read_options_.most_bytes_read)
        return true;
    diagnostics_.error(at_,
                       request_name_ + ": archives are read " + std::to_string(archives_read_) + " times, " +
                           std::to_string(summary_.bytes >> 20) +
                           " MiB in all, which is the limit; this and further ones are not read",
                       "archive-limit");
    return false;
}

void Reader::read_archive(const std::string& name) {
    if (const auto archive = inline_archives_.find(name); archive != inline_archives_.end()) {
        const std::string key = "<archive " + name + ">";
        if (!may_read_archive(name, key)) return;
        InlineArchive& known = archive->second;
        if (!known.ready) known.ready = std::make_shared<ReadyArchive>(&ready_bytes_left_);
        // They stay while they are read, whatever is defined meanwhile.
        const std::shared_ptr<const std::string> text = known.text;
        const std::shared_ptr<ReadyArchive> ready = known.ready;
        SourceLocation first = known.first;
        first.source = diagnostics_.add_source(diagnostics_.source_name(first.source), at_);
        open_files_.push_back(key);
        if (ready->is_complete())
            read_again(*ready, first.source);
        else
            read_text(*text, first, known.names, ready.get());
        open_files_.pop_back();
        return;
    }
    const auto path = find_archive(name);
    if (!path && access_.is_closed(name, current_folder()))
        error(in_quotes(name) + " " + Access::kClosed + "; nothing read");
    else if (!path)
        error(in_quotes(name) + " is not found; nothing read");
    else if (may_read_archive(name, canonical(*path)))
        read_file(*path);
}

}  // namespace trapeze::rib
