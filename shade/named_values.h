/// Attributes and options by the names that shaders ask for: attribute("user:level"), option("Format"),
/// "attribute:Sides" of gather().
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/camera.h"
#include "core/scene/scene.h"

namespace trapeze {

/// Numbers, or texts.
struct NamedValue {
    std::vector<float> numbers;
    std::vector<std::string> texts;
};

/// An attribute's value; nothing where there is none of the name. `primitive`: what has the attributes, and
/// tells whether its space is mirrored; it may be null.
std::optional<NamedValue> find_attribute_value(const Attributes& attributes, const Primitive* primitive,
                                               std::string_view name);

/// An option's value, likewise.
std::optional<NamedValue> find_option_value(const Options& options, const Camera& camera,
                                            std::string_view name);

}  // namespace trapeze
