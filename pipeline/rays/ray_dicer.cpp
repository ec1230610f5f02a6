#include "pipeline/rays/ray_dicer.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

#include "core/scene/level_of_detail.h"
#include "pipeline/rays/held_scene.h"

namespace trapeze {
namespace {

RenderContext of_rays(const RenderContext& context, const Scene* copy) {
    RenderContext own = context;
    own.motion = rays_sample_motion(context);
    if (copy) own.scene = copy;
    return own;
}

TessellationOptions with(TessellationOptions options, const RaySides& sides,
                         const Tessellation& surfaces_of) {
    options.least_side = sides.least, options.larger_where_flat = sides.longer_where_flat;
    options.surfaces_of = &surfaces_of;
    return options;
}

}  // namespace

/// What threads need to make grids.
struct RayDicer::Scratches {
    struct Scratch {
        ShadingGrid grid;
        DiceScratch dice;
        ShadeScratch shade;
    };
    tbb::enumerable_thread_specific<Scratch> of_grids;
    tbb::enumerable_thread_specific<DiceScratch> of_points;
};

/// Models come behind the scene's own primitives.
std::shared_ptr<const RayDicer::SceneForRays> RayDicer::make_scene(const RenderContext& context,
                                                                   const Shading& shading) {
    const bool moves = rays_sample_motion(context);
    auto made = std::make_shared<SceneForRays>();
    std::unique_ptr<Scene> copy = moves ? held_scene(*context.scene) : nullptr;
    made->shared = share_objects(copy ? *copy : *context.scene, context.camera, moves,
                                 {[&](uint32_t primitive) { return shading.keeps_opacity(primitive); },
                                  shading.displacing_surfaces()});
    const std::vector<Primitive>& models = made->shared.models;
    if (!models.empty() && !copy) copy = std::make_unique<Scene>(*context.scene);
    if (copy) copy->primitives.insert(copy->primitives.end(), models.begin(), models.end());
    made->copy = std::move(copy);
    return made;
}

TessellationOptions RayDicer::how_to_split(size_t most_bytes) const {
    TessellationOptions options;
    options.depth_heights = shading_.depth_heights();
    options.is_displaced = [displaces = shading_.displacing_surfaces(), this](uint32_t number) {
        return displaces(shared().own(number));
    };
    options.is_left_whole = [this](uint32_t number) {
        return number < shared().is_shared.size() && shared().is_shared[number];
    };
    options.most_bytes = most_bytes, options.lists_again = true, options.seen_by = SeenBy::Rays;
    options.larger_where_flat = true;
    return options;
}

RayDicer::RayDicer(const RenderContext& context, const Shading& shading, size_t most_bytes)
    : scene_(make_scene(context, shading)),
      context_(of_rays(context, scene_->copy.get())),
      shading_(shading),
      tessellation_(context_, how_to_split(most_bytes)),
      scratches_(std::make_unique<Scratches>()) {
    for (uint32_t i = 0; i < shared().is_shared.size(); ++i)
        keeps_opacity_.push_back(shading.keeps_opacity(i));
}

RayDicer::RayDicer(const RayDicer& finest, const RaySides& sides, size_t most_bytes)
    : scene_(finest.scene_),
      context_(finest.context_),
      shading_(finest.shading_),
      tessellation_(context_, with(how_to_split(most_bytes), sides, finest.tessellation_)),
      keeps_opacity_(finest.keeps_opacity_),
      scratches_(std::make_unique<Scratches>()) {}

RayDicer::~RayDicer() = default;

Grid RayDicer::make(size_t subpatch, GridArena& arena) const {
    Scratches::Scratch& scratch = scratches_->of_grids.local();
    ShadingGrid* const grid = &scratch.grid;
    tessellation_.dice(subpatch, *grid, scratch.dice, DiceFor::Hits);
    grid->primitive_index = shared().own(grid->primitive_index);
    grid->aovs.clear();
    shading_.displace({&grid, 1}, scratch.shade);
    PackOptions options;
    options.both_sides = true;
    options.float_colors = context_.float_colors;
    // One-sided surfaces hide nothing for sure, their other side is not there; nor do parts of solids, and
    // what not all rays see.
    options.keep_hits_behind = !keeps_opacity_[grid->primitive_index] ||
                               !seen_numbers(*grid->primitive->attributes).are_all() ||
                               grid->primitive->attributes->sides != 2 || grid->primitive->solid >= 0;
    int64_t not_finite = 0;
    return pack_grid(*grid, arena, &not_finite, options);
}

int RayDicer::make_point(const SubpatchPoint& point, ShadingGrid& grid) const {
    return tessellation_.dice_point(point, grid, scratches_->of_points.local());
}

}  // namespace trapeze
