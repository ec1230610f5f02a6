#include "shade/rsl/syntax/condition.h"

#include <charconv>
#include <optional>

namespace trapeze::rsl {
namespace {

/// Parentheses and operators within each other: the evaluation recurses.
constexpr int kDeepest = 200;  // far more than people write, little of a thread's stack

/// Thrown after an error is reported; evaluate_condition() catches it. An exception, because an error may be
/// met deep in the recursion and ends all of it.
struct BadCondition {};

/// A whole number as in C: decimal, octal, hexadecimal, and with U or L behind it. Read as 64 bits without a
/// sign, and taken as those with one, as a preprocessor's widest type would be.
std::optional<int64_t> integer_of(std::string_view text) {
    while (!text.empty() && std::string_view("uUlL").find(text.back()) != std::string_view::npos)
        text.remove_suffix(1);
    int base = 10;
    if (text.starts_with("0x") || text.starts_with("0X"))
        base = 16, text.remove_prefix(2);
    else if (text.size() > 1 && text[0] == '0')
        base = 8;
    uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return static_cast<int64_t>(value);
}

/// How tightly a binary operator binds, as in C; 0 for a token that is none. Preprocessor conditions have C's
/// operators, of which the language itself has fewer.
int precedence_of(const Token& token) {
    if (token.kind != Token::Kind::Mark) return 0;
    static constexpr struct {
        std::string_view mark;
        int precedence;
    } kOperators[] = {{"||", 1}, {"&&", 2}, {"|", 3}, {"^", 4},  {"&", 5},  {"==", 6},
                      {"!=", 6}, {"<", 7},  {">", 7}, {"<=", 7}, {">=", 7}, {"<<", 8},
                      {">>", 8}, {"+", 9},  {"-", 9}, {"*", 10}, {"/", 10}, {"%", 10}};
    for (const auto& row : kOperators)
        if (row.mark == token.text) return row.precedence;
    return 0;
}

/// Evaluates while it parses, by precedence climbing. What && || and ?: leave out is parsed but not judged
/// (idle_): a division by zero in it is no error.
class Condition {
  public:
    Condition(const std::vector<Token>& tokens, SourceLocation at, Reporter& reporter)
        : tokens_(tokens), at_(at), reporter_(reporter) {}

    /// The value of all tokens; one that is left over is an error.
    int64_t whole() {
        const int64_t value = conditional();
        if (next_ < tokens_.size()) fail("this does not belong to the condition");
        return value;
    }

  private:
    bool take(std::string_view mark) {
        const bool is = next_ < tokens_.size() && tokens_[next_].is(mark);
        next_ += is;
        return is;
    }

    /// Reports at the next token or, behind the last, at the directive.
    [[noreturn]] void fail(const std::string& text) {
        reporter_.error(next_ < tokens_.size() ? tokens_[next_].at : at_, text);
        throw BadCondition();
    }

    /// condition ? a : b. Both are parsed; only the one that is taken is judged.
    int64_t conditional() {
        if (++depth_ > kDeepest) fail("this condition nests too deeply");
        int64_t value = binary(1);
        if (take("?")) {
            const bool was_idle = idle_;
            idle_ = was_idle || value == 0;
            const int64_t yes = conditional();
            if (!take(":")) fail("a : is missing in this condition");
            idle_ = was_idle || value != 0;
            const int64_t no = conditional();
            idle_ = was_idle;
            value = value != 0 ? yes : no;
        }
        --depth_;
        return value;
    }

    /// Operators that bind at least as tightly as `lowest`, left-associative.
    int64_t binary(int lowest) {
        int64_t left = unary();
        while (next_ < tokens_.size()) {
            const Token& mark = tokens_[next_];
            const int precedence = precedence_of(mark);
            if (precedence == 0 || precedence < lowest) break;
            ++next_;
            const bool was_idle = idle_;
            idle_ = was_idle || (mark.text == "&&" && left == 0) || (mark.text == "||" && left != 0);
            const int64_t right = binary(precedence + 1);
            idle_ = was_idle;
            left = apply(mark, left, right);
        }
        return left;
    }

    /// One operator on two values of 64 bits. Sums, differences and products wrap around, a shift by 64 or
    /// more leaves 0 or, to the right, the sign, and the one quotient that does not fit (the lowest number by
    /// -1) wraps: no condition makes the compiler do what C++ leaves undefined.
    int64_t apply(const Token& mark, int64_t left, int64_t right) {
        const auto a = static_cast<uint64_t>(left), b = static_cast<uint64_t>(right);
        const std::string_view op = mark.text;
        if (op == "||") return left != 0 || right != 0;
        if (op == "&&") return left != 0 && right != 0;
        if (op == "|") return left | right;
        if (op == "^") return left ^ right;
        if (op == "&") return left & right;
        if (op == "==") return left == right;
        if (op == "!=") return left != right;
        if (op == "<") return left < right;
        if (op == ">") return left > right;
        if (op == "<=") return left <= right;
        if (op == ">=") return left >= right;
        if (op == "<<") return static_cast<int64_t>(b < 64 ? a << b : 0);
        if (op == ">>") return b < 64 ? left >> right : left < 0 ? -1 : 0;
        if (op == "+") return static_cast<int64_t>(a + b);
        if (op == "-") return static_cast<int64_t>(a - b);
        if (op == "*") return static_cast<int64_t>(a * b);
        if (right == 0) {
            if (idle_) return 0;
            reporter_.error(mark.at, "division by zero in a condition");
            throw BadCondition();
        }
        if (right == -1) return op == "/" ? static_cast<int64_t>(0 - a) : 0;
        return op == "/" ? left / right : left % right;
    }

    /// Counts the depth, as conditional() does: signs and parentheses are where a condition nests.
    int64_t unary() {
        if (++depth_ > kDeepest) fail("this condition nests too deeply");
        const int64_t value = unary_within();
        --depth_;
        return value;
    }

    /// ! - + ~, parentheses, numbers, and names, which are no macros any more and count as 0.
    int64_t unary_within() {
        if (take("!")) return unary() == 0;
        if (take("-")) return static_cast<int64_t>(0 - static_cast<uint64_t>(unary()));
        if (take("+")) return unary();
        if (take("~")) return ~unary();
        if (take("(")) {
            const int64_t value = conditional();
            if (!take(")")) fail("a ) is missing in this condition");
            return value;
        }
        if (next_ == tokens_.size()) fail("this condition is not complete");
        const Token& token = tokens_[next_];
        if (token.kind == Token::Kind::Name) {
            ++next_;
            if (next_ < tokens_.size() && tokens_[next_].is("("))
                fail("\"" + std::string(token.text.substr(0, 80)) + "\" is no macro with arguments");
            return 0;
        }
        const auto value = token.kind == Token::Kind::Number ? integer_of(token.text) : std::nullopt;
        if (!value) fail("a condition has whole numbers, names and operators only");
        ++next_;
        return *value;
    }

    const std::vector<Token>& tokens_;
    SourceLocation at_;
    Reporter& reporter_;
    size_t next_ = 0;
    int depth_ = 0;
    bool idle_ = false;  // in a part whose value is not wanted
};

}  // namespace

/// A condition that cannot be read counts as false, so that what it guards is left out.
bool evaluate_condition(const std::vector<Token>& tokens, SourceLocation at, Reporter& reporter) {
    try {
        return Condition(tokens, at, reporter).whole() != 0;
    } catch (const BadCondition&) {
        return false;
    }
}

}  // namespace trapeze::rsl
