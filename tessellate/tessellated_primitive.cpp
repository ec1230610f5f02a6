#include "tessellate/tessellated_primitive.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "tessellate/measure/blur_factor.h"
#include "tessellate/measure/growth_factor.h"
#include "tessellate/out_of_view.h"
#include "tessellate/topology/order_by_face.h"

namespace trapeze {
namespace {

constexpr int kFacesPerTask = 64, kEdgesPerTask = 512;
/// Shading rates below this (in pixels' area) are taken as this: a bound on absurd input.
constexpr float kLeastShadingRate = 1e-4f;
/// Farther from the eye, the rounding of positions is larger than what a camera can tell apart: no piece can
/// be found out of view, and all would be diced.
constexpr float kFarthest = 1e11f;

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

/// Many times the grids that fill the picture: a bound on absurd input, such as a surface that comes near
/// infinity again and again.
size_t most_parts_of_face(const Options& options, const EdgeRate& rate) {
    constexpr double kTimesThePicture = 64, kAtLeast = 1024, kAtMost = 1 << 20;
    const double grid_side = static_cast<double>(kMaxGridSide) * static_cast<double>(rate.pixels_per_segment);
    const double pixels = static_cast<double>(options.width) * options.height;
    return static_cast<size_t>(
        std::clamp(kTimesThePicture * pixels / (grid_side * grid_side), kAtLeast, kAtMost));
}

void tell_limit(const RenderContext& context, const Primitive& primitive, bool is_limited) {
    if (!is_limited) return;
    context.diagnostics->warning(
        primitive.location,
        "a face wants more micropolygons than many times those of the picture; they are made larger",
        "face-limit");
}

}  // namespace

void tessellate_primitive(const TessellatePlan& plan, const Primitive& primitive, TessellatedPrimitive& out) {
    const auto& [context, metric, raster, options, most_listed, listed] = plan;
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
    if (options.larger_where_flat && !out.displaced && displacement_bound == 0) {
        const float times = flat_times(*out.placed, metric, rate.pixels_per_segment);
        out.flat_cuts =
            FlatCuts(metric, rate.pixels_per_segment, times, has_corner_values(primitive.shape()));
        rate.pixels_per_segment *= times;
    }
    out.pixels_per_segment = rate.pixels_per_segment;
    const LineMeasure measure(metric, context.camera, *out.placed, out.displaced, rate.pixels_per_segment,
                              by_rays);
    std::optional<VertexTableMaker> vertices(*out.placed);
    std::vector<FaceEstimate> estimates = estimate_faces(*out.placed, measure, rate, *vertices);
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
    split.flat_cuts = out.flat_cuts;
    if (split.flat_cuts.are_wanted()) cut_estimates(*out.placed, split.flat_cuts, estimates);
    split.estimates = estimates;
    split.displacement_bound = displacement_bound;
    split.most_parts_of_face = most_parts;
    if (options.lists_again) {
        out.relisting = std::make_unique<Relisting>(split);
        out.is_listed = listed < most_listed;
        if (!out.is_listed) return;
    }
    std::optional<Splits> splits = split_all(split, context, most_listed);
    out.is_listed = splits.has_value();
    if (splits) {
        out.splits = std::move(*splits);
        shrink(out.splits);
        listed += out.splits.bytes();
        tell_limit(context, primitive, out.splits.limited);
    } else if (!out.relisting) {
        context.diagnostics->error(
            primitive.location,
            fmt::format("the grids into which it is split take more than {} MiB to list; left out",
                        options.most_bytes >> 20));
        out.leave_out();
    }
}

void count_instead_of_listing(const TessellatePlan& plan, const Primitive& primitive, size_t most_bytes,
                              TessellatedPrimitive& out) {
    out.is_listed = out.relisting->count(plan.context, most_bytes);
    if (out.is_listed) return tell_limit(plan.context, primitive, out.relisting->is_limited());
    plan.context.diagnostics->error(
        primitive.location,
        fmt::format("the grids into which a face of it is split take more than {} MiB to list; left out",
                    most_bytes >> 20));
    out.leave_out();
}

}  // namespace trapeze
