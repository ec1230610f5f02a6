/// Rays on their way through surfaces that may be transparent: what they see, and what is left of the light
/// along them.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "core/scene/ray_scene.h"
#include "core/scene/scene.h"
#include "core/stats.h"

namespace trapeze {

/// A ray and what has come of it.
struct WalkedRay {
    RaySegment segment;
    uint64_t seed = 0;           ///< of random numbers of shaders that it meets
    V3f seen{0, 0, 0};           ///< colour, as radiance() leaves it
    V3f through{1, 1, 1};        ///< the part of the light from behind that arrives
    float distance = kInfinity;  ///< of the first hit
};

/// Shades grids of hits, one micropolygon each: sets Ci and Oi.
using ShadeHits = std::function<void(std::span<ShadingGrid* const>)>;

/// A thread's memory: grids of hits.
struct RayWalkScratch {
    std::deque<ShadingGrid> grids;
};

/// Sends rays through a scene. All it refers to must outlive it.
class RayWalk {
  public:
    /// Without `shade` hits stand for their primitives' own colour and opacity.
    RayWalk(const RayScene& scene, ShadeHits shade, RayWalkScratch& scratch, RayStats& stats)
        : scene_(scene), shade_(std::move(shade)), scratch_(scratch), stats_(stats) {}

    /// Sets what rays of a kind see, from front to back until nothing shines through, `through` and
    /// `distance`.
    void radiance(std::span<WalkedRay> rays, RayKind kind);
    /// Sets `through`; and `distance`, if that is wanted, too.
    void transmission(std::span<WalkedRay> rays, RayKind kind, bool with_distance);
    /// Sets `distance` alone: no surface is too transparent to be found.
    void distance(std::span<WalkedRay> rays, RayKind kind);

  private:
    enum class Wants : uint8_t { Color, Opacity };
    void walk(std::span<WalkedRay* const> rays, RayKind kind, Wants wants);
    void shade_hits(Wants wants);

    /// A ray that has met something and may go on behind it.
    struct Met {
        WalkedRay* ray;
        RaySurfaceHit hit;
        int vertex = -1;  ///< of the grid that shades it; -1: the primitive's own values hold
        ShadingGrid* grid = nullptr;
    };

    const RayScene& scene_;
    const ShadeHits shade_;
    RayWalkScratch& scratch_;
    RayStats& stats_;
    std::vector<Met> met_;
};

}  // namespace trapeze
