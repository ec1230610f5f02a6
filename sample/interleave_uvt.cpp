/// INTERLEAVEUVT [Fatahalian09, as Hou10 sec. 5 describes it]: the whole picture has only k * k times as many
/// (u, v, time) tuples as a pixel has samples. For each of them a micropolygon is placed as if nothing moved
/// and the lens were a pinhole, and meets at most one sample in each k x k pixels: vector lanes are
/// micropolygons. What this costs hardly depends on blur.
///
/// No occlusion culling, as in the paper; cull=on goes through grids front to back and leaves out what lies
/// behind the hits that the tuple has already.
#include <algorithm>

#include "sample/hit_lists.h"
#include "sample/interleaved_pattern.h"
#include "sample/tile_bins.h"
#include "sample/uvt_raster.h"
#include "sample/visibility_method.h"

namespace trapeze {
namespace {

constexpr int kUvtTileSide = 64;

class InterleaveUvt final : public Visibility {
  public:
    InterleaveUvt(const VisibilityInput& input)
        : context_(input.context),
          grids_(input.grids),
          pattern_(dynamic_cast<const InterleavedPattern&>(input.pattern)),
          cull_(input.spec.is_on("cull")),
          all_opaque_(every_grid_is_opaque(input.grids)),
          bins_(input.context.camera, input.grids, kUvtTileSide),
          bounds_(input.context.camera, input.grids),
          tuples_(pattern_, input.context.camera) {}

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        UvtScratch& uvt = scratch.uvt;
        bins_.find(samples.pixels, uvt.grids);
        if (cull_)
            std::stable_sort(uvt.grids.begin(), uvt.grids.end(),
                             [this](uint32_t a, uint32_t b) { return bounds_[a].z_min < bounds_[b].z_min; });
        uvt.tile.build(samples.pixels, pattern_, context_.camera);
        scratch.hits.clear();
        scratch.hit_sample.clear();
        UvtRaster raster{context_.camera, pattern_, tuples_, samples.pixels, all_opaque_, cull_, scratch};
        for (const uint32_t index : uvt.grids)
            raster_grid_uvt(raster, {grids_.grids[index], index, bounds_}, stats);
        stats.rays += samples.size();
        scratch.nearest.resize(samples.size());
        uvt.tile.copy_nearest(scratch.nearest);
        if (all_opaque_)
            buffer_of_nearest(scratch, samples.size(), hits);
        else
            buffer_of_loose_hits(scratch, samples.size(), hits);
    }

    BuildStats build_stats() const override {
        BuildStats stats;
        stats.tree_bytes = bins_.bytes() + bounds_.bytes();
        return stats;
    }
    int tile_side() const override { return kUvtTileSide; }

  private:
    const RenderContext& context_;
    const Grids& grids_;
    const InterleavedPattern& pattern_;
    bool cull_, all_opaque_;
    TileBins bins_;
    GridBounds bounds_;
    UvtTuples tuples_;
};

}  // namespace

VisibilityMethod interleave_uvt_method() {
    return {"interleaveuvt",
            {{"k", {"2", "1", "4"}}, {"cull", {"off", "on"}}},
            [](const MethodSpec& method) { return "interleaved:k=" + method["k"]; },
            [](const MethodSpec& method, const MethodSpec& pattern) {
                return pattern.name == "interleaved" && pattern["k"] == method["k"];
            },
            [](const VisibilityInput& input) -> std::unique_ptr<Visibility> {
                return std::make_unique<InterleaveUvt>(input);
            }};
}

}  // namespace trapeze
