/// The table of visibility methods: ways to find what samples see in a region's grids. On the same samples
/// all give the same hits, bit for bit.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "accel/top_level.h"
#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/render_context.h"
#include "core/samples.h"
#include "core/stats.h"

namespace trapeze {

/// What a thread needs while resolving; any method may use any of it. One per thread, reused.
struct SampleScratch {
    std::vector<uint32_t> order;              ///< samples in the order of tracing
    std::vector<uint32_t> keys, sorted;       ///< of the sort that makes it
    TopLevel tile_top, group_top;             ///< what of a tree the tile, and a group of its rays, may meet
    std::vector<Hit> nearest;                 ///< sample -> nearest opaque hit
    std::vector<Hit> hits;                    ///< in the order of finding
    std::vector<uint32_t> hit_sample;         ///< whose each of these is
    std::vector<uint32_t> first, count;       ///< sample -> its range in hits
    std::vector<float> ox, oy, ux, uy, time;  ///< rays in planes, padded to whole vectors
    std::vector<uint32_t> found;              ///< lanes that the predicate answered yes for
    std::vector<float> found_depth;
};

/// A method with what it has prepared for some grids. Keeps references to the context and the grids.
class Visibility {
  public:
    virtual ~Visibility() = default;

    /// Every sample's hits within the clipping range, front to back, to the first opaque one. May be called
    /// from many threads at once, each with its own scratch and stats.
    virtual void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                         SampleStats& stats) const = 0;
    virtual BuildStats build_stats() const { return {}; }
};

struct VisibilityMethod {
    std::string_view name;
    std::unique_ptr<Visibility> (*prepare)(const RenderContext& context, const Grids& grids);
};

std::span<const VisibilityMethod> visibility_methods();

/// Null when there is none of that name.
const VisibilityMethod* find_visibility_method(std::string_view name);

/// The instruction set that the vector code runs on, as Highway names it.
std::string_view simd_target_name();

/// The rows: [Hou10] with bundles of rays; the paper's own form, one ray after another; every sample against
/// every micropolygon that may cover it.
std::unique_ptr<Visibility> prepare_raytrace(const RenderContext& context, const Grids& grids);
std::unique_ptr<Visibility> prepare_raytrace_without_bundles(const RenderContext& context,
                                                             const Grids& grids);
std::unique_ptr<Visibility> prepare_brute_force(const RenderContext& context, const Grids& grids);

}  // namespace trapeze
