/// Tokens to tree, by recursive descent (RISpec 3.2, appendix B, and what real shaders use beyond it).
#pragma once

#include <initializer_list>
#include <map>
#include <memory>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "shade/rsl/syntax/ast.h"
#include "shade/rsl/syntax/reporter.h"
#include "shade/rsl/syntax/token.h"

namespace trapeze::rsl {

/// After an error goes on behind the next ; or }, and reports what else is wrong. Of use only when
/// reporter.failed() is false.
std::unique_ptr<TranslationUnit> parse_tokens(const TokenStream& stream, Reporter& reporter);

/// The parser's state. parser.cpp has definitions, parse_structs.cpp, parse_classes.cpp,
/// parse_statements.cpp and parse_expressions.cpp the rest. A token is looked at as often as it takes and
/// taken once; there is no going back but in at_...(), definition() and class_definition(), which look ahead
/// by index. Functions named for a rule read that rule from now() on, and leave the token behind it as the
/// next.
class Parser {
  public:
    Parser(const std::vector<Token>& tokens, Reporter& reporter);
    std::unique_ptr<TranslationUnit> unit();

  private:
    /// Thrown after an error is reported, caught where parsing can go on; never leaves the parser.
    struct Lost {};
    /// Thrown where nothing that follows can be understood.
    struct Hopeless {};
    /// What stands before a variable's name.
    struct Specifier {
        Base base = Base::Void;
        const Struct* structure = nullptr;
        Storage storage = Storage::Unspecified;
        bool output = false, external = false;
    };
    /// Bounds the recursion: see below.
    class Nesting;
    struct ClassParts;

    // Tokens.
    /// The End is the last of tokens_ and is never passed, so that now() and ahead() always have a token.
    const Token& now() const { return tokens_[next_]; }
    const Token& ahead(size_t n) const { return tokens_[std::min(next_ + n, tokens_.size() - 1)]; }
    bool at(std::string_view text) const { return now().is(text); }
    bool at_any(std::initializer_list<std::string_view> texts) const;
    bool at_end() const { return now().kind == Token::Kind::End; }
    const Token& take();
    /// accept() takes a token if it is the one named, expect() reports when it is not.
    bool accept(std::string_view text);
    void expect(std::string_view text, std::string_view where);
    /// An error for a reserved word and for what is no name.
    std::string new_name(std::string_view what);
    /// For looking ahead over a parameter list, in time linear in its length.
    size_t behind_parentheses(size_t open) const;
    [[noreturn]] void fail(const Token& token, std::string text);
    [[noreturn]] void fail_expecting(std::string_view what);
    /// Where reading goes on after an error: both leave the End in place.
    void skip_statement();
    /// Goes on where the next shader or function is likely to begin, after an error.
    void skip_definition();
    /// Called wherever a word of RSL 2 could begin something; does nothing before any other word.
    bool skip_plugin();
    void refuse_rsl2();

    // Definitions: parser.cpp.
    void definition();
    void shader();
    void function(std::string inside);
    void warn_of_twin(const Function& function);
    std::vector<std::unique_ptr<Variable>> formals(Variable::Kind kind);
    /// at_...() look ahead and take nothing.
    bool at_specifier() const;
    Specifier specifier();
    std::unique_ptr<Variable> declarator(const Specifier& specifier, Variable::Kind kind);
    int array_length();
    ExpressionPtr initial_value();
    /// Lengths of arrays are needed while parsing, before there is an analysis to fold constants.
    static bool constant_value(const Expression& e, double& value);

    // Structs: parse_structs.cpp. flatten_structs.h takes them apart.
    bool at_struct() const;
    void struct_definition();
    void struct_members(Struct& made);
    void struct_method(Struct& made);
    void struct_base(Struct& made);
    /// The struct that a token names as the type of what follows; null for others.
    const Struct* struct_named(size_t token) const;

    // Classes: parse_classes.cpp.
    bool at_class() const;
    void class_definition();
    ClassParts class_parts();
    void class_member(ClassParts& parts);
    void class_method(ClassParts& parts);
    void place_method(ClassParts& parts, size_t number, int depth, std::vector<StatementPtr>& to);
    std::unique_ptr<Shader> shader_of(ClassParts parts, ShaderKind kind);

    // Statements: parse_statements.cpp. statement() is the one entry, and counts the nesting.
    StatementPtr statement();
    /// The kinds of statements by their first word; statement() counts the depth.
    StatementPtr statement_within();
    StatementPtr block();
    StatementPtr evaluation();
    StatementPtr declaration();
    /// Goes into the unit's functions; an empty statement stays in its place.
    StatementPtr nested_function();
    /// Looks ahead and takes nothing, like all that begin with at.
    bool at_declaration() const;
    bool at_function() const;
    StatementPtr if_statement();
    StatementPtr while_statement();
    StatementPtr for_statement();
    StatementPtr light_statement(Statement::Kind kind);
    StatementPtr loop_control(Statement::Kind kind);
    StatementPtr return_statement();
    ExpressionPtr parenthesised_condition(std::string_view where);

    // Expressions.
    /// From loosest to tightest: each function reads one level and calls the next.
    ExpressionPtr expression();
    ExpressionPtr conditional();
    ExpressionPtr binary(int lowest);
    ExpressionPtr unary();
    ExpressionPtr cast();
    ExpressionPtr postfix();
    ExpressionPtr primary();
    ExpressionPtr parentheses();
    std::vector<ExpressionPtr> arguments();
    /// Every node is handed through this when its children are complete.
    ExpressionPtr finished(ExpressionPtr e);

    const std::vector<Token>& tokens_;
    Reporter& reporter_;
    std::unique_ptr<TranslationUnit> unit_ = std::make_unique<TranslationUnit>();
    std::unordered_set<std::string> signatures_;  ///< of all functions so far but methods of structs
    bool skips_twins_ = false;                    ///< methods of structs, and of a class that is read again
    std::map<std::string, const Struct*, std::less<>> structs_;  // defined so far
    std::string inside_;                                         // the shader or function whose body is read
    bool returns_value_ = false;                                 // it has a "return" with a value
    size_t next_ = 0;
    int nesting_ = 0;
};

/// Counts how deep parsing nests while it lives.
class Parser::Nesting {
  public:
    explicit Nesting(Parser& parser) : parser_(parser) {
        if (++parser_.nesting_ <= kDeepestNesting) return;
        parser_.reporter_.error(parser_.now().at, "this nests too deeply");
        --parser_.nesting_;
        throw Hopeless();
    }
    ~Nesting() { --parser_.nesting_; }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;

  private:
    Parser& parser_;
};

/// Void for what names no type.
Base base_named(std::string_view name);
/// The type as the language calls it, such as "float".
std::string_view name_of(Base base);
std::string_view name_of(ShaderKind kind);
/// Words that cannot name variables or functions.
bool is_reserved(std::string_view name);

}  // namespace trapeze::rsl
