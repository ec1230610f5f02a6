#include "shade/map_service.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "shade/differences.h"
#include "shade/vm/context_ops.h"

namespace trapeze {
namespace {

using rsl::Op;
using vm::Operand;
using vm::Run;
using vm::Step;

/// A component of an input, written out for each lane when it is uniform.
ConstPlane plane_of(Run& run, const Operand& operand, size_t component = 0) {
    const float* data = operand.data + component * operand.stride;
    if (operand.lane_mask) return {data, run.lanes()};
    float* plane = run.scratch(1);
    std::fill_n(plane, run.lanes(), data[0]);
    return {plane, run.lanes()};
}

Plane scratch_plane(Run& run) {
    return {run.scratch(1), run.lanes()};
}

/// Changes from vertex to vertex, grid by grid; zero in the lanes past the last.
Plane differences(Run& run, GridAxis axis, ConstPlane values) {
    const Plane out = scratch_plane(run);
    std::fill(out.begin(), out.end(), 0.0f);
    if (!run.context().points) return out;
    for (const vm::GridSpan& span : run.context().points->spans) {
        const size_t count = static_cast<size_t>(span.shape.vertex_count());
        difference(span.shape, axis, values.subspan(span.first, count), out.subspan(span.first, count));
    }
    return out;
}

Lanes lanes_of(Run& run) {
    Lanes lanes;
    lanes.count = run.context().points ? run.context().points->vertices : run.lanes();
    if (!run.masks().all()) lanes.mask = {reinterpret_cast<const float*>(run.masks().current()), run.lanes()};
    return lanes;
}

size_t first_named(const Step& step) {
    return step.outputs + 2u + static_cast<size_t>(step.immediate);
}

/// The named arguments; a value that varies counts with that of the first vertex.
MapOptions options_of(Run& run, const Step& step, std::span<const Operand> operands) {
    MapOptions options;
    const vm::Frame& frame = run.frame();
    options.first_channel = static_cast<int>(std::clamp(operands[step.outputs + 1u].data[0], 0.0f, 1000.0f));
    for (size_t i = first_named(step); i + 1 < step.count; i += 2) {
        const std::string& name = frame.text(frame.register_of(step, i));
        const bool is_text = frame.reg(frame.register_of(step, i + 1)).type.base == rsl::Base::String;
        const float value = is_text ? 0 : operands[i + 1].data[0];
        if (name == "blur") options.sblur = options.tblur = value;
        if (name == "sblur") options.sblur = value;
        if (name == "tblur") options.tblur = value;
        if (name == "width") options.swidth = options.twidth = value;
        if (name == "swidth") options.swidth = value;
        if (name == "twidth") options.twidth = value;
        if (name == "fill") options.fill = value;
        if (name == "samples") options.samples = value;
        if (name == "bias") options.bias = value;
        if (name == "lerp") options.lerp = value != 0;
        if (name == "filter" && is_text)
            options.filter = map_filter(frame.text(frame.register_of(step, i + 1)));
    }
    return options;
}

std::vector<Plane> outputs_of(Run& run, const Operand& out) {
    std::vector<Plane> planes;
    for (size_t k = 0; k < (out.stride ? 3u : 1u); ++k)
        planes.push_back({out.data + k * out.stride, run.lanes()});
    return planes;
}

struct Coordinate {
    ConstPlane middle, along_u, along_v;
};

/// Of a coordinate at the corners of a quadrilateral: inputs 0, step, 2 * step, 3 * step from `first`.
Coordinate quad(Run& run, std::span<const Operand> operands, size_t first, size_t stride, size_t component) {
    const Plane middle = scratch_plane(run), along_u = scratch_plane(run), along_v = scratch_plane(run);
    const auto corner = [&](size_t k) { return plane_of(run, operands[first + k * stride], component); };
    quad_sides(corner(0), corner(1), corner(2), corner(3), {middle, along_u, along_v});
    return {middle, along_u, along_v};
}

/// A coordinate at the vertices, and its changes to the next ones.
Coordinate vertex_values(Run& run, const Operand& operand, size_t component) {
    const ConstPlane values = plane_of(run, operand, component);
    return {values, differences(run, GridAxis::U, values), differences(run, GridAxis::V, values)};
}

/// s and t from inputs `first` and the next, or from four corners.
struct MapPlace {
    Coordinate s, t;
};
MapPlace map_place(Run& run, std::span<const Operand> operands, size_t first, bool corners) {
    if (!corners) return {vertex_values(run, operands[first], 0), vertex_values(run, operands[first + 1], 0)};
    return {quad(run, operands, first, 2, 0), quad(run, operands, first + 1, 2, 0)};
}

/// A triple by components, from one input or from four corners.
std::array<Coordinate, 3> triple_values(Run& run, const Step& step, std::span<const Operand> operands) {
    std::array<Coordinate, 3> values;
    const size_t first = step.outputs + 2u;
    for (size_t k = 0; k < 3; ++k)
        values[k] =
            step.immediate >= 4 ? quad(run, operands, first, 1, k) : vertex_values(run, operands[first], k);
    return values;
}

/// Of a picture that cannot be read. White leaves a surface its own colour, and a light its own; what is
/// displaced by a picture stays where it is, and no name is no picture.
float stand_in(const vm::Frame& frame, const Step& step) {
    return frame.text_input(step, 0).empty() || frame.program().kind == rsl::ShaderKind::Displacement ? 0.0f
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

void MapService::texture(Run& run, const Step& step, std::span<const Operand> operands) {
    const auto [s, t] = map_place(run, operands, step.outputs + 2u, step.immediate >= 8);
    const Textures::Picture* picture = textures_.find(run.frame().text_input(step, 0), step.at);
    const std::vector<Plane> out = outputs_of(run, operands[0]);
    MapOptions options = options_of(run, step, operands);
    options.without = stand_in(run.frame(), step);
    textures_.texture(picture, {s.middle, t.middle, s.along_u, t.along_u, s.along_v, t.along_v}, options,
                      lanes_of(run), out);
}

/// What to add to a normal N: with heights F over s and t, the surface P + F N / |N| has the normal
/// dPds x dPdt + dF/ds (n x dPdt) - dF/dt (n x dPds), n = N / |N| [Blinn78]. Inputs: N, dPds, dPdt,
/// coordinates. Slopes are differences over the width of the lookup.
void MapService::bump(Run& run, const Step& step, std::span<const Operand> operands) {
    const MapPlace place = map_place(run, operands, step.outputs + 5u, step.immediate >= 11);
    const Coordinate &s = place.s, &t = place.t;
    const Textures::Picture* picture = textures_.find(run.frame().text_input(step, 0), step.at);
    const MapOptions options = options_of(run, step, operands);
    const size_t lanes = run.lanes();
    const Plane s_step = scratch_plane(run), t_step = scratch_plane(run);
    const Plane s_beside = scratch_plane(run), t_beside = scratch_plane(run);
    constexpr float kLeastStep = 1.0f / 4096;
    for (size_t i = 0; i < lanes; ++i) {
        s_step[i] = std::max(std::abs(s.along_u[i]) + std::abs(s.along_v[i]), kLeastStep) / 2;
        t_step[i] = std::max(std::abs(t.along_u[i]) + std::abs(t.along_v[i]), kLeastStep) / 2;
        s_beside[i] = s.middle[i] + s_step[i], t_beside[i] = t.middle[i] + t_step[i];
    }
    const auto heights = [&](ConstPlane at_s, ConstPlane at_t) {
        const Plane out = scratch_plane(run);
        textures_.texture(picture, {at_s, at_t, s.along_u, t.along_u, s.along_v, t.along_v}, options,
                          lanes_of(run), {&out, 1});
        return out;
    };
    const Plane here = heights(s.middle, t.middle);
    const Plane along_s = heights(s_beside, t.middle), along_t = heights(s.middle, t_beside);
    const auto triple = [&](size_t input, size_t i) {
        const Operand& operand = operands[step.outputs + input];
        return V3f(Run::at(operand, 0, i), Run::at(operand, 1, i), Run::at(operand, 2, i));
    };
    const std::vector<Plane> out = outputs_of(run, operands[0]);
    for (size_t i = 0; i < lanes; ++i) {
        const V3f n = triple(2, i).normalized();
        const float by_s = (along_s[i] - here[i]) / s_step[i], by_t = (along_t[i] - here[i]) / t_step[i];
        const V3f change = n.cross(triple(4, i)) * by_s - n.cross(triple(3, i)) * by_t;
        for (int k = 0; k < 3; ++k) out[static_cast<size_t>(k)][i] = change[k];
    }
}

void MapService::environment(Run& run, const Step& step, std::span<const Operand> operands) {
    const std::array<Coordinate, 3> R = triple_values(run, step, operands);
    const Textures::Picture* picture = textures_.find(run.frame().text_input(step, 0), step.at);
    const std::vector<Plane> out = outputs_of(run, operands[0]);
    textures_.environment(picture,
                          {{R[0].middle, R[1].middle, R[2].middle},
                           {R[0].along_u, R[1].along_u, R[2].along_u},
                           {R[0].along_v, R[1].along_v, R[2].along_v}},
                          options_of(run, step, operands), lanes_of(run), out);
}

void MapService::shadow(Run& run, const Step& step, std::span<const Operand> operands) {
    const std::array<Coordinate, 3> P = triple_values(run, step, operands);
    const Textures::DepthMap* map = textures_.find_shadow(run.frame().text_input(step, 0), step.at);
    const std::vector<Plane> out = outputs_of(run, operands[0]);
    textures_.shadow(map,
                     {{P[0].middle, P[1].middle, P[2].middle},
                      {P[0].along_u, P[1].along_u, P[2].along_u},
                      {P[0].along_v, P[1].along_v, P[2].along_v}},
                     scene_.camera_from_world, options_of(run, step, operands), lanes_of(run), out[0]);
    for (size_t k = 1; k < out.size(); ++k) std::copy(out[0].begin(), out[0].end(), out[k].begin());
}

/// Outputs: found, the value; inputs: the file's name, what is asked.
void MapService::texture_info(Run& run, const Step& step, std::span<const Operand> operands) {
    vm::Frame& frame = run.frame();
    const std::string& what = frame.text_input(step, 1);
    const rsl::RegisterId id = frame.register_of(step, 1);
    const rsl::Type type = frame.reg(id).type;
    bool found = false;
    if (const auto info = textures_.info(frame.text_input(step, 0))) {
        std::vector<float> values;
        if (what == "resolution")
            values = {static_cast<float>(info->width), static_cast<float>(info->height)};
        if (what == "channels") values = {static_cast<float>(info->channels)};
        if (what == "exists") values = {1};
        const auto& matrix = what == "projectionmatrix" ? info->projection_matrix : info->viewing_matrix;
        if ((what == "viewingmatrix" || what == "projectionmatrix") && matrix)
            values.assign(&(*matrix)[0][0], &(*matrix)[0][0] + 16);
        if (what == "type" && type.base == rsl::Base::String) {
            frame.text(id) = info->type;
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
