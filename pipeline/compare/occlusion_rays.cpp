#include "pipeline/compare/occlusion_rays.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/portable_math.h"
#include "core/random.h"
#include "pipeline/compare/sample_groups.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

/// Of the distance to the camera: how far from what is seen a ray starts, lest it meets that.
constexpr float kStartAt = 1e-3f;

/// Uniform on the sphere, and the same on all machines, as counts of what rays look at are to be.
V3f random_direction(uint32_t index) {
    const float z = 2 * unit_float(hash(index, 0)) - 1, r = std::sqrt(std::max(0.0f, 1 - z * z));
    const float phi = 2 * std::numbers::pi_v<float> * unit_float(hash(index, 1));
    return {r * portable::cos(phi), r * portable::sin(phi), z};
}

SpaceRay ray_from(const AxisRay& seen_by, float depth, uint32_t index) {
    const V3f to_there(seen_by.ux, seen_by.uy, 1);
    V3f direction = random_direction(index);
    if (direction.dot(to_there) > 0) direction = -direction;
    const V3f there(seen_by.ox + seen_by.ux * depth, seen_by.oy + seen_by.uy * depth, depth);
    return {there + direction * (kStartAt * depth), direction, seen_by.time};
}

}  // namespace

std::vector<SpaceRay> occlusion_rays(const SharedFrame& frame, SampleRate rate, size_t sample_bytes) {
    const RenderContext context = frame.context_at(rate);
    std::string error;
    const auto sampler = choose_sampler("raytrace", "", &error);
    const auto pattern = sampler->make_pattern(context);
    const auto visibility = sampler->prepare(context, frame.grids);
    SampleGroups groups(frame.pixels, visibility->tile_side(), rate.per_pixel(), sample_bytes);
    std::vector<SpaceRay> rays;
    uint32_t first = 0;  // of all samples, the first of a tile
    for (size_t g = 0; g < groups.count(); ++g) {
        const auto tiles = groups.make(g, *pattern);
        std::vector<HitBuffer> hits(tiles.size());
        tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t i) {
            SampleScratch scratch;
            SampleStats stats;
            if (!context.is_cancelled()) visibility->resolve(tiles[i], hits[i], scratch, stats);
        });
        if (context.is_cancelled()) return {};
        for (size_t i = 0; i < tiles.size(); ++i) {
            for (size_t s = 0; s < tiles[i].size(); ++s)
                if (const auto seen = hits[i].of(s); !seen.empty())
                    rays.push_back(
                        ray_from(tiles[i].rays[s], seen[0].depth, first + static_cast<uint32_t>(s)));
            first += static_cast<uint32_t>(tiles[i].size());
        }
    }
    return rays;
}

}  // namespace trapeze
