/// The room's door: runs a scene's shaders over diced grids.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/depth_height.h"
#include "core/files/access.h"
#include "core/scene/light_shape.h"
#include "core/scene/ray_scene.h"
#include "core/scene/render_context.h"
#include "core/scene/shading_grid.h"
#include "core/stats.h"

namespace trapeze {

/// A thread's memory for shading: registers, planes and lights, reused from grid to grid.
class ShadeScratch {
  public:
    ShadeScratch();
    ShadeScratch(ShadeScratch&&) noexcept;
    ShadeScratch& operator=(ShadeScratch&&) noexcept;
    ~ShadeScratch();
    struct State;
    std::unique_ptr<State> state;
};

/// All shading of one render: its materials, its maps, and the variables that its displays ask for.
class Shading {
  public:
    /// Makes every shader that the scene names. One that is not known is reported once for each name, where
    /// it is first named; a surface becomes defaultsurface, a light or displacement is left out. The context,
    /// its scene and `access`, to files, must outlive this.
    explicit Shading(const RenderContext& context, const Access& access = kEverything);
    ~Shading();

    /// Displaces the grid at all keys, then sets Ci and Oi. Thread-safe with a scratch per thread; the result
    /// depends on the grid alone.
    void shade(ShadingGrid& grid, ShadeScratch& scratch, ShadeStats& stats) const;

    /// Grids are added to a batch until it has so many vertices: enough that the interpreter's work for each
    /// operation is small against the operation, few enough that the planes stay in the second cache; more
    /// where their rays had better be traced together (RayScene::rays_at_once).
    size_t batch_vertices() const;

    /// Shades several grids: small ones that come one after the other and have the same attributes and
    /// uniform variables are shaded together, which gives each the same bits and costs less.
    void shade(std::span<ShadingGrid* const> grids, ShadeScratch& scratch, ShadeStats& stats) const;

    /// Whether a shader may ask for rays: it calls trace() or one of its kin. Area lights ask where there is
    /// a primitive that some rays see.
    bool asks_rays() const;
    /// Whether the shaders that may ask for rays ask point clouds instead, if these can be read.
    bool asks_clouds_alone() const;
    struct MeshLight {
        const LightInstance* light = nullptr;
        bool asks_place = false;  ///< its shader asks for LightMesh::places
    };
    /// The lights whose shapes are meshes, to be made of the primitives whose emitters they are.
    std::vector<MeshLight> mesh_lights() const;
    /// Those meshes. Until then such lights are dark; they stay so, with a warning, without a mesh of any
    /// area.
    void set_light_meshes(const LightMeshes& meshes);
    /// What rays of shaders meet from now on; outlives this. Null: nothing.
    void set_rays(const RayScene* rays);
    /// Displaces grids of the geometry that rays meet, where their attributes say so, and sets Ci and Oi to
    /// the primitive's own Cs and Os.
    void displace(std::span<ShadingGrid* const> grids, ShadeScratch& scratch) const;
    /// Whether hits of a primitive, by its index in the scene, have the primitive's own opacity for rays that
    /// ask for what is in the way.
    bool keeps_opacity(uint32_t primitive) const;

    /// Whether a primitive's grids need not be shaded where no sample sees them: shaders neither move them
    /// nor write anything, and the attributes allow it.
    bool may_stay_unshaded(uint32_t primitive) const;
    /// Whether the colours of some of a grid's vertices (ShadingGrid::wanted) can be had without those of
    /// others having what rays would tell them.
    bool may_ask_for_some(uint32_t primitive) const;
    /// Whether a primitive's grids are opaque whatever its shaders do.
    bool hides_for_sure(uint32_t primitive) const;

    /// Whether parts of the grid (grid_parts.h) get the same bits as the whole, and so threads may share it.
    bool can_be_parted(const ShadingGrid& grid) const;

    /// Whether a loop has turned out to be endless since the last call. The shader then has shorter limits:
    /// what was shaded before is to be shaded again, so that no grid depends on the order of grids. From then
    /// on each runs alone, for a batch shares its limits.
    bool found_endless_loops();

    /// Finds heights over the scene's depth maps, by names as shadow() finds them; valid as long as this.
    FindDepthHeight depth_heights() const;

    /// Tells of a primitive, by its index in the scene, whether its surface shader displaces it; valid as
    /// long as this.
    std::function<bool(uint32_t)> displacing_surfaces() const;

    /// Point clouds that are read, and those that are baked, may take so many bytes each.
    void limit_clouds(size_t bytes);
    /// Writes the point clouds that shaders have baked since the start, or since loops turned out to be
    /// endless. To be called after the last grid.
    void write_bakes();
    /// Instead of writing them, warns of each that it is not written, as the picture is a tile alone.
    void leave_out_bakes();
    /// Whether some shader may bake a point cloud.
    bool may_bake() const;

    /// To be called after the last grid: warns, once for each set of attributes, of displacement beyond
    /// the displacement bound, with the bound that was needed.
    void report_displacement_bounds() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace trapeze
