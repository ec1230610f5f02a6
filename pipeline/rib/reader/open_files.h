/// The files and texts that are being read, each named by the one before it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trapeze::rib {

/// A stack: archives in archives, and answers of programs. What is no file is named in angle brackets
/// ("<archive leaf>"), standard input is "-".
class OpenFiles {
  public:
    /// Opens one until the end of the scope.
    class Entry {
      public:
        Entry(OpenFiles& files, std::string name) : files_(files) { files.names_.push_back(std::move(name)); }
        /// Entries end in the reverse order of their making, as scopes do: the last name is always this
        /// one's.
        ~Entry() { files_.names_.pop_back(); }
        Entry(const Entry&) = delete;
        Entry& operator=(const Entry&) = delete;

      private:
        OpenFiles& files_;
    };

    const std::vector<std::string>& names() const { return names_; }
    size_t depth() const { return names_.size(); }

    /// The innermost that is a file on disk; may be empty.
    std::string current_file() const;
    /// The folder of that file, where names in it are looked for first. Empty when it is the working folder.
    std::string current_folder() const;

    /// A world is opened by what is read now.
    void begin_world() { world_depth_ = depth(); }
    /// What is read now is named by the file that opened the last world, or by one that it names: it may be a
    /// whole scene of its own, options and all.
    bool are_below_world() const { return depth() > world_depth_; }

  private:
    std::vector<std::string> names_;
    size_t world_depth_ = 0;
};

}  // namespace trapeze::rib
