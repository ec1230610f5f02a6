/// Some of a grid's vertices as a grid of their own, so that several threads can shade one grid whose shaders
/// take long.
#pragma once

#include "core/scene/shading_grid.h"

namespace trapeze {

struct Material;

/// Whether all of the material's shaders make of a vertex what follows from it alone, and so shade parts of a
/// grid with the same bits as the whole: none looks at neighbours (derivatives, filtered lookups), counts
/// vertices (random numbers), prints, or displaces.
bool shades_vertices_apart(const Material& material);

/// The fewest vertices of a part, below which the interpreter's work for each operation is more than the
/// operation, and the most.
inline constexpr size_t kFewestInPart = 48, kMostInPart = 256;

/// How many vertices a part has, all but the last, when a grid is divided into about so many: a multiple of
/// kLanes.
size_t part_size(size_t vertices, size_t parts);

/// Vertices first .. first + count - 1 as a grid of one row, with what shaders read of them, and
/// positions at all keys.
ShadingGrid part_of(const ShadingGrid& grid, size_t first, size_t count);

/// Copies the colours and output variables of a shaded part to where its vertices are in the whole grid.
void put_part(const ShadingGrid& part, size_t first, ShadingGrid& grid);

}  // namespace trapeze
