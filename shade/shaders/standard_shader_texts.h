/// What the build makes of the .sl files of this folder: see cmake/EmbedShaders.cmake.
#pragma once

#include <span>
#include <string_view>

namespace trapeze {

struct StandardShaderText {
    std::string_view name, text;
};

/// Sorted by name.
std::span<const StandardShaderText> standard_shader_texts();
std::span<const StandardShaderText> standard_header_texts();

}  // namespace trapeze
