/// The names that `-o` gives to the pictures of one run.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

namespace trapeze {

/// A name with a frame's number put in: "shot.####.exr", "shot.%04d.exr" and "shot.<frame>.exr" become
/// "shot.0007.exr". Other names stay as they are.
std::string with_frame_number(const std::string& name, int frame);

/// Gives each picture of a run its own name, and remembers which.
class OutputNames {
  public:
    /// `output` is as on the command line; empty: there is none.
    explicit OutputNames(std::string output) : output_(std::move(output)) {}

    bool empty() const { return output_.empty(); }
    /// Whether some picture already has the name that a picture of this frame would be given first.
    bool is_taken(int frame) const { return taken_.contains(with_frame_number(output_, frame)); }
    /// The name for the picture that the scene calls `given`: the output's where no other picture has it,
    /// else one with the frame's number or the next number that is free, "shot.2.exr".
    std::string take(const std::string& given, int frame);
    /// Gives a name back: what the picture that the scene calls `given` was written as, if it was renamed. A
    /// later picture may have the name: nothing is seen in this one, or a map is made of it, so that it was
    /// only a pass.
    std::optional<std::string> take_back(const std::string& given);
    /// There is a file of this name now: whatever the scene called so is written as something else.
    void forget(const std::string& given);

  private:
    std::string output_;
    std::set<std::string> taken_;
    std::map<std::string, std::string> files_;  ///< written names, by those that the scene gives
};

}  // namespace trapeze
