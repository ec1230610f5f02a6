/// The optional arguments of calls that send rays: trace(P, R, "samples", 4, ...).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/scene/parameters.h"

namespace trapeze::rsl {

/// What stands behind the name of an optional argument.
struct RayArgumentValue {
    enum class Is : uint8_t { Number, Triple, Text, Other };
    Is is = Is::Other;
    const std::string* text = nullptr;  ///< of a Text, if it is known
    std::optional<float> number = {};   ///< of a Number, if it is known and everywhere the same
};

/// What a name of gather()'s says that sends a value along with its rays: "send:surface:NAME".
struct SentName {
    HitShader to;
    std::string_view name;  ///< of the parameter; part of the text
};
/// None where the text is no such name.
std::optional<SentName> sent_name(std::string_view text);

/// What is wrong with an optional argument of a call, as a warning says it; empty if nothing is. `of_map`:
/// the call may name a map instead of rays, and what maps are told is right, too.
std::string ray_argument_problem(std::string_view call, std::string_view name, const RayArgumentValue& value,
                                 bool of_map);

/// The kind of the warning, by the call's place: the compiler and the machine may both find it.
std::string ray_argument_warning(uint32_t source, uint32_t line, uint32_t column, std::string_view name);

}  // namespace trapeze::rsl
