/// A file that appears whole or not at all: written under a temporary name in the folder of its target, then
/// renamed [decision 0025].
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "core/diagnostics.h"
#include "core/files/access.h"

namespace trapeze {

/// The file while it is written. Every failure leaves a reason in error() and nothing on the disk; so does
/// destruction before commit().
class OutputFile {
  public:
    explicit OutputFile(std::string target) : target_(std::move(target)) {}
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// Makes the temporary file. This and the functions below return false, with a reason, when they fail.
    bool open();
    bool write(const void* bytes, size_t count);
    bool seek(uint64_t position);
    uint64_t position() const { return position_; }
    /// Puts all on the disk and renames. Fails when anything before has failed.
    bool commit();

    /// Why the file failed, without its name; empty if it did not.
    const std::string& error() const { return error_; }

    /// Removes the temporary files of all OutputFiles of the process: for a process about to be ended by a
    /// signal. Thread-safe; their commit() fails from then on.
    static void remove_partials();
    /// Removes what processes that are no more, as they were killed, have left of writing a file: those that
    /// write hold a lock.
    static void remove_leftovers(const std::string& target);
    /// Lets remove_partials() remove a file or folder that is not to stay, too.
    static void remove_at_the_end(const std::string& path);
    /// Removes it now.
    static void remove(const std::string& path);

  private:
    bool fail(std::string reason);
    bool fail_with_errno();
    bool find_place(std::string& folder, std::string& name);

    std::string target_;   ///< symbolic links resolved by open()
    std::string partial_;  ///< empty unless it is on the disk
    std::FILE* file_ = nullptr;
    uint64_t position_ = 0;
    std::string error_;
};

/// Where a file that a scene names is to be written, and under which name the scene knows it.
struct OutputPlace {
    std::string name;     ///< as messages and later readers have it
    std::string path;     ///< to open
    std::string problem;  ///< why it may not be written; empty: it may
};

/// The place for a file that a scene names. It is where the name says, and the folders below the working
/// folder that it names are made: scenes come from where they were made by hand. Another folder that is not
/// here was another machine's: what belongs there goes into the working folder, where other_names() finds it,
/// with a warning. A message says what is written outside of the working folder.
OutputPlace place_to_write(const std::string& name, const Access& access, SourceLocation asked_at,
                           Diagnostics& diagnostics);

}  // namespace trapeze
