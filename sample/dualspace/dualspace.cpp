/// Clipless dual-space bounds [Laine11, "Clipless dual-space bounds for faster stochastic rasterization"]:
/// for each micropolygon and pixel, intervals on both axes of the lens and in time outside of which it cannot
/// be seen, and only the samples in them are tested. Takes any pattern.
/// (Patents near it: [decision 0027].)
///
/// What is blurred by motion and defocus at once passes a pixel at another time through each part of the
/// lens: bounds of either that hold for all of the other are wide. So the shutter is cut into parts, each
/// with bounds of its own; parts=1 is the paper's form.
#include "sample/dualspace/dual_raster.h"
#include "sample/rasterize/rasterizer.h"

namespace trapeze {
namespace {

constexpr int kDualTileSide = 32;

/// Masks and columns are made once for a tile; then grids come one by one. A tile's side is a trade: larger
/// ones share the set-up of micropolygons, smaller ones keep the masks in the caches.
class DualSpace final : public Rasterizer {
  public:
    DualSpace(const VisibilityInput& input)
        : Rasterizer(input, kDualTileSide), parts_(input.spec.number("parts")) {}

  private:
    void raster(const SampleTile& samples, const std::vector<uint32_t>& grids, SampleScratch& scratch,
                SampleStats& stats) const override {
        if (grids.empty()) return;
        const Camera& c = camera();
        const PixelRect& pixels = samples.pixels;
        DualScratch& dual = scratch.own.of<DualScratch>();
        dual.masks.build(samples, c.has_lens());
        dual.columns.set_pixels(pixels.x0, pixels.width(), c.plane_scale_x, c.plane_offset_x);
        dual.rows.set_pixels(pixels.y0, pixels.height(), c.plane_scale_y, c.plane_offset_y);
        DualRaster dual_raster{c, samples, parts_, all_opaque(), scratch, dual};
        for (const uint32_t index : grids)
            raster_grid_dual(dual_raster, {grid(index), index, bounds()}, stats);
    }

    int parts_;
};

}  // namespace

VisibilityMethod dual_space_method() {
    return {"dualspace",
            MethodKind::Rasterizer,
            {{"parts", {"4", "1", "2", "8"}}},
            stratified_pattern,
            any_pattern,
            [](const VisibilityInput& input) -> std::unique_ptr<Visibility> {
                return std::make_unique<DualSpace>(input);
            }};
}

}  // namespace trapeze
