/// The standard shaders of RISpec 3.2 (its appendix A), with those that renderers have come to share, in the
/// shading language: the .sl files of this folder, carried inside the program.
#pragma once

#include <string_view>
#include <vector>

namespace trapeze {

/// The source text of a standard shader; empty when there is none of that name. Lives as long as the program.
std::string_view standard_shader(std::string_view name);

/// In alphabetical order.
std::vector<std::string_view> standard_shader_names();

/// The text of a file that shaders include by custom and that seldom comes with them (noises.h, material.h,
/// project.h, rmannotes.sl and others), written anew here with the functions and macros that go by their
/// names. Empty when there is none.
std::string_view standard_header(std::string_view name);

/// In alphabetical order.
std::vector<std::string_view> standard_header_names();

}  // namespace trapeze
