/// Where rays leave surfaces of which no slab is known (surface_slab.h), above all displaced ones: on what
/// rays meet of them [decision 0034].
///
/// A point of the camera's grids lies in front of or behind what rays meet of its surface, by as much as two
/// dicings of it differ. So rays begin on the micropolygon that is nearest along the normal (RayGrounds), on
/// the side that they are meant to be on. A direction that leads below it nevertheless lies between the
/// surface as it is and its micropolygons: where the surface bends away the ray comes out from behind it
/// within some sides, and begins there; else the surface bends towards the ray, and is hit where that begins.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "shade/rays/ray_grounds.h"
#include "shade/rays/ray_walk.h"

namespace trapeze {

/// How a ray leaves a point.
struct LeavingRay {
    size_t ray = 0;  ///< its number
    /// As the shutter opens: where it leads, and the axis of the cone of such rays, on whose side of the
    /// surface it is meant to be.
    V3f way{0, 0, 0}, axis{0, 0, 0};
    /// Where it goes to, whatever it begins on; nothing: it keeps its direction. `ends`: it ends there, or a
    /// little before.
    std::optional<V3f> towards = {};
    bool ends = false;
    /// Of directions that ought to have turned with a surface that deforms: how their space has turned them.
    std::optional<M33f> turn = {};
};

/// The starts of rays that are to be sent together.
class RayStarts {
  public:
    void add(const LeavingPoint& point, const LeavingRay& ray);
    /// Moves the rays to where they begin; not where nothing is found of their surface. They refer to this
    /// until it is called for the next rays.
    void settle(const RayScene& scene, RayKind kind, RayGrounds& grounds, std::span<WalkedRay> rays);

  private:
    struct Start {
        LeavingRay leaving;
        size_t point;  ///< index
        bool outside;  ///< the side that it is meant to be on
        bool crosses;  ///< the vertex' plane: it may go behind the surface
    };
    /// Where a ray leads from the micropolygon that it begins on.
    enum class Way : uint8_t { Away, Into, FromBehind };

    Way begin(const Start& start, const FacetPose& facet, WalkedRay& ray) const;
    void come_out(const RayScene& scene, RayKind kind, std::span<const Start> behind,
                  std::span<WalkedRay> rays, std::vector<Start>& into) const;
    void meet_grounds(const RayScene& scene, RayKind kind, std::span<const Start> into,
                      std::span<WalkedRay> rays);

    std::vector<LeavingPoint> points_;
    std::vector<Start> starts_;
    std::vector<RayGrounds::Ground> grounds_;        ///< of points_, while they are settled
    std::vector<std::optional<RaySurfaceHit>> met_;  ///< WalkedRay::first of rays that were settled last
};

}  // namespace trapeze
