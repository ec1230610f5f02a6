#include "pipeline/study/aff/aff_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/study/aff/aff_parser.h"

namespace trapeze {
namespace {

/// 0 0 0 where it is beyond what floats can say.
V3f float_place(const V3d& place) {
    constexpr double kMost = std::numeric_limits<float>::max();
    const bool fits = std::abs(place.x) <= kMost && std::abs(place.y) <= kMost && std::abs(place.z) <= kMost;
    return fits ? V3f(place) : V3f(0, 0, 0);
}

}  // namespace

V3f AffMovingTriangle::corner_at(double time, size_t corner) const {
    const auto after = std::ranges::upper_bound(times, time);
    const auto next = static_cast<size_t>(after - times.begin());
    if (next == 0) return corners[corner];
    const V3f& from = corners[3 * (next - 1) + corner];
    if (after == times.end()) return from;
    const double u = (time - times[next - 1]) / (times[next] - times[next - 1]);
    return V3f(V3d(from) + u * (V3d(corners[3 * next + corner]) - V3d(from)));
}

std::optional<AffScene> AffScene::read(const std::string& path, std::string* problem) {
    AffScene scene;
    if (!read_aff(path, &scene.contents_, problem)) return {};
    return scene;
}

AffCamera AffScene::camera_at(double time) const {
    AffCamera camera = contents_.camera;
    if (!contents_.camera_animation) return camera;
    const AffAnimation& animation = *contents_.camera_animation;
    V3d view = V3d(camera.at) - V3d(camera.from), from(camera.from), up(camera.up);
    if (animation.translation) from = animation.translation->at(time);
    if (animation.rotation) {
        const M44d rotation = animation.rotation->at(time).toMatrix44();
        view = V3d(0, 0, -1) * rotation, up = V3d(0, 1, 0) * rotation;
    }
    camera.from = float_place(from), camera.at = float_place(from + view), camera.up = float_place(up);
    return camera;
}

std::vector<V3f> AffScene::triangles_at(double time) const {
    const std::vector<AffPlacement> placements = contents_.transforms.at(time);
    std::vector<V3f> corners = contents_.corners;
    for (const AffMovingTriangle& moving : contents_.moving) {
        const double moment = placements[static_cast<size_t>(moving.transform)].time;
        for (size_t corner = 0; corner < 3; ++corner)
            corners[3 * moving.triangle + corner] = moving.corner_at(moment, corner);
    }
    for (const AffRun& run : contents_.runs) {
        const M44d& world_from_local = placements[static_cast<size_t>(run.transform)].world_from_local;
        for (size_t i = 3 * run.begin; i < 3 * run.end; ++i)
            corners[i] = float_place(V3d(corners[i]) * world_from_local);
    }
    return corners;
}

std::vector<bool> AffScene::moving() const {
    std::vector<bool> moves(contents_.corners.size() / 3);
    for (const AffRun& run : contents_.runs)
        if (contents_.transforms.moves(run.transform))
            std::fill(moves.begin() + static_cast<std::ptrdiff_t>(run.begin),
                      moves.begin() + static_cast<std::ptrdiff_t>(run.end), true);
    for (const AffMovingTriangle& moving : contents_.moving) moves[moving.triangle] = true;
    return moves;
}

}  // namespace trapeze
