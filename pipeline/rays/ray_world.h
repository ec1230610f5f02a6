/// The geometry that rays of shaders meet [Hou10 sec. 4]: all primitives whose attributes let some kind of
/// ray see them, diced without regard to what the camera sees, with a tree over them. It is in memory as a
/// whole, while the frame is rendered.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "accel/wide/wide_tree.h"
#include "core/scene/ray_scene.h"
#include "core/scene/render_context.h"
#include "shade/shading.h"
#include "tessellate/tessellate.h"

namespace trapeze {

class RayWorld final : public RayScene {
  public:
    /// Dices and displaces all that rays see, as it is at shutter open, in parallel and alike for any number
    /// of threads. Primitives that take more than `most_bytes` to list are left out, with an error. The
    /// context's scene and `shading` outlive this.
    RayWorld(const RenderContext& context, const Shading& shading, size_t most_bytes);
    ~RayWorld() override;

    bool has(RayKind kind) const override;
    std::optional<RaySurfaceHit> closest(const RaySegment& ray, RayKind kind) const override;
    std::optional<bool> blocked(const RaySegment& ray, RayKind kind) const override;
    int dice(const RaySurfaceHit& hit, ShadingGrid& grid) const override;
    float spacing(const V3f& P) const override;

    /// Memory of grids and trees.
    size_t bytes() const;
    uint64_t micropolygon_count() const;

  private:
    /// Primitives that the same kinds of rays see, in a tree of their own.
    struct Group {
        Grids grids;
        std::unique_ptr<WideTree> tree;
        bool hides = true;  ///< any hit is opaque, and seen from both sides
    };
    /// A bit for each RayKind.
    static constexpr unsigned kMasks = 8;

    void make_grids(const Shading& shading);
    std::optional<RaySurfaceHit> closest_in(uint32_t group, const RaySegment& ray) const;
    RaySurfaceHit hit_of(uint32_t group, const RaySegment& ray, float distance, uint64_t id) const;
    bool shows(const Grid& grid, const MicropolygonId& id, const V3f& direction) const;

    RenderContext context_;  ///< of a moment: nothing moves
    Tessellation tessellation_;
    std::vector<bool> keeps_opacity_;  ///< of primitives: Shading::keeps_opacity()
    std::array<Group, kMasks> groups_;
    struct DiceScratches;
    std::unique_ptr<DiceScratches> scratches_;
};

/// The ray world of a render whose shaders ask for rays; else null. Tells when they ask and nothing is there
/// for them.
std::unique_ptr<RayWorld> make_ray_world(const RenderContext& context, const Shading& shading,
                                         size_t most_bytes);

}  // namespace trapeze
