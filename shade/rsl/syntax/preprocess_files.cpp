#include "shade/rsl/syntax/preprocess_files.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "shade/rsl/syntax/ast.h"
#include "shade/rsl/syntax/condition.h"

namespace trapeze::rsl {
namespace {

/// #line lines beyond which a file is not written by people; each costs an entry in Diagnostics.
constexpr size_t kMostRenumberings = 100000;
/// Folders that are looked into for a header that is nowhere else.
constexpr size_t kMostFoldersBeside = 1000;

/// As messages quote it, cut to a bearable length.
std::string shown(std::string_view text) {
    return "\"" + std::string(text.substr(0, 80)) + (text.size() > 80 ? "...\"" : "\"");
}

/// A string's value, for file names: \" and \\ alone are escapes. Names of files of other systems have
/// backslashes in them, which must not begin escapes of other letters.
std::string file_name_of(std::string_view text) {
    std::string name;
    for (size_t i = 1; i + 1 < text.size(); ++i) {
        if (text[i] == '\\' && (text[i + 1] == '\\' || text[i + 1] == '"') && i + 2 < text.size()) ++i;
        name += text[i];
    }
    return name;
}

}  // namespace

FileReader::FileReader(const CompileOptions& options, Macros& macros, ExpansionBudget& budget,
                       TokenStream& stream, Reporter& reporter)
    : options_(options), macros_(macros), budget_(budget), stream_(stream), reporter_(reporter) {}

/// The text is kept in the stream, since tokens point into it; Diagnostics gets it too, to show the lines
/// that messages are about. Files wait on a stack: the one that is entered is read to its end before the one
/// that includes it goes on. `from` is the place of the #include, which messages about the file tell.
void FileReader::enter(const std::string& name, const std::string& path, std::string text,
                       SourceLocation from) {
    const SourceText& source = stream_.sources.emplace_back(joined_lines(std::move(text)));
    const uint32_t number = reporter_.diagnostics().add_source(name, from, source.as_written);
    files_.push_back({path, name, from, source.as_written, Lexer(source, number, reporter_)});
}

/// Read as a line of a file of its own, so that it obeys the rules of #define and messages have a place.
void FileReader::define_from_outside(const std::string& name, const std::string& value) {
    enter("<command line>", "", "#define " + name + " " + value + "\n", {});
    while (next().kind != Token::Kind::End) {}
}

/// Whether the lines that are read now are compiled: all conditions around them hold.
bool FileReader::counts() const {
    return files_.back().conditionals.empty() || files_.back().conditionals.back().counts;
}

/// Obeys directives on the way, enters files that are included and leaves them at their ends. The end of a
/// file that is included does not end a macro's arguments, nor anything else of the parser's: tokens of all
/// files are one stream.
Token FileReader::next() {
    while (!files_.empty()) {
        // After a bound was passed, or too many errors, the source ends here.
        if (stopped_ || reporter_.full()) {
            files_.clear();
            break;
        }
        Token token = files_.back().lexer.next();
        if (token.kind == Token::Kind::End)
            leave();
        else if (token.line_start && token.is("#"))
            obey(token);
        else if (token.kind != Token::Kind::NewLine && counts())
            return token;
    }
    return {};
}

/// Ends a file. Conditions belong to the file that opened them: what is open still is an error.
void FileReader::leave() {
    for (const Conditional& open : files_.back().conditionals)
        reporter_.error(open.at, "this condition has no #endif");
    files_.pop_back();
}

/// The tokens of a directive, not expanded. Lines that a backslash joined are one; a comment that reaches
/// over lines counts as a blank.
FileReader::Line FileReader::rest_of_line() {
    Line line;
    for (Token token = files_.back().lexer.next();
         token.kind != Token::Kind::NewLine && token.kind != Token::Kind::End;
         token = files_.back().lexer.next())
        line.push_back(token);
    return line;
}

/// By the table as it is now, and against the compilation's one budget.
FileReader::Line FileReader::expanded(const Line& line) {
    return expand_all(line, macros_, budget_, stream_.made, reporter_);
}

/// A directive: all to the line's end behind a # that is the first of its line. Where lines do not count,
/// conditions alone are obeyed. What is unknown is a warning: compilers have directives of their own.
void FileReader::obey(const Token& hash) {
    Line line = rest_of_line();
    if (line.empty()) return;
    const Token word = line.front();
    line.erase(line.begin());
    if (obey_conditional(word.text, word, line) || !counts()) return;
    if (word.is("define")) {
        define(word, line);
    } else if (word.is("undef")) {
        undefine(word, line);
    } else if (word.is("include")) {
        include(word, line);
    } else if (word.is("line")) {
        this->line(word, line);
    } else if (word.kind == Token::Kind::Number) {  // as cpp writes it
        line.insert(line.begin(), word);
        this->line(word, line);
    } else if (word.is("error") || word.is("warning")) {
        say(word, line, word.is("error"));
    } else if (word.is("pragma")) {
        if (!line.empty() && line[0].is("once")) once_.insert(files_.back().path);
    } else if (!word.is("ident")) {
        reporter_.warning(hash.at,
                          "unknown directive #" + std::string(word.text.substr(0, 80)) + " (ignored)");
    }
}

/// True when the directive is one of conditions, all of which are read in lines that do not count as well.
/// Conditions belong to their file: what it leaves open is closed at its end, with an error.
bool FileReader::obey_conditional(std::string_view name, const Token& at, const Line& line) {
    std::vector<Conditional>& open = files_.back().conditionals;
    const bool starts = name == "if" || name == "ifdef" || name == "ifndef";
    if (starts) {
        if (open.size() >= kDeepestNesting) {
            reporter_.error(at.at, "conditions nest too deeply");
            stopped_ = true;
            return true;
        }
        // In lines that do not count conditions are not evaluated: they may name what is not there.
        const bool outer = counts();
        const bool is =
            outer && (name == "if" ? condition(at, line) : name_is_defined(at, line) == (name == "ifdef"));
        open.push_back({at.at, outer, is, is});
        return true;
    }
    if (name != "elif" && name != "else" && name != "endif") return false;
    if (open.empty()) {
        reporter_.error(at.at, "#" + std::string(name) + " without #if");
        return true;
    }
    Conditional& top = open.back();
    if (name == "endif") {
        open.pop_back();
    } else if (top.had_else) {
        reporter_.error(at.at, "#" + std::string(name) + " after #else");
    } else {
        top.had_else = name == "else";
        top.counts = top.outer_counts && !top.taken && (name == "else" || condition(at, line));
        top.taken = top.taken || top.counts;
    }
    return true;
}

/// The expression of #if or #elif. `defined NAME` is answered before macros are expanded, or NAME would be
/// replaced.
bool FileReader::condition(const Token& at, const Line& line) {
    Line without_defined;
    for (size_t i = 0; i < line.size(); ++i) {
        without_defined.push_back(line[i]);
        if (!line[i].is("defined")) continue;
        const bool open = i + 1 < line.size() && line[i + 1].is("(");
        const size_t name = i + (open ? 2 : 1);
        const bool complete = name < line.size() && line[name].kind == Token::Kind::Name &&
                              (!open || (name + 1 < line.size() && line[name + 1].is(")")));
        if (!complete) {
            reporter_.error(line[i].at, "\"defined\" wants a name");
            return false;
        }
        Token& value = without_defined.back();
        value.kind = Token::Kind::Number;
        value.text = macros_.contains(line[name].text) ? "1" : "0";
        i = name + (open ? 1 : 0);
    }
    return evaluate_condition(expanded(without_defined), at.at, reporter_);
}

/// The answer to #ifdef.
bool FileReader::name_is_defined(const Token& at, const Line& line) {
    if (line.empty() || line[0].kind != Token::Kind::Name) {
        reporter_.error(at.at, "#" + std::string(at.text) + " wants a name");
        return false;
    }
    return macros_.contains(line[0].text);
}

/// Reads a macro's parameters, "( a, b, ... )", from the token after the parenthesis; leaves `i` behind the
/// closing one.
bool FileReader::read_parameters(const Line& line, size_t& i, Macro& macro) {
    if (i < line.size() && line[i].is(")")) {
        ++i;
        return true;
    }
    while (i < line.size()) {
        if (line[i].is("...")) {
            macro.variadic = true;
            macro.parameters.push_back("__VA_ARGS__");
        } else if (line[i].kind == Token::Kind::Name) {
            macro.parameters.push_back(line[i].text);
            if (i + 1 < line.size() && line[i + 1].is("...")) macro.variadic = true, ++i;
        } else {
            return false;
        }
        // More than 256 are not written by people; each name in the text is compared with all of them.
        if (macro.parameters.size() > 256 || ++i == line.size()) return false;
        if (line[i].is(")")) {
            ++i;
            return true;
        }
        if (macro.variadic || !line[i].is(",")) return false;
        ++i;
    }
    return false;
}

/// #define. A ( right behind the name makes it a macro with parameters; with a blank between, it belongs to
/// the text.
void FileReader::define(const Token& at, const Line& line) {
    if (line.empty() || line[0].kind != Token::Kind::Name || line[0].is("defined")) {
        reporter_.error(at.at, "#define wants a name");
        return;
    }
    Macro macro;
    macro.at = line[0].at;
    size_t i = 1;
    if (i < line.size() && line[i].is("(") && !line[i].space_before) {
        macro.kind = Macro::Kind::Function;
        if (!read_parameters(line, ++i, macro)) {
            reporter_.error(line[std::min(i, line.size() - 1)].at,
                            "the parameters of macro " + shown(line[0].text) + " are names between ( , )");
            return;
        }
    }
    macro.body.assign(line.begin() + static_cast<std::ptrdiff_t>(i), line.end());
    const bool ends_badly =
        !macro.body.empty() && (macro.body.front().is("##") || macro.body.back().is("##"));
    if (ends_badly) {
        reporter_.error(line[0].at, "## stands between two words, in macro " + shown(line[0].text));
        return;
    }
    if (macros_.define(line[0].text, std::move(macro)))
        reporter_.warning(line[0].at, "macro " + shown(line[0].text) + " is defined anew, differently");
}

/// No error for a name that is no macro, as in C.
void FileReader::undefine(const Token& at, const Line& line) {
    if (line.empty() || line[0].kind != Token::Kind::Name)
        reporter_.error(at.at, "#undef wants a name");
    else
        macros_.remove(line[0].text);
}

/// #error and #warning: the rest of the line as it was written. Clipped at about 500 bytes: the line may be
/// as long as the file.
void FileReader::say(const Token& at, const Line& line, bool error) {
    std::string text;
    for (const Token& token : line) {
        if (!text.empty() && token.space_before) text += ' ';
        text += token.text;
        if (text.size() > 500) break;
    }
    if (line.size() == 1 && line[0].kind == Token::Kind::Text) text = file_name_of(line[0].text);
    if (text.empty()) text = "#" + std::string(at.text);
    if (error)
        reporter_.error(at.at, text);
    else
        reporter_.warning(at.at, text);
}

/// #include, whose file is looked for, in this order: where the including file and the search path say, among
/// the headers that the program carries, and in the folders beside, of which there is a warning.
void FileReader::include(const Token& at, const Line& line_as_written) {
    // A macro may stand for the file's name. Text in quotation marks and <...> is taken as written.
    Line line = line_as_written;
    if (!line.empty() && line[0].kind == Token::Kind::Name) line = expanded(line);
    std::string name;
    // "file" or <file>, which was lexed as marks and names: spaces in it are put back.
    const bool quoted = !line.empty() && line[0].kind == Token::Kind::Text;
    if (quoted) {
        name = file_name_of(line[0].text);
    } else if (!line.empty() && line[0].is("<")) {
        size_t i = 1;
        for (; i < line.size() && !line[i].is(">"); ++i)
            name += (i > 1 && line[i].space_before ? " " : "") + std::string(line[i].text);
        if (i == line.size()) name.clear();
    }
    if (name.empty()) {
        reporter_.error(at.at, "#include wants \"file\" or <file>");
        return;
    }
    if (files_.size() >= kDeepestInclude || ++includes_ > kMostIncludes) {
        reporter_.error(at.at, files_.size() >= kDeepestInclude ? "files include each other too deeply"
                                                                : "too many files are included");
        stopped_ = includes_ > kMostIncludes;
        return;
    }
    for (const std::string& path : places_of(name, quoted))
        if (is_included(path, at)) return;
    const std::string bare = std::filesystem::path(name).filename().string();
    if (options_.carried_file)
        if (const std::string_view text = options_.carried_file(bare); !text.empty()) {
            enter(bare, bare, std::string(text), at.at);
            return;
        }
    for (const std::string& path : places_beside(bare)) {
        if (!is_included(path, at)) continue;
        if (!stopped_)
            reporter_.warning(at.at, "file " + shown(name) + " is in none of the folders to search; " +
                                         shown(path) + " is read");
        return;
    }
    reporter_.error(at.at, "file " + shown(name) + " is not found" +
                               (options_.include_folders.empty() ? "" : " in any of the folders to search"));
}

/// Reads a file in the place of its #include; false if it is not there. CompileOptions::read_file stands in
/// for the disk where sources come from memory.
bool FileReader::is_included(const std::string& path, const Token& at) {
    if (once_.contains(path)) return true;
    std::optional<std::string> text =
        options_.read_file ? options_.read_file(path) : read_file_from_disk(path, kMostBytes);
    if (!text) return false;
    bytes_ += text->size();
    if (bytes_ > kMostBytes) {
        reporter_.error(at.at, "the included files are too large together");
        stopped_ = true;
    } else {
        enter(path, path, std::move(*text), at.at);
    }
    return true;
}

/// Where a file that is included may be, in the order to look. Collections of shaders keep their headers
/// above the folders of the kinds, or in one of their own, and leave it to the compiler's command line to say
/// so.
std::vector<std::string> FileReader::places_of(const std::string& name, bool quoted) const {
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(files_.back().path).parent_path();
    std::vector<std::string> places;
    if (fs::path(name).is_absolute()) return {name};
    if (quoted) places.push_back((folder / name).string());
    for (const std::string& searched : options_.include_folders)
        places.push_back((fs::path(searched) / name).string());
    if (!quoted) places.push_back((folder / name).string());
    for (const char* above : {"", "..", "../.."})
        for (const char* headers : {"", "include", "headers"})
            if (*above || *headers) places.push_back((folder / above / headers / name).string());
    return places;
}

/// In other folders of the collection: those in the file's own and those beside it, by name. Collections of
/// shaders keep their headers in one folder of several, which other compilers are told of by an option.
/// Sorted, so that the choice does not depend on the file system.
std::vector<std::string> FileReader::places_beside(const std::string& name) const {
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(files_.back().path).parent_path();
    std::vector<std::string> places;
    for (const char* above : {".", ".."}) {
        std::vector<std::string> found;
        std::error_code failed;
        for (fs::directory_iterator entry(folder / above, failed), end;
             !failed && entry != end && found.size() < kMostFoldersBeside; entry.increment(failed)) {
            std::error_code unknown;
            if (entry->is_directory(unknown)) found.push_back((entry->path() / name).string());
        }
        std::sort(found.begin(), found.end());
        places.insert(places.end(), found.begin(), found.end());
    }
    return places;
}

/// #line 10 "file", and # 10 "file" 1 as cpp writes it. Each renumbering costs an entry in Diagnostics:
/// beyond a bound they are passed over, and messages have the numbers before.
void FileReader::line(const Token& at, const Line& line_as_written) {
    const Line line = expanded(line_as_written);
    uint32_t number = 0;
    if (!line.empty() && line[0].kind == Token::Kind::Number) {
        const std::string_view text = line[0].text;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error != std::errc() || end != text.data() + text.size()) number = 0;
        if (text == "0") number = 1;
    }
    if (number == 0 || number > 1u << 30) {
        reporter_.error(at.at, "#line wants a line number");
        return;
    }
    if (++renumberings_ > kMostRenumberings) return;
    File& file = files_.back();
    if (line.size() > 1 && line[1].kind == Token::Kind::Text) file.name = file_name_of(line[1].text);
    // Diagnostics knows the lines as renumbered and, by the shift, the line of the text to show.
    const int64_t shift = static_cast<int64_t>(number) - file.lexer.physical_line();
    file.lexer.renumber(reporter_.diagnostics().add_source(file.name, file.from, file.text, shift), number);
}

}  // namespace trapeze::rsl
