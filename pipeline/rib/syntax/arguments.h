/// The arguments of one request as they stand in the file, and a cursor that takes them as RISpec allows: a
/// fixed number of values with or without brackets, then name and value pairs.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/diagnostics.h"
#include "pipeline/rib/syntax/lexer.h"

namespace trapeze::rib {

/// A number, a string, or an array of either (arrays of both are invalid).
struct Argument {
    /// As the file writes it; whether brackets matter is up to the request (RISpec appendix C.2).
    enum class Kind { Number, String, Array };

    Kind kind = Kind::Number;
    SourceLocation at;
    double number = 0;                 ///< Number
    std::vector<float> floats;         ///< Array
    std::vector<std::string> strings;  ///< Array; String: just one
    /// Elements of `floats` that are integers too large to be floats, by their place.
    std::vector<std::pair<size_t, double>> large_integers;

    bool is_text() const { return kind == Kind::String || !strings.empty(); }
    /// For a string 0, as it has no floats.
    size_t number_count() const { return kind == Kind::Number ? 1 : floats.size(); }
    /// The numbers, moved out.
    std::vector<float> take_numbers();
};

/// The arguments of one request after another: each leaves its memory to one of the next request, of which a
/// scene has millions. Copies are of what there is now.
class ArgumentList {
  public:
    ArgumentList() = default;
    ArgumentList(std::initializer_list<Argument> items) : items_(items), size_(items.size()) {}
    ArgumentList(const ArgumentList& other) : items_(other.begin(), other.end()), size_(other.size_) {}
    ArgumentList(ArgumentList&& other) noexcept
        : items_(std::move(other.items_)), size_(std::exchange(other.size_, 0)) {}
    ArgumentList& operator=(const ArgumentList& other) {
        if (this != &other) *this = ArgumentList(other);
        return *this;
    }
    ArgumentList& operator=(ArgumentList&& other) noexcept {
        items_ = std::move(other.items_), size_ = std::exchange(other.size_, 0);
        return *this;
    }
    ~ArgumentList() = default;

    size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    Argument& operator[](size_t i) { return items_[i]; }
    const Argument& operator[](size_t i) const { return items_[i]; }
    Argument& back() { return items_[size_ - 1]; }
    const Argument& back() const { return items_[size_ - 1]; }
    const Argument& front() const { return items_.front(); }
    Argument* begin() { return items_.data(); }
    Argument* end() { return items_.data() + size_; }
    const Argument* begin() const { return items_.data(); }
    const Argument* end() const { return items_.data() + size_; }

    /// A number, until the caller makes something else of it.
    Argument& emplace_back() {
        if (size_ == items_.size()) {
            ++size_;
            return items_.emplace_back();
        }
        Argument& argument = items_[size_++];
        argument.number = 0;
        if (argument.kind == Argument::Kind::Number) return argument;  // has no more than its number
        argument.kind = Argument::Kind::Number;
        leave_little(argument.floats);
        leave_little(argument.strings);
        leave_little(argument.large_integers);
        return argument;
    }
    void push_back(Argument argument) { emplace_back() = std::move(argument); }
    void clear() { size_ = 0; }

  private:
    /// Empties; keeps the memory of short lists.
    template <class Value>
    static void leave_little(std::vector<Value>& values) {
        constexpr size_t kMostKept = 64;
        if (values.capacity() > kMostKept)
            values = {};
        else
            values.clear();
    }

    std::vector<Argument> items_;  ///< the first `size_` are there, others have memory to give
    size_t size_ = 0;
};

/// A request's name and all that follows up to the next word.
struct RequestText {
    std::string name;
    SourceLocation at;
    ArgumentList arguments;
    std::string problem;  ///< what is wrong with the arguments as text; empty when nothing
    SourceLocation problem_at;

    /// For the next request, which writes its name over the old one; memory is kept.
    void clear() { problem.clear(), arguments.clear(); }
};

/// Words that begin a request. Any other word within brackets is an error there, and not the next request.
using IsRequest = bool (*)(std::string_view word);

/// Reads the next request; false at the end of the text. What stands between requests is reported and passed
/// over.
bool read_request(Lexer& lexer, RequestText& request, IsRequest is_request, Diagnostics& diagnostics);

/// Text from a file as messages show it: in quotes, clipped, one line.
std::string in_quotes(std::string_view text);
/// Text from a file for messages as in_quotes() makes it, but without quotes: for names of requests.
std::string clipped(std::string_view text);

/// Thrown by handlers through the cursor below and caught by the reader of requests: the request is skipped.
struct RequestError {
    std::string text;
    SourceLocation at;  ///< line 0: the request's own place
};

/// Takes the arguments of one request from left to right. All that take throw a RequestError that calls the
/// argument `what`, where it is missing or of another kind; what is taken is moved out of the request.
class ArgumentCursor {
  public:
    explicit ArgumentCursor(RequestText& request) : request_(request) {}

    bool done() const { return next_ >= request_.arguments.size(); }
    /// The argument after `ahead` others, or null.
    const Argument* peek(size_t ahead = 0) const {
        return next_ + ahead < request_.arguments.size() ? &request_.arguments[next_ + ahead] : nullptr;
    }
    /// Kinds of what comes next; all are false at the end. An array is also a number or a string, by its
    /// elements.
    bool next_is_number() const { return !done() && !peek()->is_text(); }
    bool next_is_string() const { return !done() && peek()->is_text(); }
    bool next_is_array() const { return !done() && peek()->kind == Argument::Kind::Array; }

    /// One number, or an array of one.
    float number(const char* what);
    /// A whole number within limits, both included.
    int integer(const char* what, int lowest, int highest);
    /// `count` numbers, as arrays or one by one.
    std::vector<float> numbers(size_t count, const char* what) { return numbers(count, count, what); }
    std::vector<float> numbers(size_t least, size_t most, const char* what);
    /// Numbers and arrays of them until there are `most`, as they come: perhaps fewer, or more.
    std::vector<float> numbers_up_to(size_t most);
    /// One string, or an array of one.
    std::string string(const char* what);
    /// An array of any length; a single number counts as an array of one.
    std::vector<float> number_array(const char* what);
    /// An array of whole numbers of 32 bits, which are exact although arrays are kept as floats.
    std::vector<int> int_array(const char* what);
    /// Strings of any number; an empty array will do.
    std::vector<std::string> string_array(const char* what);
    /// A handle: a string, or an integer as text.
    std::string handle(const char* what);
    /// The next argument, which is there, of whatever kind: to be moved from where it is.
    Argument& take_here() { return request_.arguments[next_++]; }
    /// How many arguments are left.
    size_t left() const { return request_.arguments.size() - std::min(next_, request_.arguments.size()); }
    /// Passes over what is left.
    void skip_rest() { next_ = request_.arguments.size(); }

  private:
    [[noreturn]] void missing(const char* what) const;

    RequestText& request_;
    size_t next_ = 0;
};

}  // namespace trapeze::rib
