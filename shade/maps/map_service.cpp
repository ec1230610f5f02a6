#include "shade/maps/map_service.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "shade/maps/sky_turns.h"
#include "shade/planes/differences.h"
#include "shade/vm/context_ops.h"
#include "shade/vm/kernels/neighbours.h"

namespace trapeze {
namespace {

using rsl::Op;
using vm::Operand;
using vm::Run;
using vm::Step;

/// How a call runs over the lanes. One whose inputs are all uniform has a uniform result: planes of kLanes
/// equal floats, one after another, which is looked up once, whatever lanes run.
class CallLanes {
  public:
    CallLanes(Run& run, const Operand& result)
        : run_(run), plane_(vm::plane_size(run, result)), is_uniform_(!result.lane_mask) {}

    /// Floats in a plane: all lanes, or kLanes of a uniform call.
    size_t plane() const { return plane_; }
    Plane scratch() const { return {run_.scratch(1), plane_}; }

    Lanes wanted() const {
        if (is_uniform_) return {1, {}};
        Lanes lanes;
        lanes.count = run_.context().batch ? run_.context().batch->vertices : plane_;
        if (!run_.masks().all())
            lanes.mask = {reinterpret_cast<const float*>(run_.masks().current()), plane_};
        return lanes;
    }

    /// A component of an input as a plane of the call's size; a uniform input is written out.
    ConstPlane plane_of(const Operand& operand, size_t component = 0) const {
        const float* data = operand.data + component * operand.stride;
        if (operand.lane_mask || is_uniform_) return {data, plane_};
        const Plane written = scratch();
        std::fill(written.begin(), written.end(), data[0]);
        return written;
    }

    /// Differences of values from vertex to vertex along an axis, grid by grid; zero in the lanes past the
    /// last vertex.
    Plane differences(GridAxis axis, ConstPlane values) const {
        const Plane out = scratch();
        std::fill(out.begin(), out.end(), 0.0f);
        if (!run_.context().batch || is_uniform_) return out;
        for (const vm::GridSpan& span : run_.context().batch->spans) {
            const size_t count = static_cast<size_t>(span.shape.vertex_count());
            difference(span.shape, axis, values.subspan(span.first, count), out.subspan(span.first, count));
        }
        return out;
    }

    /// How a component changes along both axes of the vertices' footprints (vm::Footprint).
    std::array<Plane, 2> changes(const Operand& operand, size_t component, ConstPlane values) const {
        const vm::Context& context = run_.context();
        if (!context.footprints || !context.batch || is_uniform_ || !operand.lane_mask)
            return {differences(GridAxis::U, values), differences(GridAxis::V, values)};
        const vm::Footprint& footprint = context.footprints->get();
        Operand value = operand;
        value.data += component * operand.stride;
        const Plane by_u = scratch(), by_v = scratch(), along_a = scratch(), along_b = scratch();
        const vm::GridSpans spans = context.batch->spans;
        const auto into = [](Plane plane) { return Operand{plane.data(), ~size_t{0}, 0, 0, 0}; };
        vm::derivative_u(spans, plane_, 1, value, footprint.u, footprint.v, into(by_u));
        vm::derivative_v(spans, plane_, 1, value, footprint.u, footprint.v, into(by_v));
        for (size_t i = 0; i < plane_; ++i) {
            along_a[i] = by_u[i] * footprint.u_of_a[i] + by_v[i] * footprint.v_of_a[i];
            along_b[i] = by_u[i] * footprint.u_of_b[i] + by_v[i] * footprint.v_of_b[i];
        }
        return {along_a, along_b};
    }

    std::vector<Plane> outputs(const Operand& out) const {
        std::vector<Plane> planes;
        for (size_t k = 0; k < (out.stride ? 3u : 1u); ++k)
            planes.push_back({out.data + k * out.stride, plane_});
        return planes;
    }

  private:
    Run& run_;
    size_t plane_;
    bool is_uniform_;
};

/// The operand of a step where its named arguments begin: behind the plain ones, which the immediate counts.
size_t first_named(const Step& step) {
    return step.outputs + 2u + static_cast<size_t>(step.immediate);
}

/// A named argument's number: of each lane where it varies.
LaneNumber number_of(const Operand& operand, size_t lanes) {
    return operand.lane_mask ? LaneNumber(ConstPlane(operand.data, lanes)) : LaneNumber(operand.data[0]);
}

/// Options from a call's named arguments, such as "sblur", .01.
MapOptions options_of(Run& run, const Step& step, std::span<const Operand> operands) {
    MapOptions options;
    const vm::Registers& registers = run.registers();
    options.first_channel = number_of(operands[step.outputs + 1u], run.lanes());
    for (size_t i = first_named(step); i + 1 < step.count; i += 2) {
        const std::string& name = registers.text(registers.register_of(step, i));
        const rsl::RegisterId id = registers.register_of(step, i + 1);
        if (registers.reg(id).type.base == rsl::Base::String) {
            const std::string& text = registers.text(id);
            if (name == "filter") options.filter = map_filter(text);
            if (name == "swrap" || name == "wrap") options.swrap = map_wrap(text);
            if (name == "twrap" || name == "wrap") options.twrap = map_wrap(text);
            continue;
        }
        const LaneNumber value = number_of(operands[i + 1], run.lanes());
        if (name == "sblur" || name == "blur") options.sblur = value;
        if (name == "tblur" || name == "blur") options.tblur = value;
        if (name == "swidth" || name == "width") options.swidth = value;
        if (name == "twidth" || name == "width") options.twidth = value;
        if (name == "fill") options.fill = value;
        if (name == "samples") options.samples = value;
        if (name == "bias") options.bias = value;
        if (name == "lerp") options.lerp = operands[i + 1].data[0] != 0;
    }
    return options;
}

/// The argument "colorspace"; empty where there is none.
std::string_view colorspace_of(Run& run, const Step& step) {
    const vm::Registers& registers = run.registers();
    for (size_t i = first_named(step); i + 1 < step.count; i += 2)
        if (registers.text(registers.register_of(step, i)) == "colorspace" &&
            registers.reg(registers.register_of(step, i + 1)).type.base == rsl::Base::String)
            return registers.text(registers.register_of(step, i + 1));
    return {};
}

/// A coordinate of a lookup and how it changes along u and v, as the lookup is filtered over.
struct Coordinate {
    ConstPlane middle, along_u, along_v;
};

/// A coordinate at the middle of a quadrilateral, and its sides, from its corners: inputs `first`, + step, +
/// 2 * step, + 3 * step.
Coordinate quad(const CallLanes& lanes, std::span<const Operand> operands, size_t first, size_t stride,
                size_t component) {
    const Plane middle = lanes.scratch(), along_u = lanes.scratch(), along_v = lanes.scratch();
    const auto corner = [&](size_t k) { return lanes.plane_of(operands[first + k * stride], component); };
    quad_sides(corner(0), corner(1), corner(2), corner(3), {middle, along_u, along_v});
    return {middle, along_u, along_v};
}

/// A coordinate at the vertices, and its changes along the axes of their footprints.
Coordinate vertex_values(const CallLanes& lanes, const Operand& operand, size_t component) {
    const ConstPlane values = lanes.plane_of(operand, component);
    const auto [along_a, along_b] = lanes.changes(operand, component, values);
    return {values, along_a, along_b};
}

/// s and t of a call, from inputs `first` and the next, or from four corners.
struct MapPlace {
    Coordinate s, t;
};
MapPlace map_place(const CallLanes& lanes, std::span<const Operand> operands, size_t first, bool corners) {
    if (!corners)
        return {vertex_values(lanes, operands[first], 0), vertex_values(lanes, operands[first + 1], 0)};
    return {quad(lanes, operands, first, 2, 0), quad(lanes, operands, first + 1, 2, 0)};
}

/// A triple by components, from one input or from four corners.
std::array<Coordinate, 3> triple_values(const CallLanes& lanes, const Step& step,
                                        std::span<const Operand> operands) {
    std::array<Coordinate, 3> values;
    const size_t first = step.outputs + 2u;
    for (size_t k = 0; k < 3; ++k)
        values[k] = step.immediate >= 4 ? quad(lanes, operands, first, 1, k)
                                        : vertex_values(lanes, operands[first], k);
    return values;
}

/// The value of a picture that cannot be read: white, which leaves a surface its own colour and a light its
/// own; but 0 for what is displaced by the picture, which then stays where it is, and for an empty name.
float stand_in(const vm::Registers& registers, const Step& step) {
    return registers.text_input(step, 0).empty() || registers.program().kind == rsl::ShaderKind::Displacement
               ? 0.0f
               : 1.0f;
}

}  // namespace

void MapService::look_up(Run& run, const Step& step, std::span<const Operand> operands) {
    switch (step.op) {
        case Op::Texture:
            return texture(run, step, operands);
        case Op::Environment:
            return environment(run, step, operands);
        case Op::Shadow:
            return shadow(run, step, operands);
        case Op::TextureInfo:
            return texture_info(run, step, operands);
        case Op::Bump:
            return bump(run, step, operands);
        default:
            return;
    }
}

/// The picture that a lookup names; null when it cannot be read. A lookup of a float reads numbers, unless it
/// says that they are encoded.
const Textures::Picture* MapService::picture_of(Run& run, const Step& step, bool of_color) {
    return textures_.find(run.registers().text_input(step, 0), step.at,
                          textures_.reading_of_lookup(colorspace_of(run, step), of_color, step.at));
}

void MapService::texture(Run& run, const Step& step, std::span<const Operand> operands) {
    const CallLanes lanes(run, operands[0]);
    const auto [s, t] = map_place(lanes, operands, step.outputs + 2u, step.immediate >= 8);
    const Textures::Picture* picture = picture_of(run, step, operands[0].stride != 0);
    const std::vector<Plane> out = lanes.outputs(operands[0]);
    MapOptions options = options_of(run, step, operands);
    options.without = stand_in(run.registers(), step);
    textures_.texture(picture, {s.middle, t.middle, s.along_u, t.along_u, s.along_v, t.along_v}, options,
                      lanes.wanted(), out);
}

/// What to add to a normal N: with heights F over s and t, the surface P + F N / |N| has the normal
/// dPds x dPdt + dF/ds (n x dPdt) - dF/dt (n x dPds), n = N / |N| [Blinn78]. Inputs: N, dPds, dPdt,
/// coordinates. Slopes are differences over the width of the lookup.
void MapService::bump(Run& run, const Step& step, std::span<const Operand> operands) {
    const CallLanes lanes(run, operands[0]);
    const MapPlace place = map_place(lanes, operands, step.outputs + 5u, step.immediate >= 11);
    const Coordinate &s = place.s, &t = place.t;
    const Textures::Picture* picture = picture_of(run, step, false);
    const MapOptions options = options_of(run, step, operands);
    const Plane s_step = lanes.scratch(), t_step = lanes.scratch();
    const Plane s_beside = lanes.scratch(), t_beside = lanes.scratch();
    constexpr float kLeastStep = 1.0f / 4096;
    for (size_t i = 0; i < lanes.plane(); ++i) {
        s_step[i] = std::max(std::abs(s.along_u[i]) + std::abs(s.along_v[i]), kLeastStep) / 2;
        t_step[i] = std::max(std::abs(t.along_u[i]) + std::abs(t.along_v[i]), kLeastStep) / 2;
        s_beside[i] = s.middle[i] + s_step[i], t_beside[i] = t.middle[i] + t_step[i];
    }
    const auto heights = [&](ConstPlane at_s, ConstPlane at_t) {
        const Plane out = lanes.scratch();
        textures_.texture(picture, {at_s, at_t, s.along_u, t.along_u, s.along_v, t.along_v}, options,
                          lanes.wanted(), {&out, 1});
        return out;
    };
    const Plane here = heights(s.middle, t.middle);
    const Plane along_s = heights(s_beside, t.middle), along_t = heights(s.middle, t_beside);
    const auto triple = [&](size_t input, size_t i) {
        const Operand& operand = operands[step.outputs + input];
        return V3f(Run::at(operand, 0, i), Run::at(operand, 1, i), Run::at(operand, 2, i));
    };
    const std::vector<Plane> out = lanes.outputs(operands[0]);
    for (size_t i = 0; i < lanes.plane(); ++i) {
        const V3f n = triple(2, i).normalized();
        const float by_s = (along_s[i] - here[i]) / s_step[i], by_t = (along_t[i] - here[i]) / t_step[i];
        const V3f change = n.cross(triple(4, i)) * by_s - n.cross(triple(3, i)) * by_t;
        for (int k = 0; k < 3; ++k) out[static_cast<size_t>(k)][i] = change[k];
    }
}

void MapService::environment(Run& run, const Step& step, std::span<const Operand> operands) {
    const CallLanes lanes(run, operands[0]);
    const std::array<Coordinate, 3> R = triple_values(lanes, step, operands);
    const Textures::Picture* picture = picture_of(run, step, operands[0].stride != 0);
    const std::vector<Plane> out = lanes.outputs(operands[0]);
    textures_.environment(picture,
                          {{R[0].middle, R[1].middle, R[2].middle},
                           {R[0].along_u, R[1].along_u, R[2].along_u},
                           {R[0].along_v, R[1].along_v, R[2].along_v}},
                          options_of(run, step, operands), lanes.wanted(), out);
}

/// The region around each direction has sides of `width`, at a right angle to it and to each other.
void MapService::sky(std::string_view name, SourceLocation at, std::span<const V3f> directions,
                     std::span<const float> widths, std::span<V3f> colors) {
    const Textures::Picture* picture = textures_.find(name, at, textures_.reading_of_lookup({}, true, at));
    constexpr size_t kTriples = 4;  // R, its changes, the colours
    const size_t count = directions.size(), plane = padded_size(count);
    std::vector<float> memory(plane * 3 * kTriples, 0.0f);
    const auto set = [&](size_t triple, size_t i, const V3f& v) {
        for (size_t k = 0; k < 3; ++k) memory[(triple * 3 + k) * plane + i] = v[static_cast<int>(k)];
    };
    const auto plane_of = [&](size_t triple, size_t k) {
        return Plane(&memory[(triple * 3 + k) * plane], plane);
    };
    const auto triple_of = [&](size_t triple) {
        return ConstPlane3{plane_of(triple, 0), plane_of(triple, 1), plane_of(triple, 2)};
    };
    for (size_t i = 0; i < count; ++i) {
        const V3f& R = directions[i];
        const float width = widths[widths.size() == count ? i : 0];
        const V3f across = R.cross(std::abs(R.z) < std::abs(R.x) ? V3f(0, 0, 1) : V3f(1, 0, 0)).normalized();
        set(0, i, R), set(1, i, across * width), set(2, i, R.cross(across) * width);
    }
    const Plane out[] = {plane_of(3, 0), plane_of(3, 1), plane_of(3, 2)};
    textures_.environment(picture, {triple_of(0), triple_of(1), triple_of(2)}, {}, {count, {}}, out);
    for (size_t i = 0; i < count; ++i) colors[i] = {out[0][i], out[1][i], out[2][i]};
}

std::unique_ptr<vm::GatherTurns> MapService::gather_sky(std::string_view name, Run& run, const Step& step,
                                                        std::span<const Operand> operands) {
    std::shared_ptr<const SkyParts> parts = textures_.sky_parts(name, step.at);
    if (!parts) return {};
    return std::make_unique<SkyTurns>(std::move(parts), run, step, operands, seed_);
}

void MapService::shadow(Run& run, const Step& step, std::span<const Operand> operands) {
    const CallLanes lanes(run, operands[0]);
    const std::array<Coordinate, 3> P = triple_values(lanes, step, operands);
    const Textures::DepthMap* map = textures_.find_shadow(run.registers().text_input(step, 0), step.at);
    const std::vector<Plane> out = lanes.outputs(operands[0]);
    textures_.shadow(map,
                     {{P[0].middle, P[1].middle, P[2].middle},
                      {P[0].along_u, P[1].along_u, P[2].along_u},
                      {P[0].along_v, P[1].along_v, P[2].along_v}},
                     scene_.camera_from_world, options_of(run, step, operands), lanes.wanted(), out[0]);
    for (size_t k = 1; k < out.size(); ++k) std::copy(out[0].begin(), out[0].end(), out[k].begin());
}

/// Outputs: found, the value; inputs: the file's name, what is asked.
void MapService::texture_info(Run& run, const Step& step, std::span<const Operand> operands) {
    vm::Registers& registers = run.registers();
    const std::string& what = registers.text_input(step, 1);
    const rsl::RegisterId id = registers.register_of(step, 1);
    const rsl::Type type = registers.reg(id).type;
    bool found = false;
    if (const auto info = textures_.info(registers.text_input(step, 0))) {
        std::vector<float> values;
        if (what == "resolution")
            values = {static_cast<float>(info->width), static_cast<float>(info->height)};
        if (what == "channels") values = {static_cast<float>(info->channels)};
        if (what == "exists") values = {1};
        if (what == "viewingmatrix" || what == "projectionmatrix") {
            const auto& from_world =
                what == "projectionmatrix" ? info->projection_matrix : info->viewing_matrix;
            // They are told from current space, which is the camera's here.
            const M44f matrix =
                from_world ? M44f(M44d(scene_.camera_from_world).inverse() * M44d(*from_world)) : M44f();
            if (from_world) values.assign(&matrix[0][0], &matrix[0][0] + 16);
        }
        const std::string text = what == "type" ? info->type : what == "wrapmodes" ? info->wrap_modes : "";
        if (!text.empty() && type.base == rsl::Base::String) {
            registers.text(id) = text;
            found = true;
        }
        const size_t width = static_cast<size_t>(rsl::width_of(type.base));
        const size_t wanted = width * static_cast<size_t>(std::max(type.length, 1));
        if (width && !values.empty() && values.size() >= wanted) {
            for (size_t p = 0; p < wanted; ++p)
                std::fill_n(operands[1].data + p / width * operands[1].element_stride +
                                p % width * operands[1].stride,
                            vm::plane_size(run, operands[1]), values[p]);
            found = true;
        }
    }
    vm::fill_operand(run, operands[0], std::array{found ? 1.0f : 0.0f});
}

}  // namespace trapeze
