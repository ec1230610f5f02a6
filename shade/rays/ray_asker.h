/// The surface whose shaders ask for rays: what holds for all calls of a grid's shaders, and the lanes of one
/// call.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/scene/level_of_detail.h"
#include "core/scene/scene.h"
#include "shade/rays/ray_aim.h"
#include "shade/rays/ray_starts.h"
#include "shade/rays/ray_walk.h"
#include "shade/rays/surface_slab.h"
#include "shade/vm/machine.h"

namespace trapeze {

class LaneMotion;

/// What calls of a grid's shaders ask. All it refers to must outlive the calls.
struct RayService {
    const RayScene* scene = nullptr;
    ShadeHits shade;  ///< shades hits, one bounce farther from the camera
    int depth = 0;    ///< bounces from the camera to the points that are shaded
    int max_depth = 10;
    HitVisit visit;     ///< how the points are visited: by the camera, or by the ray that hit them
    uint32_t seed = 0;  ///< of the render
    std::span<const M44f> held_from_camera;  ///< Scene::held_from_camera
    const VolumeTable* volumes = nullptr;
    RayWalkScratch* scratch = nullptr;
    RayStats* stats = nullptr;
};

/// A lane that asks, with the seed of its random numbers in this call.
struct RayLane {
    size_t lane = 0;
    uint32_t seed = 0;
    /// What it is told holds for these lanes: for itself, or for all of the grid that it speaks for.
    size_t first = 0, count = 1;
    const ShadingGrid* grid = nullptr;  ///< whose vertex it is, if any is known
    size_t first_of_grid = 0;
    SurfaceBend bend;  ///< of the grid, RayAsker::bend_of()

    /// Of the geometry that it lies on.
    uint8_t level() const { return grid ? grid->hit_level : uint8_t{0}; }
    /// The seed of what one of its rays hits.
    uint64_t of_ray(int sample) const;
};

/// The shaded surface, for its calls.
class RayAsker {
  public:
    /// `attributes`: of the surface that is shaded.
    RayAsker(const RayService& service, const Attributes& attributes)
        : service_(service), attributes_(attributes), seen_(seen_numbers(attributes)) {}

    const RayService& service() const { return service_; }
    /// bend_of() a grid of the surface, next to what rays meet of it.
    SurfaceBend bend_of(const ShadingGrid& grid) const;
    /// How near to P, at most, rays of a lane begin or end: what they meet of a surface there lies within it,
    /// by the size of pixels at P. `asked` below 0: the call does not say.
    float margin_at(const V3f& P, const RayLane& lane, float asked) const;
    /// How far from P, which is where the lane's point is at a time, its rays begin that leave then; `asked`
    /// as above.
    LeftSurface left_at(const V3f& P, const RayLane& lane, const LaneMotion& motion, float time,
                        float asked) const;
    /// Where a ray ends that goes the way `aim` to a place of which the lane knows nothing but how far it may
    /// lie from its surface.
    ReachedPlace reached_at(const RayAim& aim, const RayLane& lane, float roughness) const;
    /// Whether the call or the attributes say from where on hits count.
    bool has_bias(float asked) const { return asked >= 0 || attributes_.rays.bias > 0; }
    /// What a ray of a kind leaves at P, as the shutter opens, where `left` does not tell along its
    /// direction; nothing where it does not meet it, or where has_bias(). `is_exact`: who is told how far it
    /// is from P has a witness for edges (WalkedRay::witness).
    std::optional<LeavingPoint> leaving_at(const V3f& P, const V3f& direction, const RayLane& lane,
                                           float asked, const LeftSurface& left, RayKind kind,
                                           bool is_exact = false) const;
    /// Whether either tells of rays of a kind at P as the shutter opens.
    bool knows_where_to_begin(const V3f& P, const RayLane& lane, const LaneMotion& motion, float asked,
                              RayKind kind) const;
    /// Which way the surface faces of a lane's vertex at P or next to it, as the shutter opens; 0 where P is
    /// somewhere else.
    static V3f normal_at(const V3f& P, const RayLane& lane);
    /// What is left of light that comes to the other side of a lane's own surface than is seen of it, at P:
    /// all of it where the surface is none that `only`, or rays of transmission, meet from there
    /// (knows_where_to_begin()).
    V3f left_of_light_behind(const RayLane& lane, bool is_met, const RayFilter* only) const;
    /// How far within its own grid the rays of a lane begin that is on an edge of the grid (inwards_at()).
    static V3f inwards(const RayLane& lane, const LeftSurface& left);
    /// Of rays that tell what is seen from P, or how far it is: on edges of the face alone, and no farther
    /// than a quarter of a side of what rays meet.
    static V3f inwards_of_face(const RayLane& lane, const LeftSurface& left);
    /// How wide the rays of a lane are where they begin.
    float width_at(const V3f& P, const RayLane& lane) const;
    /// Whether rays meet the scene at times of their own.
    bool samples_motion() const { return attributes_.rays.sample_motion; }
    /// The depths of what rays of a kind hit.
    RayDepths depths_behind(RayKind kind) const;
    /// Whether there is any medium that a lane's rays may begin in.
    bool knows_media(const RayLane& lane) const { return lane.grid && !service_.volumes->empty(); }
    /// Whether calls are of the shader of what the surface is seen through: their rays begin in it.
    /// `for_opacity`: its opacity alone is wanted.
    void ask_within_medium(bool within, bool for_opacity) {
        within_medium_ = within, dims_alone_ = within && for_opacity;
    }
    /// Whether rays to lights are to take things for what they are by themselves: what dims light need not be
    /// lit through itself, and would ask again at each step of its way.
    bool dims_alone() const { return dims_alone_; }
    /// RaySegment::number of a lane's ray: a level of detail in transition sees what is seen along with it.
    float number(const RayLane& lane, int sample) const;
    /// What a ray of a lane goes through first.
    RayMedium medium(const RayLane& lane, const V3f& direction) const;
    /// Whether hits are not shaded any more: they are black.
    bool is_too_deep(RayKind kind) const;

  private:
    float side(int level) const;
    LooseEnd loose_end_at(const V3f& P, const RayLane& lane, float roughness) const;
    static V3f vertex_of(const RayLane& lane);
    static bool may_hide_others(const V3f& direction, const RayLane& lane, const LeftSurface& left);
    static bool may_come_back(const V3f& direction, const RayLane& lane, const LeftSurface& left);

    const RayService& service_;
    const Attributes& attributes_;
    const SeenNumbers seen_;
    bool within_medium_ = false, dims_alone_ = false;
};

}  // namespace trapeze
