/// Comments are what the lexer passes over: it is run for them alone, and its tokens are dropped.
#include "pipeline/rib/syntax/comments.h"

#include "pipeline/rib/syntax/lexer.h"
#include "pipeline/rib/syntax/source_text.h"

namespace trapeze::rib {

/// Comments are what the lexer passes over: it is run for them alone, and its tokens are dropped. It alone
/// can tell a comment from a "#" within a string or an encoded value.
bool for_each_comment(const std::string& path, size_t max_bytes,
                      const std::function<void(Comment)>& on_comment, std::string* error) {
    const std::optional<SourceText> source = read_source(path, max_bytes, error);
    if (!source) return false;
    Lexer lexer(source->text, {0, 1, 1});
    lexer.on_comment([&](std::string_view line) {
        const bool is_structure = line.starts_with("##");
        on_comment({is_structure, std::string(line.substr(is_structure ? 2 : 1))});
    });
    while (lexer.peek().kind != TokenKind::End) lexer.skip();
    return true;
}

}  // namespace trapeze::rib
