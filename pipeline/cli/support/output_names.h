/// The names that `-o` gives to the pictures of one run.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

namespace trapeze {

/// "shot.####.exr", "shot.%04d.exr" and "shot.<frame>.exr" with a frame's number: "shot.0007.exr". A name
/// without these stays as it is.
std::string with_frame_number(const std::string& name, int frame);

class OutputNames {
  public:
    /// As on the command line; empty: there is none.
    explicit OutputNames(std::string output) : output_(std::move(output)) {}

    bool empty() const { return output_.empty(); }
    /// Whether a picture has the name that one of this frame would have first.
    bool is_taken(int frame) const { return taken_.contains(with_frame_number(output_, frame)); }
    /// For the picture that the scene calls `given`: the output's name where no other picture has it, else
    /// one with the frame's number or the next that is free, "shot.2.exr". A picture of nothing keeps no name
    /// from a later one.
    std::string take(const std::string& given, int frame, bool shows_something);
    /// What the picture that the scene calls so was written as, if it was renamed. A map is made of it, so
    /// that it was a pass: a later picture may have its name.
    std::optional<std::string> take_back(const std::string& given);

  private:
    std::string output_;
    std::set<std::string> taken_;
    std::map<std::string, std::string> files_;  ///< by the names that the scene gives
};

}  // namespace trapeze
