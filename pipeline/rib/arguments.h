/// The arguments of one request as they stand in the file, and a cursor that takes them as RISpec allows: a
/// fixed number of values with or without brackets, then name and value pairs.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "pipeline/rib/scanner.h"

namespace trapeze::rib {

/// A number, a string, or an array of either (arrays of both are invalid).
struct Argument {
    enum class Kind { Number, String, Array };

    Kind kind = Kind::Number;
    SourceLocation at;
    std::vector<float> numbers;
    std::vector<std::string> strings;

    bool is_text() const { return !strings.empty(); }
};

/// A request's name and all that follows up to the next word.
struct RequestText {
    std::string name;
    SourceLocation at;
    std::vector<Argument> arguments;
    std::string problem;  ///< what is wrong with the arguments as text; empty when nothing
    SourceLocation problem_at;
};

/// Reads the next request; false at the end of the text. Stray tokens before it are reported through `stray`.
bool read_request(Scanner& scanner, RequestText& request, Diagnostics& diagnostics);

/// Thrown by handlers through the cursor below and caught by the reader of requests: the request is skipped.
struct RequestError {
    std::string text;
    SourceLocation at;  ///< line 0: the request's own place
};

class ArgumentCursor {
  public:
    explicit ArgumentCursor(RequestText& request) : request_(request) {}

    bool done() const { return next_ >= request_.arguments.size(); }
    const Argument* peek() const { return done() ? nullptr : &request_.arguments[next_]; }

    float number(const char* what);
    /// `count` numbers, as one array or one by one.
    std::vector<float> numbers(size_t count, const char* what);
    std::string string(const char* what);
    /// An array of any length; a single number counts as an array of one.
    std::vector<float> number_array(const char* what);
    std::vector<int> int_array(const char* what);
    std::vector<std::string> string_array(const char* what);
    /// A handle: a string, or an integer as text.
    std::string handle(const char* what);
    Argument take(const char* what);
    bool next_is_number() const {
        return !done() && !peek()->is_text() && peek()->kind != Argument::Kind::String;
    }
    bool next_is_string() const {
        return !done() && (peek()->kind == Argument::Kind::String || peek()->is_text());
    }

  private:
    [[noreturn]] void missing(const char* what) const;

    RequestText& request_;
    size_t next_ = 0;
};

}  // namespace trapeze::rib
