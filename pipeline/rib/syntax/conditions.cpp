/// Evaluates expressions of conditions. Both sides of && and || are evaluated, so that all undefined names
/// are known; nothing in an expression has an effect.
#include "pipeline/rib/syntax/conditions.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "shade/vm/text_format.h"

namespace trapeze::rib {
namespace {

constexpr int kDeepestNesting = 100;  ///< of parentheses and signs

/// Thrown within this file only.
struct Problem {
    std::string text;
};

/// Names have colons within: "Option:user:quality".
bool is_name_character(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == ':';
}

/// A number as a condition's value. Truth values are numbers too: 1 or 0.
ConditionValue number(double value) {
    return {{value}, {}};
}

/// Any number other than 0 in an array, or a text that is not empty; what nobody set is false.
bool is_true(const ConditionValue& value) {
    if (value.text) return !value.text->empty();
    return std::any_of(value.numbers.begin(), value.numbers.end(), [](double v) { return v != 0; });
}

/// A text that is a number becomes that number, as options may say "1" or 1; another text becomes no value.
ConditionValue as_numbers(const ConditionValue& value) {
    if (!value.text) return value;
    double parsed = 0;
    const char* const end = value.text->data() + value.text->size();
    const auto [stop, error] = std::from_chars(value.text->data(), end, parsed);
    if (error != std::errc() || stop != end) return {};
    return number(parsed);
}

/// Texts by their bytes, arrays from the first element on, as std::string and std::vector compare.
template <class T>
bool compare(const T& a, std::string_view op, const T& b) {
    if (op == "==") return a == b;
    if (op == "!=") return a != b;
    if (op == "<") return a < b;
    if (op == "<=") return a <= b;
    if (op == ">") return a > b;
    return a >= b;
}

/// Texts by their letters, numbers by value, a text with a number by value; what cannot be compared differs.
/// Arrays of other lengths are unlike, and neither is less.
bool compare_values(const ConditionValue& a, std::string_view op, const ConditionValue& b) {
    if (op == "=~") return a.text && b.text && vm::matches(*b.text, *a.text);
    if (a.text && b.text) return compare(*a.text, op, *b.text);
    const ConditionValue x = as_numbers(a), y = as_numbers(b);
    const bool is_order = op != "==" && op != "!=";
    if (x.is_undefined() || y.is_undefined() || (is_order && x.numbers.size() != y.numbers.size()))
        return op == "!=";
    return compare(x.numbers, op, y.numbers);
}

/// Only numbers, and texts that are one; an array is none.
ConditionValue arithmetic(const ConditionValue& a, char op, const ConditionValue& b) {
    const ConditionValue x = as_numbers(a), y = as_numbers(b);
    if (x.numbers.size() != 1 || y.numbers.size() != 1)
        throw Problem{std::string("'") + op + "' wants a number on both sides"};
    const double u = x.numbers[0], v = y.numbers[0];
    if (op == '/' && v == 0) throw Problem{"a division by 0"};
    return number(op == '+' ? u + v : op == '-' ? u - v : op == '*' ? u * v : u / v);
}

/// Recursive descent, which evaluates as it goes. No tree is made: an expression is evaluated once, in the
/// state in which its request stands.
class Evaluator {
  public:
    Evaluator(std::string_view text, const ConditionVariables& variables)
        : text_(text), variables_(variables) {}

    /// The value of the text, which must be one expression and nothing after it.
    ConditionValue whole() {
        ConditionValue value = either();
        if (!at_end()) throw Problem{"what follows " + place() + " is not understood"};
        return value;
    }
    std::vector<std::string> undefined;

  private:
    void skip_space() {
        while (next_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[next_]))) ++next_;
    }
    bool at_end() {
        skip_space();
        return next_ >= text_.size();
    }
    std::string place() const { return "character " + std::to_string(next_ + 1); }
    /// Takes the token if it comes next, blanks before it aside. Whether it did.
    bool take(std::string_view token) {
        skip_space();
        if (!text_.substr(next_).starts_with(token)) return false;
        next_ += token.size();
        return true;
    }
    void expect(std::string_view token) {
        if (!take(token)) throw Problem{"'" + std::string(token) + "' is expected at " + place()};
    }
    /// A name as it stands after "$".
    std::string name() {
        skip_space();
        const size_t first = next_;
        while (next_ < text_.size() && is_name_character(text_[next_])) ++next_;
        if (next_ == first) throw Problem{"a name is expected at " + place()};
        return std::string(text_.substr(first, next_ - first));
    }

    /// The grammar, loosest first: either, both, comparison, sum, product, primary. A comparison does not
    /// chain.
    ConditionValue either() {
        ConditionValue value = both();
        while (take("||")) {
            const bool right = is_true(both());
            value = number(is_true(value) || right);
        }
        return value;
    }
    ConditionValue both() {
        ConditionValue value = comparison();
        while (take("&&")) {
            const bool right = is_true(comparison());
            value = number(is_true(value) && right);
        }
        return value;
    }
    /// Longer operators come first in the list, so that "<=" is not taken for "<".
    ConditionValue comparison() {
        const ConditionValue left = sum();
        for (const std::string_view op : {"==", "!=", "=~", "<=", ">=", "<", ">"})
            if (take(op)) return number(compare_values(left, op, sum()));
        return left;
    }
    // From left to right: a - b - c is (a - b) - c.
    ConditionValue sum() {
        ConditionValue value = product();
        while (true)
            if (take("+"))
                value = arithmetic(value, '+', product());
            else if (take("-"))
                value = arithmetic(value, '-', product());
            else
                return value;
    }
    ConditionValue product() {
        ConditionValue value = primary();
        while (true)
            if (take("*"))
                value = arithmetic(value, '*', primary());
            else if (take("/"))
                value = arithmetic(value, '/', primary());
            else
                return value;
    }

    /// A sign, a bracket or an operand. The depth is that of the recursion, which a file must not choose.
    ConditionValue primary() {
        if (++depth_ > kDeepestNesting)
            throw Problem{"it is nested too deep, more than " + std::to_string(kDeepestNesting) + " times"};
        ConditionValue value = primary_within();
        --depth_;
        return value;
    }
    ConditionValue primary_within() {
        if (at_end()) throw Problem{"it ends too early"};
        if (take("!")) return number(!is_true(primary()));
        if (take("-")) return arithmetic(number(0), '-', primary());
        if (take("(")) {
            ConditionValue value = either();
            expect(")");
            return value;
        }
        const char c = text_[next_];
        if (c == '$') return variable();
        if (c == '\'' || c == '"') return quoted(c);
        if (c == '[') return array();
        if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') return literal();
        return call();
    }
    /// $name, ${name}, or $(expression) whose text is the name.
    ConditionValue variable() {
        ++next_;
        std::string asked;
        if (take("(")) {
            asked = text_of(either());
            expect(")");
        } else if (take("{")) {
            asked = name();
            expect("}");
        } else {
            asked = name();
        }
        ConditionValue value = variables_(asked);
        if (value.is_undefined()) undefined.push_back(asked);
        return value;
    }
    /// A backslash before the quote makes it a part of the string.
    ConditionValue quoted(char quote) {
        ConditionValue value{{}, std::string()};
        for (size_t at = next_ + 1; at < text_.size(); ++at) {
            if (text_[at] == quote) {
                next_ = at + 1;
                return value;
            }
            if (text_[at] == '\\' && at + 1 < text_.size() && text_[at + 1] == quote) ++at;
            *value.text += text_[at];
        }
        throw Problem{"the string at " + place() + " is never closed"};
    }
    /// Decimal, with an exponent if it likes; signs are primary()'s.
    ConditionValue literal() {
        double value = 0;
        const auto [stop, error] = std::from_chars(text_.data() + next_, text_.data() + text_.size(), value);
        if (error != std::errc()) throw Problem{"a number is expected at " + place()};
        next_ = static_cast<size_t>(stop - text_.data());
        return number(value);
    }
    /// Numbers apart by spaces, with signs; no expressions within.
    ConditionValue array() {
        ConditionValue value;
        expect("[");
        while (!take("]")) {
            const bool negative = take("-");
            if (at_end()) throw Problem{"an array is never closed"};
            const double element = literal().numbers[0];
            value.numbers.push_back(negative ? -element : element);
        }
        return value;
    }
    /// defined(), concat(), and bare words, which are texts.
    ConditionValue call() {
        const std::string word = name();
        if (!take("(")) {
            if (word == "true" || word == "false") return number(word == "true");
            return {{}, word};
        }
        if (word == "defined") {
            take("$");
            const bool is = !variables_(name()).is_undefined();
            expect(")");
            return number(is);
        }
        if (word != "concat") throw Problem{"there is no function " + word + "()"};
        std::string joined;
        do joined += text_of(either());
        while (take(","));
        expect(")");
        return {{}, joined};
    }

    std::string_view text_;
    const ConditionVariables& variables_;
    size_t next_ = 0;
    int depth_ = 0;
};

}  // namespace

/// The value as text. Numbers are written as floats: options are floats, and 0.1 shall not read
/// 0.10000000149011612.
std::string text_of(const ConditionValue& value) {
    if (value.text) return *value.text;
    std::string text;
    for (const double v : value.numbers) {
        char digits[32];
        const auto end = std::to_chars(digits, digits + sizeof digits, static_cast<float>(v)).ptr;
        if (!text.empty()) text += ' ';
        text.append(digits, end);
    }
    return text;
}

/// Undefined names are told even where the expression turns out wrong.
ConditionResult evaluate_condition(std::string_view expression, const ConditionVariables& variables) {
    Evaluator evaluator(expression, variables);
    ConditionResult result;
    try {
        result.holds = is_true(evaluator.whole());
    } catch (const Problem& problem) {
        result.problem = problem.text;
    }
    result.undefined = std::move(evaluator.undefined);
    return result;
}

/// A name ends where no name character follows; colons at its end are the text's ("$name: "). A value is not
/// looked through again, so that one that names itself ends. The marker may be any text.
std::string substitute_variables(const std::string& text, const std::string& marker,
                                 const ConditionVariables& variables) {
    if (marker.empty()) return text;
    std::string result;
    size_t at = 0;
    while (true) {
        const size_t found = text.find(marker, at);
        if (found == std::string::npos) break;
        result += text.substr(at, found - at);
        size_t begin = found + marker.size(), end = begin, after = begin;
        if (begin < text.size() && text[begin] == '{') {
            end = std::min(text.find('}', ++begin), text.size());
            after = std::min(end + 1, text.size());
        } else {
            while (end < text.size() && is_name_character(text[end])) ++end;
            while (end > begin && text[end - 1] == ':') --end;
            after = end;
        }
        const ConditionValue value = variables(text.substr(begin, end - begin));
        result += value.is_undefined() ? text.substr(found, after - found) : text_of(value);
        at = after;
    }
    return result + text.substr(at);
}

}  // namespace trapeze::rib
