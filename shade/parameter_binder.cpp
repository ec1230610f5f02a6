#include "shade/parameter_binder.h"

#include <fmt/format.h>

#include <algorithm>

namespace trapeze {

const Parameter* ParameterBinder::find(std::string_view name, std::string_view expected,
                                       std::initializer_list<ValueType> types) const {
    const Parameter* parameter = instance_.parameters.find(name);
    if (!parameter) return nullptr;
    const ValueType type = parameter->declaration.type;
    const size_t values = parameter->is_string() ? parameter->strings.size() : parameter->floats.size();
    if (std::find(types.begin(), types.end(), type) != types.end() &&
        values >= static_cast<size_t>(component_count(type)))
        return parameter;
    if (diagnostics_)
        diagnostics_->warning(
            instance_.location,
            fmt::format("shader \"{}\": parameter \"{}\" is not a {}; the shader's default is used",
                        instance_.name, name, expected),
            fmt::format("shader parameter type {} {}", instance_.name, name));
    return nullptr;
}

FloatParameter ParameterBinder::number(std::string name, float fallback) const {
    const Parameter* parameter = find(name, "float", {ValueType::Float, ValueType::Integer});
    return {std::move(name), parameter ? parameter->floats[0] : fallback};
}

ColorParameter ParameterBinder::color(std::string name, const V3f& fallback) const {
    const Parameter* parameter = find(name, "color", {ValueType::Color});
    if (!parameter) return {std::move(name), fallback};
    return {std::move(name), {parameter->floats[0], parameter->floats[1], parameter->floats[2]}};
}

StringParameter ParameterBinder::string(std::string name, std::string fallback) const {
    const Parameter* parameter = find(name, "string", {ValueType::String});
    return {std::move(name), parameter ? parameter->strings[0] : std::move(fallback)};
}

V3f ParameterBinder::point(std::string_view name, const V3f& fallback) const {
    const Parameter* parameter = find(name, "point", {ValueType::Point});
    const V3f in_shader =
        parameter ? V3f(parameter->floats[0], parameter->floats[1], parameter->floats[2]) : fallback;
    V3f in_camera;
    instance_.camera_from_shader.multVecMatrix(in_shader, in_camera);
    return in_camera;
}

}  // namespace trapeze
