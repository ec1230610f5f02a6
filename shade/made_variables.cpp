#include "shade/made_variables.h"

namespace trapeze {
namespace {

constexpr const char* kAlbedo = "albedo";
constexpr const char* kMotion = "motion";

/// From where a vertex is as the shutter opens to where it is as it closes.
V3f seen_motion(const V3f& open, const V3f& close, const Camera& camera) {
    if (camera.perspective && (open.z <= camera.near_clip || close.z <= camera.near_clip)) return V3f(0);
    const V2f from = camera.raster_from_camera(open), to = camera.raster_from_camera(close);
    return {to.x - from.x, from.y - to.y, close.z - open.z};
}

}  // namespace

bool is_made_variable(const Aov& aov) {
    return aov.channels == 3 && (aov.name == kAlbedo || aov.name == kMotion);
}

void make_variable(const Aov& aov, const Camera& camera, ShadingGrid& grid) {
    const size_t count = grid.vertex_count();
    const auto channel = [&](int c) -> std::vector<float>& {
        return grid.aovs[static_cast<size_t>(aov.offset + c)];
    };
    for (int c = 0; c < 3; ++c) channel(c).assign(count, 0.0f);
    if (aov.name == kMotion && grid.P.size() < 2) return;
    for (size_t i = 0; i < count; ++i) {
        const V3f value = aov.name == kMotion ? seen_motion(grid.P.front().at(i), grid.P.back().at(i), camera)
                                              : grid.Cs.at(i) * grid.Os.at(i);
        for (int c = 0; c < 3; ++c) channel(c)[i] = value[c];
    }
}

}  // namespace trapeze
