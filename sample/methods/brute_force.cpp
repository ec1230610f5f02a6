/// Every sample against every micropolygon whose swept, lens-grown raster box covers it: the truth that other
/// methods are tested against, simple where it could be fast.
#include <tbb/parallel_for.h>

#include <algorithm>

#include "accel/grid_block.h"
#include "accel/hit_policies.h"
#include "sample/hit_lists.h"
#include "sample/methods/moving_quad.h"
#include "sample/swept_bound.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

/// A tile's rays, and those of one micropolygon's hits. One for each thread; it grows to the largest tile.
struct BruteForceScratch {
    std::vector<float> ox, oy, ux, uy, time;  ///< rays in planes, padded to whole vectors
    std::vector<uint32_t> found;              ///< samples that the predicate answered yes for
    std::vector<float> found_depth;           ///< along each of them

    /// Copies the tile's rays to planes, in the order of samples. Padding is 0: vectors may read past the
    /// end.
    void load(const SampleTile& samples) {
        const size_t n = samples.size(), padded = n + kRayPadding;
        for (auto* plane : {&ox, &oy, &ux, &uy, &time}) plane->assign(padded, 0.0f);
        for (size_t i = 0; i < n; ++i) {
            const AxisRay& ray = samples.rays[i];
            ox[i] = ray.ox, oy[i] = ray.oy, ux[i] = ray.ux, uy[i] = ray.uy, time[i] = ray.time;
        }
        found.resize(n);
        found_depth.resize(n);
    }
    RayPlanes planes() const { return {ox.data(), oy.data(), ux.data(), uy.data(), time.data()}; }
};

/// Holds nothing but a box for each grid: no tree, no order. Grids and camera must outlive it.
class BruteForce final : public Visibility {
  public:
    BruteForce(const RenderContext& context, const Grids& grids)
        : camera_(context.camera),
          grids_(grids),
          all_opaque_(every_grid_is_opaque(grids)),
          boxes_(grids.grids.size()) {
        tbb::parallel_for(size_t{0}, boxes_.size(),
                          [this](size_t i) { boxes_[i] = raster_bound(grids_.grids[i], camera_); });
    }

    void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                 SampleStats& stats) const override {
        scratch.own.of<BruteForceScratch>().load(samples);
        // Every sample begins with nothing, infinitely far away.
        scratch.nearest.assign(samples.size(), Hit{kInfinity, MicropolygonId::kNone});
        scratch.found.begin(samples.size(), scratch.window);
        for (size_t i = 0; i < boxes_.size(); ++i)
            if (!pixels_within(boxes_[i], samples.pixels).empty()) test_grid(i, samples, scratch, stats);
        stats.rays += samples.size();
        if (all_opaque_)
            buffer_of_nearest(scratch, samples.size(), hits);
        else
            buffer_of_loose_hits(scratch, samples.size(), hits);
    }

    /// Each ray against each micropolygon, without even a box, so that nothing of a tree can be wrong in it.
    bool occluded(std::span<const SpaceRay> rays, DepthRange range, std::span<uint8_t> met,
                  SampleStats& stats) const override {
        for (size_t i = 0; i < rays.size(); ++i) {
            TraceRay ray = TraceRay::turned(axis_ray(rays[i]), range);
            AnyHit policy;
            for (size_t g = 0; g < grids_.grids.size(); ++g) {
                const Grid& grid = grids_.grids[g];
                for (int v = 0; v < grid.shape.nv; ++v)
                    for (int u = 0; u < grid.shape.nu; ++u) {
                        const MicropolygonId id{static_cast<uint32_t>(g), static_cast<uint8_t>(u),
                                                static_cast<uint8_t>(v)};
                        trapeze::test_micropolygon(grid, id, ray, policy, stats);
                    }
            }
            met[i] = policy.found;
        }
        stats.rays += rays.size();
        return true;
    }

  private:
    /// Tests a grid's micropolygons, each in the pixels that its own box over the whole shutter and lens
    /// allows.
    void test_grid(size_t index, const SampleTile& samples, SampleScratch& scratch,
                   SampleStats& stats) const {
        const Grid& grid = grids_.grids[index];
        for (int v = 0; v < grid.shape.nv; ++v)
            for (int u = 0; u < grid.shape.nu; ++u) {
                // Each vertex at the ends of all its motion segments; between them it goes straight.
                SweptBound bound;
                for (int corner = 0; corner < 4; ++corner)
                    add_vertex(grid, u + (corner & 1), v + (corner >> 1), bound);
                // The box is grown by the lens and by rounding: it holds every sample that can see the
                // micropolygon.
                const PixelRect pixels = pixels_within(bound.raster(camera_), samples.pixels);
                if (pixels.empty()) continue;
                const MicropolygonId id{static_cast<uint32_t>(index), static_cast<uint8_t>(u),
                                        static_cast<uint8_t>(v)};
                test_micropolygon(MovingQuad(grid, u, v), id, grid.opaque, pixels, samples, scratch, stats);
            }
    }

    /// All samples of the pixels, row by row: those of a row of pixels lie one after the other. A list is
    /// tested whole.
    void test_micropolygon(const MovingQuad& quad, const MicropolygonId& id, bool opaque,
                           const PixelRect& pixels, const SampleTile& samples, SampleScratch& scratch,
                           SampleStats& stats) const {
        BruteForceScratch& own = scratch.own.of<BruteForceScratch>();
        const RayPlanes rays = own.planes();
        const auto test = [&](size_t first, size_t count) {
            const size_t found =
                find_hits(rays, first, count, quad, own.found.data(), own.found_depth.data());
            stats.predicate_tests += count, stats.predicate_hits += found;
            for (size_t i = 0; i < found; ++i)
                keep(own.found[i], {own.found_depth[i], id.packed()}, opaque, scratch);
        };
        if (samples.is_list()) return test(0, samples.size());
        const size_t count = static_cast<size_t>(pixels.width()) * samples.samples_per_pixel;
        for (int py = pixels.y0; py < pixels.y1; ++py) test(samples.first_of_pixel(pixels.x0, py), count);
    }

    /// Hits outside the clipping range do not count, nor those behind the nearest opaque one so far. Others
    /// are listed, and those that a later hit hides are taken out at the end.
    void keep(uint32_t sample, const Hit& hit, bool opaque, SampleScratch& scratch) const {
        if (!(hit.depth >= camera_.near_clip && hit.depth <= camera_.far_clip)) return;
        if (!in_front(hit, scratch.nearest[sample])) return;
        if (opaque) scratch.nearest[sample] = hit;
        if (all_opaque_) return;
        scratch.found.add(sample, hit);
    }

    const Camera& camera_;
    const Grids& grids_;
    bool all_opaque_;  ///< nothing but the nearest hit of each sample is wanted
    std::vector<RasterBox> boxes_;
};

}  // namespace

/// The reference that all other methods are compared with, hit by hit: it has no tree that could miss
/// anything.
VisibilityMethod brute_force_method() {
    return {"bruteforce",
            MethodKind::Reference,
            {},
            stratified_pattern,
            any_pattern,
            [](const VisibilityInput& input) -> std::unique_ptr<Visibility> {
                return std::make_unique<BruteForce>(input.context, input.grids);
            },
            nullptr,
            true,
            true};
}

}  // namespace trapeze
