/// The words of an AFF file, one after the other, and what is wrong with it. Words are split at blanks,
/// braces are words of their own, and # or % at the beginning of a word makes the rest of its line a comment.
#pragma once

#include <string>
#include <string_view>

#include "core/math.h"

namespace trapeze {

class AffWords {
  public:
    /// `name`, of the file, stands in messages. `text` and `problem` are kept by the caller; `problem` is one
    /// for all files of a scene.
    AffWords(std::string name, std::string_view text, std::string& problem)
        : name_(std::move(name)), rest_(text), problem_(problem) {}

    const std::string& name() const { return name_; }
    /// The line of the word taken last, from 1.
    int line() const { return word_line_; }

    /// Says "name:line: error: what", unless something has been wrong before. From then on no file of the
    /// scene has words: all that is read is 0 or empty.
    void fail(const std::string& what);
    /// The same with a word of the file, or a name, shortened and in quotes after it.
    void fail_on(const std::string& what, std::string_view word);
    bool failed() const { return !problem_.empty(); }
    bool at_end() { return peek().empty(); }
    /// The word that comes next; empty at the end.
    std::string_view peek();

    /// These take a word, and fail where it is not what it should be; `what` says what that is.
    std::string_view word(const char* what);
    void expect(std::string_view word);
    int integer(const char* what, int least, int most);
    /// Up to 1e18 in size, so that squares are still floats.
    double number(const char* what);
    V3d vector(const char* what);
    /// Takes numbers that nobody needs.
    void skip_numbers(int count, const char* what);

  private:
    std::string name_;
    std::string_view rest_;  ///< what has not been taken
    int line_ = 1;           ///< where rest_ begins
    int word_line_ = 1;
    std::string& problem_;
};

}  // namespace trapeze
