/// Makes the grids that rays of shaders meet [Hou10 sec. 4]: of all primitives whose attributes let some kind
/// of ray see them, without regard to what the camera sees.
#pragma once

#include <memory>
#include <vector>

#include "core/grid.h"
#include "core/scene/ray_scene.h"
#include "core/scene/render_context.h"
#include "pipeline/rays/shared_objects.h"
#include "shade/shading.h"
#include "tessellate/tessellate.h"

namespace trapeze {

/// How long sides of micropolygons are.
struct RaySides {
    float least = 0;  ///< in pixels
    bool longer_where_flat = true;
};

/// Makes any grid at any time, the same bits each time; from many threads.
class RayDicer {
  public:
    /// Splits the scene for rays. It moves where rays ask for that (RayAttributes::sample_motion), without
    /// the motion of the camera; else it is as at shutter open. Lists of subpatches take `most_bytes`; what
    /// is more is listed again when it is asked for. The context's scene and `shading` outlive this.
    RayDicer(const RenderContext& context, const Shading& shading, size_t most_bytes);
    /// Of the same scene.
    RayDicer(const RayDicer& finest, const RaySides& sides, size_t most_bytes);
    ~RayDicer();

    const RenderContext& context() const { return context_; }
    const Tessellation& tessellation() const { return tessellation_; }
    const Attributes& attributes(uint32_t primitive) const {
        return *context_.scene->primitives[primitive].attributes;
    }
    /// Whether hits of a primitive have its own opacity, whatever its shader.
    bool keeps_opacity(uint32_t primitive) const { return keeps_opacity_[primitive]; }
    /// The objects whose instances have grids together. context().scene has their models behind the scene's
    /// own primitives: subpatches are of these.
    const SharedObjects& shared() const { return scene_->shared; }

    /// Dices, displaces and packs a subpatch, by its number; Grid::ordinal is that number. Of a model
    /// positions are in the model's space, and Grid::primitive is what it is a copy of
    /// (SharedObjects::own()).
    Grid make(size_t subpatch, GridArena& arena) const;
    /// Tessellation::dice_point().
    int make_point(const SubpatchPoint& point, ShadingGrid& grid) const;

  private:
    /// Without the camera's motion, and with models.
    struct SceneForRays {
        SharedObjects shared;
        std::unique_ptr<const Scene> copy;  ///< null: the scene itself will do
    };
    static std::shared_ptr<const SceneForRays> make_scene(const RenderContext& context,
                                                          const Shading& shading);
    TessellationOptions how_to_split(size_t most_bytes) const;

    std::shared_ptr<const SceneForRays> scene_;
    RenderContext context_;  ///< of that scene
    const Shading& shading_;
    Tessellation tessellation_;
    std::vector<bool> keeps_opacity_;  ///< of primitives: Shading::keeps_opacity()
    struct Scratches;
    std::unique_ptr<Scratches> scratches_;
};

}  // namespace trapeze
