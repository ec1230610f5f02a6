#include "shade/materials/scene_spaces.h"

#include "shade/materials/picture_spaces.h"

namespace trapeze {
namespace {

/// The inverse of a matrix; a flat space, which has none, stays as it is.
M44d inverse_of(const M44d& m) {
    return m.inverse();
}

}  // namespace

std::optional<M44d> SceneSpaces::camera_from(std::string_view space) const {
    if (space == "current" || space == "camera" || space == "eye" || space == "cameraspace") return M44d();
    if (space == "world") return M44d(scene_.camera_from_world);
    if (space == "shader")
        return shader_ ? M44d(shader_->camera_from_shader) : M44d(scene_.camera_from_world);
    if (space == "object")
        return primitive_ && !primitive_->camera_from_object.empty()
                   ? M44d(primitive_->camera_from_object.front())
                   : M44d(scene_.camera_from_world);
    if (shader_ && shader_->camera_from_scoped)
        if (const auto scoped = shader_->camera_from_scoped->find(std::string(space));
            scoped != shader_->camera_from_scoped->end())
            return M44d(scoped->second);
    if (const auto named = scene_.camera_from_named.find(std::string(space));
        named != scene_.camera_from_named.end())
        return M44d(named->second);
    return camera_from_picture(camera_, space);
}

std::optional<M44f> SceneSpaces::matrix(std::string_view from, std::string_view to) const {
    if (from == to) return M44f();
    const auto camera_from_first = camera_from(from);
    const auto camera_from_second = camera_from(to);
    if (!camera_from_first || !camera_from_second) return {};
    return M44f(*camera_from_first * inverse_of(*camera_from_second));
}

}  // namespace trapeze
