#include "pipeline/rays/held_scene.h"

#include <algorithm>
#include <cmath>

#include "core/scene/held_camera.h"

namespace trapeze {
namespace {

/// Poses that differ by no more than this, as a part of the largest number in them, are one.
constexpr float kSame = 0x1p-18f;

/// Rounding is no motion: vertices that hardly move cost as much as those that do.
bool is_same(const M44f& a, const M44f& b) {
    float largest = 0, difference = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            largest = std::max(largest, std::abs(a[i][j]));
            difference = std::max(difference, std::abs(a[i][j] - b[i][j]));
        }
    return difference <= kSame * largest;
}

std::vector<M44f> held_poses(const std::vector<M44f>& poses, std::span<const M44f> held) {
    const int keys = poses.size() > 1 ? static_cast<int>(poses.size()) : kHeldKeys;
    std::vector<M44f> all;
    for (int key = 0; key < keys; ++key) {
        const M44f& pose = poses[poses.size() > 1 ? static_cast<size_t>(key) : 0];
        all.emplace_back(M44d(pose) * M44d(held_at(held, key, keys)));
    }
    if (std::ranges::all_of(all, [&](const M44f& pose) { return is_same(pose, poses.front()); }))
        return {poses.front()};
    return all;
}

}  // namespace

std::unique_ptr<const Scene> held_scene(const Scene& scene) {
    if (scene.held_from_camera.empty()) return nullptr;
    auto copy = std::make_unique<Scene>(scene);
    for (Primitive& primitive : copy->primitives)
        primitive.camera_from_object = held_poses(primitive.camera_from_object, scene.held_from_camera);
    return copy;
}

bool rays_sample_motion(const RenderContext& context) {
    return context.motion && std::ranges::any_of(context.scene->primitives, [](const Primitive& primitive) {
               return primitive.attributes->rays.sample_motion;
           });
}

}  // namespace trapeze
