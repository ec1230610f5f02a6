/// The geometry that rays meet as discs, for point-based occlusion [Christensen08].
#pragma once

#include <functional>
#include <optional>

#include "core/scene/surfels.h"
#include "pipeline/rays/ray_dicer.h"

namespace trapeze {

/// A disc for each block of kSurfelSide x kSurfelSide micropolygons, or what is left of it at a grid's end.
inline constexpr int kSurfelSide = 2;

/// Of the primitives that are wanted, in the order of their subpatches; in parallel, alike for any number of
/// threads. The task that asks does nothing else meanwhile. Nothing where they take more than `most_bytes`.
std::optional<Surfels> make_surfels(const RayDicer& dicer, const std::function<bool(uint32_t)>& wanted,
                                    size_t most_bytes);

/// RayScene::dice_surfel().
int dice_surfel(const RayDicer& dicer, uint64_t id, ShadingGrid& grid);

}  // namespace trapeze
