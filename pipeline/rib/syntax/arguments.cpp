/// Requests as text: what stands between one request's name and the next. A mistake in the text is noted with
/// the request, which is skipped as a whole by its executor; the next request is not lost with it.
#include "pipeline/rib/syntax/arguments.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace trapeze::rib {
namespace {

/// Integers beyond it are kept as doubles too: indices and handles must not be rounded.
constexpr double kLargestExactFloatInteger = 1 << 24;
constexpr size_t kMostArguments = 100000;  ///< of one request; arrays count once
/// Characters of a file that a message shows.
constexpr size_t kLongestShown = 100;
/// Infinite or not a number, also by rounding to float.
constexpr const char* kNotFinite = "a value is not a finite number";

/// Keeps the first problem of a request: what follows is mostly its consequence.
void note_problem(RequestText& request, SourceLocation at, std::string text) {
    if (!request.problem.empty()) return;
    request.problem = std::move(text);
    request.problem_at = at;
}

/// Rounds each number once: the lexer has seen to that (read_number).
void append_numbers(Argument& array, std::span<const double> values) {
    float floats[Lexer::kNumbersAtOnce];
    for (size_t i = 0; i < values.size(); ++i) {
        const double value = values[i];
        if (std::abs(value) > kLargestExactFloatInteger && value == std::trunc(value)) [[unlikely]]
            array.large_integers.push_back({array.floats.size() + i, value});
        floats[i] = static_cast<float>(value);
    }
    // A short array takes just what it needs.
    array.floats.insert(array.floats.end(), floats, floats + values.size());
}

constexpr size_t kMostStringBytes = size_t{1} << 26;  ///< of an array of strings, which codes can make short

/// The floats of an encoded array, as they are.
void append_encoded(RequestText& request, const Token& token, Argument& array) {
    if (!append_floats(token.text, array.floats)) note_problem(request, token.at, kNotFinite);
}

/// The elements of an array up to its end, or to the request that stands where the end should be. The first
/// mistake is kept and the rest read past, up to the bracket: messages are one for a request.
void read_array(Lexer& lexer, Argument& array, RequestText& request, IsRequest is_request) {
    array.kind = Argument::Kind::Array;
    array.at = lexer.peek().at;
    lexer.skip();
    // Codes of strings make a few bytes of a file stand for thousands.
    size_t string_bytes = 0;
    bool closed = false;
    while (!closed) {
        const Token& token = lexer.peek();
        const SourceLocation at = token.at;
        switch (token.kind) {
            case TokenKind::Number:
                if (const SourceLocation bad =
                        lexer.scan_numbers([&](auto values) { append_numbers(array, values); });
                    bad.line > 0)
                    note_problem(request, bad, kNotFinite);
                continue;  // the lexer stands at what ended the numbers
            case TokenKind::String:
                string_bytes += token.string.size();
                if (string_bytes <= kMostStringBytes)
                    array.strings.push_back(token.string);
                else
                    note_problem(request, array.at,
                                 "an array of strings that are too long in all, more than " +
                                     std::to_string(kMostStringBytes >> 20) + " MiB");
                break;
            case TokenKind::Close:
                closed = true;
                break;
            case TokenKind::Word:
                if (is_request(token.text)) {
                    note_problem(request, array.at, "the array that begins here is never closed");
                    return;
                }
                note_problem(request, at, in_quotes(token.text) + " stands within an array");
                break;
            case TokenKind::End:
                note_problem(request, array.at, "the array that begins here is never closed");
                return;
            case TokenKind::Open:
                note_problem(request, at, "an array within an array");
                break;
            case TokenKind::Bad:
                note_problem(request, at, std::string(token.text));
                break;
            case TokenKind::Floats:
                append_encoded(request, token, array);
                break;
        }
        lexer.skip();
    }
    if (!array.floats.empty() && !array.strings.empty())
        note_problem(request, array.at, "an array holds both numbers and strings");
}

/// Passes over what stands before a request; false at the end of the text. One message for all that is passed
/// over: stray text mostly comes in runs.
bool find_request_name(Lexer& lexer, Diagnostics& diagnostics) {
    for (bool reported = false;; lexer.skip()) {
        const Token& token = lexer.peek();
        if (token.kind == TokenKind::End) return false;
        if (token.kind == TokenKind::Word) return true;
        if (reported) continue;
        reported = true;
        diagnostics.error(token.at, "a request is expected here; skipped to the next one",
                          "request-expected");
    }
}

/// Where the last argument begins, or the request.
uint32_t last_line(const RequestText& request) {
    return request.arguments.empty() ? request.at.line : request.arguments.back().at.line;
}

}  // namespace

/// Control characters are replaced: a file must not write escape sequences to the terminal of who reads it.
std::string clipped(std::string_view text) {
    std::string shown(text.substr(0, kLongestShown));
    for (char& c : shown)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    return text.size() > kLongestShown ? shown + "..." : shown;
}

std::string in_quotes(std::string_view text) {
    return '"' + clipped(text) + '"';
}

std::vector<float> Argument::take_numbers() {
    if (kind == Kind::Number) return {static_cast<float>(number)};
    return std::move(floats);
}

/// A loop over tokens up to the next word outside of brackets. It is one function as its cases are one table:
/// a token kind each.
bool read_request(Lexer& lexer, RequestText& request, IsRequest is_request, Diagnostics& diagnostics) {
    request.clear();
    if (!find_request_name(lexer, diagnostics)) return false;
    request.name.clear();
    request.name.append(lexer.peek().text);
    request.at = lexer.peek().at;
    lexer.skip();
    while (true) {
        const Token& token = lexer.peek();
        if (request.arguments.size() > kMostArguments) {
            note_problem(request, token.at, "more than " + std::to_string(kMostArguments) + " arguments");
            request.arguments.clear();
        }
        switch (token.kind) {
            case TokenKind::End:
            case TokenKind::Word:
                return true;
            case TokenKind::Open:
                read_array(lexer, request.arguments.emplace_back(), request, is_request);
                continue;
            case TokenKind::Number: {
                if (!std::isfinite(token.number)) note_problem(request, token.at, kNotFinite);
                Argument& argument = request.arguments.emplace_back();
                argument.at = token.at, argument.number = token.number;
                break;
            }
            case TokenKind::String: {
                Argument& argument = request.arguments.emplace_back();
                argument.kind = Argument::Kind::String, argument.at = token.at;
                argument.strings.push_back(token.string);
                break;
            }
            case TokenKind::Close:
                note_problem(request, token.at, "a ] without its [");
                break;
            case TokenKind::Bad:
                // What stands on a line of its own is none of the request's.
                if (token.text == kStrayCharacters && token.at.line > last_line(request)) {
                    diagnostics.error(token.at, std::string(token.text) + "; skipped", "stray-characters");
                    lexer.skip();
                    return true;
                }
                note_problem(request, token.at, std::string(token.text));
                break;
            case TokenKind::Floats: {
                Argument& argument = request.arguments.emplace_back();
                argument.kind = Argument::Kind::Array, argument.at = token.at;
                append_encoded(request, token, argument);
                break;
            }
        }
        lexer.skip();
    }
}

/// Two texts: at the end of the request something is missing, elsewhere something else stands in its place.
void ArgumentCursor::missing(const char* what) const {
    if (done()) throw RequestError{std::string(what) + " is missing", {}};
    throw RequestError{std::string(what) + " is expected here", peek()->at};
}

float ArgumentCursor::number(const char* what) {
    if (!next_is_number() || peek()->number_count() != 1) missing(what);
    return request_.arguments[next_++].take_numbers()[0];
}

/// The limits are those that the caller can work with, and are said where they do not hold. A float that is
/// whole will do: RIB has one kind of numbers in its text.
int ArgumentCursor::integer(const char* what, int lowest, int highest) {
    const SourceLocation at = done() ? SourceLocation{} : peek()->at;
    const std::vector<int> values = int_array(what);
    if (values.size() != 1) throw RequestError{std::string(what) + " is expected here", at};
    if (values[0] < lowest || values[0] > highest)
        throw RequestError{std::string(what) + " is " + std::to_string(values[0]) + ", must be " +
                               std::to_string(lowest) + " to " + std::to_string(highest),
                           at};
    return values[0];
}

/// RISpec's appendix C.2 lets a fixed number of values stand with brackets or without; files also mix the
/// two.
std::vector<float> ArgumentCursor::numbers(size_t least, size_t most, const char* what) {
    if (!next_is_number()) missing(what);
    const SourceLocation at = peek()->at;
    std::vector<float> values = numbers_up_to(most);
    if (values.size() < least || values.size() > most)
        throw RequestError{std::string(what) + " has " + std::to_string(values.size()) + " numbers, needs " +
                               std::to_string(most),
                           at};
    return values;
}

/// Bare numbers take memory once. The first array's memory is taken over, as mostly it holds all of the
/// numbers.
std::vector<float> ArgumentCursor::numbers_up_to(size_t most) {
    std::vector<float> values;
    if (next_is_number() && peek()->kind == Argument::Kind::Number)
        values.reserve(std::min(most, request_.arguments.size() - next_));
    const size_t count = request_.arguments.size();
    for (; values.size() < most && next_ < count; ++next_) {
        Argument& argument = request_.arguments[next_];
        if (argument.kind == Argument::Kind::Number)
            values.push_back(static_cast<float>(argument.number));
        else if (argument.is_text())
            break;
        else if (values.empty())
            values = std::move(argument.floats);
        else
            values.insert(values.end(), argument.floats.begin(), argument.floats.end());
    }
    return values;
}

/// Moved out, like all that is taken: a request is carried out once, and what is read again is copied first.
std::string ArgumentCursor::string(const char* what) {
    if (!next_is_string() || peek()->strings.size() != 1) missing(what);
    return std::move(request_.arguments[next_++].strings[0]);
}

std::vector<float> ArgumentCursor::number_array(const char* what) {
    if (!next_is_number()) missing(what);
    return request_.arguments[next_++].take_numbers();
}

/// Integers are floats in RIB until here: those beyond 2^24 are looked up where they were kept.
std::vector<int> ArgumentCursor::int_array(const char* what) {
    if (!next_is_number()) missing(what);
    const Argument& argument = request_.arguments[next_++];
    const auto whole = [&](double value) {
        if (value < INT32_MIN || value > INT32_MAX || value != std::trunc(value))
            throw RequestError{std::string(what) + " holds a number that is no integer of 32 bits",
                               argument.at};
        return static_cast<int>(value);
    };
    if (argument.kind == Argument::Kind::Number) return {whole(argument.number)};
    std::vector<int> ints(argument.floats.size());
    size_t large = 0;
    for (size_t i = 0; i < ints.size(); ++i) {
        const bool is_large =
            large < argument.large_integers.size() && argument.large_integers[large].first == i;
        ints[i] = whole(is_large ? argument.large_integers[large++].second : argument.floats[i]);
    }
    return ints;
}

/// An empty array is one of strings, as it is one of numbers.
std::vector<std::string> ArgumentCursor::string_array(const char* what) {
    if (done() || (!peek()->is_text() && peek()->number_count() > 0)) missing(what);
    return std::move(request_.arguments[next_++].strings);
}

/// Handles of lights and objects are integers in RISpec 3.2, strings in later versions; both name the same
/// thing when they print alike.
std::string ArgumentCursor::handle(const char* what) {
    if (next_is_string()) return string(what);
    return std::to_string(integer(what, INT32_MIN, INT32_MAX));
}

}  // namespace trapeze::rib
