/// Clipless dual-space bounds [Laine11, "Clipless dual-space bounds for faster stochastic rasterization"]:
/// for each micropolygon and pixel, intervals on both axes of the lens and in time outside of which it cannot
/// be seen, and only the samples in them are tested. Takes any pattern.
///
/// What is blurred by motion and defocus at once passes a pixel at another time through each part of the
/// lens: bounds of either that hold for all of the other are wide. So the shutter is cut into parts, each
/// with bounds of its own; parts=1 is the paper's form.
#include "sample/dual_raster.h"
#include "sample/hit_lists.h"
#include "sample/tile_bins.h"
#include "sample/visibility_method.h"

namespace trapeze {
namespace {

constexpr int kDualTileSide = 32;

class DualSpace final : public Visibility {
  public:
    DualSpace(const VisibilityInput& input)
        : camera_(input.context.camera),
          grids_(input.grids),
          all_opaque_(every_grid_is_opaque(input.grids)),
          bins_(camera_, grids_, kDualTileSide),
          bounds_(camera_, grids_),
          parts_(input.spec.number("parts")) {}

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        DualScratch& dual = scratch.dual;
        const PixelRect& pixels = samples.pixels;
        bins_.find(pixels, dual.grids);
        scratch.nearest.assign(samples.size(), Hit{kInfinity, MicropolygonId::kNone});
        scratch.hits.clear();
        scratch.hit_sample.clear();
        if (!dual.grids.empty()) {
            dual.masks.build(samples, camera_.has_lens());
            dual.columns.set_pixels(pixels.x0, pixels.width(), camera_.plane_scale_x, camera_.plane_offset_x);
            dual.rows.set_pixels(pixels.y0, pixels.height(), camera_.plane_scale_y, camera_.plane_offset_y);
        }
        DualRaster raster{camera_, samples, parts_, all_opaque_, scratch};
        for (const uint32_t index : dual.grids)
            raster_grid_dual(raster, {grids_.grids[index], index, bounds_}, stats);
        stats.rays += samples.size();
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
    int tile_side() const override { return kDualTileSide; }

  private:
    const Camera& camera_;
    const Grids& grids_;
    bool all_opaque_;
    TileBins bins_;
    GridBounds bounds_;
    int parts_;
};

}  // namespace

VisibilityMethod dual_space_method() {
    return {"dualspace",
            {{"parts", {"4", "1", "2", "8"}}},
            stratified_pattern,
            any_pattern,
            [](const VisibilityInput& input) -> std::unique_ptr<Visibility> {
                return std::make_unique<DualSpace>(input);
            }};
}

}  // namespace trapeze
