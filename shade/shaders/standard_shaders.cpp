#include "shade/shaders/standard_shaders.h"

#include "shade/shaders/standard_shader_texts.h"

namespace trapeze {
namespace {

std::vector<std::string_view> names_of(std::span<const StandardShaderText> texts) {
    std::vector<std::string_view> names;
    for (const StandardShaderText& text : texts) names.push_back(text.name);
    return names;
}

std::string_view text_named(std::string_view name, std::span<const StandardShaderText> texts) {
    for (const StandardShaderText& text : texts)
        if (text.name == name) return text.text;
    return {};
}

}  // namespace

std::string_view standard_shader(std::string_view name) {
    return text_named(name, standard_shader_texts());
}

std::string_view standard_header(std::string_view name) {
    return text_named(name, standard_header_texts());
}

std::vector<std::string_view> standard_shader_names() {
    return names_of(standard_shader_texts());
}

std::vector<std::string_view> standard_header_names() {
    return names_of(standard_header_texts());
}

}  // namespace trapeze
