#include "shade/materials/bound_shader.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/scene/scene.h"
#include "shade/materials/fill_plane.h"
#include "shade/materials/shader_library.h"

namespace trapeze {
namespace {

using rsl::Base;

/// Whether a value of a scene's type may stand for a shader's: whole numbers are floats, and points, vectors
/// and normals stand for each other, as RISpec's declarations are often careless of them.
bool suits(ValueType given, Base wanted) {
    switch (given) {
        case ValueType::Float:
        case ValueType::Integer:
            return wanted == Base::Float;
        case ValueType::String:
            return wanted == Base::String;
        case ValueType::Color:
            return wanted == Base::Color;
        case ValueType::Point:
        case ValueType::Vector:
        case ValueType::Normal:
            return wanted == Base::Point || wanted == Base::Vector || wanted == Base::Normal;
        case ValueType::Matrix:
            return wanted == Base::Matrix;
        case ValueType::HPoint:
            return false;
    }
    return false;
}

/// Whether an undeclared value, which the reader takes for floats, is of as many floats as the parameter: the
/// shader then says what they are.
bool looks_like(const Parameter& given, size_t floats) {
    return given.declaration.type == ValueType::Float && given.declaration.array_length > 1 && floats > 1 &&
           given.floats.size() == floats;
}

std::string_view type_name(Base base) {
    static constexpr std::string_view kNames[] = {"void",   "bool",   "float",  "color", "point",
                                                  "vector", "normal", "matrix", "string"};
    return kNames[static_cast<size_t>(base)];
}

/// Turns a triple or a matrix from shader to camera space, in place; colours stay. What a matrix takes to
/// shader space it takes to camera space afterwards, as `matrix "shader" m` does.
void to_camera(float* values, Base base, const M44f& camera_from_shader) {
    if (base == Base::Matrix) {
        M44f m;
        std::copy_n(values, 16, m.getValue());
        m = m * camera_from_shader;
        std::copy_n(m.getValue(), 16, values);
        return;
    }
    const V3f v(values[0], values[1], values[2]);
    V3f out = v;
    if (base == Base::Point)
        camera_from_shader.multVecMatrix(v, out);
    else if (base == Base::Vector)
        camera_from_shader.multDirMatrix(v, out);
    else if (base == Base::Normal)
        camera_from_shader.inverse().transposed().multDirMatrix(v, out);
    for (int k = 0; k < 3; ++k) values[k] = out[k];
}

/// Elements of a value of this type; `given` of an array of no length in it.
size_t element_count(const rsl::Type& type, size_t given) {
    return type.is_unsized() ? given : static_cast<size_t>(std::max(type.length, 1));
}

/// The same of what rays bring along, of which texts are as many, too.
bool can_take_sent(const rsl::Type& type, const GridVariable& variable) {
    return can_take(type, variable) &&
           (type.base != Base::String ||
            variable.strings.size() == element_count(type, variable.strings.size()));
}

/// Whether a value is sent to this parameter, of whatever type.
bool is_for(const SentVariable& sent, const rsl::Program& program, const rsl::ProgramParameter& parameter) {
    const rsl::ShaderKind kind = sent.to == HitShader::Surface        ? rsl::ShaderKind::Surface
                                 : sent.to == HitShader::Displacement ? rsl::ShaderKind::Displacement
                                                                      : rsl::ShaderKind::Volume;
    return program.kind == kind && sent.variable.name == parameter.name;
}

std::string& text_of(vm::Registers& registers, const rsl::ProgramParameter& parameter, size_t element) {
    return parameter.type.is_unsized() ? registers.text_array(parameter.id)[element]
                                       : registers.text(parameter.id, element);
}

/// Puts a value into a parameter's register; returns the number of elements that there was room for.
size_t give_value(vm::Registers& registers, const rsl::ProgramParameter& parameter,
                  const BoundShader::Value& value) {
    const size_t width = static_cast<size_t>(rsl::width_of(parameter.type.base));
    size_t elements = width ? value.floats.size() / width : value.texts.size();
    if (parameter.type.is_unsized()) elements = registers.set_count(parameter.id, elements);
    for (size_t e = 0; e < elements; ++e) {
        if (width)
            registers.set_uniform(parameter.id, value.floats.data() + e * width, e);
        else
            text_of(registers, parameter, e) = value.texts[e];
    }
    return elements;
}

}  // namespace

bool can_take(const rsl::Type& type, const GridVariable& variable) {
    if (!suits(variable.declaration.type, type.base)) return false;
    if (type.base == Base::String) return !variable.strings.empty();
    const size_t width = static_cast<size_t>(rsl::width_of(type.base));
    const size_t planes = element_count(type, variable.planes.size() / width) * width;
    return planes > 0 && variable.planes.size() == planes &&
           std::ranges::none_of(variable.planes, [](const auto& plane) { return plane.empty(); });
}

BoundShader::BoundShader(std::shared_ptr<const vm::Executable> executable, const ShaderInstance& instance,
                         const vm::Spaces& spaces, Diagnostics* diagnostics)
    : executable_(std::move(executable)), instance_(instance) {
    const rsl::Program& program = executable_->program();
    values_.resize(program.parameters.size());
    // Defaults may name parameters before them, and so all are set one after the other in registers.
    vm::Machine machine;
    vm::Registers& registers = machine.registers(executable_);
    registers.start(kLanes);
    vm::Context context;
    context.spaces = &spaces;
    context.diagnostics = diagnostics;
    for (size_t i = 0; i < values_.size(); ++i) {
        const rsl::ProgramParameter& parameter = program.parameters[i];
        Value& value = values_[i];
        size_t elements = element_count(parameter.type, 0);
        const size_t width = static_cast<size_t>(rsl::width_of(parameter.type.base));
        if (take_from_instance(parameter, value, diagnostics)) {
            elements = give_value(registers, parameter, value);
            if (elements < std::max(value.floats.size() / std::max<size_t>(width, 1), value.texts.size()) &&
                diagnostics)
                diagnostics->warning(
                    instance.location,
                    fmt::format("shader \"{}\" is given more elements of \"{}\" than arrays may have: "
                                "the array is left empty",
                                instance.name, parameter.name),
                    fmt::format("shader-parameter-length {} {}", instance.name, parameter.name));
            continue;
        }
        if (executable_->has_run_default(i)) {
            run_defaults_.push_back(i);
            value.floats.assign(elements * width, 0.0f);
            value.texts.resize(width ? 0 : elements);
            continue;
        }
        machine.run_initial(registers, i, context).get();
        if (parameter.type.is_unsized()) elements = registers.count(parameter.id);
        for (size_t e = 0; e < elements; ++e) {
            if (!width) value.texts.push_back(text_of(registers, parameter, e));
            const vm::Operand& operand = registers.operand(parameter.id);
            for (size_t k = 0; k < width; ++k)
                value.floats.push_back(operand.data[e * operand.element_stride + k * operand.stride]);
        }
    }
}

bool BoundShader::take_from_instance(const rsl::ProgramParameter& parameter, Value& value,
                                     Diagnostics* diagnostics) const {
    const Parameter* given = instance_.parameters.find(parameter.name);
    if (!given) return false;
    const Base base = parameter.type.base;
    const size_t width = static_cast<size_t>(rsl::width_of(base));
    const size_t count = width ? given->floats.size() / std::max<size_t>(width, 1) : given->strings.size();
    const size_t elements = element_count(parameter.type, count);
    const bool is_suitable = suits(given->declaration.type, base) || looks_like(*given, elements * width);
    if (!is_suitable || count < elements) {
        if (diagnostics)
            diagnostics->warning(
                instance_.location,
                fmt::format("shader \"{}\" declares \"{}\" as {}{}; the value given is another, and "
                            "the default holds",
                            instance_.name, parameter.name, type_name(base),
                            elements > 1 ? fmt::format("[{}]", elements) : ""),
                fmt::format("shader-parameter-type {} {}", instance_.name, parameter.name));
        return false;
    }
    if (!width) {
        value.texts.assign(given->strings.begin(),
                           given->strings.begin() + static_cast<std::ptrdiff_t>(elements));
        return true;
    }
    value.floats.assign(given->floats.begin(),
                        given->floats.begin() + static_cast<std::ptrdiff_t>(elements * width));
    for (size_t e = 0; e < elements && width >= 3; ++e)
        to_camera(value.floats.data() + e * width, base, instance_.camera_from_shader);
    return true;
}

const GridVariable* suitable_variable(const ShadingGrid& grid, const rsl::Program& program,
                                      const rsl::ProgramParameter& parameter) {
    for (size_t i = grid.sent.size(); i-- > 0;)
        if (is_for(grid.sent[i], program, parameter) && can_take_sent(parameter.type, grid.sent[i].variable))
            return &grid.sent[i].variable;
    const GridVariable* variable = grid.find(parameter.name);
    return variable && can_take(parameter.type, *variable) ? variable : nullptr;
}

void BoundShader::report_sent(const ShadingGrid& grid, Diagnostics& diagnostics) const {
    for (const SentVariable& sent : grid.sent)
        for (const rsl::ProgramParameter& parameter : program().parameters)
            if (is_for(sent, program(), parameter) && !can_take_sent(parameter.type, sent.variable))
                diagnostics.warning(
                    sent.at,
                    fmt::format("{} shader \"{}\" declares \"{}\" as another type than what gather "
                                "sends, and does not take it",
                                kind_name(program().kind), program().name, parameter.name),
                    fmt::format("rsl-sent-type {} {} {}", kind_name(program().kind), program().name,
                                parameter.name));
}

void BoundShader::set_parameters(vm::Registers& registers, std::span<const ShadingGrid* const> grids) const {
    for (size_t i = 0; i < values_.size(); ++i) {
        const rsl::ProgramParameter& parameter = program().parameters[i];
        const Value& value = values_[i];
        const rsl::RegisterId id = parameter.id;
        const size_t width = static_cast<size_t>(rsl::width_of(parameter.type.base));
        const GridVariable* variable =
            grids.empty() ? nullptr : suitable_variable(*grids.front(), program(), parameter);
        if (!width && parameter.type.is_unsized()) {
            give_value(registers, parameter, variable ? Value{{}, variable->strings} : value);
            continue;
        }
        if (!width) {
            for (size_t e = 0; e < value.texts.size(); ++e)
                registers.text(id, e) =
                    variable && e < variable->strings.size() ? variable->strings[e] : value.texts[e];
            continue;
        }
        if (!variable) {
            give_value(registers, parameter, value);
            continue;
        }
        if (parameter.type.is_unsized() &&
            registers.set_count(id, variable->planes.size() / width) * width < variable->planes.size())
            continue;
        const vm::Operand& out = registers.operand(id);
        const bool varying = out.lane_mask != 0;
        const size_t plane = varying ? registers.lanes() : kLanes;
        for (size_t p = 0; p < variable->planes.size(); ++p) {
            float* to = out.data + p * plane;
            if (!varying) {
                std::fill_n(to, plane, variable->planes[p].front());
                continue;
            }
            const auto own = [&](const ShadingGrid& grid) {
                return suitable_variable(grid, program(), parameter);
            };
            fill_plane(grids, own, p, value.floats[p], {to, plane});
        }
    }
}

Task<> BoundShader::set_run_defaults(vm::Machine& machine, vm::Registers& registers,
                                     const vm::Context& context, std::span<const ShadingGrid* const> grids,
                                     std::span<const size_t> given) const {
    for (const size_t i : run_defaults_) {
        if (std::ranges::find(given, i) != given.end()) continue;
        const rsl::ProgramParameter& parameter = program().parameters[i];
        // Grids of one run all have the variable, or none has (can_share_run()).
        if (grids.empty() || !suitable_variable(*grids.front(), program(), parameter))
            co_await machine.run_initial(registers, i, context);
    }
}

}  // namespace trapeze
