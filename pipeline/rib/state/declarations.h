/// Types of parameters: RISpec's own, those that Declare adds, and inline ones ("uniform color foo").
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>

#include "core/scene/parameters.h"

namespace trapeze::rib {

/// The longest array a declaration may have.
inline constexpr int kLongestArray = 1000000;

/// "[class] type[n]", words apart by spaces; nothing when it is not one.
std::optional<Declaration> parse_declaration(std::string_view text);

std::string_view name_of(StorageClass storage);

class Declarations {
  public:
    Declarations();  ///< RISpec's predeclared names

    void declare(const std::string& name, const Declaration& declaration) {
        known_[name] = declaration;
        predeclared_.erase(name);
    }
    /// A name that was never declared is none to forget; RISpec's own stay.
    void forget(const std::string& name) {
        if (!predeclared_.contains(name)) known_.erase(name);
    }
    /// A parameter's token, which may carry its declaration: the bare name and its type, or nothing when it
    /// is unknown.
    std::optional<std::pair<std::string, Declaration>> resolve(const std::string& token) const;

    /// A bare name of RISpec's own, that nobody has declared anew.
    bool is_predeclared(const std::string& token) const { return predeclared_.contains(token); }

  private:
    std::unordered_map<std::string, Declaration> known_;
    std::set<std::string> predeclared_;
};

}  // namespace trapeze::rib
