/// Archives that are read again: their text is taken apart once, and the shapes that are the same each time
/// are there once. All else happens anew, as it would when the text was read again: what requests do depends
/// on where they are read.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/shapes.h"
#include "pipeline/rib/syntax/arguments.h"

namespace trapeze::rib {

/// A file's identity and state: the same stamp means the same text as before.
struct FileStamp {
    uint64_t device = 0, number = 0, size = 0;
    int64_t seconds = 0, nanoseconds = 0;  ///< of the last change

    bool operator==(const FileStamp&) const = default;
};
/// Stamps of regular files; nothing for pipes and the like, which are read as they come.
std::optional<FileStamp> stamp_of(const std::string& path);

/// A text's requests, in its order, while and after it is read for the first time.
class ReadyArchive {
  public:
    /// What it takes comes out of `bytes_left`, which all archives of a reader share.
    explicit ReadyArchive(uint64_t* bytes_left) : bytes_left_(bytes_left) {}
    ~ReadyArchive() { *bytes_left_ += taken_; }
    ReadyArchive(const ReadyArchive&) = delete;
    ReadyArchive& operator=(const ReadyArchive&) = delete;

    /// To be called while the text is read for the first time, in its order; without effect after give_up().
    void add(const RequestText& request);
    /// What was added was all of a text of so many bytes.
    void complete(uint64_t text_bytes) { is_complete_ = !is_given_up_, text_bytes_ = text_bytes; }
    /// The text has to be read as text each time.
    void give_up();
    bool is_given_up() const { return is_given_up_; }
    /// Then its requests stand for the text, which need not be read again.
    bool is_complete() const { return is_complete_; }

    uint64_t text_bytes() const { return text_bytes_; }
    size_t size() const { return requests_.size(); }
    const std::string& name(size_t request) const { return requests_[request].name; }
    /// Copies into `request`, whose memory serves again; places are those of `source`.
    void copy(size_t index, uint32_t source, RequestText& request) const;

    /// The `ordinal`-th shape of request `index`: that of an earlier time where it is there still and the
    /// same, else the one given, for later times. Whether it was there.
    bool share(size_t index, size_t ordinal, std::shared_ptr<const Shape>& shape);

  private:
    /// A request as it was read the first time, whose source its places still have (see copy()), and the
    /// shapes that it made, by their order.
    struct Known {
        std::string name;
        SourceLocation at;
        ArgumentList arguments;
        std::string problem;
        SourceLocation problem_at;
        std::vector<std::weak_ptr<const Shape>> shapes;
    };

    std::vector<Known> requests_;
    uint64_t text_bytes_ = 0, taken_ = 0;
    uint64_t* bytes_left_;
    bool is_complete_ = false, is_given_up_ = false;
};

/// Where a stream of requests stands in the archive that it is read from.
struct ArchivePlace {
    ReadyArchive* archive = nullptr;  ///< null: what is read is no archive, and is read once
    size_t request = 0;               ///< that which is being carried out
    size_t shapes = 0;                ///< how many it has made so far

    /// ReadyArchive::share() for the next shape of the request; false outside of archives.
    bool share(std::shared_ptr<const Shape>& shape) {
        return archive && archive->share(request, shapes++, shape);
    }
};

}  // namespace trapeze::rib
