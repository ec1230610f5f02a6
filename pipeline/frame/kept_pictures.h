/// Pictures that one run has written. A later one of the same name takes its place, and the earlier one is
/// kept under a name with its frame's number, so that none is lost.
#pragma once

#include <map>
#include <string>

#include "core/diagnostics.h"

namespace trapeze {

/// The pictures of one run by path, with the frame that wrote each.
class KeptPictures {
  public:
    explicit KeptPictures(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    /// Makes way for a file that is about to be written: a picture of an earlier frame there, "shot.exr" of
    /// frame 3, becomes "shot.3.exr", and a message says so.
    void make_way(const std::string& path, SourceLocation location);
    /// Notes that a picture has been written. Frame 0: the file has no frames.
    void wrote(const std::string& path, int frame);
    /// Drops a picture that nobody would miss: a map has been made of it, or it is to be replaced.
    void forget(const std::string& path);

    /// The frames by path; and puts back those that an earlier run had.
    const std::map<std::string, int>& frames() const { return frames_; }
    void set_frames(std::map<std::string, int> frames) { frames_ = std::move(frames); }

  private:
    Diagnostics& diagnostics_;
    std::map<std::string, int> frames_;  ///< by path
};

/// A name with a frame's number before its ending: "shot.exr" and 3 give "shot.3.exr".
std::string numbered(const std::string& name, int number);

}  // namespace trapeze
