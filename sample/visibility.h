/// The table of visibility methods: ways to find what samples see in a region's grids. On the same samples
/// all give the same hits, bit for bit.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "accel/paper/top_level.h"
#include "accel/wide/bundle.h"
#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/samples.h"
#include "core/scene/render_context.h"
#include "core/stats.h"
#include "sample/dualspace/dual_raster.h"
#include "sample/interleave/uvt_raster.h"
#include "sample/interval/interval_scratch.h"
#include "sample/names/method_spec.h"
#include "sample/patterns/sample_pattern.h"

namespace trapeze {

/// What samples cost, for pictures of it: indexed by sample, set to zero by the caller.
struct SampleHeat {
    std::vector<uint32_t> tests;  ///< predicate tests
    std::vector<uint32_t> nodes;  ///< nodes visited, or (rasterizers) boxes set up that reached the sample
};

class Visibility;

/// An order of a tile's samples that may serve again.
struct KnownOrder {
    const void* owner = nullptr;  ///< who made it
    std::array<int, 6> kind{};    ///< for what tiles, how sorted
    std::vector<uint32_t> order;
};

/// What a thread needs while resolving; any method may use any of it. One per thread, reused.
struct SampleScratch {
    SampleHeat* heat = nullptr;               ///< when set, methods add what each sample cost
    std::vector<uint32_t> order;              ///< samples in the order of tracing
    std::vector<uint32_t> keys, sorted;       ///< of the sort that makes it
    TopLevel tile_top, group_top;             ///< what of a tree the tile, and a group of its rays, may meet
    std::vector<Hit> nearest;                 ///< sample -> nearest opaque hit
    std::vector<Hit> hits;                    ///< in the order of finding
    std::vector<uint32_t> hit_sample;         ///< whose each of these is
    std::vector<uint32_t> first, count;       ///< sample -> its range in hits
    std::vector<float> ox, oy, ux, uy, time;  ///< rays in planes, padded to whole vectors
    std::vector<uint32_t> raster_grids;       ///< that a rasterizer's tile may see
    std::vector<uint32_t> found;              ///< lanes that the predicate answered yes for
    std::vector<float> found_depth;
    std::vector<uint32_t> starts, pixel_first;  ///< of the order of bundles
    std::vector<KnownOrder> bundle_orders;      ///< in which bundles take samples; at most a few
    std::unique_ptr<RayBundle> bundle;          ///< made when first needed
    BundleScratchPointer bundle_scratch;
    std::vector<uint32_t> ray_tests, ray_nodes;  ///< what the rays of a bundle cost
    IntervalScratch interval;
    UvtScratch uvt;
    DualScratch dual;
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

    /// Side in pixels, a multiple of kTileSide, of the tiles that the method likes to resolve. Any size is
    /// right; this one is fast.
    virtual int tile_side() const { return kTileSide; }
};

/// What a method is prepared with; all of it outlives what is prepared.
struct VisibilityInput {
    const RenderContext& context;
    const Grids& grids;
    const SamplePattern& pattern;  ///< one that the method honours
    const MethodSpec& spec;        ///< parse_method's
};

/// How a method works, for comparisons: contests are between ray tracers and rasterizers, and a Reference
/// takes no part in them.
enum class MethodKind : uint8_t { RayTracer, Rasterizer, Reference };

/// A row of the table of methods; the first is the default.
struct VisibilityMethod {
    std::string_view name;
    MethodKind kind;
    std::vector<SpecOption> options;
    /// The pattern that the method, with these options, was made for.
    std::string (*natural_pattern)(const MethodSpec& method);
    /// Whether the method finds what samples of a pattern see.
    bool (*honours)(const MethodSpec& method, const MethodSpec& pattern);
    std::unique_ptr<Visibility> (*prepare)(const VisibilityInput& input);
    /// What is wrong with options that do not go together; empty when nothing is. May be null.
    std::string (*check)(const MethodSpec& method) = nullptr;
};

const std::vector<VisibilityMethod>& visibility_methods();

/// A method and a pattern, checked against the tables and each other.
struct Sampler {
    MethodSpec method, pattern;

    std::unique_ptr<SamplePattern> make_pattern(const RenderContext& context) const {
        return make_sample_pattern(context, pattern);
    }
    std::unique_ptr<Visibility> prepare(const RenderContext& context, const Grids& grids,
                                        const SamplePattern& made_pattern) const;
    /// The method as a user would name it, without options at their default.
    std::string name() const;
};

/// Reads "raytrace:tree=paper" and the like, and a pattern's name (empty: the method's natural one). Empty
/// with *error set when either is wrong or the method does not honour the pattern.
std::optional<Sampler> choose_sampler(std::string_view method, std::string_view pattern, std::string* error);

/// The instruction set that the vector code runs on, as Highway names it.
std::string_view simd_target_name();

/// The rows of the table, one file each.
VisibilityMethod raytrace_method();
VisibilityMethod brute_force_method();
VisibilityMethod interval_method();
VisibilityMethod interleave_uvt_method();
VisibilityMethod dual_space_method();
VisibilityMethod embree_method();  ///< in the table where Embree was found at build time

/// For methods that take any sample as it comes.
inline std::string stratified_pattern(const MethodSpec&) {
    return "stratified";
}
inline bool any_pattern(const MethodSpec&, const MethodSpec&) {
    return true;
}

}  // namespace trapeze
