/// Groups of primitives that calls of shaders let their rays meet: Attribute "grouping" "membership", and
/// what calls name by "subset".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trapeze {

/// Changes the groups that a primitive is in. Names are parted by commas or blanks; a "+" before them adds to
/// the groups, a "-" takes from them; without, they replace all.
void change_membership(std::string_view names, std::vector<std::string>& groups);

/// The primitives that a call's rays meet: those in any of its groups, but in none of those that it leaves
/// out.
struct RaySubset {
    std::vector<std::string> in, out;  ///< an empty `in`: all primitives

    /// Of "a,b" or "-a".
    explicit RaySubset(std::string_view names = {});
    bool has(const std::vector<std::string>& groups) const;
    bool names_none() const { return in.empty() && out.empty(); }
};

}  // namespace trapeze
