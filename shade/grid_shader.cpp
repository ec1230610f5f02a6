#include "shade/grid_shader.h"

#include <algorithm>
#include <bit>

namespace trapeze {
namespace {

using vm::Operand;

/// Writes a grid's values behind those of the grids before it.
class Loader {
  public:
    Loader(vm::Frame& frame, std::span<const ShadingGrid* const> grids) : frame_(frame), grids_(grids) {}

    template <class PlaneOf>
    void load(const Operand& out, int components, const PlaneOf& plane_of) const {
        for (int k = 0; k < components; ++k) {
            float* to = out.data + static_cast<size_t>(k) * out.stride;
            size_t at = 0;
            for (const ShadingGrid* grid : grids_) {
                const std::vector<float>& from = plane_of(*grid, k);
                const size_t count = grid->vertex_count(), given = std::min(from.size(), count);
                std::copy_n(from.begin(), given, to + at);
                std::fill_n(to + at + given, count - given, given ? from[given - 1] : 0.0f);
                at += count;
            }
            std::fill(to + at, to + frame_.lanes(), at ? to[at - 1] : 0.0f);
        }
    }

    void load(const Operand& out, Triples ShadingGrid::*triples) const {
        load(out, 3, [&](const ShadingGrid& grid, int k) -> const std::vector<float>& {
            return (grid.*triples).c[k];
        });
    }
    void load(const Operand& out, std::vector<float> ShadingGrid::*plane) const {
        load(out, 1, [&](const ShadingGrid& grid, int) -> const std::vector<float>& { return grid.*plane; });
    }
    void load_P(const Operand& out) const {
        load(out, 3,
             [](const ShadingGrid& grid, int k) -> const std::vector<float>& { return grid.P.front().c[k]; });
    }

    /// The step of u or v from a vertex to the next.
    void load_steps(const Operand& out, std::vector<float> ShadingGrid::*plane, bool along_u) const {
        size_t at = 0;
        for (const ShadingGrid* grid : grids_) {
            const std::vector<float>& values = grid->*plane;
            const auto in_piece = static_cast<size_t>(grid->shape.vertex_count());
            const size_t next = along_u ? 1 : static_cast<size_t>(grid->shape.vertices_u());
            for (size_t first = 0; first < grid->vertex_count(); first += in_piece) {
                const float step = first + next < values.size() ? values[first + next] - values[first] : 1.0f;
                std::fill_n(out.data + at, in_piece, step);
                at += in_piece;
            }
        }
        std::fill(out.data + at, out.data + frame_.lanes(), at ? out.data[at - 1] : 0.0f);
    }

  private:
    vm::Frame& frame_;
    std::span<const ShadingGrid* const> grids_;
};

void set_variable(const Loader& loader, vm::Frame& frame, rsl::RegisterId id, const RenderContext& context,
                  bool shaded) {
    const std::string& name = frame.reg(id).name;
    const Operand& out = frame.operand(id);
    if (name == "P" || name == "Ps") return loader.load_P(out);
    if (name == "N") return loader.load(out, &ShadingGrid::N);
    if (name == "Ng") return loader.load(out, &ShadingGrid::Ng);
    if (name == "dPdu") return loader.load(out, &ShadingGrid::dPdu);
    if (name == "dPdv") return loader.load(out, &ShadingGrid::dPdv);
    if (name == "Cs") return loader.load(out, &ShadingGrid::Cs);
    if (name == "Os") return loader.load(out, &ShadingGrid::Os);
    if (name == "Ci") return loader.load(out, shaded ? &ShadingGrid::Ci : &ShadingGrid::Cs);
    if (name == "Oi") return loader.load(out, shaded ? &ShadingGrid::Oi : &ShadingGrid::Os);
    if (name == "u") return loader.load(out, &ShadingGrid::u);
    if (name == "v") return loader.load(out, &ShadingGrid::v);
    if (name == "s") return loader.load(out, &ShadingGrid::s);
    if (name == "t") return loader.load(out, &ShadingGrid::t);
    if (name == "du") return loader.load_steps(out, &ShadingGrid::u, true);
    if (name == "dv") return loader.load_steps(out, &ShadingGrid::v, false);
    const float zeros[16] = {};
    if (name == "I") {
        // From the eye to P; along the view when the projection is orthographic.
        if (context.camera.perspective) return loader.load_P(out);
        const float along[3] = {0, 0, 1};
        return frame.set_uniform(id, along);
    }
    if (name == "ncomps") {
        const float three = 3;
        return frame.set_uniform(id, &three);
    }
    if (name == "time") return frame.set_uniform(id, &context.scene->options.shutter_open);
    if (name == "dtime") {
        const float open = context.scene->options.shutter_close - context.scene->options.shutter_open;
        return frame.set_uniform(id, &open);
    }
    if (rsl::width_of(frame.reg(id).type.base) > 0) frame.set_uniform(id, zeros);  // E, L, Cl, dPdtime...
}

/// Follows from the bits of a position.
uint64_t place_seed(const V3f& P) {
    uint64_t seed = 0;
    for (int k = 0; k < 3; ++k) seed = seed * 0x9e3779b97f4a7c15u + std::bit_cast<uint32_t>(P[k]);
    return seed;
}

}  // namespace

vm::Points points_of(std::span<const ShadingGrid* const> grids, bool shared) {
    vm::Points points;
    for (const ShadingGrid* grid : grids) {
        const auto in_piece = static_cast<size_t>(grid->shape.vertex_count());
        for (size_t first = 0; first < grid->vertex_count(); first += in_piece) {
            const uint64_t seed = shared ? place_seed(grid->P.front().at(first)) : grid->ordinal;
            points.spans.push_back({points.vertices, grid->shape, grid->reverse_orientation, seed});
            points.vertices += in_piece;
        }
    }
    points.lanes = padded_size(points.vertices);
    return points;
}

void set_variables(vm::Frame& frame, std::span<const ShadingGrid* const> grids, const RenderContext& context,
                   bool shaded) {
    const Loader loader(frame, grids);
    for (const rsl::RegisterId id : frame.program().globals) set_variable(loader, frame, id, context, shaded);
}

Plane3 variable_planes(const vm::Frame& frame, std::string_view name) {
    const rsl::RegisterId* id = frame.program().find_global(name);
    if (!id) return {};
    const Operand& operand = frame.operand(*id);
    const size_t lanes = frame.lanes();
    return {{operand.data, lanes},
            {operand.data + operand.stride, lanes},
            {operand.data + 2 * operand.stride, lanes}};
}

bool writes_variable(const rsl::Program& program, std::string_view name) {
    const rsl::RegisterId* id = program.find_global(name);
    if (!id) return false;
    for (const rsl::Instruction& instruction : program.code)
        for (size_t k = 0; k < instruction.outputs; ++k)
            if (instruction.operands[k] == *id) return true;
    return false;
}

void take_colors(const vm::Frame& frame, std::span<ShadingGrid* const> grids) {
    for (const auto& [name, triples] :
         {std::pair{"Ci", &ShadingGrid::Ci}, std::pair{"Oi", &ShadingGrid::Oi}}) {
        const Plane3 planes = variable_planes(frame, name);
        if (planes.size() == 0) continue;
        size_t at = 0;
        for (ShadingGrid* grid : grids) {
            const size_t count = grid->vertex_count();
            for (int k = 0; k < 3; ++k)
                (grid->*triples)
                    .c[k]
                    .assign(planes[k].begin() + static_cast<std::ptrdiff_t>(at),
                            planes[k].begin() + static_cast<std::ptrdiff_t>(at + count));
            at += count;
        }
    }
}

}  // namespace trapeze
