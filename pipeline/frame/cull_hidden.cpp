#include "pipeline/frame/cull_hidden.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>

#include "pipeline/frame/collect_grids.h"
#include "pipeline/frame/tiles/tile_order.h"
#include "sample/hit_lists.h"

namespace trapeze {
namespace {

constexpr size_t kSubpatchesATask = 16;

/// A thread's memory for grids without shading.
struct PlainGridMaker {
    ShadingGrid grid;
    DiceScratch scratch;
    GridArena arena;
    std::vector<Grid> grids;
};

/// Grids of the candidates, where they will be once they are shaded. They hide what is behind them only where
/// it is known that no shader lets that through.
Grids plain_grids(const RenderContext& context, const std::vector<uint32_t>& candidates,
                  const Tessellation& tessellation, const Shading& shading) {
    tbb::enumerable_thread_specific<PlainGridMaker> makers;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, candidates.size(), kSubpatchesATask),
                      [&](const auto& range) {
                          PlainGridMaker& maker = makers.local();
                          for (size_t i = range.begin(); i != range.end() && !context.is_cancelled(); ++i) {
                              ShadingGrid& grid = maker.grid;
                              tessellation.dice(candidates[i], grid, maker.scratch, DiceFor::Hits);
                              grid.aovs.clear();
                              grid.Ci.fill(grid.vertex_count(), V3f(0));
                              grid.Oi.fill(grid.vertex_count(), V3f(1));
                              PackOptions options = pack_options(*context.scene, *grid.primitive);
                              if (!shading.hides_for_sure(grid.primitive_index))
                                  options.keep_hits_behind = true;
                              int64_t not_finite = 0;
                              maker.grids.push_back(pack_grid(grid, maker.arena, &not_finite, options));
                          }
                      });
    return collect_grids(makers);
}

/// Whether as much hides what is behind it as pays for finding out: half-transparent hair hides nothing.
bool enough_hides(const std::vector<uint32_t>& candidates, const Tessellation& tessellation,
                  const Shading& shading) {
    constexpr int64_t kOneOf = 4;    // micropolygons
    std::map<uint32_t, bool> hides;  // by primitive
    int64_t all = 0, hiding = 0;
    for (const uint32_t candidate : candidates) {
        const SubpatchInfo& subpatch = tessellation.subpatches()[candidate];
        const auto [known, is_new] = hides.try_emplace(subpatch.primitive);
        if (is_new) known->second = shading.hides_for_sure(subpatch.primitive);
        const int micropolygons = subpatch.shape.micropolygon_count();
        all += micropolygons, hiding += known->second ? micropolygons : 0;
    }
    return hiding * kOneOf >= all;
}

/// How much of what is in a picture lies behind something, as far as bounds tell: in cells of some pixels,
/// what micropolygons cover of each beyond what fits side by side.
class Overlap {
  public:
    explicit Overlap(const PixelRect& pixels)
        : pixels_(pixels),
          columns_((pixels.width() + kCell - 1) / kCell),
          covered_(static_cast<size_t>(columns_) *
                   static_cast<size_t>((pixels.height() + kCell - 1) / kCell)) {}

    /// Spreads what a subpatch covers evenly over its bound, which whole pixels make larger by about one each
    /// way; what is blurred over many cells over all of the picture.
    void add(const SubpatchInfo& subpatch, float shading_rate) {
        const PixelRect& bound = subpatch.bound;
        if (bound.empty()) return;
        const auto across = static_cast<float>(bound.width()), along = static_cast<float>(bound.height());
        const float inner = std::max(across - 1, 0.5f) * std::max(along - 1, 0.5f);
        const float wished = static_cast<float>(subpatch.shape.micropolygon_count()) * shading_rate;
        const float share = std::min(wished, inner) / (across * along);
        const int x0 = std::max(bound.x0, pixels_.x0), x1 = std::min(bound.x1, pixels_.x1);
        const int y0 = std::max(bound.y0, pixels_.y0), y1 = std::min(bound.y1, pixels_.y1);
        if (x1 <= x0 || y1 <= y0) return;
        const auto seen = static_cast<float>(x1 - x0) * static_cast<float>(y1 - y0);
        if (seen > kMostCells * kCell * kCell) {
            everywhere_ += share * seen / static_cast<float>(covered_.size());
            return;
        }
        for (int y = y0; y < y1; y = next_cell(y, pixels_.y0))
            for (int x = x0; x < x1; x = next_cell(x, pixels_.x0)) {
                const int width = std::min(next_cell(x, pixels_.x0), x1) - x;
                const int height = std::min(next_cell(y, pixels_.y0), y1) - y;
                const int column = (x - pixels_.x0) / kCell, row = (y - pixels_.y0) / kCell;
                covered_[static_cast<size_t>(row * columns_ + column)] +=
                    share * static_cast<float>(width) * static_cast<float>(height);
            }
    }
    float hidden_part() const {
        constexpr float kFits = kCell * kCell;
        float all = 0, hidden = 0;
        for (const float in_cell : covered_) {
            const float covered = in_cell + everywhere_;
            all += covered, hidden += std::max(covered - kFits, 0.0f);
        }
        return all > 0 ? hidden / all : 0;
    }

  private:
    static constexpr int kCell = 16;  ///< pixels along a side
    static constexpr int kMostCells = 64;
    static int next_cell(int at, int first) { return at + kCell - (at - first) % kCell; }

    PixelRect pixels_;
    int columns_;
    std::vector<float> covered_;  ///< pixels, by cell
    float everywhere_ = 0;        ///< pixels of each cell
};

/// Whether so much may lie behind something that finding out pays.
bool enough_is_hidden(const RenderContext& context, const Region& region,
                      const std::vector<uint32_t>& candidates, const Tessellation& tessellation) {
    constexpr float kLeastPart = 0.2f;
    Overlap overlap(region.pixels);
    for (const uint32_t candidate : candidates) {
        const SubpatchInfo& subpatch = tessellation.subpatches()[candidate];
        overlap.add(subpatch, context.scene->primitives[subpatch.primitive].attributes->shading_rate);
    }
    return overlap.hidden_part() >= kLeastPart;
}

/// What a thread needs to look at tiles.
struct TileLooker {
    SampleTile samples;
    HitBuffer hits;
    SampleScratch scratch;
    SampleStats stats;
};

/// Which micropolygons samples have hits on.
class SeenMicropolygons {
  public:
    explicit SeenMicropolygons(const Grids& grids) : grids_(grids), first_(grids.grids.size() + 1) {
        for (size_t g = 0; g < grids.grids.size(); ++g)
            first_[g + 1] = first_[g] + static_cast<size_t>(grids.grids[g].shape.micropolygon_count());
        seen_ = std::vector<std::atomic<uint8_t>>(first_.back());
    }
    /// By many threads at once.
    void see(const Hit& hit) {
        const MicropolygonId id = MicropolygonId::unpack(hit.id);
        std::atomic<uint8_t>& seen = seen_[at(id.grid, id.u, id.v)];
        if (!seen.load(std::memory_order_relaxed)) seen.store(1, std::memory_order_relaxed);
    }
    /// The corners of those of a grid that are seen.
    VertexSet corners(size_t grid) const {
        const GridShape shape = grids_.grids[grid].shape;
        VertexSet corners;
        for (int v = 0; v < shape.nv; ++v)
            for (int u = 0; u < shape.nu; ++u) {
                if (!seen_[at(grid, u, v)].load(std::memory_order_relaxed)) continue;
                const size_t corner =
                    static_cast<size_t>(v) * static_cast<size_t>(shape.nu + 1) + static_cast<size_t>(u);
                const size_t above = corner + static_cast<size_t>(shape.nu + 1);
                corners.set(corner).set(corner + 1).set(above).set(above + 1);
            }
        return corners;
    }

  private:
    size_t at(size_t grid, int u, int v) const {
        return first_[grid] + static_cast<size_t>(v * grids_.grids[grid].shape.nu + u);
    }

    const Grids& grids_;
    std::vector<size_t> first_;  ///< micropolygon of each grid
    std::vector<std::atomic<uint8_t>> seen_;
};

/// What samples of some pixels have hits on; nothing where there is no room for all hits.
std::optional<SeenMicropolygons> seen_micropolygons(const RenderContext& context, const PixelRect& pixels,
                                                    const Grids& grids, const Visibility& visibility,
                                                    const SamplePattern& pattern, const LayerLimits& limits) {
    std::optional<SeenMicropolygons> seen(grids);
    std::atomic<bool> has_room{true};
    const bool bounded = !every_grid_is_opaque(grids);
    const std::vector<PixelRect> tiles = tiles_of(pixels, visibility.tile_side());
    tbb::enumerable_thread_specific<TileLooker> lookers;
    const auto look = [&](size_t i) {
        if (context.is_cancelled() || !has_room.load(std::memory_order_relaxed)) return;
        TileLooker& looker = lookers.local();
        pattern.make_tile(tiles[i], looker.samples);
        looker.scratch.window = bounded ? LayerWindow{{}, limits.most, limits.room} : LayerWindow{};
        const bool fits = !bounded || looker.samples.size() <= limits.room / 2;
        if (fits) visibility.resolve(looker.samples, looker.hits, looker.scratch, looker.stats);
        if (!fits || !holds_all(looker.scratch, looker.hits, limits.most))
            return has_room.store(false, std::memory_order_relaxed);
        for (const Hit& hit : looker.hits.hits) seen->see(hit);
    };
    tbb::parallel_for(size_t{0}, tiles.size(), look, tbb::simple_partitioner());
    if (!has_room.load()) return {};
    return seen;
}

}  // namespace

void leave_out_hidden(const RenderContext& context, Region& region, const Tessellation& tessellation,
                      const Shading& shading, const Sampler& sampler, const SamplePattern& pattern,
                      const LayerLimits& limits, bool always, FrameStats& stats) {
    std::vector<uint32_t> candidates;
    std::map<uint32_t, VertexSet> wanted;  // by subpatch
    for (const uint32_t subpatch : region.subpatches)
        if (shading.may_stay_unshaded(tessellation.subpatches()[subpatch].primitive))
            candidates.push_back(subpatch);
        else
            wanted[subpatch].set();
    if (!always && !(enough_hides(candidates, tessellation, shading) &&
                     enough_is_hidden(context, region, candidates, tessellation)))
        return;
    const Grids grids = plain_grids(context, candidates, tessellation, shading);
    if (context.is_cancelled() || grids.grids.empty()) return;
    const std::unique_ptr<Visibility> visibility = sampler.prepare(context, grids);
    const auto seen = seen_micropolygons(context, region.pixels, grids, *visibility, pattern, limits);
    if (!seen) return;
    for (size_t g = 0; g < grids.grids.size(); ++g) {
        const Grid& grid = grids.grids[g];
        const VertexSet corners = seen->corners(g);
        if (corners.none()) {
            ++stats.unshaded_grids;
            stats.unshaded_vertices += static_cast<uint64_t>(grid.shape.vertex_count());
            continue;
        }
        wanted[static_cast<uint32_t>(grid.ordinal)] =
            shading.may_ask_for_some(grid.primitive) ? corners : ~VertexSet();
    }
    region.subpatches.clear();
    for (const auto& [subpatch, vertices] : wanted) {
        region.subpatches.push_back(subpatch);
        region.wanted.push_back(vertices);
    }
}

}  // namespace trapeze
