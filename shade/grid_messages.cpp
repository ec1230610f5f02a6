#include "shade/grid_messages.h"

#include <algorithm>
#include <cstring>

#include "shade/materials/attribute_values.h"

namespace trapeze {
namespace {

using rsl::Base;
using rsl::Op;

/// Distance of a register's planes: all lanes, or the padding of a uniform one.
size_t plane_of(const vm::Operand& out, size_t lanes) {
    return out.lane_mask ? lanes : kLanes;
}

/// Copies a variable of another shader, a parameter or a predefined one, to `out` or `text`. False when there
/// is none of the type.
bool copy_variable(const vm::Registers* registers, std::string_view name, rsl::Type type,
                   const vm::Operand& out, std::string* text) {
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
        if (!text || own.base != Base::String) return false;
        *text = registers->text(*id);
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

bool set_parameter(const Parameter* parameter, rsl::Type type, const vm::Operand& out, std::string* text) {
    if (!parameter) return false;
    if (type.base == Base::String) {
        if (!text || parameter->strings.empty()) return false;
        *text = parameter->strings.front();
        return true;
    }
    return set_value(parameter->floats, type, out);
}

bool set_text(std::string value, rsl::Type type, std::string* text) {
    if (type.base != Base::String || !text) return false;
    *text = std::move(value);
    return true;
}

}  // namespace

bool GridMessages::find_attribute(std::string_view name, rsl::Type type, const vm::Operand& out,
                                  std::string* text) const {
    if (!attributes) return false;
    const std::optional<NamedValue> value = find_attribute_value(*attributes, name);
    if (!value) return false;
    if (value->text) return set_text(*value->text, type, text);
    return type.base != Base::String && set_value(value->numbers, type, out);
}

bool GridMessages::find_option(std::string_view name, rsl::Type type, const vm::Operand& out,
                               std::string* text) const {
    const Options& o = context_.scene->options;
    const Camera& camera = context_.camera;
    if (name == "Format")
        return set_value(
            std::array{static_cast<float>(camera.width), static_cast<float>(camera.height), o.pixel_aspect},
            type, out);
    if (name == "CropWindow") return set_value(o.crop_window, type, out);
    if (name == "FrameAspectRatio") {
        const float picture = o.pixel_aspect * static_cast<float>(camera.width) /
                              static_cast<float>(std::max(camera.height, 1));
        return set_value(std::array{o.frame_aspect.value_or(picture)}, type, out);
    }
    if (name == "DepthOfField")
        return set_value(std::array{o.f_stop, o.focal_length, o.focal_distance}, type, out);
    if (name == "Shutter") return set_value(std::array{o.shutter_open, o.shutter_close}, type, out);
    if (name == "Clipping") return set_value(std::array{o.near_clip, o.far_clip}, type, out);
    if (name == "Frame") return set_value(std::array{static_cast<float>(o.frame)}, type, out);
    if (name == "trace:maxdepth")
        return set_value(std::array{static_cast<float>(o.max_ray_depth)}, type, out);
    return set_parameter(find_user_value(o.user, name), type, out, text);
}

bool GridMessages::find(Op what, std::string_view name, rsl::Type type, const vm::Operand& out,
                        std::string* text, const vm::Registers* light) {
    switch (what) {
        case Op::LightMessage:
            return copy_variable(light, name, type, out, text);
        case Op::SurfaceMessage:
            return copy_variable(surface, name, type, out, text);
        case Op::DisplacementMessage:
            return copy_variable(displacement, name, type, out, text);
        case Op::AtmosphereMessage:
        case Op::IncidentMessage:  // the volume between the eye and the surface
            return copy_variable(atmosphere, name, type, out, text);
        case Op::AttributeMessage:
            return find_attribute(name, type, out, text);
        case Op::OptionMessage:
            return find_option(name, type, out, text);
        case Op::RendererInfo:
            if (name == "renderer") return set_text("Trapeze", type, text);
            if (name == "version") return set_value(std::array{0.0f, 1.0f, 0.0f, 0.0f}, type, out);
            return name == "versionstring" && set_text("0.1.0", type, text);
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
    return kind.empty() ? running : std::string();
}

}  // namespace trapeze
