#include "shade/materials/grid_shader.h"

#include <algorithm>
#include <bit>

#include "shade/materials/polygon_parameters.h"

namespace trapeze {
namespace {

using vm::Operand;

/// Loads grids' values into registers, each grid's behind those of the grids before it. Lanes past the last
/// vertex repeat its value.
class Loader {
  public:
    Loader(vm::Registers& registers, std::span<const ShadingGrid* const> grids)
        : registers_(registers), grids_(grids) {}

    /// Loads `components` planes; plane_of(grid, k) is a grid's plane, which may be shorter than the grid:
    /// its last value then holds for the rest.
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
            std::fill(to + at, to + registers_.lanes(), at ? to[at - 1] : 0.0f);
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

    /// Whether the grids are of what rays have hit; those of one run all are, or none.
    bool are_seen_by_rays() const { return grids_.front()->I.size() > 0; }

    /// Copies a plane that already has the run's lanes.
    void copy(const Operand& out, const float* plane) const {
        std::copy_n(plane, registers_.lanes(), out.data);
    }

  private:
    vm::Registers& registers_;
    std::span<const ShadingGrid* const> grids_;
};

/// Where the rays began that have hit the grids: of the camera's in the eye, or on the eye's plane in front
/// of P.
void load_ray_origin(const Loader& loader, const Operand& out, bool perspective) {
    std::vector<float> plane;
    loader.load(out, 3, [&](const ShadingGrid& grid, int k) -> const std::vector<float>& {
        const std::vector<float>& P = grid.P.front().c[k];
        if (grid.I.size() == 0 && !perspective && k < 2) return P;
        plane.assign(P.size(), 0.0f);
        for (size_t i = 0; i < grid.I.size(); ++i) plane[i] = P[i] - grid.I.c[k][i];
        return plane;
    });
}

/// How fast points move as the shutter opens, in camera space a unit of time.
void load_velocity(const Loader& loader, const Operand& out, float shutter) {
    std::vector<float> plane;
    loader.load(out, 3, [&](const ShadingGrid& grid, int k) -> const std::vector<float>& {
        plane.assign(grid.vertex_count(), 0.0f);
        const size_t keys = grid.P.size();
        if (keys < 2 || !(shutter > 0)) return plane;
        const std::vector<float>&from = grid.P[0].c[k], &to = grid.P[1].c[k];
        const float times = static_cast<float>(keys - 1) / shutter;
        for (size_t i = 0; i < plane.size(); ++i) plane[i] = (to[i] - from[i]) * times;
        return plane;
    });
}

/// Sets one predefined variable (RISpec 3.2, tables 12.1 to 12.5). Spaces are the grids', camera space; the
/// eye is at the origin.
void set_variable(const Loader& loader, vm::Registers& registers, const vm::StartValue& value,
                  const RenderContext& context, vm::Footprints& footprints, bool shaded) {
    const Operand& out = registers.operand(value.id);
    const Options& options = context.scene->options;
    using vm::Predefined;
    switch (value.variable) {
        case Predefined::P:
        case Predefined::Ps:
            return loader.load_P(out);
        case Predefined::N:
            return loader.load(out, &ShadingGrid::N);
        case Predefined::Ng:
            return loader.load(out, &ShadingGrid::Ng);
        case Predefined::dPdu:
            return loader.load(out, &ShadingGrid::dPdu);
        case Predefined::dPdv:
            return loader.load(out, &ShadingGrid::dPdv);
        case Predefined::Cs:
            return loader.load(out, &ShadingGrid::Cs);
        case Predefined::Os:
            return loader.load(out, &ShadingGrid::Os);
        case Predefined::Ci: {
            // Black where nothing has shaded yet: what a shader leaves alone, or adds to, shows nothing of
            // its own.
            if (shaded) return loader.load(out, &ShadingGrid::Ci);
            const float black[3] = {};
            return registers.set_uniform(value.id, black);
        }
        case Predefined::Oi:
            return loader.load(out, shaded ? &ShadingGrid::Oi : &ShadingGrid::Os);
        case Predefined::u:
        case Predefined::SurfaceU:
            return loader.load(out, &ShadingGrid::u);
        case Predefined::v:
        case Predefined::SurfaceV:
            return loader.load(out, &ShadingGrid::v);
        case Predefined::s:
            return loader.load(out, &ShadingGrid::s);
        case Predefined::t:
            return loader.load(out, &ShadingGrid::t);
        case Predefined::du:
            return loader.copy(out, footprints.get().du);
        case Predefined::dv:
            return loader.copy(out, footprints.get().dv);
        case Predefined::ncomps: {
            const float three = 3;
            return registers.set_uniform(value.id, &three);
        }
        case Predefined::time:
            return registers.set_uniform(value.id, &options.shutter_open);
        case Predefined::dtime: {
            const float open = options.shutter_close - options.shutter_open;
            return registers.set_uniform(value.id, &open);
        }
        case Predefined::dPdtime:
            return load_velocity(loader, out, options.shutter_close - options.shutter_open);
        case Predefined::RayOrigin:
            return load_ray_origin(loader, out, context.camera.perspective);
        // From the eye to P, or from where a ray begins; from the plane of the eye when the projection is
        // orthographic. As long as that way, which is what light goes through an atmosphere [RISpec, fog].
        case Predefined::I:
        case Predefined::RayWay: {
            if (loader.are_seen_by_rays()) return loader.load(out, &ShadingGrid::I);
            if (context.camera.perspective) return loader.load_P(out);
            const std::vector<float> none{0};
            return loader.load(out, 3, [&](const ShadingGrid& grid, int k) -> const std::vector<float>& {
                return k == 2 ? grid.P.front().c[2] : none;
            });
        }
        case Predefined::Ns:
        case Predefined::Other: {  // E, L, Cl...: blocks set them, or nothing does
            const float zeros[16] = {};
            if (rsl::width_of(registers.reg(value.id).type.base) > 0) registers.set_uniform(value.id, zeros);
        }
    }
}

/// A seed of random numbers that follows from the bits of a position, and so is the same in all grids that
/// have the point.
uint64_t place_seed(const V3f& P) {
    uint64_t seed = 0;
    for (int k = 0; k < 3; ++k) seed = seed * 0x9e3779b97f4a7c15u + std::bit_cast<uint32_t>(P[k]);
    return seed;
}

}  // namespace

vm::Batch batch_of(std::span<const ShadingGrid* const> grids, bool shared) {
    vm::Batch batch;
    for (const ShadingGrid* grid : grids) {
        const auto in_piece = static_cast<size_t>(grid->shape.vertex_count());
        for (size_t first = 0; first < grid->vertex_count(); first += in_piece) {
            const uint64_t seed = shared ? place_seed(grid->P.front().at(first)) : grid->seed;
            vm::GridSpan& span = batch.spans.emplace_back();
            span.first = batch.vertices, span.shape = grid->shape, span.seed = seed;
            span.reverse_orientation = grid->reverse_orientation;
            span.hit_vertex = grid->hit_vertex;
            span.steps = steps_of_face(*grid, first / in_piece);
            if (!shared) span.grid = grid, span.wanted = grid->wanted;
            batch.vertices += in_piece;
        }
    }
    batch.lanes = padded_size(batch.vertices);
    return batch;
}

void set_variables(vm::Registers& registers, std::span<const ShadingGrid* const> grids,
                   const RenderContext& context, vm::Footprints& footprints, bool shaded, bool all) {
    const Loader loader(registers, grids);
    for (const vm::StartValue& value : registers.executable().start_values())
        if (all || value.needed) set_variable(loader, registers, value, context, footprints, shaded);
}

Plane3 variable_planes(const vm::Registers& registers, std::string_view name) {
    const rsl::RegisterId* id = registers.program().find_global(name);
    if (!id) return {};
    const Operand& operand = registers.operand(*id);
    const size_t lanes = registers.lanes();
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

void take_colors(const vm::Registers& registers, std::span<ShadingGrid* const> grids) {
    for (const auto& [name, triples] :
         {std::pair{"Ci", &ShadingGrid::Ci}, std::pair{"Oi", &ShadingGrid::Oi}}) {
        const Plane3 planes = variable_planes(registers, name);
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
