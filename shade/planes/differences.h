/// Differences over a grid: how a value changes from a vertex to the next along u and v. Central inside the
/// grid and one-sided at its border.
#pragma once

#include "core/grid.h"
#include "core/scene/shading_grid.h"
#include "shade/planes/planes.h"

namespace trapeze {

enum class GridAxis { U, V };

/// `out` = the change of `values` from a vertex to the next along an axis: half the difference of the
/// neighbours, or at the border the difference to the one neighbour. Values are in row order; `out` must be
/// another plane.
void difference(const GridShape& shape, GridAxis axis, ConstPlane values, Plane out);

/// Unit normals of the surface through P, along dPdu x dPdv or, if asked, against it. Where that is
/// nothing because neighbours lie on one point (borders snapped to a coarser rate, poles) the neighbours'
/// normals are used; where they have none either, N keeps what it holds.
void find_normals(const GridShape& shape, ConstPlane3 P, bool reverse, Plane3 N);

}  // namespace trapeze
