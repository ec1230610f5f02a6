#include "shade/materials/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/scene/scene.h"
#include "shade/rsl/analysis/globals.h"
#include "shade/vm/run_defaults.h"

namespace trapeze {
namespace {

using Layers = std::vector<const BoundShader*>;

/// Index of the layer of a name; layers.size() when there is none.
size_t find_layer(const Layers& layers, const std::string& name) {
    const auto found =
        std::ranges::find_if(layers, [&](const BoundShader* s) { return s->instance().layer == name; });
    return static_cast<size_t>(found - layers.begin());
}

const rsl::ProgramParameter* find_parameter(const rsl::Program& program, const std::string& name) {
    const auto found = std::ranges::find(program.parameters, name, &rsl::ProgramParameter::name);
    return found == program.parameters.end() ? nullptr : &*found;
}

/// Whether a value of one type can be copied to the other: numbers, triples or matrices of as many elements.
/// Texts do not travel between layers, nor arrays of no length in their type.
bool same_kind(const rsl::Type& a, const rsl::Type& b) {
    const int width = rsl::width_of(a.base);
    return width > 0 && width == rsl::width_of(b.base) && a.length == b.length && !a.is_unsized();
}

/// The register of a parameter or predefined variable; null when the program names no such variable.
const rsl::RegisterId* find_variable(const rsl::Program& program, const std::string& name) {
    const rsl::ProgramParameter* parameter = find_parameter(program, name);
    return parameter ? &parameter->id : program.find_global(name);
}

/// Resolves a connection. Returns what is wrong with it, or nothing; `resolved` is then set, unless the
/// connection goes to a predefined variable that the shader does not look at.
std::string resolve(const LayerConnection& wanted, const Layers& layers,
                    std::optional<LayeredShader::Connection>& resolved) {
    LayeredShader::Connection out;
    out.from = find_layer(layers, wanted.from_layer), out.to = find_layer(layers, wanted.to_layer);
    if (out.from == layers.size()) return fmt::format("there is no layer \"{}\"", wanted.from_layer);
    if (out.to == layers.size()) return fmt::format("there is no layer \"{}\"", wanted.to_layer);
    if (out.from >= out.to)
        return fmt::format("layer \"{}\" does not run before \"{}\"", wanted.from_layer, wanted.to_layer);
    const rsl::Program &from = layers[out.from]->program(), &to = layers[out.to]->program();
    const rsl::RegisterId *source = find_variable(from, wanted.from_variable),
                          *target = find_variable(to, wanted.to_variable);
    if (!target && rsl::find_global(to.kind, wanted.to_variable)) return {};
    if (!target) return fmt::format("shader \"{}\" has no variable \"{}\"", to.name, wanted.to_variable);
    if (!source) return fmt::format("shader \"{}\" has no variable \"{}\"", from.name, wanted.from_variable);
    out.source = *source, out.target = *target;
    if (!same_kind(from.reg(out.source).type, to.reg(out.target).type))
        return fmt::format("\"{}\" and \"{}\" are of different types", wanted.from_variable,
                           wanted.to_variable);
    resolved = out;
    return {};
}

/// Whether the program, or a parameter's default, may ask for the space named "object".
bool asks_object_space(const rsl::Program& program) {
    return vm::may_ask_object_space(program, program.code) ||
           std::ranges::any_of(program.parameters, [&](const rsl::ProgramParameter& parameter) {
               return vm::may_ask_object_space(program, parameter.initial);
           });
}

}  // namespace

namespace {

/// Whether a program, or a default value of its parameters, has one of some operations.
bool has_any(const rsl::Program& program, std::initializer_list<rsl::Op> wanted) {
    const auto asks = [&](const rsl::Code& code) {
        return std::ranges::any_of(
            code, [&](const rsl::Instruction& i) { return std::ranges::find(wanted, i.op) != wanted.end(); });
    };
    return asks(program.code) ||
           std::ranges::any_of(program.parameters, [&](const rsl::ProgramParameter& parameter) {
               return asks(parameter.initial);
           });
}

}  // namespace

bool asks_variables(const rsl::Program& program) {
    return has_any(program, {rsl::Op::VariableMessage});
}

bool LayeredShader::asks_volume() const {
    return std::ranges::any_of(layers, [](const BoundShader* layer) {
        return has_any(layer->program(), {rsl::Op::AtmosphereMessage, rsl::Op::IncidentMessage});
    });
}

bool LayeredShader::asks_primitive() const {
    return std::ranges::any_of(layers, [](const BoundShader* layer) {
        return asks_object_space(layer->program()) || asks_variables(layer->program());
    });
}

void LayeredShader::connect(size_t to, std::span<vm::Registers* const> registers) const {
    for (const Connection& c : connections) {
        if (c.to != to) continue;
        const vm::Registers& source_registers = *registers[c.from];
        const vm::Operand &from = source_registers.operand(c.source),
                          &target = registers[to]->operand(c.target);
        const rsl::Type type = source_registers.reg(c.source).type;
        const size_t lanes = target.lane_mask ? registers[to]->lanes() : kLanes;
        const size_t width = static_cast<size_t>(rsl::width_of(type.base));
        for (size_t p = 0; p < width * static_cast<size_t>(std::max(type.length, 1)); ++p) {
            const auto plane = [&](const vm::Operand& operand) {
                return operand.data + p / width * operand.element_stride + p % width * operand.stride;
            };
            if (from.lane_mask && target.lane_mask)
                std::copy_n(plane(from), lanes, plane(target));
            else
                std::fill_n(plane(target), lanes, *plane(from));
        }
    }
}

std::vector<std::string> connected_parameters(const ShaderInstance& instance, const std::string& layer) {
    std::vector<std::string> names;
    for (const LayerConnection& connection : instance.connections)
        if (connection.to_layer == layer) names.push_back(connection.to_variable);
    return names;
}

LayeredShader make_layered(const ShaderInstance& instance, Layers layers, Diagnostics* diagnostics) {
    LayeredShader made;
    made.layers = std::move(layers);
    for (const LayerConnection& wanted : instance.connections) {
        std::optional<LayeredShader::Connection> connection;
        const std::string wrong = resolve(wanted, made.layers, connection);
        if (connection) made.connections.push_back(*connection);
        if (!wrong.empty() && diagnostics)
            diagnostics->warning(instance.location, "ConnectShaderLayers: " + wrong,
                                 "connect-layers " + wrong);
    }
    return made;
}

}  // namespace trapeze
