#include "sample/cut_hits.h"

#include <map>

#include "core/scene/solid_state.h"

namespace trapeze {

namespace {

/// Another method's hits without those that clipping planes or solids take away.
class CutVisibility : public Visibility {
  public:
    CutVisibility(std::unique_ptr<Visibility> method, const Scene& scene, const Grids& grids)
        : method_(std::move(method)), scene_(scene), grids_(grids) {}

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        method_->resolve(samples, hits, scratch, stats);
        SolidState state(scene_.solids);
        std::map<int, bool> odd;
        size_t kept = 0;
        for (size_t s = 0; s < samples.size(); ++s) {
            const auto [first, last] = std::pair(hits.first[s], hits.first[s + 1]);
            hits.first[s] = static_cast<uint32_t>(kept);
            const std::span<const Hit> found(hits.hits.data() + first, last - first);
            start(found, state, odd);
            for (const Hit hit : found)
                if (is_kept(samples.rays[s], hit, state)) hits.hits[kept++] = hit;
        }
        hits.first[samples.size()] = static_cast<uint32_t>(kept);
        hits.hits.resize(kept);
    }
    BuildStats build_stats() const override { return method_->build_stats(); }
    int tile_side() const override { return method_->tile_side(); }
    /// Where a ray starts in a solid follows from all of its hits.
    bool bounds_layers() const override { return scene_.solids.empty() && method_->bounds_layers(); }

  private:
    const Grid& grid_of(const Hit& hit) const { return grids_.grids[MicropolygonId::unpack(hit.id).grid]; }
    int solid_of(const Hit& hit) const { return scene_.primitives[grid_of(hit).primitive].solid; }

    /// A ray that crosses a closed surface an odd number of times starts inside it. Only where an opaque hit
    /// ends the list is the number not known; such rays start outside.
    void start(std::span<const Hit> hits, SolidState& state, std::map<int, bool>& odd) const {
        state.reset();
        if (scene_.solids.empty() || hits.empty() || grid_of(hits.back()).opaque) return;
        odd.clear();
        for (const Hit& hit : hits)
            if (const int solid = solid_of(hit); solid >= 0) odd[solid] = !odd[solid];
        for (const auto& [solid, is_odd] : odd)
            if (is_odd) state.cross(solid);
    }

    bool is_kept(const AxisRay& ray, const Hit& hit, SolidState& state) const {
        const int solid = solid_of(hit);
        if (solid >= 0 && !state.cross(solid)) return false;
        const V3f at(ray.ox + ray.ux * hit.depth, ray.oy + ray.uy * hit.depth, hit.depth);
        for (const ClippingPlane& plane : scene_.clipping_planes)
            if (plane.normal.dot(at) < plane.distance) return false;
        return true;
    }

    const std::unique_ptr<Visibility> method_;
    const Scene& scene_;
    const Grids& grids_;
};

}  // namespace

std::unique_ptr<Visibility> with_cuts(std::unique_ptr<Visibility> method, const RenderContext& context,
                                      const Grids& grids) {
    const Scene* scene = context.scene;
    if (!method || !scene || (scene->solids.empty() && scene->clipping_planes.empty())) return method;
    return std::make_unique<CutVisibility>(std::move(method), *scene, grids);
}

}  // namespace trapeze
