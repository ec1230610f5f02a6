/// The files that a preprocessor reads, and their directives.
#pragma once

#include <unordered_set>

#include "shade/rsl/syntax/lexer.h"
#include "shade/rsl/syntax/macros.h"
#include "shade/rsl/syntax/source.h"

namespace trapeze::rsl {

/// Tokens of a file and its includes before macros are expanded; directives are obeyed on the way. It is
/// asked by an Expander, token by token; so a directive takes effect exactly between the tokens where it
/// stands, even within a macro's arguments.
class FileReader {
  public:
    /// Bounds that no collection of shaders comes near, and that end a file which includes itself.
    static constexpr size_t kDeepestInclude = 32;
    static constexpr size_t kMostIncludes = 5000;
    static constexpr size_t kMostBytes = size_t{64} << 20;

    FileReader(const CompileOptions& options, Macros& macros, ExpansionBudget& budget, TokenStream& stream,
               Reporter& reporter);

    /// Begins a file; `from` is where it is included.
    void enter(const std::string& name, const std::string& path, std::string text, SourceLocation from);
    /// What -D says: `name` may have parameters.
    void define_from_outside(const std::string& name, const std::string& value);
    /// The next token outside directives and of lines that count; End after the last file.
    Token next();

  private:
    /// An #if that is open. outer_counts: the lines around it are compiled; counts: those of the branch that
    /// is read now; taken: some branch has been compiled, so that no later one is.
    struct Conditional {
        SourceLocation at;
        bool outer_counts, counts, taken, had_else = false;
    };
    /// A file that is open: the last of files_ is read, the others wait behind their #include.
    struct File {
        std::string path;  ///< where it was found, for includes beside it
        std::string name;  ///< as messages and #line call it
        SourceLocation from;
        std::shared_ptr<const std::string> text;  ///< as written, for what messages show
        Lexer lexer;
        std::vector<Conditional> conditionals = {};
    };
    /// What stands in a directive's line behind its word.
    using Line = std::vector<Token>;

    /// Of the innermost condition: it knows whether those around it hold.
    bool counts() const;
    /// Ends the innermost file; conditions that it leaves open are errors of its own.
    void leave();
    /// The tokens up to the line's end, which is taken as well.
    Line rest_of_line();
    Line expanded(const Line& line);

    void obey(const Token& hash);
    /// Conditionals are obeyed in lines that do not count too, or their #endif would be taken for another's.
    bool obey_conditional(std::string_view name, const Token& at, const Line& line);
    bool condition(const Token& at, const Line& line);
    bool name_is_defined(const Token& at, const Line& line);
    void define(const Token& at, const Line& line);
    bool read_parameters(const Line& line, size_t& i, Macro& macro);
    void undefine(const Token& at, const Line& line);
    void include(const Token& at, const Line& line);
    bool is_included(const std::string& path, const Token& at);
    /// Paths to try, in order; nothing is opened here.
    std::vector<std::string> places_of(const std::string& name, bool quoted) const;
    std::vector<std::string> places_beside(const std::string& name) const;
    void line(const Token& at, const Line& line);
    void say(const Token& at, const Line& line, bool error);

    const CompileOptions& options_;
    Macros& macros_;
    ExpansionBudget& budget_;
    TokenStream& stream_;
    Reporter& reporter_;
    std::vector<File> files_;
    std::unordered_set<std::string> once_;  ///< files with #pragma once
    size_t bytes_ = 0, includes_ = 0, renumberings_ = 0;
    bool stopped_ = false;  ///< a bound was passed: nothing more is read
};

}  // namespace trapeze::rsl
