#include "shade/shaders/standard_shaders.h"

#include "shade/shaders/standard_shader_texts.h"

namespace trapeze {

std::string_view standard_shader(std::string_view name) {
    for (const StandardShaderText& shader : standard_shader_texts())
        if (shader.name == name) return shader.text;
    return {};
}

std::vector<std::string_view> standard_shader_names() {
    std::vector<std::string_view> names;
    for (const StandardShaderText& shader : standard_shader_texts()) names.push_back(shader.name);
    return names;
}

}  // namespace trapeze
