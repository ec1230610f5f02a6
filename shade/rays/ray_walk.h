/// Rays on their way through surfaces that may be transparent: what they see, and what is left of the light
/// along them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene/ray_scene.h"
#include "core/scene/scene.h"
#include "core/scene/shading_grid.h"
#include "core/stats.h"
#include "core/task.h"
#include "shade/rays/hit_outputs.h"
#include "shade/rays/volume_table.h"

namespace trapeze {

/// A ray and what has come of it.
struct WalkedRay {
    RaySegment segment;
    RayFootprint footprint;
    /// How far the segment's origin lies from where who asks is told that the ray begins: within the edge
    /// that it stands on.
    V3f moved{0, 0, 0};
    /// Of distance() alone: from the origin to that of a second ray, which cannot slip through an edge on
    /// which the first one begins.
    V3f witness{0, 0, 0};
    uint64_t seed = 0;  ///< of random numbers of shaders that it meets
    RayMedium medium;   ///< what it goes through from the distance `medium_from` on
    float medium_from = 0;
    float end = kInfinity;  ///< where it ends if nothing is in its way; what is shortly before may not count
    RayMedium end_medium;   ///< what it comes to its end through, if no surface on the way says so
    V3f seen{0, 0, 0};      ///< colour, as radiance() leaves it
    V3f through{1, 1, 1};   ///< the part of the light from behind that arrives
    float distance = kInfinity;            ///< of the first hit
    float* answers = nullptr;              ///< where the first hit's answers to RayAsk::outputs go
    const RaySurfaceHit* first = nullptr;  ///< what it meets where it begins, if that is known already
    const float* sent = nullptr;  ///< numbers for RayAsk::sent, of one variable's planes after the other's

    bool hits() const { return distance < kInfinity; }
    /// Of the first hit, from where the ray is said to begin.
    float told_distance() const {
        return hits() ? std::max(distance + moved.dot(segment.direction), 0.0f) : distance;
    }
};

/// Bounces from the camera, by kinds of rays, and how many there may be.
struct RayDepths {
    static constexpr size_t kKinds = 3;  ///< of RayKind
    std::array<int, kKinds> bounces{};
    /// The least that the surfaces on the way allow. (Transmission: no bound.)
    std::array<int, kKinds> most{kEndless, kEndless, kEndless};
    static constexpr int kEndless = 1 << 30;

    int of(RayKind kind) const { return bounces[static_cast<size_t>(kind)]; }
};

/// How hits are visited: by rays of what kind, under which label, and what is asked.
struct HitVisit {
    std::optional<RayKind> kind;  ///< none: by the camera
    RayDepths depths;             ///< of the hits
    std::string_view label;
    bool shades = true;  ///< else only the answers are wanted
    const HitOutputs* outputs = nullptr;
};

/// Shades grids of hits, one micropolygon each: sets Ci and Oi, and answers what is asked.
using ShadeHits = std::function<Task<>(std::span<ShadingGrid* const>, const HitVisit&)>;

/// What all rays of a call have in common.
struct RayAsk {
    using HitMode = RayAttributes::HitMode;

    RayKind kind = RayKind::Specular;
    RayDepths depths;  ///< of hits
    std::string_view label;
    /// What hits stand for; without it their attributes say so.
    std::optional<HitMode> hit_mode;
    bool shades = true;  ///< else all hits stand for their primitives' own colour and opacity
    /// Opacity of each component that ends a ray; without it next to nothing must be left of the light.
    std::optional<V3f> opaque;
    bool first_alone = false;  ///< rays end at the first surface
    const HitOutputs* outputs = nullptr;
    /// What comes along with each ray to all that it hits; the numbers are the ray's own.
    std::span<const SentVariable> sent = {};
};

/// Rays that should be traced together, at least.
size_t rays_at_once(const RayScene& scene);

/// A thread's memory: grids of hits, and arrays of rays, which the system would take back after each call.
struct RayWalkScratch {
    std::deque<ShadingGrid> grids;
    std::vector<std::vector<WalkedRay>> spare;

    /// Empty, with room for as many as it had.
    std::vector<WalkedRay> take() {
        if (spare.empty()) return {};
        std::vector<WalkedRay> rays = std::move(spare.back());
        spare.pop_back();
        return rays;
    }
    void give_back(std::vector<WalkedRay> rays) {
        constexpr size_t kMostKept = 1 << 14;
        rays.clear();
        if (rays.capacity() <= kMostKept) spare.push_back(std::move(rays));
    }
};

/// Sends rays through a scene. All it refers to must outlive it.
class RayWalk {
  public:
    RayWalk(const RayScene& scene, const ShadeHits& shade, const VolumeTable& volumes,
            RayWalkScratch& scratch, RayStats& stats)
        : scene_(scene), shade_(shade), volumes_(volumes), scratch_(scratch), stats_(stats) {}

    /// Sets what rays see, from front to back until nothing shines through, `through` and `distance`; answers
    /// what is asked of first hits.
    Task<> radiance(std::span<WalkedRay> rays, const RayAsk& ask);
    /// Sets `through`; and `distance`, if that is wanted, too.
    Task<> transmission(std::span<WalkedRay> rays, const RayAsk& ask, bool with_distance);
    /// Sets `distance` alone: no surface is too transparent to be found.
    void distance(std::span<WalkedRay> rays, const RayAsk& ask);

  private:
    enum class Wants : uint8_t { Color, Opacity };

    /// A ray that has met something and may go on behind it.
    struct Met {
        WalkedRay* ray;
        RaySurfaceHit hit;
        RayMedium medium = {};  ///< what it is seen through, if that has a shader
        int vertex = -1;  ///< of the grid that shades it, or its medium; -1: the primitive's own values hold
        ShadingGrid* grid = nullptr;
    };

    void ask_witnesses(std::span<WalkedRay> rays, const RayAsk& ask);
    Task<> walk(std::span<WalkedRay* const> rays, std::vector<WalkedRay*> free, const RayAsk& ask,
                Wants wants);
    bool pass(const Met& met, const RayAsk& ask) const;
    static bool see(WalkedRay& ray, const V3f& color, const V3f& opacity);
    // ray_ends.cpp
    bool ends_in_media(const WalkedRay& ray, const RayAsk& ask) const;
    Task<> come_to_ends(std::vector<WalkedRay*>& rays, const RayAsk& ask, Wants wants);
    ShadingGrid& grid_at_end(const WalkedRay& ray, const RayAsk& ask, size_t number);
    ShadingGrid& grid_of_number(size_t number);
    static void send(const WalkedRay& ray, const RayAsk& ask, ShadingGrid& grid);
    void find_media(std::span<Met> met, const RayAsk& ask, Wants wants) const;
    bool shades(const RaySurfaceHit& hit, const RayAsk& ask, Wants wants) const;
    Task<> visit_hits(std::span<Met> met, const RayAsk& ask, Wants wants, bool first);
    ShadingGrid& grid_of(Met& met, const RayAsk& ask, size_t number);

    const RayScene& scene_;
    const ShadeHits& shade_;
    const VolumeTable& volumes_;
    RayWalkScratch& scratch_;
    RayStats& stats_;
};

}  // namespace trapeze
