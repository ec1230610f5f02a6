/// Which surfaces along a ray border a solid (RISpec 5.7) [decision 0013].
#pragma once

#include <functional>
#include <optional>

#include <tbb/enumerable_thread_specific.h>

#include "core/scene/ray_scene.h"
#include "core/scene/solid_state.h"

namespace trapeze {

class SolidHits {
  public:
    /// The nearest surface within a segment, whatever solids say.
    using Find = std::function<std::optional<RaySurfaceHit>(const RaySegment&)>;

    /// The scene outlives this.
    explicit SolidHits(const Scene& scene)
        : scene_(scene), states_([&] { return SolidState(scene.solids); }) {}

    /// Whether a primitive bounds a part of a solid.
    bool has(uint32_t primitive) const { return scene_.primitives[primitive].solid >= 0; }
    /// The nearest surface that is no part of a solid or borders one; comes from outside where the ray enters
    /// the whole solid.
    std::optional<RaySurfaceHit> nearest(const RaySegment& ray, const Find& find) const;

  private:
    const Scene& scene_;
    mutable tbb::enumerable_thread_specific<SolidState> states_;
};

}  // namespace trapeze
