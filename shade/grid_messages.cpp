#include "shade/grid_messages.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "shade/materials/bound_shader.h"
#include "shade/materials/fill_plane.h"
#include "shade/named_values.h"

namespace trapeze {
namespace {

using rsl::Base;
using rsl::Op;

/// Distance of a register's planes: all lanes, or the padding of a uniform one.
size_t plane_of(const vm::Operand& out, size_t lanes) {
    return out.lane_mask ? lanes : kLanes;
}

/// Copies a variable of another shader, a parameter or a predefined one, to `out` or `texts`. False when
/// there is none of the type.
bool copy_variable(const vm::Registers* registers, std::string_view name, rsl::Type type,
                   const vm::Operand& out, std::span<std::string> texts) {
    if (!registers) return false;
    const rsl::Program& program = registers->program();
    const rsl::RegisterId* id = program.find_global(name);
    for (const rsl::ProgramParameter& parameter : program.parameters)
        if (parameter.name == name) id = &parameter.id;
    if (!id) return false;
    const rsl::Type own = program.reg(*id).type;
    if (own.is_unsized() || own.length != type.length || rsl::width_of(own.base) != rsl::width_of(type.base))
        return false;
    if (type.base == Base::String) {
        if (own.base != Base::String) return false;
        for (size_t e = 0; e < texts.size(); ++e) texts[e] = registers->text(*id, e);
        return true;
    }
    const vm::Operand& from = registers->operand(*id);
    const size_t from_plane = plane_of(from, registers->lanes()),
                 to_plane = plane_of(out, registers->lanes());
    const size_t planes = static_cast<size_t>(rsl::width_of(type.base) * std::max(type.length, 1));
    for (size_t p = 0; p < planes; ++p) {
        if (from.lane_mask && out.lane_mask)
            std::memcpy(out.data + p * to_plane, from.data + p * from_plane, to_plane * sizeof(float));
        else
            std::fill_n(out.data + p * to_plane, to_plane, from.data[p * from_plane]);
    }
    return true;
}

/// Sets all lanes of `out` to one value; false when there are too few numbers.
bool set_value(std::span<const float> values, rsl::Type type, const vm::Operand& out) {
    const size_t wanted = static_cast<size_t>(rsl::width_of(type.base) * std::max(type.length, 1));
    if (wanted == 0 || values.size() < wanted) return false;
    const size_t width = static_cast<size_t>(rsl::width_of(type.base));
    for (size_t p = 0; p < wanted; ++p) {
        float* plane = out.data + (p / width) * out.element_stride + (p % width) * out.stride;
        // The planes of an element's components lie one after the other, and so tell their size.
        const size_t size = out.lane_mask ? out.element_stride / width : kLanes;
        std::fill_n(plane, size, values[p]);
    }
    return true;
}

/// Likewise of texts.
bool set_texts(std::span<const std::string> values, rsl::Type type, std::span<std::string> texts) {
    if (type.base != Base::String || values.size() < texts.size()) return false;
    std::copy_n(values.begin(), texts.size(), texts.begin());
    return true;
}

bool set_named(const std::optional<NamedValue>& value, rsl::Type type, const vm::Operand& out,
               std::span<std::string> texts) {
    if (!value) return false;
    return type.base == Base::String ? set_texts(value->texts, type, texts)
                                     : set_value(value->numbers, type, out);
}

}  // namespace

/// A variable that the primitive has by itself, and no predefined one. Grids of a run are one primitive's, if
/// any of its shaders ask (Material::asks_primitive). Texts must be the same in all of them.
bool GridMessages::find_variable(std::string_view name, rsl::Type type, const vm::Operand& out,
                                 std::span<std::string> texts) const {
    const auto variable_of = [&](const ShadingGrid& grid) -> const GridVariable* {
        const GridVariable* const variable = grid.find(name);
        return variable && can_take(type, *variable) ? variable : nullptr;
    };
    const GridVariable* const first = grids.empty() ? nullptr : variable_of(*grids.front());
    if (!first) return false;
    if (type.base == Base::String)
        return first->declaration.storage == StorageClass::Constant && set_texts(first->strings, type, texts);
    for (size_t p = 0; p < first->planes.size(); ++p) {
        const size_t width = static_cast<size_t>(rsl::width_of(type.base));
        float* const to = out.data + (p / width) * out.element_stride + (p % width) * out.stride;
        if (out.lane_mask)
            fill_plane(grids, variable_of, p, 0.0f, {to, out.element_stride / width});
        else
            std::fill_n(to, kLanes, first->planes[p].front());
    }
    return true;
}

bool GridMessages::find(Op what, std::string_view name, rsl::Type type, const vm::Operand& out,
                        std::span<std::string> texts, const vm::Registers* light) {
    switch (what) {
        case Op::LightMessage:
            return copy_variable(light, name, type, out, texts);
        case Op::SurfaceMessage:
            return copy_variable(surface, name, type, out, texts);
        case Op::DisplacementMessage:
            return copy_variable(displacement, name, type, out, texts);
        case Op::AtmosphereMessage:
        case Op::IncidentMessage:  // the volume between the eye and the surface
            return copy_variable(atmosphere, name, type, out, texts);
        case Op::VariableMessage:
            return find_variable(name, type, out, texts);
        case Op::AttributeMessage:
            return attributes &&
                   set_named(find_attribute_value(*attributes, primitive, name), type, out, texts);
        case Op::OptionMessage:
            return set_named(find_option_value(context_.scene->options, context_.camera, name), type, out,
                             texts);
        case Op::RendererInfo:
            if (name == "renderer") return set_texts(std::array{std::string("Trapeze")}, type, texts);
            if (name == "version") return set_value(std::array{0.0f, 1.0f, 0.0f, 0.0f}, type, out);
            return name == "versionstring" && set_texts(std::array{std::string("0.1.0")}, type, texts);
        default:
            return false;  // opposite(): no volume behind a surface is run
    }
}

std::string GridMessages::shader_name(std::string_view kind) {
    const auto name_of = [](const vm::Registers* registers) {
        return registers ? registers->program().name : std::string();
    };
    if (kind == "surface") return name_of(surface);
    if (kind == "displacement") return name_of(displacement);
    if (kind == "atmosphere") return name_of(atmosphere);
    return {};
}

}  // namespace trapeze
