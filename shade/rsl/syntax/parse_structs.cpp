#include <algorithm>
#include <utility>

#include "shade/rsl/syntax/clone.h"
#include "shade/rsl/syntax/parser.h"
#include "shade/rsl/syntax/printer.h"

namespace trapeze::rsl {

/// "struct" is a name elsewhere.
bool Parser::at_struct() const {
    if (!at("struct") || ahead(1).kind != Token::Kind::Name) return false;
    return ahead(2).is("{") || (ahead(2).is(":") && ahead(3).kind == Token::Kind::Name && ahead(4).is("{"));
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
    if (at_function()) return struct_method(made);
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

/// A function of the file, whose name tells the struct.
void Parser::struct_method(Struct& made) {
    const size_t before = unit_->functions.size();
    const bool skipped = std::exchange(skips_twins_, true);
    function("");
    skips_twins_ = skipped;
    if (unit_->functions.size() == before) return;  // a prototype
    Function& method = *unit_->functions.back();
    const std::string name = std::exchange(method.name, made.name + "->" + method.name);
    for (size_t i = before; i + 1 < unit_->functions.size(); ++i)
        if (unit_->functions[i]->inside == name) unit_->functions[i]->inside = method.name;
    method.method_of = &made;
    made.methods.push_back(name);
}

/// The members of another struct, which come first.
void Parser::struct_base(Struct& made) {
    const auto base = structs_.find(now().text);
    if (base == structs_.end())
        fail(now(), "there is no struct \"" + std::string(now().text.substr(0, 80)) + "\"");
    take();
    made.base = base->second;
    made.pieces = made.base->pieces, made.depth = made.base->depth + 1;
    for (const auto& member : made.base->members) made.members.push_back(clone(*member));
}

/// struct name [: base] { members and methods }, known from here to the end of the file. Headers that are
/// included twice define theirs twice, which says nothing new.
void Parser::struct_definition() {
    take();
    auto made = std::make_unique<Struct>();
    made->at = now().at;
    made->name = new_name("the struct's name");
    const size_t functions = unit_->functions.size();
    if (accept(":")) struct_base(*made);
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
    const bool is_large = made->pieces > kMostMembers || made->depth > kDeepestStruct;  // reported
    const auto known = structs_.find(made->name);
    if (!is_large && known == structs_.end()) {
        structs_[made->name] = made.get();
        unit_->structs.push_back(std::move(made));
        return;
    }
    if (!is_large && print(*known->second) != print(*made))
        reporter_.error(made->at, "struct \"" + made->name.substr(0, 80) + "\" has been defined otherwise");
    unit_->functions.resize(functions);
}

}  // namespace trapeze::rsl
