#include "pipeline/rays/held_scene.h"

#include <algorithm>

#include "core/scene/poses.h"

namespace trapeze {
std::unique_ptr<Scene> held_scene(const Scene& scene) {
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
