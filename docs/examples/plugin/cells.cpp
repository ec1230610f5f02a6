/// A visibility method in a file of its own, as a beginning for others: `cells` sorts micropolygons into cells of
/// the picture, and tests each sample against those of its cell. It is built and used so:
///
///     g++ -O2 -fPIC -shared cells.cpp -o cells.so $(pkg-config --cflags trapeze-plugin)
///     trapeze compare scene.rib --plugin ./cells.so --samplers "raytrace cells cells:side=4"
///
/// What a method must keep to: docs/how-to-add-a-visibility-method.md.
#include <algorithm>
#include <vector>

#include "core/hit_micropolygon.h"
#include "sample/hit_lists.h"
#include "sample/plugin.h"
#include "sample/swept_bound.h"

namespace {

using namespace trapeze;

class Cells final : public Visibility {
  public:
    /// Builds, once for each region. Keeps references: context and grids outlive it.
    Cells(const RenderContext& context, const Grids& grids, int side)
        : camera_(context.camera),
          grids_(grids),
          side_(side),
          columns_(std::max(1, (camera_.width + side - 1) / side)),
          rows_(std::max(1, (camera_.height + side - 1) / side)),
          cells_(static_cast<size_t>(columns_) * static_cast<size_t>(rows_)) {
        for (uint32_t g = 0; g < grids.grids.size(); ++g)
            for (int v = 0; v < grids.grids[g].shape.nv; ++v)
                for (int u = 0; u < grids.grids[g].shape.nu; ++u)
                    insert({g, static_cast<uint8_t>(u), static_cast<uint8_t>(v)});
    }

    /// Every sample's hits. Called from many threads at once, each with its own scratch and stats.
    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        scratch.nearest.assign(samples.size(), Hit{kInfinity, MicropolygonId::kNone});
        scratch.found.begin(samples.size(), scratch.window);
        for (uint32_t s = 0; s < samples.size(); ++s) {
            const PixelPlace pixel = samples.pixel_of(s);
            for (const MicropolygonId& id : cells_[cell(column(pixel.x), row(pixel.y))])
                test(id, s, samples.rays[s], scratch, stats);
        }
        stats.rays += samples.size();
        buffer_of_loose_hits(scratch, samples.size(), hits);
    }

    BuildStats build_stats() const override {
        BuildStats stats;
        for (const auto& list : cells_) stats.tree_bytes += list.capacity() * sizeof(MicropolygonId);
        return stats;
    }

  private:
    /// Samples beyond the border of the picture are of the cells at the border, as are micropolygons there.
    int column(double x) const {
        return static_cast<int>(std::clamp(x / side_, 0.0, static_cast<double>(columns_ - 1)));
    }
    int row(double y) const {
        return static_cast<int>(std::clamp(y / side_, 0.0, static_cast<double>(rows_ - 1)));
    }
    size_t cell(int at_column, int at_row) const {
        return static_cast<size_t>(at_row) * static_cast<size_t>(columns_) + static_cast<size_t>(at_column);
    }

    /// Into all cells where it may be seen at some time through some point of the lens.
    void insert(const MicropolygonId& id) {
        SweptBound bound;
        for (int corner = 0; corner < 4; ++corner)
            add_vertex(grids_.grids[id.grid], id.u + (corner & 1), id.v + (corner >> 1), bound);
        const RasterBox box = bound.raster(camera_);
        if (!(box.min_x <= box.max_x && box.min_y <= box.max_y)) return;
        for (int y = row(box.min_y); y <= row(box.max_y); ++y)
            for (int x = column(box.min_x); x <= column(box.max_x); ++x) cells_[cell(x, y)].push_back(id);
    }

    /// The predicate decides. Hits out of the clipping range do not count; those behind something opaque are left out.
    void test(const MicropolygonId& id, uint32_t sample, const AxisRay& ray, SampleScratch& scratch,
              SampleStats& stats) const {
        const Grid& grid = grids_.grids[id.grid];
        Hit hit{0, id.packed()};
        ++stats.predicate_tests;
        if (!hit_micropolygon(ray, grid.quad(id.u, id.v, ray.time), grid.facing, &hit.depth)) return;
        ++stats.predicate_hits;
        if (!(hit.depth >= camera_.near_clip && hit.depth <= camera_.far_clip)) return;
        if (!in_front(hit, scratch.nearest[sample])) return;
        if (grid.opaque) scratch.nearest[sample] = hit;
        scratch.found.add(sample, hit);
    }

    const Camera& camera_;
    const Grids& grids_;
    int side_;            ///< of a cell, in pixels
    int columns_, rows_;  ///< of cells
    std::vector<std::vector<MicropolygonId>> cells_;
};

VisibilityMethod cells_method() {
    return {"cells",
            MethodKind::Rasterizer,
            {{"side", {"8", "4", "16"}}},  // options; the first value is the default
            stratified_pattern,            // the pattern that it was made for
            any_pattern,                   // the patterns whose samples it can resolve
            [](const VisibilityInput& input) -> std::unique_ptr<Visibility> {
                return std::make_unique<Cells>(input.context, input.grids, input.spec.number("side"));
            }};
}

}  // namespace

TRAPEZE_PLUGIN(cells_method)
