#include "shade/rsl/syntax/preprocessor.h"

#include "shade/rsl/syntax/preprocess_files.h"

namespace trapeze::rsl {
namespace {

// A bound on memory and time for files from strangers.
constexpr size_t kMostTokens = size_t{1} << 20;  // that the parser gets

/// __FILE__ and __LINE__, and TRAPEZE, by which shaders tell this compiler from others. The first two have
/// kinds of their own, as their text depends on where they are used.
void define_builtin(Macros& macros) {
    Macro file, line, trapeze;
    file.kind = Macro::Kind::File;
    line.kind = Macro::Kind::Line;
    Token one;
    one.kind = Token::Kind::Number;
    one.text = "1";
    trapeze.body = {one};
    macros.define("__FILE__", std::move(file));
    macros.define("__LINE__", std::move(line));
    macros.define("TRAPEZE", std::move(trapeze));
}

}  // namespace

/// Two stages in a pipe: FileReader hands on the tokens of lines that count, Expander replaces macros among
/// them.
TokenStream preprocess(const Source& source, const CompileOptions& options, Reporter& reporter) {
    TokenStream stream;
    Macros macros;
    ExpansionBudget budget;
    FileReader files(options, macros, budget, stream, reporter);
    define_builtin(macros);
    for (const auto& [name, value] : options.defines) files.define_from_outside(name, value);
    if (source.text.size() <= FileReader::kMostBytes)
        files.enter(source.name, source.name, source.text, {});
    else
        reporter.error({}, "\"" + source.name + "\" is too large for a shader");
    Expander expander([&] { return files.next(); }, macros, budget, stream.made, reporter);
    for (Token token = expander.next(); token.kind != Token::Kind::End; token = expander.next()) {
        if (stream.tokens.size() == kMostTokens) {
            reporter.error(token.at, "this file is too large after its macros are expanded");
            break;
        }
        stream.tokens.push_back(token);
    }
    // The End stands behind the last token, for messages about what is missing.
    Token end;
    if (!stream.tokens.empty()) {
        const Token& last = stream.tokens.back();
        end.at = last.at;
        end.at.column += static_cast<uint32_t>(last.text.size());
    }
    stream.tokens.push_back(end);
    return stream;
}

}  // namespace trapeze::rsl
