/// The table of visibility methods: ways to find what samples see in a region's grids. On the same samples
/// all give the same hits, bit for bit.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/samples.h"
#include "core/scene/render_context.h"
#include "core/stats.h"
#include "sample/build_memory.h"
#include "sample/names/method_spec.h"
#include "sample/patterns/sample_pattern.h"
#include "sample/sample_scratch.h"

namespace trapeze {

/// A method with what it has prepared for some grids. Keeps references to the context and the grids. It is
/// made by VisibilityMethod::prepare once for a region and used by all threads; whatever a call changes is in
/// its scratch.
class Visibility {
  public:
    virtual ~Visibility() = default;

    /// Every sample's hits within the clipping range, front to back, to the first opaque one; or those of
    /// them that scratch.window wants. May be called from many threads at once, each with its own scratch and
    /// stats.
    virtual void resolve(const SampleTile& samples, HitBuffer& hits, SampleScratch& scratch,
                         SampleStats& stats) const = 0;
    /// For reports; asked once, after preparation.
    virtual BuildStats build_stats() const { return {}; }

    /// Takes the grids of the next frame of a sequence in place of those that it was prepared for, which must
    /// still be there, and changes what it has prepared to fit them. `changed`: the grids, by number, in
    /// which they differ from those before; null: any may. False, with nothing changed, where that is not its
    /// way: prepare anew.
    virtual bool update(const Grids& /*grids*/, const std::vector<uint32_t>* /*changed*/ = nullptr) {
        return false;
    }

    /// Whether rays in any direction (core/ray_query.h) meet anything within a range of depths: a byte each,
    /// 1 or 0, in `met`, which has a place for each. False, with nothing written, where the method takes none
    /// but the camera's. May be called from many threads at once.
    virtual bool occluded(std::span<const SpaceRay> /*rays*/, DepthRange /*range*/,
                          std::span<uint8_t> /*met*/, SampleStats& /*stats*/) const {
        return false;
    }

    /// Whether resolve() takes as long for a part of the samples' lists as for the whole: then few samples at
    /// a time are to be looked at, of which nothing is left for another pass.
    virtual bool walks_whole_lists() const { return false; }

    /// Side in pixels, a multiple of kTileSide, of the tiles that the method likes to resolve. Any size is
    /// right; this one is fast.
    virtual int tile_side() const { return kTileSide; }
};

/// What a method is prepared with; all of it outlives what is prepared. Which pattern samples come from
/// follows from honours(): a method that builds on one makes its own, which is equal.
struct VisibilityInput {
    const RenderContext& context;
    const Grids& grids;
    const MethodSpec& spec;  ///< parse_method's
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
    /// Whether the hits are those of brute force, bit for bit. Other libraries have predicates of their own.
    bool is_exact = true;
    /// Whether resolve() takes tiles of listed pixels: what adaptive sampling asks for.
    bool takes_lists = false;
    /// A choice, as "clip=naive", that finds other hits all the same, to show that it does; empty: none.
    std::string_view wrong_choice = {};
    /// What prepare() takes with these options; null: what most do.
    BuildMemory (*build_memory)(const MethodSpec& method) = nullptr;
};

/// Which methods this build has, in the order of the table; plugins' rows come last. Rows stay where they are
/// once work has begun: plugins are loaded before.
const std::vector<VisibilityMethod>& visibility_methods();

/// A method and a pattern, checked against the tables and each other.
struct Sampler {
    MethodSpec method, pattern;

    std::unique_ptr<SamplePattern> make_pattern(const RenderContext& context) const {
        return make_sample_pattern(context, pattern);
    }
    /// Prepares the method for some grids. Samples must come from the pattern that make_pattern() makes with
    /// the same context.
    std::unique_ptr<Visibility> prepare(const RenderContext& context, const Grids& grids) const;
    /// What that takes while it is done.
    BuildMemory build_memory() const;
    /// Whether pixels may have numbers of samples of their own (SamplePattern::levels()).
    bool takes_levels() const;
    /// The method as a user would name it, without options at their default.
    std::string name() const;
};

/// Reads "raytrace:tree=paper" and the like, and a pattern's name (empty: the method's natural one). Empty
/// with *error set when either is wrong or the method does not honour the pattern.
std::optional<Sampler> choose_sampler(std::string_view method, std::string_view pattern, std::string* error);

/// The instruction set that the vector code runs on, as Highway names it.
std::string_view simd_target_name();

/// The rows of the table, one file each.
#define TRAPEZE_METHOD(row) VisibilityMethod row();
#include "sample/visibility_methods.def"
#undef TRAPEZE_METHOD
VisibilityMethod embree_method();  ///< in the table where Embree was found at build time

/// The pattern of methods that take any sample as it comes.
inline std::string stratified_pattern(const MethodSpec&) {
    return "stratified";
}
/// For VisibilityMethod::honours: the samples may lie anywhere.
inline bool any_pattern(const MethodSpec&, const MethodSpec&) {
    return true;
}

}  // namespace trapeze
