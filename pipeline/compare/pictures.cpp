#include "pipeline/compare/pictures.h"

#include <algorithm>
#include <cmath>

#include "pipeline/compare/frame_parts.h"
#include "pipeline/compare/peak_memory.h"
#include "pipeline/frame/cost/progress.h"
#include "pipeline/frame/tiles/tile_order.h"

namespace trapeze {
namespace {

/// Apart from the frame's own random numbers, so that no method's samples are among the reference's.
constexpr uint32_t kReferenceSeed = 0x52454652;

/// Renders the shared grids with one sampler. `with_heat`: also counts what the pixels' samples cost.
std::optional<MethodPicture> resolve(const SharedFrame& frame, const RenderContext& context,
                                     const Sampler& sampler, const std::function<void(double)>& on_progress,
                                     bool with_heat) {
    const auto pattern = sampler.make_pattern(context);
    HeatMap heat(with_heat ? frame.pixels : PixelRect{});
    Film film(context);
    FrameStats stats;
    Progress progress(on_progress);
    std::optional<size_t> most_bytes;
    const std::vector<FramePart> parts = parts_of(frame, sampler.build_memory());
    for (size_t i = 0; i < parts.size() && !context.is_cancelled(); ++i) {
        const FramePart& part = parts[i];
        const PeakMemory peak;
        const auto visibility = sampler.prepare(context, *part.grids);
        if (const auto bytes = peak.bytes()) most_bytes = std::max(most_bytes.value_or(0), *bytes);
        progress.begin_part(
            static_cast<double>(i) / parts.size(), static_cast<double>(i + 1) / parts.size(),
            tiles_of(part.pixels, context.sample_levels > 1 ? kTileSide : visibility->tile_side()).size());
        resolve_tiles(context, part.pixels, *part.grids, *visibility, *pattern, film, stats,
                      [&progress] { progress.step(); },
                      {{context.most_layers}, TileOrder::Rows, with_heat ? &heat : nullptr});
    }
    if (context.is_cancelled()) return {};
    return MethodPicture{film.finish(), std::move(heat), most_bytes};
}

/// The part of a map that a picture shows: samples are taken beyond its border too.
HeatMap cut(const HeatMap& heat, const PixelRect& pixels) {
    HeatMap part(pixels);
    for (int y = pixels.y0; y < pixels.y1; ++y)
        for (int x = pixels.x0; x < pixels.x1; ++x) {
            part.tests[part.index(x, y)] = heat.tests[heat.index(x, y)];
            part.nodes[part.index(x, y)] = heat.nodes[heat.index(x, y)];
            part.samples[part.index(x, y)] = heat.samples[heat.index(x, y)];
        }
    return part;
}

}  // namespace

std::optional<MethodPicture> make_picture(const SharedFrame& frame, const Sampler& sampler, SampleRate rate,
                                          const std::function<void(double)>& on_progress, float variance) {
    const RenderContext context =
        variance > 0 ? frame.adaptive_context(rate, variance) : frame.context_at(rate);
    auto picture = resolve(frame, context, sampler, on_progress, true);
    if (picture) picture->heat = cut(picture->heat, picture->image.window);
    return picture;
}

std::optional<Image> make_reference(const SharedFrame& frame, int side,
                                    const std::function<void(double)>& on_progress) {
    RenderContext context = frame.context_at({side, side});
    context.seed ^= kReferenceSeed;
    std::string error;
    const auto sampler = choose_sampler("raytrace", "stratified", &error);
    auto picture = resolve(frame, context, *sampler, on_progress, false);
    if (!picture) return {};
    return std::move(picture->image);
}

double rms_difference(const Image& a, const Image& b) {
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < a.rgba.size(); ++i) {
        if (i % 4 == 3) continue;
        const double difference = static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]);
        sum += difference * difference;
        ++count;
    }
    return count ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

}  // namespace trapeze
