/// Pictures that one run has written. A later one of the same name takes its place, and the earlier one is
/// kept under a name with its frame's number, so that none is lost.
#pragma once

#include <map>
#include <string>

#include "core/diagnostics.h"

namespace trapeze {

class KeptPictures {
  public:
    explicit KeptPictures(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    /// A file is about to be written. One of an earlier frame there, "shot.exr" of frame 3, becomes
    /// "shot.3.exr", which is said.
    void make_way(const std::string& path, SourceLocation location);
    /// It has been written. Frame 0: there are no frames.
    void wrote(const std::string& path, int frame);
    /// Nobody misses it: a map has been made of it, or it is to be replaced.
    void forget(const std::string& path);

  private:
    Diagnostics& diagnostics_;
    std::map<std::string, int> frames_;  ///< by path
};

/// "shot.exr" and 3: "shot.3.exr".
std::string numbered(const std::string& name, int number);

}  // namespace trapeze
