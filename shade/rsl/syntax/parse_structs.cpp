#include <algorithm>

#include "shade/rsl/syntax/parser.h"
#include "shade/rsl/syntax/printer.h"

namespace trapeze::rsl {

/// "struct" is a name elsewhere.
bool Parser::at_struct() const {
    return at("struct") && ahead(1).kind == Token::Kind::Name && ahead(2).is("{");
}

/// A struct's name makes a value where a parenthesis follows.
const Struct* Parser::struct_named(size_t token) const {
    if (structs_.empty() || tokens_[token].kind != Token::Kind::Name) return nullptr;
    if (tokens_[std::min(token + 1, tokens_.size() - 1)].kind != Token::Kind::Name) return nullptr;
    const auto known = structs_.find(tokens_[token].text);
    return known == structs_.end() ? nullptr : known->second;
}

/// Those of one declaration.
void Parser::struct_members(Struct& made) {
    if (accept(";")) return;
    while (at_any({"public", "private"}) && ahead(1).kind == Token::Kind::Name) take();
    if (at_function()) fail(now(), "structs have members only, and no methods");
    if (!at_specifier()) fail_expecting("a member of the struct");
    const StatementPtr declared = declaration();
    for (auto& member : declared->variables) {
        if (made.find(member->name))
            reporter_.error(member->at, "member \"" + member->name.substr(0, 80) + "\" is there twice");
        if (member->structure && member->initial)
            reporter_.error(member->at, "a member that is a struct has that one's values");
        // Other than variables.
        if (member->storage == Storage::Unspecified && !member->structure) member->storage = Storage::Uniform;
        made.pieces += member->structure ? member->structure->pieces : 1;
        if (member->structure) made.depth = std::max(made.depth, member->structure->depth + 1);
        made.members.push_back(std::move(member));
    }
    if (made.pieces > kMostMembers || made.depth > kDeepestStruct)
        fail(now(), "struct \"" + made.name.substr(0, 80) + "\" has too many members with those in them");
}

/// struct name { members }, known from here to the end of the file. Headers that are included twice define
/// theirs twice, which says nothing new.
void Parser::struct_definition() {
    take();
    auto made = std::make_unique<Struct>();
    made->at = now().at;
    made->name = new_name("the struct's name");
    expect("{", "before the struct's members");
    while (!at("}") && !at_end() && !reporter_.full()) {
        try {
            struct_members(*made);
        } catch (const Lost&) {
            skip_statement();
        }
    }
    expect("}", "after the struct's members");
    accept(";");
    if (made->pieces > kMostMembers || made->depth > kDeepestStruct) return;  // reported
    const auto known = structs_.find(made->name);
    if (known == structs_.end()) {
        structs_[made->name] = made.get();
        unit_->structs.push_back(std::move(made));
    } else if (print(*known->second) != print(*made)) {
        reporter_.error(made->at, "struct \"" + made->name.substr(0, 80) + "\" has been defined otherwise");
    }
}

}  // namespace trapeze::rsl
