/// The preprocessor's macros: their table, and their expansion within bounds.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "shade/rsl/syntax/reporter.h"
#include "shade/rsl/syntax/token.h"

namespace trapeze::rsl {

/// A macro as it was defined; __FILE__ and __LINE__ are kinds of their own.
struct Macro {
    enum class Kind : uint8_t { Object, Function, File, Line };
    Kind kind = Kind::Object;
    bool variadic = false;  ///< the last parameter takes all further arguments
    std::vector<std::string_view> parameters;
    std::vector<Token> body;
    SourceLocation at;
    int disabled = 0;  ///< how many expansions of it are being read
};

/// The table of macros. Names are views of texts that the TokenStream keeps, tokens of bodies too. One table
/// for a compilation: definitions of an included file stay in force behind its #include.
class Macros {
  public:
    /// Null for what is no macro. Shared, since a directive among a macro's arguments may remove it.
    std::shared_ptr<Macro> find(std::string_view name) const;
    bool contains(std::string_view name) const { return table_.contains(name); }
    /// The name's text must outlive the table. True when it had another meaning.
    bool define(std::string_view name, Macro macro);
    void remove(std::string_view name) { table_.erase(name); }

  private:
    std::unordered_map<std::string_view, std::shared_ptr<Macro>> table_;
};

/// How much expansion has cost in one compilation. Macros that use macros can grow without end in a few
/// lines of source; beyond these bounds all expansion ends, with one error. Shared by all expanders of a
/// compilation, those of arguments and directives included.
struct ExpansionBudget {
    static constexpr size_t kMostTokens = size_t{1} << 21;     ///< written by all expansions together
    static constexpr size_t kMostMadeBytes = size_t{1} << 25;  ///< by # and ##
    static constexpr int kDeepestArguments = 64;               ///< macros in arguments of macros in...
    static constexpr size_t kDeepestExpansions = 1000;         ///< macros in texts of macros in...

    size_t tokens = 0, made_bytes = 0;
    int argument_depth = 0;
    bool exceeded = false;
};

/// Replaces macros in the tokens that a function gives, until End. Tokens come from three places, innermost
/// first: texts of macros that are being read, tokens put back after a look ahead, and `read`.
class Expander {
  public:
    using Read = std::function<Token()>;
    Expander(Read read, Macros& macros, ExpansionBudget& budget, std::deque<std::string>& made,
             Reporter& reporter)
        : read_(std::move(read)), macros_(macros), budget_(budget), made_(made), reporter_(reporter) {}
    ~Expander();
    Expander(const Expander&) = delete;
    Expander& operator=(const Expander&) = delete;

    /// The next token after expansion; End at the end, or when the budget is used up.
    Token next();

  private:
    /// A macro's text that is being read. The macro is disabled while it is on the stack, so that its name in
    /// its own text stays as it is.
    struct Context {
        std::vector<Token> tokens;
        size_t position = 0;
        std::shared_ptr<Macro> macro;
    };
    using Arguments = std::vector<std::vector<Token>>;

    /// The next token before expansion.
    Token pull();
    /// Leaves macros' texts that are read to their end, so that a call may begin in a macro's text and end
    /// behind it.
    bool next_is_open_parenthesis();
    void leave_context();
    void expand(const Token& name, const std::shared_ptr<Macro>& macro);
    /// False after an error, which is reported; then the macro's name and what was read of its arguments are
    /// gone.
    bool collect_arguments(const Token& name, const Macro& macro, Arguments& arguments);
    /// The text of one use, arguments in place; # and ## take arguments as they were written, all else as
    /// expanded.
    std::vector<Token> substitute(const Token& name, const Macro& macro, const Arguments& arguments);
    std::vector<Token> expanded(const std::vector<Token>& argument);
    Token stringized(const std::vector<Token>& argument, const Token& name);
    Token pasted(const Token& left, const Token& right, const Token& name);
    /// For words that stand in no file: those made by #, ## and __LINE__.
    std::string_view keep(std::string text);
    /// Reports what there is too much of, and ends all expansion.
    void exceed(SourceLocation at, const char* what);

    Read read_;
    Macros& macros_;
    ExpansionBudget& budget_;
    std::deque<std::string>& made_;  ///< TokenStream::made
    Reporter& reporter_;
    std::vector<Context> contexts_;
    std::vector<Token> put_back_;  ///< read to see whether a parenthesis follows
};

/// All of a list, expanded.
std::vector<Token> expand_all(const std::vector<Token>& tokens, Macros& macros, ExpansionBudget& budget,
                              std::deque<std::string>& made, Reporter& reporter);

}  // namespace trapeze::rsl
