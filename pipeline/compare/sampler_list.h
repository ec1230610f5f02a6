/// The methods that a user asks to compare.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sample/visibility.h"

namespace trapeze {

/// "raytrace:tree=paper,bundle=off interval": separated by spaces or semicolons, for commas are part of a
/// method's name. `pattern` is for all; empty: each one's natural pattern. Empty with *error set when one is
/// wrong, or there is none.
std::optional<std::vector<Sampler>> parse_samplers(std::string_view text, std::string_view pattern,
                                                   std::string* error);

/// Every method of the table that honours the pattern, with its default options.
std::vector<Sampler> default_samplers(std::string_view pattern, bool with_references);

}  // namespace trapeze
