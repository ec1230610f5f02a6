/// Parameter lists of primitives: points and other variables (RISpec 5).
#pragma once

#include <cstdint>

#include "pipeline/rib/reader/request_context.h"

namespace trapeze::rib {

/// Sizes beyond which a shape is an error and not allocated: counts come from strangers.
inline constexpr int kMostPointsAlongSide = 1 << 20;
inline constexpr int64_t kMostPoints = 1 << 28;

/// How a primitive takes its points. Mesh: "P", or "Pw" divided by its weights. Patch: "P", "Pw", or heights
/// "Pz" over a regular grid. None: a quadric.
enum class PointForm { Mesh, Patch, None };

/// The parameter list at the end of a primitive. RISpec's own variables have their own types in it, and of
/// all forms of points only one is left.
ParameterList read_variables(RequestContext& context, ArgumentCursor& cursor, PointForm form);

/// The parameter list of a primitive that must have points; without them the request ends with the error that
/// "P" is missing.
ParameterList read_variables_with_points(RequestContext& context, ArgumentCursor& cursor, PointForm form);

/// Number of points in such a list; 0 when there are none.
int point_count_of(const ParameterList& list);

/// Checks the list against its primitive: points of a wrong number end the request, other variables of a
/// wrong length are reported and left out. "Pz" becomes "P", "st" becomes "s" and "t".
ParameterList checked_variables(RequestReport& report, ParameterList list, const Topology& topology);

}  // namespace trapeze::rib
