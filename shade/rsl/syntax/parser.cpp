#include "shade/rsl/syntax/parser.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace trapeze::rsl {
namespace {

/// Nothing for other words. Kinds are no reserved words: what follows has to be looked at, too.
std::optional<ShaderKind> shader_kind_named(std::string_view name) {
    for (int kind = 0; kind <= static_cast<int>(ShaderKind::Imager); ++kind)
        if (name_of(static_cast<ShaderKind>(kind)) == name) return static_cast<ShaderKind>(kind);
    return {};
}

/// A token as messages quote it.
std::string shown(const Token& token) {
    if (token.kind == Token::Kind::End) return "the end of the file";
    if (token.kind == Token::Kind::Text) return "a string";
    return "\"" + std::string(token.text.substr(0, 60)) + (token.text.size() > 60 ? "...\"" : "\"");
}

}  // namespace

std::unique_ptr<TranslationUnit> parse_tokens(const TokenStream& stream, Reporter& reporter) {
    return Parser(stream.tokens, reporter).unit();
}

Parser::Parser(const std::vector<Token>& tokens, Reporter& reporter) : tokens_(tokens), reporter_(reporter) {}

/// Definitions until the end. An error ends the definition that it is in, and reading goes on behind it. Two
/// exceptions stay within the parser: Lost ends what is being read, Hopeless the whole source.
std::unique_ptr<TranslationUnit> Parser::unit() {
    try {
        while (!at_end() && !reporter_.full()) {
            try {
                if (accept(";") || skip_plugin()) continue;
                if (at_struct()) {
                    struct_definition();
                    continue;
                }
                if (at_class()) {
                    class_definition();
                    continue;
                }
                refuse_rsl2();
                definition();
            } catch (const Lost&) {
                skip_definition();
            }
        }
    } catch (const Hopeless&) {
        // Reported.
    }
    return std::move(unit_);
}

// ---- Tokens

/// The token that is read next, and on; the End is never left behind.
const Token& Parser::take() {
    const Token& token = now();
    if (next_ + 1 < tokens_.size()) ++next_;
    return token;
}

/// For words that may stand in one place; none is taken.
bool Parser::at_any(std::initializer_list<std::string_view> texts) const {
    return std::any_of(texts.begin(), texts.end(), [&](std::string_view text) { return at(text); });
}

/// Takes a mark or word if it comes now.
bool Parser::accept(std::string_view text) {
    if (!at(text)) return false;
    take();
    return true;
}

/// Reports, and leaves the rule that was being read by an exception.
void Parser::fail(const Token& token, std::string text) {
    reporter_.error(token.at, std::move(text));
    throw Lost();
}

void Parser::fail_expecting(std::string_view what) {
    fail(now(), "expected " + std::string(what) + ", not " + shown(now()));
}

/// Takes a mark or word that must come now; `where` completes the message: expected ")" after arguments.
void Parser::expect(std::string_view text, std::string_view where) {
    if (accept(text)) return;
    const std::string wanted = "\"" + std::string(text) + "\" " + std::string(where);
    // What is missing at a line's end is shown there, not at the next line's beginning.
    if (next_ > 0 && (at_end() || now().at.line != tokens_[next_ - 1].at.line) && text != "{") {
        const Token& last = tokens_[next_ - 1];
        Token behind = last;
        if (last.kind != Token::Kind::Text) behind.at.column += static_cast<uint32_t>(last.text.size());
        fail(behind, "expected " + wanted);
    }
    fail_expecting(wanted);
}

/// A name that is not a word of the language; `what` it is the name of, for messages.
std::string Parser::new_name(std::string_view what) {
    if (now().kind != Token::Kind::Name) fail_expecting(what);
    if (is_reserved(now().text)) fail(now(), shown(now()) + " is a word of the language and no name");
    return std::string(take().text);
}

/// The index behind the parenthesis that closes the one at `open`; that of the end when none does. Braces end
/// the search: where they come first, a parenthesis is missing.
size_t Parser::behind_parentheses(size_t open) const {
    int depth = 0;
    for (size_t i = open; i < tokens_.size(); ++i) {
        if (tokens_[i].kind == Token::Kind::Mark && tokens_[i].text.size() == 1) {
            const char c = tokens_[i].text[0];
            depth += c == '(' ? 1 : c == ')' ? -1 : 0;
            if (c == '{' || c == '}') break;
        }
        if (depth == 0) return i + 1;
    }
    return tokens_.size() - 1;
}

/// Behind the next ; or block, before the next } of outside. The error has been said: what is skipped must
/// end where the next statement is likely to begin, so that one mistake makes one message.
void Parser::skip_statement() {
    for (int depth = 0; !at_end(); take()) {
        if (depth == 0 && accept(";")) return;
        if (at("{")) ++depth;
        if (!at("}")) continue;
        if (depth == 0) return;
        if (--depth == 0) {
            take();
            return;
        }
    }
}

/// Behind the definition that is being read. Braces are counted from where the error was, which may be within
/// some: a shader at a line's beginning ends the search in any case.
void Parser::skip_definition() {
    for (int depth = 0; !at_end(); take()) {
        // Where a shader begins, whatever was wrong before has an end.
        const bool begins = now().line_start && shader_kind_named(now().text) &&
                            ahead(1).kind == Token::Kind::Name && ahead(2).is("(");
        if (begins) return;
        if (at("{")) ++depth;
        if (at("}") && --depth <= 0) {
            take();
            return;
        }
    }
}

/// plugin "file"; offers functions of a library. Headers name libraries that few of their shaders call.
bool Parser::skip_plugin() {
    if (!at("plugin") || ahead(1).kind != Token::Kind::Text || !ahead(2).is(";")) return false;
    reporter_.warning(now().at, "plugins are not supported: functions of \"" +
                                    std::string(ahead(1).text.substr(0, 80)) + "\" are not there");
    for (int i = 0; i < 3; ++i) take();
    return true;
}

/// What RenderMan's second shading language adds is said to be missing once. Words that RSL 2 reserves are
/// names in RSL 1: each is taken for RSL 2 only where what follows could be nothing else.
void Parser::refuse_rsl2() {
    const bool plugin = at("plugin") && ahead(1).kind == Token::Kind::Text;
    const bool public_ = (at("public") || at("method") || at("constant") || at("private")) &&
                         ahead(1).kind == Token::Kind::Name && !ahead(1).is("=") && !ahead(2).is(".");
    const bool handle = at("shader") && ahead(1).kind == Token::Kind::Name;
    const bool member = at("->") || at("::");
    if (!at_class() && !plugin && !public_ && !handle && !member) return;
    reporter_.error(now().at, shown(now()) +
                                  " belongs to RSL 2, of which structs and classes that are shaders "
                                  "are supported, but no co-shaders and plugins");
    throw Hopeless();
}

// ---- Definitions

/// A shader or a function, which are told apart by what stands before the first parenthesis. A function's
/// type may be left out, and words may stand before it, so that no single word tells the two apart.
void Parser::definition() {
    if (shader_kind_named(now().text) && ahead(1).kind == Token::Kind::Name && ahead(2).is("("))
        return shader();
    if (at("transformation") && ahead(1).kind == Token::Kind::Name)
        fail(now(), "transformation shaders are not supported (no renderer ever had them)");
    // Looks past the words and the type for "name (": a function; then begins again from them.
    const size_t before = next_;
    while (at_any({"uniform", "varying", "extern", "output"})) take();
    const bool typed = base_named(now().text) != Base::Void || at("void") || struct_named(next_);
    const size_t name = next_ + (typed ? 1 : 0);
    next_ = before;
    if (tokens_[name].kind == Token::Kind::Name && name + 1 < tokens_.size() && tokens_[name + 1].is("("))
        return function("");
    if (name > before && tokens_[name].kind == Token::Kind::Name)
        fail(tokens_[name], "variables are declared in shaders and functions, not outside them");
    fail_expecting("a shader or a function");
}

/// kind name ( parameters ) { ... }
/// Functions that stand within belong to this shader by its name (Function::inside).
void Parser::shader() {
    auto shader = std::make_unique<Shader>();
    shader->kind = *shader_kind_named(take().text);
    shader->at = now().at;
    shader->name = new_name("the shader's name");
    expect("(", "before the parameters");
    shader->parameters = formals(Variable::Kind::Parameter);
    expect(")", "after the parameters");
    if (!at("{")) fail_expecting("\"{\" before the shader's body");
    inside_ = shader->name;
    shader->body = block();
    inside_.clear();
    unit_->shaders.push_back(std::move(shader));
}

/// [type] name ( parameters ) { ... }; a type left out means that nothing is returned, or a float where a
/// value is.
void Parser::function(std::string inside) {
    auto function = std::make_unique<Function>();
    while (at_any({"uniform", "varying", "extern", "output"})) take();
    function->result_structure = struct_named(next_);
    const bool typed = base_named(now().text) != Base::Void || at("void") || function->result_structure;
    function->typed = typed;
    if (typed) function->result.base = base_named(take().text);
    function->at = now().at;
    function->name = new_name("the function's name");
    function->inside = std::move(inside);
    expect("(", "before the parameters");
    function->parameters = formals(Variable::Kind::FunctionParameter);
    expect(")", "after the parameters");
    if (accept(";")) return;  // a prototype says nothing new
    if (!at("{")) fail_expecting("\"{\" before the function's body");
    // A nested function is read in the middle of another one, whose state is put back behind it.
    const std::string outer = std::exchange(inside_, function->name);
    const bool outer_returns = std::exchange(returns_value_, false);
    function->body = block();
    if (!typed && returns_value_) function->result.base = Base::Float;
    inside_ = outer;
    returns_value_ = outer_returns;
    warn_of_twin(*function);
    unit_->functions.push_back(std::move(function));
}

/// Of functions that no call could tell apart the first counts (Analyser::candidates()).
void Parser::warn_of_twin(const Function& function) {
    if (skips_twins_) return;
    const auto name_of = [](const Type& type, const Struct* structure) {
        return structure ? structure->name : print(type);
    };
    std::string signature = function.inside + '\n' + name_of(function.result, function.result_structure) +
                            ' ' + function.name + '(';
    for (const auto& parameter : function.parameters)
        signature += name_of(parameter->type, parameter->structure) + ',';
    if (!signatures_.insert(std::move(signature)).second)
        reporter_.warning(function.at, "function \"" + function.name +
                                           "\" is defined before with the same parameters: the first "
                                           "definition counts");
}

/// Parameters between parentheses: "float a = 1, b; color c". A type holds until the next ; or type, and a
/// stray ; or , is let pass.
std::vector<std::unique_ptr<Variable>> Parser::formals(Variable::Kind kind) {
    std::vector<std::unique_ptr<Variable>> variables;
    if (at("void") && ahead(1).is(")")) take();
    Specifier now_specified;
    bool specified = false;
    while (!at(")") && !at_end()) {
        if (accept(";")) {
            specified = false;
            continue;
        }
        if (accept(",")) continue;
        refuse_rsl2();
        if (at_specifier()) {
            now_specified = specifier();
            specified = true;
        } else if (!specified) {
            fail_expecting("a parameter's type");
        }
        variables.push_back(declarator(now_specified, kind));
        if (!at_any({",", ";", ")"})) fail_expecting("\";\" or \")\" after a parameter");
    }
    return variables;
}

bool Parser::at_specifier() const {
    return now().kind == Token::Kind::Name && (at_any({"output", "extern", "uniform", "varying"}) ||
                                               base_named(now().text) != Base::Void || struct_named(next_));
}

/// output, extern, uniform and varying in any order, and then the type. RISpec has an order for these words,
/// which shaders do not keep.
Parser::Specifier Parser::specifier() {
    Specifier specifier;
    while (true) {
        if (accept("output")) {
            specifier.output = true;
        } else if (accept("extern")) {
            specifier.external = true;
        } else if (accept("uniform")) {
            specifier.storage = Storage::Uniform;
        } else if (accept("varying")) {
            specifier.storage = Storage::Varying;
        } else {
            break;
        }
    }
    specifier.base = base_named(now().text);
    specifier.structure = struct_named(next_);
    if (now().kind != Token::Kind::Name || (specifier.base == Base::Void && !specifier.structure)) {
        refuse_rsl2();
        fail_expecting("a type");
    }
    take();
    // RISpec 3.1 let the type name a space; it never changed what the variable holds.
    if (now().kind == Token::Kind::Text && ahead(1).kind == Token::Kind::Name) take();
    return specifier;
}

/// name [length] = value. What may not stand where it stands (output of a local, extern with a value) is said
/// by the analysis.
std::unique_ptr<Variable> Parser::declarator(const Specifier& specifier, Variable::Kind kind) {
    auto variable = std::make_unique<Variable>();
    variable->at = now().at;
    variable->name = new_name("a variable's name");
    variable->kind = kind;
    variable->type.base = specifier.base;
    variable->structure = specifier.structure;
    variable->storage = specifier.storage;
    variable->output = specifier.output;
    variable->external = specifier.external;
    if (at("[") && specifier.structure) fail(now(), "arrays of structs are not supported");
    if (accept("[")) variable->type.length = array_length();
    if (accept("=")) variable->initial = initial_value();
    return variable;
}

/// Behind "[": a constant expression, or nothing. Lengths are known before any value is: registers are laid
/// out by them.
int Parser::array_length() {
    if (accept("]")) return Type::kUnsized;
    const Token& first = now();
    const ExpressionPtr length = conditional();
    double value = 0;
    if (!constant_value(*length, value) || value != std::floor(value))
        fail(first, "an array's length is a constant whole number");
    if (value < 1 || value > kLongestArray)
        fail(first, "an array has 1 to " + std::to_string(kLongestArray) + " elements");
    expect("]", "after the array's length");
    return static_cast<int>(value);
}

/// The value of an expression of numbers and + - * / alone; false for any other. Lengths of arrays mostly
/// come out of macros, as "2*N+1": names are numbers by then.
bool Parser::constant_value(const Expression& e, double& value) {
    double left = 0, right = 0;
    if (e.kind == Expression::Kind::Number) {
        value = e.number;
        return true;
    }
    if (e.kind == Expression::Kind::Unary && e.op == Operator::Negate) {
        if (!constant_value(*e.children[0], left)) return false;
        value = -left;
        return true;
    }
    if (e.kind != Expression::Kind::Binary || !constant_value(*e.children[0], left) ||
        !constant_value(*e.children[1], right))
        return false;
    switch (e.op) {
        case Operator::Add:
            value = left + right;
            return true;
        case Operator::Subtract:
            value = left - right;
            return true;
        case Operator::Multiply:
            value = left * right;
            return true;
        case Operator::Divide:
            value = right != 0 ? left / right : 0;
            return right != 0;
        default:
            return false;
    }
}

/// An expression, or an array's values in braces. Braces do not nest, as arrays in RSL have one dimension.
/// {0, ...} fills the array with its last value (3Delight's).
ExpressionPtr Parser::initial_value() {
    if (!at("{")) return expression();
    auto list = std::make_unique<Expression>();
    list->kind = Expression::Kind::List;
    list->at = take().at;
    while (!at("}") && !at_end()) {
        list->children.push_back(expression());
        if (!accept(",")) break;
        list->repeats = accept("...");
        if (list->repeats) break;
    }
    expect("}", "after the array's values");
    return finished(std::move(list));
}

}  // namespace trapeze::rsl
