/// Requests, one after another, out of files, archives and programs' answers.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "core/files/access.h"
#include "pipeline/rib/reader/conditional_blocks.h"
#include "pipeline/rib/reader/file_search.h"
#include "pipeline/rib/reader/open_files.h"
#include "pipeline/rib/reader/request_report.h"
#include "pipeline/rib/state/ready_archive.h"
#include "pipeline/rib/syntax/arguments.h"

namespace trapeze::rib {

class RequestExecutor;

/// Owns the place in the text, and the archives that are known. Hands each request to the executor; those of
/// an archive in between, where ReadArchive stands. Files that are opened by the files of the command, and
/// inline archives, are kept as requests (ReadyArchive): scenes read the same one thousands of times.
class RequestStream {
  public:
    /// All are kept by reference. `place` follows what is read.
    RequestStream(const ReadOptions& options, const Access& access, RequestReport& report, OpenFiles& files,
                  FileSearch& search, ConditionalBlocks& conditions, ArchivePlace& place,
                  RequestExecutor& executor);

    /// A file of the command, or the one that an archive request has found, with what it may reach.
    void read_file(const std::string& path, const Access& access);
    /// A text that is no file; messages name it `<name>`.
    void read_memory(std::string_view text, const std::string& name);
    /// ReadArchive: an inline archive of the name, else a file.
    void read_archive(const std::string& name);
    /// Whether one more archive or answer may be read, which is said where not: it does not read itself, does
    /// not nest too deeply, and the limits of ReadOptions hold. `key`: the name it has among the open files;
    /// empty: one that may read itself.
    bool may_read_archive(const std::string& name, const std::string& key);
    /// Reads a text whose first character stands at `first`; who calls has opened it (OpenFiles). `names`:
    /// codes that were defined before it. `ready`: keeps the requests for the next time; null when it is no
    /// archive.
    void read_text(std::string_view text, SourceLocation first, EncodedNames names = {},
                   ReadyArchive* ready = nullptr);

  private:
    /// ArchiveBegin and ArchiveEnd: the text in between, which is carried out whenever the archive is read.
    struct InlineArchive {
        std::shared_ptr<const std::string> text;
        SourceLocation first;  ///< the place of its first character
        EncodedNames names;    ///< what was defined before it
        std::shared_ptr<ReadyArchive> ready;
    };
    /// A file that changes while it is read, as one that a program writes, has another stamp, and is read
    /// afresh.
    struct KnownFile {
        FileStamp stamp;
        std::shared_ptr<ReadyArchive> ready;
    };

    void read_inline_archive(InlineArchive& archive, const std::string& key);
    void read_again(ReadyArchive& ready, uint32_t source);
    template <class Read>
    void in_stream(ReadyArchive* ready, Read&& read);
    bool reads_next(Lexer& lexer, RequestText& request, ReadyArchive* ready);
    std::shared_ptr<ReadyArchive> ready_archive(const std::string& path);
    void record_archive(RequestText& request, Lexer& lexer, std::string_view text);

    const ReadOptions& read_options_;
    const Access& access_;
    RequestReport& report_;
    OpenFiles& files_;
    FileSearch& search_;
    ConditionalBlocks& conditions_;
    ArchivePlace& place_;
    RequestExecutor& executor_;

    std::map<std::string, InlineArchive> inline_archives_;  ///< by name
    std::map<std::string, KnownFile> known_files_;          ///< archives, by path
    uint64_t ready_bytes_left_;                             ///< of what archives that are read again may take
    uint64_t archives_read_ = 0;                            ///< how often any was
};

}  // namespace trapeze::rib
