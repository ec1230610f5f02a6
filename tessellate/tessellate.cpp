/// How a scene's primitives become lists of subpatches, within a budget of memory and the same for any number
/// of threads.
#include "tessellate/tessellate.h"
#include "tessellate/measure/blur_factor.h"
#include "tessellate/measure/growth_factor.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "core/random.h"
#include "tessellate/dice.h"
#include "tessellate/out_of_view.h"
#include "tessellate/shared_grids.h"
#include "tessellate/topology/order_by_face.h"

namespace trapeze {
namespace {

constexpr int kFacesPerTask = 64, kEdgesPerTask = 512;
/// Primitives that are split before their bytes are counted.
constexpr size_t kPrimitivesAtOnce = 1024;
/// Bytes that grids of instances in object space may take.
constexpr size_t kSharedGridBytes = size_t{256} << 20;
/// Shading rates below this (in pixels' area) are taken as this: a bound on absurd input.
constexpr float kLeastShadingRate = 1e-4f;
/// Farther from the eye, the rounding of positions is larger than what a camera can tell apart: no piece can
/// be found out of view, and all would be diced.
constexpr float kFarthest = 1e11f;

}  // namespace

/// A primitive's part of a Tessellation. The surface may be shared with other primitives; all else is its
/// own, since rates depend on where it is.
struct TessellatedPrimitive {
    std::shared_ptr<const Surface> surface;
    std::unique_ptr<PlacedSurface> placed;
    VertexTable vertices;
    EdgeTessellations surface_edges;
    Splits splits;
    size_t first_subpatch = 0;
    float pixels_per_segment = 1;
    bool displaced = false;
    bool left_whole = false;  ///< it has no subpatches of its own

    DiceContext dice_context(const ScreenMetric& metric) const {
        return {placed.get(),       {surface.get(), &surface_edges, &splits.made_lines, &splits.made},
                &vertices,          &metric,
                pixels_per_segment, displaced};
    }
    size_t bytes() const { return vertices.bytes() + surface_edges.bytes() + splits.bytes(); }
    /// Frees all; a primitive without subpatches stays in its place, so that indices hold.
    void leave_out() {
        placed.reset();
        vertices = {};
        surface_edges = {};
        splits = {};
    }
};

namespace {

/// Cuts the surface's edges, in tasks of those that are evaluated on the same faces (surfaces keep the face
/// evaluated last); the result is by number of the edge.
EdgeTessellations tessellate_edges(const PlacedSurface& placed, const LineMeasure& measure,
                                   const EdgeRate& rate, std::span<const FaceEstimate> estimates) {
    const Surface& surface = placed.surface();
    const uint32_t count = surface.edge_count();
    std::vector<int> faces(count);
    for (uint32_t e = 0; e < count; ++e) faces[e] = surface.edge(e).face;
    const std::vector<uint32_t> order = order_by_face(faces, surface.face_count());
    const size_t tasks = (count + kEdgesPerTask - 1) / kEdgesPerTask;
    std::vector<EdgeTessellations> parts(tasks);
    tbb::parallel_for(size_t{0}, tasks, [&](size_t task) {
        EvaluationScratch scratch;
        const size_t end = std::min<size_t>((task + 1) * kEdgesPerTask, count);
        for (size_t i = task * kEdgesPerTask; i < end; ++i) {
            const EdgeLine line = surface.edge(order[i]);
            const uint8_t segments = estimates.empty() ? uint8_t{0} : estimates[line.face].segments_of(line);
            if (segments > 0)
                parts[task].add_whole(segments);
            else
                parts[task].add(placed, line, measure, rate, scratch);
        }
    });
    EdgeTessellations edges;
    for (const EdgeTessellations& part : parts) edges.append(part);
    edges.renumber(order);
    edges.shrink_to_fit();
    return edges;
}

/// Splits all faces of a surface, in parallel, and joins the lists in the order of faces. Nothing when they
/// take more than `most_bytes`.
std::optional<Splits> split_all(const SplitContext& context, const RenderContext& render, size_t most_bytes) {
    const Surface& surface = context.surface->surface();
    const int faces = surface.face_count();
    const size_t tasks = static_cast<size_t>((faces + kFacesPerTask - 1) / kFacesPerTask);
    // Few faces may be large ones: a task each.
    const int per_task = faces < 4 * kFacesPerTask ? 1 : kFacesPerTask;
    const size_t count = per_task == 1 ? static_cast<size_t>(faces) : tasks;
    std::vector<Splits> parts(count);
    std::atomic<size_t> bytes{0};
    tbb::parallel_for(size_t{0}, count, [&](size_t task) {
        const int first = static_cast<int>(task) * per_task;
        if (render.is_cancelled() || bytes.load(std::memory_order_relaxed) > most_bytes) return;
        parts[task] = split_faces(context, first, std::min(first + per_task, faces));
        bytes.fetch_add(parts[task].bytes(), std::memory_order_relaxed);
    });
    if (bytes > most_bytes) return {};
    if (parts.size() == 1) return std::move(parts[0]);
    Splits splits;
    for (Splits& part : parts) {
        splits.append(std::move(part), surface.edge_count());
        part = {};
    }
    return splits;
}

/// Lists grow by doubling, and stay as they are for the frame.
void shrink(Splits& splits) {
    splits.subpatches.shrink_to_fit();
    splits.made_lines.shrink_to_fit();
    splits.made.shrink_to_fit();
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
    explicit Impl(const Camera& camera) : metric(camera) {}

    const ScreenMetric metric;
    std::shared_ptr<SharedGridBudget> shared_grids;  ///< outlives the surfaces
    std::vector<TessellatedPrimitive> primitives;
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

/// Many times the grids that fill the picture: a bound on absurd input, such as a surface that comes near
/// infinity again and again.
size_t most_parts_of_face(const Options& options, const EdgeRate& rate) {
    constexpr double kTimesThePicture = 64, kAtLeast = 1024, kAtMost = 1 << 20;
    const double grid_side = static_cast<double>(kMaxGridSide) * static_cast<double>(rate.pixels_per_segment);
    const double pixels = static_cast<double>(options.width) * options.height;
    return static_cast<size_t>(
        std::clamp(kTimesThePicture * pixels / (grid_side * grid_side), kAtLeast, kAtMost));
}

/// Places, measures and splits one primitive. What cannot be diced is left out, with a diagnostic.
void tessellate_primitive(const RenderContext& context, const Primitive& primitive,
                          const ScreenMetric& metric, const RasterBound& raster,
                          const TessellationOptions& options, TessellatedPrimitive& out) {
    const bool by_rays = options.seen_by == SeenBy::Rays;
    const bool is_seen =
        by_rays ? primitive.attributes->rays.seen() : primitive.attributes->visible_to_camera;
    if (!out.surface || !is_seen || context.is_cancelled()) return;
    out.placed = std::make_unique<PlacedSurface>(*out.surface, primitive, context.motion);
    if (out.left_whole) return;
    const float displacement_bound = std::max(primitive.attributes->displacement_bound, 0.0f);
    if (!by_rays && is_out_of_view(*out.placed, raster, displacement_bound, kFarthest)) {
        out.splits.culled = static_cast<uint64_t>(out.surface->face_count());
        return;
    }
    const Attributes& attributes = *primitive.attributes;
    const float blur = blur_factor(*out.placed, context.camera, metric);
    EdgeRate rate;
    rate.binary = attributes.dice.binary;
    rate.pixels_per_segment = std::sqrt(std::max(attributes.shading_rate, kLeastShadingRate) * blur) /
                              growth_factor(*out.placed, context.camera, metric);
    if (std::holds_alternative<Curves>(primitive.shape().topology))
        rate.pixels_per_segment = std::max(rate.pixels_per_segment, attributes.dice.min_length);
    rate.pixels_per_segment = std::max(rate.pixels_per_segment, options.least_side);
    const size_t most_parts = most_parts_of_face(context.scene->options, rate);
    rate.max_intervals = static_cast<int>(std::min<size_t>(most_parts, rate.max_intervals));
    out.pixels_per_segment = rate.pixels_per_segment;
    const LineMeasure measure(metric, context.camera, *out.placed, out.displaced, rate.pixels_per_segment,
                              by_rays);
    std::optional<VertexTableMaker> vertices(*out.placed);
    const std::vector<FaceEstimate> estimates = estimate_faces(*out.placed, measure, rate, *vertices);
    out.vertices = vertices->finish();
    vertices.reset();
    if (const float reach = out.vertices.reach(); reach > kFarthest) {
        context.diagnostics->error(
            primitive.location,
            fmt::format(
                "reaches {:.3g} from the camera, where surfaces beyond {:.0g} cannot be diced; left out",
                reach, kFarthest));
        out.leave_out();
        return;
    }
    out.surface_edges = tessellate_edges(*out.placed, measure, rate, estimates);
    SplitContext split;
    split.surface = out.placed.get();
    split.surface_edges = &out.surface_edges;
    split.vertices = &out.vertices;
    split.measure = &measure;
    split.raster = &raster;
    split.rate = rate;
    split.estimates = estimates;
    split.displacement_bound = displacement_bound;
    split.most_parts_of_face = most_parts;
    std::optional<Splits> splits = split_all(split, context, options.most_bytes);
    if (!splits) {
        context.diagnostics->error(
            primitive.location,
            fmt::format("the grids into which it is split take more than {} MiB to list; left out",
                        options.most_bytes >> 20));
        out.leave_out();
        return;
    }
    out.splits = std::move(*splits);
    if (out.splits.limited)
        context.diagnostics->warning(primitive.location,
                                     "a face wants more micropolygons than many times those of the picture; "
                                     "they are made larger",
                                     "face-limit");
    shrink(out.splits);
}

/// Tessellates all primitives, or those before the first with which the bytes are too many: the same ones
/// however many threads there are, because bytes are counted in the primitives' order.
void tessellate_all(const RenderContext& context, const ScreenMetric& metric,
                    const TessellationOptions& options, std::vector<TessellatedPrimitive>& primitives) {
    const Scene& scene = *context.scene;
    const PixelRect picture = sampled_pixels(context.camera, scene.options);
    const RasterBound raster = options.seen_by == SeenBy::Rays
                                   ? RasterBound::of_everything(context.camera, picture)
                                   : RasterBound(context.camera, picture);
    const size_t most_bytes = options.most_bytes;
    size_t bytes = 0;
    for (size_t first = 0; first < primitives.size(); first += kPrimitivesAtOnce) {
        const size_t end = std::min(first + kPrimitivesAtOnce, primitives.size());
        tbb::parallel_for(first, end, [&](size_t i) {
            tessellate_primitive(context, scene.primitives[i], metric, raster, options, primitives[i]);
        });
        for (size_t i = first; i < end; ++i) {
            const size_t own = primitives[i].bytes();
            if (own <= most_bytes - bytes) {
                bytes += own;
                continue;
            }
            context.diagnostics->error(
                scene.primitives[i].location,
                fmt::format("the grids into which primitives are split take more than {} MiB to list; this "
                            "and those after it are left out",
                            most_bytes >> 20));
            for (; i < end; ++i) primitives[i].leave_out();
            return;
        }
    }
}

}  // namespace

/// What one tessellation leaves out its follower for rays leaves out as well: surfaces are taken over from
/// those that have been placed.
Tessellation::Tessellation(const RenderContext& context, const TessellationOptions& options)
    : impl_(std::make_unique<Impl>(context.camera)) {
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
    tessellate_all(context, impl_->metric, options, primitives);

    size_t count = 0;
    for (const TessellatedPrimitive& p : primitives) count += p.splits.subpatches.size();
    infos_.reserve(count);
    for (size_t i = 0; i < primitives.size(); ++i) {
        TessellatedPrimitive& p = primitives[i];
        p.first_subpatch = infos_.size();
        for (size_t s = 0; s < p.splits.subpatches.size(); ++s) {
            const GridShape shape = p.splits.subpatches[s].shape;
            infos_.push_back({p.splits.bounds[s], shape, static_cast<uint8_t>(p.placed->key_count()),
                              static_cast<uint32_t>(i)});
            stats_.micropolygons += shape.micropolygon_count();
        }
        stats_.primitives += p.placed ? 1 : 0;
        stats_.culled_subpatches += p.splits.culled;
        p.splits.bounds = {};
    }
    stats_.subpatches = stats_.grids = infos_.size();
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
                   impl_->primitives.capacity() * sizeof(TessellatedPrimitive);
    for (const TessellatedPrimitive& p : impl_->primitives) total += p.bytes();
    return total;
}

/// The ordinal is the index among all subpatches, and orders grids of the frame whoever dices them.
void Tessellation::dice(size_t subpatch, ShadingGrid& grid, DiceScratch& scratch, DiceFor wanted) const {
    const SubpatchInfo& info = infos_[subpatch];
    const TessellatedPrimitive& p = impl_->primitives[info.primitive];
    dice_subpatch(p.dice_context(impl_->metric), p.splits.subpatches[subpatch - p.first_subpatch], grid,
                  *scratch.state, wanted);
    const Subpatch& piece = p.splits.subpatches[subpatch - p.first_subpatch];
    grid.primitive_index = info.primitive;
    grid.ordinal = subpatch;
    grid.seed = seed_of(info.primitive, piece);
}

/// For rays that ask at a point: a grid of one micropolygon is the least that derivatives can be taken of.
int Tessellation::dice_point(const SubpatchPoint& point, ShadingGrid& grid, DiceScratch& scratch) const {
    const SubpatchInfo& info = infos_[point.subpatch];
    const TessellatedPrimitive& p = impl_->primitives[info.primitive];
    const uint32_t primitive = point.primitive.value_or(info.primitive);
    DiceContext context = p.dice_context(impl_->metric);
    context.surface = impl_->primitives[primitive].placed.get();
    const int vertex = trapeze::dice_point(context, p.splits.subpatches[point.subpatch - p.first_subpatch],
                                           point.at, grid, *scratch.state);
    grid.primitive_index = primitive;
    grid.ordinal = point.subpatch;
    return vertex;
}

}  // namespace trapeze
