/// An animated scene of an AFF file, as those of BART: its triangles and its camera at any time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/study/aff/aff_contents.h"

namespace trapeze {

class AffScene {
  public:
    /// Empty, with *problem = "file:line: error: what", where it cannot be read.
    static std::optional<AffScene> read(const std::string& path, std::string* problem);

    /// Of an animation's frames, as the file has it: frames are (last - first) / (count - 1) apart. Both 0,
    /// and one frame, where it has no such line.
    double first_time() const { return contents_.first_time; }
    double last_time() const { return contents_.last_time; }
    int frame_count() const { return contents_.frames; }

    /// Where keyframes of the name "camera" translate, `from` is the translation; where they rotate, the view
    /// is along the rotated negative z-axis with the rotated y-axis upwards. Their scale is not looked at. A
    /// file without a view has AffCamera's own.
    AffCamera camera_at(double time) const;

    /// Corners of all triangles, three each, in world space, the same triangles in the same order at all
    /// times. What is invisible at a time is where it was at the nearest time at which it is visible. Corners
    /// that are too far away for floats are at 0 0 0.
    std::vector<V3f> triangles_at(double time) const;

    /// Of each triangle whether it is in a transform, at any depth, that keyframes translate, rotate or
    /// scale, or has keys itself, two or more. Keys may all say the same.
    std::vector<bool> moving() const;

  private:
    AffContents contents_;
};

}  // namespace trapeze
