/// A NuPatch of which TrimCurve leaves only a part.
#pragma once

#include "tessellate/topology/surface.h"

namespace trapeze {

/// The loops of a trimmed patch as polylines; u and v from 0 to 1 over the patch's range.
std::vector<std::vector<Imath::V2d>> flattened_loops(const NuPatch& patch);

/// Makes the surface of what is left of a patch, as a mesh of its pieces. `whole`: a face for each pair of
/// the patch's knot spans. Null when nothing is left.
std::unique_ptr<Surface> make_trimmed_patch(const NuPatch& patch, std::unique_ptr<Surface> whole);

}  // namespace trapeze
