/// What a scene may reach on the machine that renders it: the one place that decides.
///
/// By default all that the user may. Confined, for scenes from strangers: files are read below the working
/// folder, the scene's and those that the user has named, and written below the working folder or where the
/// user has said; links count as what they lead to; nothing is known of the environment. In either case a
/// scene overwrites nothing but pictures and point clouds.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/files/read_names.h"

namespace trapeze {

/// The permissions of one run: a value that is copied to whoever opens files; nothing is global.
class Access {
  public:
    /// Allows everything.
    Access() = default;
    /// Allows what is below the working folder alone; if that is the root of all folders, nothing.
    static Access confined();

    bool is_confined() const { return confined_; }
    bool may_see_environment() const { return !confined_; }

    /// Allows in addition what the user, and not the scene, has named.
    void allow_reading_below(const std::string& folder);
    void allow_writing(const std::string& file);

    /// Whether a file of this name may be read, be it there or not.
    bool may_read(const std::string& path) const;
    /// Whether the path is a regular file that may be read.
    bool has_file(const std::string& path) const;
    /// Whether a name that starts from a folder was not even looked for, because files there may not be read;
    /// kClosed says so in messages.
    bool is_closed(const std::string& name, const std::string& folder = {}) const;
    static constexpr const char* kClosed = "lies outside of the folders that are open to scenes (--safe)";
    /// Opens a file to read. A confined run opens only a regular file that may be read, and asks this of what
    /// has been opened, so that no link can be put in its place between. Null, with errno set, when there is
    /// none.
    std::FILE* open_to_read(const std::string& path) const;
    /// Whoever opens a file by other means than this class says so, for record_reads().
    void note_read(const std::string& path) const {
        if (reads_) reads_->add(path);
    }
    /// From now on the names of files that have been opened to read, also by copies of this, are added to
    /// `reads`.
    void record_reads(std::shared_ptr<ReadNames> reads) { reads_ = std::move(reads); }
    /// Reads a whole file; false where there is none or it has more than `most_bytes`.
    bool read(const std::string& path, size_t most_bytes, std::string* bytes) const;

    /// Whether, and by which path, a file may be written.
    struct Writing {
        std::string problem;        ///< why it may not be written; empty: it may
        std::string path;           ///< under which to open it
        bool is_elsewhere = false;  ///< outside of the working folder, without the user having said so
    };
    Writing may_write(const std::string& path) const;

  private:
    std::FILE* open_confined(const std::string& path) const;

    bool confined_ = false;             ///< all paths below are without links and dots
    std::string working_folder_;        ///< empty: none
    std::vector<std::string> folders_;  ///< to read below
    std::vector<std::string> files_;    ///< to write
    std::shared_ptr<ReadNames> reads_;  ///< null: nobody asks
};

/// The permissions of whoever is not confined.
inline const Access kEverything;

}  // namespace trapeze
