/// Types of parameters: RISpec's own, those that Declare adds, and inline ones ("uniform color foo").
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "core/scene/parameters.h"

namespace trapeze::rib {

/// The longest array a declaration may have.
inline constexpr int kLongestArray = 1000000;

/// "[class] type[n]", words apart by spaces; nothing when it is not one.
std::optional<Declaration> parse_declaration(std::string_view text);

/// As Declare writes it; static memory.
std::string_view name_of(StorageClass storage);

/// One table for the whole reading: Declare is not part of the graphics state, and no block ends what it
/// says.
class Declarations {
  public:
    Declarations();  ///< RISpec's predeclared names

    /// What a token stands for.
    struct Meaning {
        std::string name;  ///< without the declaration that the token may carry
        Declaration declaration;
        bool is_predeclared = false;  ///< a bare name of RISpec's own, that nobody has declared anew
    };

    /// Primitives that were read before keep the types that they were read with.
    void declare(const std::string& name, const Declaration& declaration) {
        known_[name] = {name, declaration, false};
    }
    /// A name that was never declared is none to forget; RISpec's own stay.
    void forget(const std::string& name) {
        if (const auto known = known_.find(name); known != known_.end() && !known->second.is_predeclared)
            known_.erase(known);
    }
    /// A parameter's token, which may carry its declaration; null when it is unknown. Holds until the next
    /// token is looked for, or declared.
    const Meaning* find(const std::string& token) const;
    /// The same as the bare name and its type.
    std::optional<std::pair<std::string, Declaration>> resolve(const std::string& token) const {
        const Meaning* const meaning = find(token);
        if (!meaning) return {};
        return {{meaning->name, meaning->declaration}};
    }

  private:
    using Meanings = std::unordered_map<std::string, Meaning>;

    Meanings known_;
    mutable Meanings inline_;  ///< tokens that were read as declarations, for when they come again
};

}  // namespace trapeze::rib
