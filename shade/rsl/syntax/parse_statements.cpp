#include "shade/rsl/syntax/parser.h"

namespace trapeze::rsl {
namespace {

/// Begins a statement where a token stands.
StatementPtr make(Statement::Kind kind, const Token& token) {
    auto statement = std::make_unique<Statement>();
    statement->kind = kind;
    statement->at = token.at;
    return statement;
}

}  // namespace

/// { ... }: an error within ends one statement only. The message of an error has been given where it was
/// thrown.
StatementPtr Parser::block() {
    StatementPtr block = make(Statement::Kind::Block, now());
    const Nesting nesting(*this);
    expect("{", "before a block");
    while (!at("}") && !at_end() && !reporter_.full()) {
        try {
            block->children.push_back(statement());
        } catch (const Lost&) {
            skip_statement();
        }
    }
    expect("}", "after a block");
    return block;
}

/// One statement of any kind, counted as one level of nesting.
StatementPtr Parser::statement() {
    const Nesting nesting(*this);
    return statement_within();
}

/// The first word decides. Declarations and functions both begin with a type, as casts do, so what follows
/// the type is looked at; whatever else comes is an expression. Words of control are reserved, and need no
/// look at what follows.
StatementPtr Parser::statement_within() {
    if (at("{")) return block();
    if (at(";")) return make(Statement::Kind::Empty, take());
    if (now().kind == Token::Kind::Name) {
        if (at_struct()) {
            StatementPtr place = make(Statement::Kind::Empty, now());
            struct_definition();
            return place;
        }
        refuse_rsl2();
        if (at("if")) return if_statement();
        if (at("while")) return while_statement();
        if (at("for")) return for_statement();
        if (at("illuminance")) return light_statement(Statement::Kind::Illuminance);
        if (at("illuminate")) return light_statement(Statement::Kind::Illuminate);
        if (at("solar")) return light_statement(Statement::Kind::Solar);
        if (at("gather")) return light_statement(Statement::Kind::Gather);
        if (at("break")) return loop_control(Statement::Kind::Break);
        if (at("continue")) return loop_control(Statement::Kind::Continue);
        if (at("return")) return return_statement();
        if (at("else")) fail(now(), "\"else\" without \"if\"");
        if (at_function()) return nested_function();
        if (at_declaration()) return declaration();
    }
    return evaluation();
}

/// An expression, or several with commas between them. Several become an open block, which has no scope of
/// its own, since each is a statement by itself.
StatementPtr Parser::evaluation() {
    const Token& first = now();
    StatementPtr statement, several;
    do {
        if (statement && !several) several = make(Statement::Kind::Block, first);
        if (several) several->open = true;
        if (statement) several->children.push_back(std::move(statement));
        statement = make(Statement::Kind::Evaluate, now());
        statement->expressions.push_back(expression());
    } while (accept(","));
    expect(";", "after a statement");
    if (!several) return statement;
    several->children.push_back(std::move(statement));
    return several;
}

/// "float f(float x) {": not the cast of a call. A nested function and a cast of a call begin alike, up to
/// what stands behind the closing parenthesis.
bool Parser::at_function() const {
    size_t name = next_;
    while (tokens_[name].is("uniform") || tokens_[name].is("varying")) ++name;
    // A "void" is always a function's; another type may be a cast of a call, which no "{" follows.
    const bool is_void = tokens_[name].is("void");
    if (!is_void && base_named(tokens_[name].text) == Base::Void && !struct_named(name)) return false;
    ++name;
    if (tokens_[name].kind != Token::Kind::Name || is_reserved(tokens_[name].text) ||
        !tokens_[name + 1].is("("))
        return false;
    return is_void || tokens_[behind_parentheses(name + 1)].is("{");
}

/// Whether a declaration begins here: a type and a name, without the parenthesis that makes it a cast of a
/// call.
bool Parser::at_declaration() const {
    if (at_any({"extern", "output", "uniform", "varying"})) return true;
    if (struct_named(next_)) return !ahead(2).is("(");
    if (base_named(now().text) == Base::Void) return false;
    const size_t name = ahead(1).kind == Token::Kind::Text ? 2 : 1;
    if (ahead(name).kind != Token::Kind::Name || base_named(ahead(name).text) != Base::Void) return false;
    // "float x" is a declaration whatever follows; "float f(x)" is not.
    return !ahead(name + 1).is("(");
}

/// A function within a shader or function. It joins those of the file, with the name of what encloses it; an
/// Empty statement stays in its place, which says from where on it is known.
StatementPtr Parser::nested_function() {
    StatementPtr statement = make(Statement::Kind::Empty, now());
    const size_t before = unit_->functions.size();
    const size_t start = next_;
    const Token& first = tokens_[start];
    function(inside_);
    if (unit_->functions.size() > before) statement->defines = unit_->functions.back().get();
    statement->at = first.at;
    return statement;
}

/// "float a = 1, b, color c;": a type may change between commas. The words before a type hold for all names
/// up to the next type.
StatementPtr Parser::declaration() {
    StatementPtr statement = make(Statement::Kind::Declare, now());
    Specifier specified = specifier();
    do {
        if (at_specifier()) specified = specifier();
        statement->variables.push_back(declarator(specified, Variable::Kind::Local));
    } while (accept(","));
    expect(";", "after a declaration");
    return statement;
}

/// The head of an if or while; `where` ends the message about a missing parenthesis.
ExpressionPtr Parser::parenthesised_condition(std::string_view where) {
    expect("(", where);
    ExpressionPtr condition = expression();
    expect(")", "after the condition");
    return condition;
}

/// An else belongs to the nearest if, since the inner one has taken it by the time the outer looks.
StatementPtr Parser::if_statement() {
    StatementPtr statement = make(Statement::Kind::If, take());
    statement->expressions.push_back(parenthesised_condition("after \"if\""));
    statement->children.push_back(this->statement());
    if (accept("else")) statement->children.push_back(this->statement());
    return statement;
}

StatementPtr Parser::while_statement() {
    StatementPtr statement = make(Statement::Kind::While, take());
    statement->expressions.push_back(parenthesised_condition("after \"while\""));
    statement->children.push_back(this->statement());
    return statement;
}

/// A declaration in the head, or several expressions before the first ;, go into a block around the loop.
/// Expressions of the loop: what is done before, the condition, and what is done after each turn, of which
/// there may be several; null where one is left out.
StatementPtr Parser::for_statement() {
    StatementPtr loop = make(Statement::Kind::For, take());
    StatementPtr around;
    expect("(", "after \"for\"");
    if (now().kind == Token::Kind::Name && at_declaration()) {
        // Variables of the head have a scope of their own, that of this block.
        around = make(Statement::Kind::Block, tokens_[next_ - 1]);
        around->children.push_back(declaration());
        loop->expressions.push_back(nullptr);
    } else {
        loop->expressions.push_back(at(";") ? nullptr : expression());
        while (accept(",")) {
            if (!around) around = make(Statement::Kind::Block, tokens_[next_ - 1]);
            around->open = true;
            StatementPtr before = make(Statement::Kind::Evaluate, now());
            before->expressions.push_back(std::move(loop->expressions[0]));
            around->children.push_back(std::move(before));
            loop->expressions[0] = expression();
        }
        expect(";", "in the head of \"for\"");
    }
    loop->expressions.push_back(at(";") ? nullptr : expression());
    expect(";", "in the head of \"for\"");
    loop->expressions.push_back(at(")") ? nullptr : expression());
    while (accept(",")) loop->expressions.push_back(expression());
    expect(")", "after the head of \"for\"");
    loop->children.push_back(statement());
    if (!around) return loop;
    around->children.push_back(std::move(loop));
    return around;
}

/// illuminance, illuminate, solar and gather: arguments in parentheses, a statement, and for gather an else.
/// How many arguments there may be depends on their types, which the analysis knows (Analyser::light_loop).
StatementPtr Parser::light_statement(Statement::Kind kind) {
    const Token& word = take();
    StatementPtr statement = make(kind, word);
    if (!at("(")) fail_expecting("\"(\" after \"" + std::string(word.text) + "\"");
    statement->expressions = arguments();
    statement->children.push_back(this->statement());
    if (kind == Statement::Kind::Gather && accept("else")) statement->children.push_back(this->statement());
    return statement;
}

/// break n and continue n: out of the n-th loop, from the inside. Without a number the innermost. Whether
/// there are so many is the analysis' to say.
StatementPtr Parser::loop_control(Statement::Kind kind) {
    const Token& word = take();
    StatementPtr statement = make(kind, word);
    if (now().kind == Token::Kind::Number) {
        const float levels = now().number;
        if (levels < 1 || levels > kDeepestNesting || levels != static_cast<float>(static_cast<int>(levels)))
            fail(now(), "\"" + std::string(word.text) + "\" wants a number of loops, from 1");
        statement->levels = static_cast<int>(levels);
        take();
    }
    expect(";", "after \"" + std::string(word.text) + "\"");
    return statement;
}

/// Whether a value is returned is kept for functions whose type is left out.
StatementPtr Parser::return_statement() {
    StatementPtr statement = make(Statement::Kind::Return, take());
    if (!at(";")) statement->expressions.push_back(expression());
    returns_value_ = returns_value_ || !statement->expressions.empty();
    expect(";", "after \"return\"");
    return statement;
}

}  // namespace trapeze::rsl
