/// INTERLEAVEUVT [Fatahalian09, as Hou10 sec. 5 describes it]: the whole picture has only k * k times as many
/// (u, v, time) tuples as a pixel has samples. For each of them a micropolygon is placed as if nothing moved
/// and the lens were a pinhole, and meets at most one sample in each k x k pixels: vector lanes are
/// micropolygons. What this costs hardly depends on blur.
///
/// With k = 1 it is the accumulation buffer [Haeberli90]: every pixel has the same tuples, and a picture of
/// each is drawn and added up, as the renderer did that Hou et al. had before [Hou10 sec. 5].
///
/// No occlusion culling, as in the paper; cull=on goes through grids front to back and leaves out what lies
/// behind the hits that the tuple has already.
#include "sample/interleave/uvt_raster.h"
#include "sample/patterns/interleaved_pattern.h"
#include "sample/rasterize/rasterizer.h"

namespace trapeze {
namespace {

constexpr int kUvtTileSide = 64;

/// The method makes the pattern itself, equal to the one that the samples came from, since it needs the
/// tuples and not only the samples.
class InterleaveUvt final : public Rasterizer {
  public:
    InterleaveUvt(const VisibilityInput& input)
        : Rasterizer(input, kUvtTileSide),
          pattern_(input.context, input.spec.number("k")),
          tuples_(pattern_, input.context.camera) {}

  private:
    void raster(const SampleTile& samples, const std::vector<uint32_t>& grids, SampleScratch& scratch,
                SampleStats& stats) const override {
        UvtScratch& own = scratch.own.of<UvtScratch>();
        own.tile.build(samples.pixels, pattern_, camera());
        UvtRaster uvt{camera(), pattern_, tuples_, samples.pixels, all_opaque(), cull(), scratch, own};
        for (const uint32_t index : grids) raster_grid_uvt(uvt, {grid(index), index, bounds()}, stats);
        own.tile.copy_nearest(scratch.nearest);
    }

    InterleavedPattern pattern_;
    UvtTuples tuples_;
};

}  // namespace

VisibilityMethod interleave_uvt_method() {
    return {"interleaveuvt",
            MethodKind::Rasterizer,
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
