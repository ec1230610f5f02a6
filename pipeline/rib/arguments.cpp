#include "pipeline/rib/arguments.h"

namespace trapeze::rib {
namespace {

void note_problem(RequestText& request, SourceLocation at, std::string text) {
    if (!request.problem.empty()) return;
    request.problem = std::move(text);
    request.problem_at = at;
}

void read_array(Scanner& scanner, Argument& array, RequestText& request) {
    array.kind = Argument::Kind::Array;
    array.at = scanner.peek().at;
    scanner.skip();
    while (true) {
        const Token& token = scanner.peek();
        switch (token.kind) {
            case TokenKind::Number: {
                const SourceLocation at = token.at;
                if (!scanner.scan_numbers([&](double v) { array.numbers.push_back(static_cast<float>(v)); }))
                    note_problem(request, at, "a value is not a finite number");
                break;
            }
            case TokenKind::String:
                array.strings.push_back(token.string);
                scanner.skip();
                break;
            case TokenKind::Close:
            case TokenKind::End:
            case TokenKind::Word:
                if (token.kind == TokenKind::Close)
                    scanner.skip();
                else
                    note_problem(request, array.at, "the array that begins here is never closed");
                if (!array.numbers.empty() && !array.strings.empty())
                    note_problem(request, array.at, "an array holds both numbers and strings");
                return;
            case TokenKind::Open:
            case TokenKind::Bad:
                note_problem(request, token.at,
                             token.kind == TokenKind::Open ? "an array within an array"
                                                           : "characters that RIB does not have");
                scanner.skip();
                break;
        }
    }
}

bool is_binary(const Token& token) {
    return token.kind == TokenKind::Bad && static_cast<unsigned char>(token.text[0]) >= 0x80;
}

void report_binary(const Token& token, Diagnostics& diagnostics) {
    diagnostics.error(token.at, "binary RIB is not supported; the encoded bytes are skipped", "binary-rib");
}

}  // namespace

bool read_request(Scanner& scanner, RequestText& request, Diagnostics& diagnostics) {
    request = {};
    bool stray_reported = false;
    for (;; scanner.skip()) {
        const Token& token = scanner.peek();
        if (token.kind == TokenKind::End) return false;
        if (token.kind == TokenKind::Word) break;
        if (!stray_reported) {
            if (is_binary(token))
                report_binary(token, diagnostics);
            else
                diagnostics.error(token.at, "a request is expected here; skipped to the next one");
            stray_reported = true;
        }
    }
    request.name = scanner.peek().text;
    request.at = scanner.peek().at;
    scanner.skip();
    while (true) {
        const Token& token = scanner.peek();
        switch (token.kind) {
            case TokenKind::End:
            case TokenKind::Word:
                return true;
            case TokenKind::Number: {
                if (!(token.number - token.number == 0))
                    note_problem(request, token.at, "a value is not a finite number");
                request.arguments.push_back(
                    {Argument::Kind::Number, token.at, {static_cast<float>(token.number)}, {}});
                scanner.skip();
                break;
            }
            case TokenKind::String:
                request.arguments.push_back({Argument::Kind::String, token.at, {}, {token.string}});
                scanner.skip();
                break;
            case TokenKind::Open:
                request.arguments.emplace_back();
                read_array(scanner, request.arguments.back(), request);
                break;
            case TokenKind::Close:
                note_problem(request, token.at, "a ] without its [");
                scanner.skip();
                break;
            case TokenKind::Bad:
                if (is_binary(token))
                    report_binary(token, diagnostics);
                else
                    note_problem(request, token.at,
                                 token.text == "\"" ? "a string that is never closed"
                                                    : "characters that RIB does not have");
                scanner.skip();
                break;
        }
    }
}

void ArgumentCursor::missing(const char* what) const {
    if (done()) throw RequestError{std::string(what) + " is missing", {}};
    throw RequestError{std::string(what) + " is expected here", peek()->at};
}

float ArgumentCursor::number(const char* what) {
    if (!next_is_number() || peek()->numbers.size() != 1) missing(what);
    return request_.arguments[next_++].numbers[0];
}

std::vector<float> ArgumentCursor::numbers(size_t count, const char* what) {
    if (!next_is_number()) missing(what);
    if (peek()->kind == Argument::Kind::Array) {
        if (peek()->numbers.size() != count)
            throw RequestError{std::string(what) + " has " + std::to_string(peek()->numbers.size()) +
                                   " numbers, needs " + std::to_string(count),
                               peek()->at};
        return std::move(request_.arguments[next_++].numbers);
    }
    std::vector<float> values;
    while (values.size() < count && !done() && peek()->kind == Argument::Kind::Number)
        values.push_back(request_.arguments[next_++].numbers[0]);
    if (values.size() != count)
        throw RequestError{std::string(what) + " has " + std::to_string(values.size()) + " numbers, needs " +
                               std::to_string(count),
                           {}};
    return values;
}

std::string ArgumentCursor::string(const char* what) {
    if (!next_is_string() || peek()->strings.size() != 1) missing(what);
    return std::move(request_.arguments[next_++].strings[0]);
}

std::vector<float> ArgumentCursor::number_array(const char* what) {
    if (!next_is_number()) missing(what);
    return std::move(request_.arguments[next_++].numbers);
}

std::vector<int> ArgumentCursor::int_array(const char* what) {
    const SourceLocation at = done() ? SourceLocation{} : peek()->at;
    const std::vector<float> values = number_array(what);
    std::vector<int> ints(values.size());
    for (size_t i = 0; i < values.size(); ++i) {
        if (!(std::abs(values[i]) < 2.1e9f) || values[i] != std::trunc(values[i]))
            throw RequestError{std::string(what) + " holds a number that is not an integer", at};
        ints[i] = static_cast<int>(values[i]);
    }
    return ints;
}

std::vector<std::string> ArgumentCursor::string_array(const char* what) {
    if (done() || (!peek()->is_text() && !peek()->numbers.empty())) missing(what);
    return std::move(request_.arguments[next_++].strings);
}

std::string ArgumentCursor::handle(const char* what) {
    if (next_is_string()) return string(what);
    const float value = number(what);
    return std::to_string(static_cast<long long>(value));
}

Argument ArgumentCursor::take(const char* what) {
    if (done()) missing(what);
    return std::move(request_.arguments[next_++]);
}

}  // namespace trapeze::rib
