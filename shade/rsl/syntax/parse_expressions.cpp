#include <algorithm>

#include "shade/rsl/syntax/parser.h"

namespace trapeze::rsl {
namespace {

/// A row of the operators' table; both tables are small enough to be searched for each token.
struct BinaryOperator {
    std::string_view mark;
    Operator op;
    int precedence;  // the higher, the tighter
};

// RISpec 3.2, section 13.1: dot product, then * and /, then cross product, then + and -, ...
constexpr BinaryOperator kBinary[] = {{"||", Operator::Or, 1},     {"&&", Operator::And, 2},
                                      {"==", Operator::Equal, 3},  {"!=", Operator::NotEqual, 3},
                                      {"<", Operator::Less, 4},    {"<=", Operator::LessEqual, 4},
                                      {">", Operator::Greater, 4}, {">=", Operator::GreaterEqual, 4},
                                      {"+", Operator::Add, 5},     {"-", Operator::Subtract, 5},
                                      {"^", Operator::Cross, 6},   {"*", Operator::Multiply, 7},
                                      {"/", Operator::Divide, 7},  {".", Operator::Dot, 8}};

constexpr BinaryOperator kAssignments[] = {{"=", Operator::None, 0},
                                           {"+=", Operator::Add, 0},
                                           {"-=", Operator::Subtract, 0},
                                           {"*=", Operator::Multiply, 0},
                                           {"/=", Operator::Divide, 0}};

template <size_t N>
/// The row of the operator that a token is; null for others.
const BinaryOperator* find(const BinaryOperator (&table)[N], const Token& token) {
    if (token.kind != Token::Kind::Mark) return nullptr;
    const auto* row = std::find_if(std::begin(table), std::end(table),
                                   [&](const BinaryOperator& r) { return r.mark == token.text; });
    return row == std::end(table) ? nullptr : row;
}

/// Begins an expression where a token stands.
ExpressionPtr make(Expression::Kind kind, const Token& token) {
    auto expression = std::make_unique<Expression>();
    expression->kind = kind;
    expression->at = token.at;
    return expression;
}

}  // namespace

/// Knows its height; one that is too high is an error. The bound keeps every later walk over the tree, which
/// recurses, within any thread's stack.
ExpressionPtr Parser::finished(ExpressionPtr e) {
    int height = 0;
    for (const ExpressionPtr& child : e->children) height = std::max<int>(height, child->height);
    e->height = static_cast<uint16_t>(height + 1);
    if (height < kHighestExpression) return e;
    reporter_.error(e->at, "this expression is too long; split it");
    throw Lost();
}

/// conditional, or place = value and its like, which are right-associative. Assignments have values in RSL as
/// in C. Only their left side's form is checked here; whether it may be written is the analysis' to say.
ExpressionPtr Parser::expression() {
    const Nesting nesting(*this);
    ExpressionPtr left = conditional();
    const BinaryOperator* row = find(kAssignments, now());
    if (!row) return left;
    const Token& mark = take();
    if (left->kind != Expression::Kind::Variable && left->kind != Expression::Kind::Element &&
        left->kind != Expression::Kind::Member)
        fail(mark, "only variables, elements and components can be assigned to");
    ExpressionPtr assignment = make(Expression::Kind::Assignment, mark);
    assignment->op = row->op;
    assignment->children.push_back(std::move(left));
    assignment->children.push_back(row->op == Operator::None ? initial_value() : expression());
    return finished(std::move(assignment));
}

/// condition ? a : b, right-associative. Each "?" nests once more in this program's stack, and is counted for
/// that.
ExpressionPtr Parser::conditional() {
    ExpressionPtr condition = binary(1);
    if (!at("?")) return condition;
    ExpressionPtr choice = make(Expression::Kind::Conditional, take());
    choice->children.push_back(std::move(condition));
    choice->children.push_back(expression());
    expect(":", "after the first value of \"?\"");
    const Nesting nesting(*this);
    choice->children.push_back(conditional());
    return finished(std::move(choice));
}

/// Operators that bind at least as tightly as `lowest`, by precedence climbing: all are left-associative. A
/// loop for what stands side by side, and a call for what binds more tightly: long sums do not nest.
ExpressionPtr Parser::binary(int lowest) {
    ExpressionPtr left = unary();
    while (const BinaryOperator* row = find(kBinary, now())) {
        if (row->precedence < lowest) break;
        ExpressionPtr e = make(Expression::Kind::Binary, take());
        e->op = row->op;
        e->children.push_back(std::move(left));
        e->children.push_back(binary(row->precedence + 1));
        left = finished(std::move(e));
    }
    return left;
}

/// - and !, and + which says nothing. A type's name begins a cast, which binds as tightly.
/// Casts are known by their words alone, as types are reserved in RSL: no table of names is needed while
/// parsing.
ExpressionPtr Parser::unary() {
    if (at("-") || at("!")) {
        const Nesting nesting(*this);
        const Token& mark = take();
        ExpressionPtr e = make(Expression::Kind::Unary, mark);
        e->op = mark.text == "-" ? Operator::Negate : Operator::Not;
        e->children.push_back(unary());
        return finished(std::move(e));
    }
    if (at("+")) {
        if (next_ > 0 && tokens_[next_ - 1].is("+") && !now().space_before)
            fail(now(), "there is no \"++\" in the shading language; write \"+= 1\"");
        take();
        const Nesting nesting(*this);
        return unary();
    }
    if (now().kind == Token::Kind::Name && base_named(now().text) != Base::Void) return cast();
    if (at("(") && base_named(ahead(1).text) != Base::Void && ahead(1).kind == Token::Kind::Name &&
        ahead(2).is(")"))
        return cast();
    return postfix();
}

/// type ["space"] operand, or as in C, (type) operand. Casts bind tighter than any binary operator: in
/// "float a + b", a alone is converted.
ExpressionPtr Parser::cast() {
    const Nesting nesting(*this);
    const bool parenthesised = accept("(");
    const Token& word = take();
    if (parenthesised) take();
    ExpressionPtr e = make(Expression::Kind::Cast, word);
    e->type.base = base_named(word.text);
    // color "hsv" (...), point "world" (...), matrix "shader" 1: floats and strings are in no space.
    const bool has_spaces = e->type.base != Base::Float && e->type.base != Base::String;
    if (has_spaces && now().kind == Token::Kind::Text) e->text = take().text;
    e->children.push_back(unary());
    return finished(std::move(e));
}

/// Elements: a[i], m[i][j], and members of structs: a->x. Elements and components alike; which of the two an
/// index means depends on the type, which the parser does not know.
ExpressionPtr Parser::postfix() {
    ExpressionPtr e = primary();
    // Where there are no structs it is something of RSL 2 that there is not.
    const auto at_member = [&] {
        return at("->") && ahead(1).kind == Token::Kind::Name && !structs_.empty();
    };
    while (at("[") || at_member()) {
        if (at("->") && ahead(2).is("(")) {
            ExpressionPtr call = make(Expression::Kind::Call, take());
            call->text = "->" + std::string(take().text);
            call->children.push_back(std::move(e));
            std::vector<ExpressionPtr> given = arguments();
            for (ExpressionPtr& argument : given) call->children.push_back(std::move(argument));
            e = finished(std::move(call));
            continue;
        }
        if (at("->")) {
            ExpressionPtr member = make(Expression::Kind::Member, take());
            member->text = take().text;
            member->children.push_back(std::move(e));
            e = finished(std::move(member));
            continue;
        }
        ExpressionPtr element = make(Expression::Kind::Element, take());
        element->children.push_back(std::move(e));
        element->children.push_back(expression());
        expect("]", "after an index");
        e = finished(std::move(element));
    }
    if (at("->") || at("::")) refuse_rsl2();
    if (e->kind == Expression::Kind::Variable && e->text == "shader") refuse_rsl2();
    return e;
}

/// A number, string, name, call, or something in parentheses. A name before a parenthesis is a call, whatever
/// it names: functions and variables have names apart.
ExpressionPtr Parser::primary() {
    const Token& token = now();
    if (token.kind == Token::Kind::Number) {
        ExpressionPtr e = make(Expression::Kind::Number, take());
        e->number = token.number;
        return e;
    }
    if (token.kind == Token::Kind::Text) {
        ExpressionPtr e = make(Expression::Kind::Text, take());
        e->text = token.text;
        return e;
    }
    if (at("(")) return parentheses();
    if (token.kind != Token::Kind::Name) fail_expecting("an expression");
    if (is_reserved(token.text)) {
        if (at_any({"illuminance", "illuminate", "solar", "gather"}))
            fail(token, "\"" + std::string(token.text) + "\" is a statement, and has no value");
        fail_expecting("an expression");
    }
    const bool of_base = ahead(1).is("::") && ahead(2).kind == Token::Kind::Name && ahead(3).is("(") &&
                         structs_.contains(token.text);
    if (of_base) {
        ExpressionPtr e = make(Expression::Kind::Call, take());
        take();
        e->text = std::string(token.text) + "::" + std::string(take().text);
        e->children = arguments();
        return finished(std::move(e));
    }
    const bool call = ahead(1).is("(");
    ExpressionPtr e = make(call ? Expression::Kind::Call : Expression::Kind::Variable, take());
    e->text = token.text;
    if (call) e->children = arguments();
    return finished(std::move(e));
}

/// (a), the triple (a, b, c), or a matrix of 16. Read like the arguments of a call, and told apart by how
/// many they are.
ExpressionPtr Parser::parentheses() {
    const Token& open = now();
    std::vector<ExpressionPtr> values = arguments();
    if (values.size() == 1) return std::move(values[0]);
    if (values.size() != 3 && values.size() != 16)
        fail(open, values.empty() ? "expected an expression between \"(\" and \")\""
                                  : "in parentheses stand one value, three or sixteen, not " +
                                        std::to_string(values.size()));
    ExpressionPtr e = make(values.size() == 3 ? Expression::Kind::Triple : Expression::Kind::Sixteen, open);
    e->children = std::move(values);
    return finished(std::move(e));
}

/// "(" ... ")", of a call as of a parenthesis: a comma behind the last value is let pass. Macros that join
/// arguments leave such commas. Values in braces are those of arrays in structs; elsewhere the analysis
/// refuses them.
std::vector<ExpressionPtr> Parser::arguments() {
    std::vector<ExpressionPtr> values;
    expect("(", "before arguments");
    while (!at(")") && !at_end()) {
        values.push_back(initial_value());
        if (!at(")")) expect(",", "or \")\" after an argument");
    }
    expect(")", "after arguments");
    return values;
}

}  // namespace trapeze::rsl
