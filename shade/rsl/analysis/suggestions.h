/// Names that a misspelt one may have meant.
#pragma once

#include <string>
#include <string_view>

namespace trapeze::rsl {

/// Takes candidates one by one and keeps the nearest that is near enough. It only ever changes the text of a
/// message; what the source means is never guessed.
class Suggestion {
  public:
    explicit Suggestion(std::string_view written);
    /// Candidates are views: they must live until text() is called.
    void consider(std::string_view candidate);
    /// " (did you mean \"Kd\"?)", or nothing.
    std::string text() const;

  private:
    static constexpr int kMostConsidered = 1000;  ///< distances worked out for one name

    std::string_view written_, best_;
    /// Twice the number of changes, as distance() in the .cpp counts.
    size_t least_;  // the distance that is too far
    int considered_ = 0;
};

}  // namespace trapeze::rsl
