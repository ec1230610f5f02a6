/// Which options, attributes and parameters anything looks at. The others are kept, as RISpec asks, and
/// shaders may read them; `trapeze check` lists them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trapeze::rib {

/// All of them, for people: "category name", or "category (all)"; sorted.
struct RecognisedNames {
    std::vector<std::string> options, attributes, hider, display;
};

/// From the same tables that recognises_...() look into, so that documents made of it cannot go stale.
RecognisedNames recognised_names();

/// Attributes of other renderers that tune quality or speed where this renderer has nothing to tune: pictures
/// are right without them.
struct UnneededAttribute {
    std::string_view category, name, why;
};
std::span<const UnneededAttribute> unneeded_attributes();
/// Null for others.
const UnneededAttribute* unneeded_attribute(std::string_view category, std::string_view name);

/// Names alone: whether the value makes sense is its reader's to say.
bool recognises_option(std::string_view category, std::string_view name);
bool recognises_attribute(std::string_view category, std::string_view name);
bool recognises_hider_parameter(std::string_view name);
bool recognises_display_parameter(std::string_view name);

}  // namespace trapeze::rib
