#include "pipeline/compare/blur.h"

#include <algorithm>

namespace trapeze {
namespace {

/// The blur of one micropolygon, in pixels.
struct Blur {
    float motion = 0, defocus = 0;
};

/// The time of a key, 0 to 1 over the shutter.
float key_time(int key, int key_count) {
    return key_count > 1 ? static_cast<float>(key) / static_cast<float>(key_count - 1) : 0.0f;
}

/// The blur of a vertex, over the shutter; false when the vertex is always outside of the clipping range.
bool blur_of_vertex(const Camera& camera, const Grid& grid, int i, int j, Blur& blur) {
    bool seen = false;
    V2f last(0, 0);
    bool has_last = false;
    blur = {};
    for (int key = 0; key < grid.key_count; ++key) {
        const V3f p = grid.vertex(i, j, key_time(key, grid.key_count));
        const bool visible =
            p.z >= camera.near_clip && p.z <= camera.far_clip && (!camera.perspective || p.z > 0);
        if (visible) {
            const V2f half = camera.circle_of_confusion(p.z), at = camera.raster_from_camera(p);
            blur.defocus = std::max(blur.defocus, 2 * std::max(half.x, half.y));
            if (has_last) blur.motion += (at - last).length();
            last = at;
            seen = true;
        }
        has_last = visible;
    }
    return seen;
}

}  // namespace

float weighted_median(std::vector<std::pair<float, uint64_t>> values) {
    std::sort(values.begin(), values.end());
    uint64_t all = 0, below = 0;
    for (const auto& [value, weight] : values) all += weight;
    for (const auto& [value, weight] : values)
        if (below += weight; 2 * below >= all) return value;
    return 0;
}

FrameBlur measure_blur(const Camera& camera, const Grids& grids) {
    FrameBlur frame;
    std::vector<std::pair<float, uint64_t>> defocus, motion;
    for (const Grid& grid : grids.grids) {
        const int nu = grid.shape.nu, nv = grid.shape.nv;
        const int corners[][2] = {{0, 0}, {nu, 0}, {0, nv}, {nu, nv}};
        Blur blur;
        for (const auto& [i, j] : corners)
            if (blur_of_vertex(camera, grid, i, j, blur)) {
                frame.defocus.largest = std::max(frame.defocus.largest, blur.defocus);
                frame.motion.largest = std::max(frame.motion.largest, blur.motion);
            }
        // The middle stands for the grid's micropolygons.
        if (!blur_of_vertex(camera, grid, nu / 2, nv / 2, blur)) continue;
        const auto weight = static_cast<uint64_t>(grid.shape.micropolygon_count());
        defocus.emplace_back(blur.defocus, weight);
        motion.emplace_back(blur.motion, weight);
    }
    frame.defocus.median = weighted_median(std::move(defocus));
    frame.motion.median = weighted_median(std::move(motion));
    return frame;
}

}  // namespace trapeze
