#include "shade/materials/grid_parts.h"

#include <algorithm>

#include "shade/materials/material.h"
#include "shade/operations/op_table.h"

namespace trapeze {
namespace {

using rsl::Op;

/// Whether the code makes of a vertex what follows from that vertex alone.
bool keeps_to_its_vertex(const rsl::Code& code) {
    return std::ranges::none_of(code, [](const rsl::Instruction& i) {
        return rsl::reads_neighbours(i.op) || i.op == Op::Random || i.op == Op::Print || i.op == Op::Gather ||
               rsl::row_of(i.op).context == rsl::ContextFamily::Rays;
    });
}

bool keeps_to_its_vertex(const rsl::Program& program) {
    return keeps_to_its_vertex(program.code) && !program.find_global("du") && !program.find_global("dv") &&
           std::ranges::all_of(program.parameters, [](const rsl::ProgramParameter& parameter) {
               return keeps_to_its_vertex(parameter.initial);
           });
}

bool keeps_to_its_vertex(const LayeredShader* shader) {
    return !shader || std::ranges::all_of(shader->layers, [](const BoundShader* layer) {
        return keeps_to_its_vertex(layer->program());
    });
}

using Floats = std::vector<float>;

/// Values first .. first + count - 1 of a plane.
Floats part_of(const Floats& values, size_t first, size_t count) {
    // A plane may be shorter than the grid: its last value then holds for all vertices that follow.
    Floats part;
    for (size_t i = first; i < first + count && !values.empty(); ++i)
        part.push_back(values[std::min(i, values.size() - 1)]);
    return part;
}

Triples part_of(const Triples& values, size_t first, size_t count) {
    Triples part;
    for (int k = 0; k < 3; ++k) part.c[k] = part_of(values.c[k], first, count);
    return part;
}

/// Puts a part's values in their place; makes the plane as long as the grid.
void put(const Floats& part, size_t first, size_t vertices, Floats& whole) {
    whole.resize(vertices);
    std::copy(part.begin(), part.end(), whole.begin() + static_cast<std::ptrdiff_t>(first));
}

void put(const Triples& part, size_t first, size_t vertices, Triples& whole) {
    for (int k = 0; k < 3; ++k) put(part.c[k], first, vertices, whole.c[k]);
}

}  // namespace

bool shades_vertices_apart(const Material& material) {
    return !material.displacement && !material.surface_moves && keeps_to_its_vertex(material.surface) &&
           keeps_to_its_vertex(material.atmosphere) &&
           std::ranges::all_of(material.lights, [](const Lamp* lamp) {
               return !lamp->area && keeps_to_its_vertex(lamp->shader->program());
           });
}

size_t part_size(size_t vertices, size_t parts) {
    return std::clamp(padded_size((vertices + parts - 1) / std::max<size_t>(parts, 1)), kFewestInPart,
                      kMostInPart);
}

ShadingGrid part_of(const ShadingGrid& grid, size_t first, size_t count) {
    ShadingGrid part;
    part.shape = {static_cast<uint8_t>(count - 1), 0};
    part.key_count = grid.key_count;
    part.primitive = grid.primitive;
    part.primitive_index = grid.primitive_index;
    part.ordinal = grid.ordinal, part.seed = grid.seed;
    part.reverse_orientation = grid.reverse_orientation;
    for (const Triples& places : grid.P) part.P.push_back(part_of(places, first, count));
    for (const auto member : {&ShadingGrid::N, &ShadingGrid::Ng, &ShadingGrid::dPdu, &ShadingGrid::dPdv,
                              &ShadingGrid::Cs, &ShadingGrid::Os})
        part.*member = part_of(grid.*member, first, count);
    for (const auto member : {&ShadingGrid::u, &ShadingGrid::v, &ShadingGrid::s, &ShadingGrid::t})
        part.*member = part_of(grid.*member, first, count);
    part.variables = grid.variables;
    for (GridVariable& variable : part.variables)
        if (!variable.uniform)
            for (Floats& plane : variable.planes) plane = part_of(plane, first, count);
    return part;
}

void put_part(const ShadingGrid& part, size_t first, ShadingGrid& grid) {
    const size_t vertices = grid.vertex_count();
    put(part.Ci, first, vertices, grid.Ci);
    put(part.Oi, first, vertices, grid.Oi);
    grid.aovs.resize(part.aovs.size());
    for (size_t i = 0; i < part.aovs.size(); ++i) put(part.aovs[i], first, vertices, grid.aovs[i]);
}

}  // namespace trapeze
