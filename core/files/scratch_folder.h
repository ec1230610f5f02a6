/// A folder for files that nobody has asked for.
#pragma once

#include <set>
#include <string>

namespace trapeze {

/// A folder of its own where the system has temporary files. It goes away with the object, or with
/// OutputFile::remove_partials().
class ScratchFolder {
  public:
    ScratchFolder() = default;
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    /// A path in the folder for a file that is to be written, with an ending like ".exr". Empty when the
    /// folder cannot be made.
    std::string new_file(const std::string& ending);
    /// Removes a file of new_file().
    void remove(const std::string& file);
    const std::string& path() const { return path_; }  ///< empty: there was no file yet

  private:
    bool make();

    std::string path_;
    std::set<std::string> files_;
    int count_ = 0;
};

}  // namespace trapeze
