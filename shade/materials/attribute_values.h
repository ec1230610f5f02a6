/// Attributes by the names that shaders ask for: attribute("user:level"), "attribute:Sides" of gather().
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"

namespace trapeze {

/// Numbers, or a text.
struct NamedValue {
    std::vector<float> numbers;
    std::optional<std::string> text;
};

/// The value that "category:name" asks for, in lists by category; without a category it is "user".
const Parameter* find_user_value(const std::map<std::string, ParameterList>& lists, std::string_view name);

/// An attribute's value; nothing where there is none of the name.
std::optional<NamedValue> find_attribute_value(const Attributes& attributes, std::string_view name);

}  // namespace trapeze
