/// How a scene's primitives become lists of subpatches, within a budget of memory and the same for any number
/// of threads.
#include "tessellate/tessellate.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <set>

#include "core/memory/clock_cache.h"
#include "core/random.h"
#include "tessellate/dice.h"
#include "tessellate/shared_grids.h"
#include "tessellate/tessellated_primitive.h"

namespace trapeze {
namespace {

/// Primitives that are split before their bytes are counted.
constexpr size_t kPrimitivesAtOnce = 1024;
/// Bytes that grids of instances in object space may take.
constexpr size_t kSharedGridBytes = size_t{256} << 20;
/// Where lists are made again: of the most bytes, those for edges and vertices, for lists that are kept as a
/// whole, and for blocks of the others. What is left out follows from the first alone, so that it does not
/// depend on which lists are kept, as threads may have it.
constexpr double kEdgeShare = 0.75, kWholeShare = 0.125, kAgainShare = 0.125;

size_t share_of(size_t bytes, double share) {
    return static_cast<size_t>(share * static_cast<double>(bytes));
}

/// Shapes shared by several primitives (instances) make one surface. What else a surface reads of its
/// primitive is part of the key.
class SurfaceCache {
  public:
    std::shared_ptr<const Surface>& of(const Primitive& primitive) {
        Key key;
        for (const auto& shape : primitive.shape_keys) key.shapes.push_back(shape.get());
        key.texture_coordinates = primitive.attributes->texture_coordinates;
        if (depends_on_view(primitive.shape().topology)) key.primitive = &primitive;
        return surfaces_[key];
    }
    size_t size() const { return surfaces_.size(); }

  private:
    /// What surfaces depend on; `primitive` only where they depend on the place, too.
    struct Key {
        std::vector<const Shape*> shapes;
        std::array<float, 8> texture_coordinates{};
        const Primitive* primitive = nullptr;
        auto operator<=>(const Key&) const = default;
    };
    std::map<Key, std::shared_ptr<const Surface>> surfaces_;
};

}  // namespace

/// Kept out of the header, so that those who use tessellations need not know of surfaces and metrics.
struct Tessellation::Impl {
    Impl(const RenderContext& context, SeenBy seen_by)
        : metric(context.camera), raster(raster_for(context, seen_by)) {}

    const ScreenMetric metric;
    const RasterBound raster;
    std::shared_ptr<SharedGridBudget> shared_grids;  ///< outlives the surfaces
    std::vector<TessellatedPrimitive> primitives;
    mutable std::optional<ClockCache<Splits>> again;  ///< blocks of lists that are made again; or nothing

    /// Places and lists all primitives, within the most bytes.
    void tessellate(const RenderContext& context, const TessellationOptions& options);

  private:
    static RasterBound raster_for(const RenderContext& context, SeenBy seen_by) {
        const PixelRect picture = sampled_pixels(context.camera, context.scene->options);
        return seen_by == SeenBy::Rays ? RasterBound::of_everything(context.camera, picture)
                                       : RasterBound(context.camera, picture);
    }
};

DiceScratch::DiceScratch() : state(std::make_unique<State>()) {}
DiceScratch::DiceScratch(DiceScratch&&) noexcept = default;
DiceScratch& DiceScratch::operator=(DiceScratch&&) noexcept = default;
DiceScratch::~DiceScratch() = default;

namespace {

/// One surface for each slot that the cache hands out, made in parallel.
void make_surfaces(const RenderContext& context, const FindDepthHeight& depth_heights,
                   SharedGridBudget& shared_grids, std::vector<TessellatedPrimitive>& primitives) {
    SurfaceCache cache;
    std::vector<std::shared_ptr<const Surface>*> slots(primitives.size());
    std::vector<size_t> makers;
    for (size_t i = 0; i < primitives.size(); ++i) {
        const size_t before = cache.size();
        slots[i] = &cache.of(context.scene->primitives[i]);
        if (cache.size() > before) makers.push_back(i);
    }
    tbb::parallel_for(size_t{0}, makers.size(), [&](size_t m) {
        *slots[makers[m]] = make_surface(context.scene->primitives[makers[m]], *context.diagnostics,
                                         {&context.camera, depth_heights ? &depth_heights : nullptr});
    });
    // What is there twice shares its grids; at most once wrapped.
    std::set<const Surface*> seen, shared;
    for (size_t i = 0; i < primitives.size(); ++i) {
        std::shared_ptr<const Surface>& surface = *slots[i];
        if (!surface || shared.contains(surface.get())) continue;
        if (seen.insert(surface.get()).second) continue;
        if (!pays_to_share(context.scene->primitives[i].shape().topology)) continue;
        surface = share_grids(surface, shared_grids);
        shared.insert(surface.get());
    }
    for (size_t i = 0; i < primitives.size(); ++i) primitives[i].surface = *slots[i];
}

void tell_too_much(const RenderContext& context, const Primitive& first, size_t most_bytes) {
    context.diagnostics->error(
        first.location, fmt::format("the grids into which primitives are split take more than {} MiB to "
                                    "list; this and those after it are left out",
                                    most_bytes >> 20));
}

}  // namespace

/// All primitives, or those before the first with which the bytes are too many: the same ones however many
/// threads there are, because bytes are counted in the primitives' order.
void Tessellation::Impl::tessellate(const RenderContext& context, const TessellationOptions& options) {
    const bool lists_again = options.lists_again;
    const size_t most = lists_again ? share_of(options.most_bytes, kEdgeShare) : options.most_bytes;
    const size_t most_whole = lists_again ? share_of(options.most_bytes, kWholeShare) : options.most_bytes;
    std::atomic<size_t> listed{0};
    const TessellatePlan plan{context, metric, raster, options, most_whole, listed};
    const auto primitive = [&](size_t i) -> const Primitive& { return context.scene->primitives[i]; };
    size_t bytes = 0, whole = 0;
    bool is_full = false;
    for (size_t first = 0; first < primitives.size() && !is_full; first += kPrimitivesAtOnce) {
        const size_t end = std::min(first + kPrimitivesAtOnce, primitives.size());
        tbb::parallel_for(first, end,
                          [&](size_t i) { tessellate_primitive(plan, primitive(i), primitives[i]); });
        std::vector<size_t> counted;
        for (size_t i = first; i < end && !is_full; ++i) {
            TessellatedPrimitive& own = primitives[i];
            const size_t lists = own.splits.bytes(), taken = own.edge_bytes() + (lists_again ? 0 : lists);
            if (taken > most - bytes) {
                is_full = true;
                tell_too_much(context, primitive(i), options.most_bytes);
                for (size_t left = i; left < end; ++left) primitives[left].leave_out();
                continue;
            }
            bytes += taken;
            if (!own.relisting) continue;
            if (own.is_listed && lists <= most_whole - whole)
                whole += lists, own.relisting.reset();
            else
                own.splits = {}, counted.push_back(i);
        }
        listed = whole;
        tbb::parallel_for(size_t{0}, counted.size(), [&](size_t k) {
            count_instead_of_listing(plan, primitive(counted[k]), share_of(options.most_bytes, kAgainShare),
                                     primitives[counted[k]]);
        });
    }
}

/// What one tessellation leaves out its follower for rays leaves out as well: surfaces are taken over from
/// those that have been placed.
Tessellation::Tessellation(const RenderContext& context, const TessellationOptions& options)
    : impl_(std::make_unique<Impl>(context, options.seen_by)) {
    const Scene& scene = *context.scene;
    std::vector<TessellatedPrimitive>& primitives = impl_->primitives;
    primitives.resize(scene.primitives.size());
    const auto is_so = [](const TessellationOptions::OfPrimitive& tells, size_t i) {
        return tells && tells(static_cast<uint32_t>(i));
    };
    for (size_t i = 0; i < primitives.size(); ++i) {
        primitives[i].displaced =
            scene.primitives[i].attributes->displacement != nullptr || is_so(options.is_displaced, i);
        primitives[i].left_whole = is_so(options.is_left_whole, i);
    }
    if (options.surfaces_of) {
        impl_->shared_grids = options.surfaces_of->impl_->shared_grids;
        for (size_t i = 0; i < primitives.size(); ++i)
            if (const TessellatedPrimitive& known = options.surfaces_of->impl_->primitives[i]; known.placed)
                primitives[i].surface = known.surface;
    } else {
        impl_->shared_grids = std::make_shared<SharedGridBudget>();
        impl_->shared_grids->bytes_left = std::min(kSharedGridBytes, options.most_bytes / 8);
        make_surfaces(context, options.depth_heights, *impl_->shared_grids, primitives);
    }
    impl_->tessellate(context, options);
    number_subpatches(options.most_bytes);
}

/// The camera's order of subpatches is that of whole lists; those that are made again have their numbers
/// among them.
void Tessellation::number_subpatches(size_t most_bytes) {
    std::vector<TessellatedPrimitive>& primitives = impl_->primitives;
    size_t count = 0, blocks = 0;
    for (TessellatedPrimitive& p : primitives) {
        p.first_subpatch = count, p.first_block = blocks;
        count += p.subpatch_count();
        blocks += p.relisting ? p.relisting->block_count() : 0;
        stats_.primitives += p.placed ? 1 : 0;
        stats_.culled_subpatches += p.relisting ? p.relisting->culled_count() : p.splits.culled;
        stats_.micropolygons += p.relisting ? p.relisting->micropolygon_count() : 0;
    }
    if (blocks > 0) {
        const size_t most = share_of(most_bytes, kAgainShare),
                     places = ClockCache<Splits>::place_bytes(blocks);
        impl_->again.emplace(blocks, most - std::min(most, places));
    } else {
        infos_.reserve(count);
    }
    for (size_t i = 0; i < primitives.size(); ++i) {
        TessellatedPrimitive& p = primitives[i];
        for (size_t s = 0; s < p.splits.subpatches.size(); ++s) {
            const GridShape shape = p.splits.subpatches[s].shape;
            stats_.micropolygons += static_cast<uint64_t>(shape.micropolygon_count());
            if (blocks > 0) continue;
            infos_.push_back({p.splits.bounds[s], shape, static_cast<uint8_t>(p.placed->key_count()),
                              static_cast<uint32_t>(i)});
        }
        p.splits.bounds = {};
    }
    stats_.subpatches = stats_.grids = count;
}

namespace {

/// Of a piece, by its primitive and where it lies on it alone: a crop, in whose list of pieces others are
/// missing, has the numbers of the whole picture.
uint64_t seed_of(uint32_t primitive, const Subpatch& piece) {
    const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
    const auto half = [&](uint32_t which) {
        return hash(hash(which, primitive, static_cast<uint32_t>(piece.face)),
                    hash(bits(piece.lo.x), bits(piece.lo.y), bits(piece.hi.x), bits(piece.hi.y)));
    };
    return uint64_t{half(1)} << 32 | half(2);
}

}  // namespace

Tessellation::~Tessellation() = default;

/// Capacities, which is what has been taken; surfaces, which primitives may share, are not counted.
size_t Tessellation::bytes() const {
    size_t total = infos_.capacity() * sizeof(SubpatchInfo) + sizeof(Impl) +
                   impl_->primitives.capacity() * sizeof(TessellatedPrimitive) +
                   (impl_->again ? impl_->again->bytes() : 0);
    for (const TessellatedPrimitive& p : impl_->primitives) total += p.bytes();
    return total;
}

bool Tessellation::makes_lists_again() const {
    return impl_->again.has_value();
}

bool Tessellation::has_larger_flats() const {
    return std::ranges::any_of(impl_->primitives,
                               [](const TessellatedPrimitive& own) { return own.flat_cuts.are_wanted(); });
}

/// Of primitives without subpatches, which begin where the next one does, the last is the next one.
uint32_t Tessellation::primitive_of(size_t subpatch) const {
    if (!makes_lists_again()) return infos_[subpatch].primitive;
    const auto behind =
        std::ranges::upper_bound(impl_->primitives, subpatch, {}, &TessellatedPrimitive::first_subpatch);
    return static_cast<uint32_t>(behind - impl_->primitives.begin() - 1);
}

size_t Tessellation::end_of_primitive(size_t subpatch) const {
    const TessellatedPrimitive& p = impl_->primitives[primitive_of(subpatch)];
    return p.first_subpatch + p.subpatch_count();
}

struct Tessellation::Listed {
    uint32_t number;  ///< of the primitive
    const TessellatedPrimitive& primitive;
    std::shared_ptr<const Splits> keeps;  ///< lists that are made again
    const Splits& lists;
    const Subpatch& subpatch;
};

Tessellation::Listed Tessellation::listed(size_t subpatch) const {
    const uint32_t number = primitive_of(subpatch);
    const TessellatedPrimitive& p = impl_->primitives[number];
    const size_t at = subpatch - p.first_subpatch;
    if (!p.relisting) return {number, p, nullptr, p.splits, p.splits.subpatches[at]};
    const Relisting::Place place = p.relisting->place_of(static_cast<uint32_t>(at));
    std::shared_ptr<const Splits> block = impl_->again->get(p.first_block + place.block, [&] {
        return std::make_shared<const Splits>(p.relisting->list(place.block));
    });
    const Splits& lists = *block;
    return {number, p, std::move(block), lists, lists.subpatches[place.at]};
}

GridShape Tessellation::shape_of(size_t subpatch) const {
    return makes_lists_again() ? listed(subpatch).subpatch.shape : infos_[subpatch].shape;
}

/// The ordinal is the index among all subpatches, and orders grids of the frame whoever dices them.
void Tessellation::dice(size_t subpatch, ShadingGrid& grid, DiceScratch& scratch, DiceFor wanted) const {
    const Listed at = listed(subpatch);
    dice_subpatch(at.primitive.dice_context(impl_->metric, at.lists), at.subpatch, grid, *scratch.state,
                  wanted);
    grid.primitive_index = at.number;
    grid.ordinal = subpatch;
    grid.seed = seed_of(at.number, at.subpatch);
}

/// For rays that ask at a point: a grid of one micropolygon is the least that derivatives can be taken of.
int Tessellation::dice_point(const SubpatchPoint& point, ShadingGrid& grid, DiceScratch& scratch) const {
    const Listed at = listed(point.subpatch);
    const uint32_t primitive = point.primitive.value_or(at.number);
    DiceContext context = at.primitive.dice_context(impl_->metric, at.lists);
    context.surface = impl_->primitives[primitive].placed.get();
    const int vertex = trapeze::dice_point(context, at.subpatch, point.at, grid, *scratch.state);
    grid.primitive_index = primitive;
    grid.ordinal = point.subpatch;
    return vertex;
}

}  // namespace trapeze
