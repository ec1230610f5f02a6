/// Where points of surfaces lie on what rays meet of them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/scene/ray_scene.h"

namespace trapeze {

/// A point of a surface that rays leave, as the shutter opens, camera space.
struct LeavingPoint {
    V3f P, normal;     ///< of unit length, outside
    float number = 0;  ///< of a ray that sees the surface (RaySegment::number)
    uint32_t primitive = 0;
    uint8_t level = 0;      ///< of the geometry
    float reach = 0;        ///< what rays meet of the surface is no farther from P
    float rounding = 0;     ///< of positions
    bool is_vertex = true;  ///< else a place beside one, which is asked for once

    bool operator==(const LeavingPoint&) const = default;
};

/// Knows those that have been asked for: calls for several lights ask for the same ones.
class RayGrounds {
  public:
    using Ground = std::shared_ptr<const RayFacet>;

    /// Of each point the micropolygon of its primitive that is nearest along the normal, of those that face
    /// the same way, or that which is seen from a little outside; null where rays of the kind meet none
    /// within reach.
    std::vector<Ground> of(const RayScene& scene, RayKind kind, std::span<const LeavingPoint> points);

  private:
    struct Asked {
        LeavingPoint point;
        RayKind kind;
        bool operator==(const Asked&) const = default;
    };
    struct Hash {
        size_t operator()(const Asked& asked) const;
    };

    std::unordered_map<Asked, Ground, Hash> known_;
};

/// RayScene::closest() of rays that lie side by side in memory.
std::vector<std::optional<RaySurfaceHit>> closest_hits(const RayScene& scene, RayKind kind,
                                                       std::span<const RaySegment> rays);

}  // namespace trapeze
