/// What is cut away from a scene by constructive solid geometry (RISpec 5.7) and by clipping planes: hits
/// that lie on no border of what is left are taken out of samples' lists. Resolved along each sample's ray,
/// at its time and point of the lens, it is exact with motion and defocus, and the same for all methods
/// [decision 0013].
#pragma once

#include <memory>

#include "core/scene/scene.h"
#include "sample/visibility.h"

namespace trapeze {

/// A method whose hits are cut; the method itself when the scene cuts nothing away.
std::unique_ptr<Visibility> with_cuts(std::unique_ptr<Visibility> method, const RenderContext& context,
                                      const Grids& grids);

}  // namespace trapeze
