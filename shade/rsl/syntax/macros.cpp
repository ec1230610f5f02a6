#include "shade/rsl/syntax/macros.h"

#include <algorithm>

#include "shade/rsl/syntax/lexer.h"

namespace trapeze::rsl {
namespace {

/// Whether two definitions are the same to the letter, which makes defining anew harmless.
bool same_body(const Macro& a, const Macro& b) {
    return a.kind == b.kind && a.variadic == b.variadic && a.parameters == b.parameters &&
           std::equal(a.body.begin(), a.body.end(), b.body.begin(), b.body.end(),
                      [](const Token& x, const Token& y) { return x.kind == y.kind && x.text == y.text; });
}

/// Which parameter a name in a macro's text is; npos for none.
size_t parameter_index(const Macro& macro, const Token& token) {
    if (macro.kind != Macro::Kind::Function || token.kind != Token::Kind::Name) return std::string::npos;
    for (size_t i = 0; i < macro.parameters.size(); ++i)
        if (macro.parameters[i] == token.text) return i;
    return std::string::npos;
}

}  // namespace

/// The pointer keeps a macro alive while its text is read, even if #undef takes it out of the table
/// meanwhile.
std::shared_ptr<Macro> Macros::find(std::string_view name) const {
    const auto entry = table_.find(name);
    return entry == table_.end() ? nullptr : entry->second;
}

/// A new object each time: expansions of the old definition that are under way go on with it.
bool Macros::define(std::string_view name, Macro macro) {
    std::shared_ptr<Macro>& entry = table_[name];
    const bool differs = entry && !same_body(*entry, macro);
    entry = std::make_shared<Macro>(std::move(macro));
    return differs;
}

/// Macros are enabled again, for the table outlives this expander where an error has ended it early.
Expander::~Expander() {
    while (!contexts_.empty()) leave_context();
}

/// The macro's text has been read to its end: its name means it again.
void Expander::leave_context() {
    --contexts_.back().macro->disabled;
    contexts_.pop_back();
}

/// Ends all expansion of this compilation, and says so once.
void Expander::exceed(SourceLocation at, const char* what) {
    if (!budget_.exceeded) reporter_.error(at, what);
    budget_.exceeded = true;
}

/// The next token before expansion: of the innermost macro's text, or of the file. A macro's text is left as
/// soon as it is used up, which makes its name one that may be expanded again: C's rule that a macro does not
/// expand within itself.
Token Expander::pull() {
    while (!contexts_.empty()) {
        Context& top = contexts_.back();
        if (top.position < top.tokens.size()) return top.tokens[top.position++];
        leave_context();
    }
    if (!put_back_.empty()) {
        const Token token = put_back_.back();
        put_back_.pop_back();
        return token;
    }
    return read_();
}

/// Looks ahead without expanding: the name of a macro with parameters that no parenthesis follows is an
/// ordinary name.
bool Expander::next_is_open_parenthesis() {
    while (!contexts_.empty() && contexts_.back().position == contexts_.back().tokens.size()) leave_context();
    if (!contexts_.empty()) return contexts_.back().tokens[contexts_.back().position].is("(");
    if (put_back_.empty()) put_back_.push_back(read_());
    return put_back_.back().is("(");
}

/// Every name that is a macro, and not within its own expansion, is replaced until a token is left that is
/// none. A name that was met inside its own expansion stays painted: it is never replaced, wherever it goes
/// (C 6.10.3.4).
Token Expander::next() {
    while (true) {
        if (budget_.exceeded) return {};
        Token token = pull();
        if (token.kind != Token::Kind::Name || token.painted) return token;
        const std::shared_ptr<Macro> macro = macros_.find(token.text);
        if (!macro) return token;
        // Met while its own text is read: this token stays a plain name from now on, wherever it goes.
        if (macro->disabled > 0) {
            token.painted = true;
            return token;
        }
        if (macro->kind == Macro::Kind::Line) {
            token.kind = Token::Kind::Number;
            token.text = keep(std::to_string(token.at.line));
            return token;
        }
        if (macro->kind == Macro::Kind::File) {
            token.kind = Token::Kind::Text;
            token.text = keep('"' + reporter_.diagnostics().source_name(token.at.source) + '"');
            return token;
        }
        if (macro->kind == Macro::Kind::Function && !next_is_open_parenthesis()) return token;
        expand(token, macro);
    }
}

/// Puts the macro's text in front of what is still to be read, where next() looks for macros in it again;
/// while it is read the macro's own name stays as it is, as in C.
void Expander::expand(const Token& name, const std::shared_ptr<Macro>& macro) {
    Arguments arguments;
    if (macro->kind == Macro::Kind::Function && !collect_arguments(name, *macro, arguments)) return;
    std::vector<Token> tokens = substitute(name, *macro, arguments);
    budget_.tokens += tokens.size() + 1;
    if (budget_.tokens > ExpansionBudget::kMostTokens)
        exceed(name.at, "the macros of this file expand without end");
    if (contexts_.size() >= ExpansionBudget::kDeepestExpansions)
        exceed(name.at, "macros that use macros nest too deeply");
    if (budget_.exceeded) return;
    if (!tokens.empty()) tokens.front().space_before = name.space_before;
    ++macro->disabled;
    contexts_.push_back({std::move(tokens), 0, macro});
}

/// Reads "( a, b, ... )" after a macro's name. Commas within parentheses separate nothing. Lines may end
/// among the arguments; directives there are obeyed by the reader.
bool Expander::collect_arguments(const Token& name, const Macro& macro, Arguments& arguments) {
    const std::string called = "macro \"" + std::string(name.text) + "\"";
    const size_t wanted = macro.parameters.size();
    pull();  // the parenthesis
    arguments.emplace_back();
    for (int depth = 0;;) {
        const Token token = pull();
        if (token.kind == Token::Kind::End) {
            reporter_.error(name.at, "the arguments of " + called + " never end: a ) is missing");
            return false;
        }
        if (++budget_.tokens > ExpansionBudget::kMostTokens) {
            exceed(name.at, "the macros of this file expand without end");
            return false;
        }
        if (depth == 0 && token.is(")")) break;
        depth += token.is("(") ? 1 : token.is(")") ? -1 : 0;
        const bool rest = macro.variadic && arguments.size() == wanted;
        if (depth == 0 && token.is(",") && !rest)
            arguments.emplace_back();
        else
            arguments.back().push_back(token);
    }
    // "f()" reads as one empty argument: none for a macro without parameters. "..." may be left out.
    if (wanted == 0 && arguments.size() == 1 && arguments[0].empty()) arguments.clear();
    if (macro.variadic && arguments.size() + 1 == wanted) arguments.emplace_back();
    if (arguments.size() == wanted) return true;
    reporter_.error(name.at, called + " takes " + std::to_string(wanted) +
                                 (wanted == 1 ? " argument, " : " arguments, ") +
                                 std::to_string(arguments.size()) + " are given");
    return false;
}

/// The macro's text with its arguments in place. Tokens of the text stand where the macro is used. As C has
/// it: an argument beside # or ## is taken as it was written, any other is expanded first; what results is
/// read again for further macros.
std::vector<Token> Expander::substitute(const Token& name, const Macro& macro, const Arguments& arguments) {
    std::vector<Token> out;
    // Arguments after expansion: each is expanded at most once, and not at all where # or ## takes it.
    std::vector<std::vector<Token>> cache(arguments.size());
    std::vector<bool> cached(arguments.size(), false);
    // paste: a ## stands before this piece. left_empty: nothing stands to its left that could be pasted to.
    bool paste = false, left_empty = true;
    const std::vector<Token>& body = macro.body;
    for (size_t i = 0; i < body.size() && !budget_.exceeded; ++i) {
        const bool function = macro.kind == Macro::Kind::Function;
        if (body[i].is("##") && i > 0 && i + 1 < body.size()) {
            paste = true;
            continue;
        }
        std::vector<Token> piece;
        const size_t parameter = parameter_index(macro, body[i]);
        if (function && body[i].is("#") && i + 1 < body.size() &&
            parameter_index(macro, body[i + 1]) != std::string::npos) {
            piece = {stringized(arguments[parameter_index(macro, body[++i])], name)};
        } else if (parameter == std::string::npos) {
            piece = {body[i]};
            piece[0].at = name.at;
        } else if (paste || (i + 1 < body.size() && body[i + 1].is("##"))) {
            piece = arguments[parameter];
            // ", ## __VA_ARGS__": the comma goes where nothing follows it.
            if (paste && macro.variadic && parameter + 1 == macro.parameters.size() && !out.empty() &&
                out.back().is(",")) {
                if (piece.empty()) out.pop_back();
                paste = false;
            }
        } else {
            if (!cached[parameter]) cache[parameter] = expanded(arguments[parameter]);
            cached[parameter] = true;
            piece = cache[parameter];
        }
        if (!piece.empty()) piece.front().space_before = body[i].space_before;
        const bool empty = piece.empty();
        if (paste && !left_empty && !empty) {
            out.back() = pasted(out.back(), piece.front(), name);
            piece.erase(piece.begin());
        }
        left_empty = empty && (!paste || left_empty);
        paste = false;
        budget_.tokens += piece.size();
        if (budget_.tokens > ExpansionBudget::kMostTokens)
            exceed(name.at, "the macros of this file expand without end");
        out.insert(out.end(), piece.begin(), piece.end());
    }
    return out;
}

/// An argument is expanded by itself before it is put in, as if it were the rest of the file. It has a budget
/// of depth of its own, as each level is one of this program's stack.
std::vector<Token> Expander::expanded(const std::vector<Token>& argument) {
    if (++budget_.argument_depth > ExpansionBudget::kDeepestArguments && !argument.empty())
        exceed(argument.front().at, "macros in arguments of macros nest too deeply");
    std::vector<Token> tokens;
    if (!budget_.exceeded) tokens = expand_all(argument, macros_, budget_, made_, reporter_);
    --budget_.argument_depth;
    return tokens;
}

/// Texts that stand in no source live as long as the stream of tokens.
std::string_view Expander::keep(std::string text) {
    budget_.made_bytes += text.size();
    made_.push_back(std::move(text));
    return made_.back();
}

/// # parameter. Blanks between tokens become one; quotation marks and backslashes within strings are escaped,
/// so that the result reads back as the same text.
Token Expander::stringized(const std::vector<Token>& argument, const Token& name) {
    std::string text = "\"";
    for (const Token& token : argument) {
        if (token.space_before && text.size() > 1) text += ' ';
        for (const char c : token.text) {
            if (token.kind == Token::Kind::Text && (c == '"' || c == '\\')) text += '\\';
            text += c;
        }
        if (budget_.made_bytes + text.size() > ExpansionBudget::kMostMadeBytes) {
            exceed(name.at, "the macros of this file make too much text");
            break;
        }
    }
    Token token;
    token.kind = Token::Kind::Text;
    token.text = keep(text + '"');
    token.at = name.at;
    return token;
}

/// left ## right. The text is scanned by a lexer that reports nothing, since what a paste must not make is
/// said here. A pasted name may be a macro's again. After an error the left one stands alone.
Token Expander::pasted(const Token& left, const Token& right, const Token& name) {
    Token token = left;
    const std::string text = std::string(left.text) + std::string(right.text);
    if (budget_.made_bytes + text.size() > ExpansionBudget::kMostMadeBytes) {
        exceed(name.at, "the macros of this file make too much text");
        return token;
    }
    if (!is_one_token(text, token.kind)) {
        reporter_.error(name.at, "## makes no word of \"" + std::string(left.text.substr(0, 40)) +
                                     "\" and \"" + std::string(right.text.substr(0, 40)) + "\"");
        return left;
    }
    token.text = keep(text);
    token.at = name.at;
    token.painted = false;
    return token;
}

/// By an expander of its own, whose source is the list: a macro's name at its end finds no parenthesis behind
/// the list.
std::vector<Token> expand_all(const std::vector<Token>& tokens, Macros& macros, ExpansionBudget& budget,
                              std::deque<std::string>& made, Reporter& reporter) {
    size_t position = 0;
    Expander expander([&] { return position < tokens.size() ? tokens[position++] : Token(); }, macros, budget,
                      made, reporter);
    std::vector<Token> out;
    for (Token token = expander.next(); token.kind != Token::Kind::End; token = expander.next())
        out.push_back(token);
    return out;
}

}  // namespace trapeze::rsl
