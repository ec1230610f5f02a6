/// The methods that a user asks to compare.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sample/visibility.h"

namespace trapeze {

/// Reads a list such as "raytrace:tree=paper,bundle=off interval": separated by spaces or semicolons, since
/// commas are part of a method's name. `pattern` is for all methods; empty: each one's natural pattern. Empty
/// with *error set when a method or the pattern is wrong, or there is no method.
std::optional<std::vector<Sampler>> parse_samplers(std::string_view text, std::string_view pattern,
                                                   std::string* error);

/// Every method of the table that honours the pattern, with its default options.
std::vector<Sampler> default_samplers(std::string_view pattern, bool with_references);

}  // namespace trapeze
