#include "shade/materials/scene_spaces.h"

namespace trapeze {
namespace {

/// The inverse of a matrix; a flat space, which has none, stays as it is.
M44d inverse_of(const M44d& m) {
    return m.inverse();
}

/// The matrix from screen_from_camera()'s -1..1 to a raster-like space: the screen window, NDC (0..1, y down)
/// or raster (pixels, y down).
M44d screen_to(const Camera& camera, std::string_view space) {
    M44d m;
    const auto scale = [&](double sx, double sy, double tx, double ty) {
        m[0][0] = sx, m[1][1] = sy, m[3][0] = tx, m[3][1] = ty;
    };
    if (space == "screen")
        scale((camera.right - camera.left) / 2, (camera.top - camera.bottom) / 2,
              (camera.right + camera.left) / 2, (camera.top + camera.bottom) / 2);
    else if (space == "NDC")
        scale(0.5, -0.5, 0.5, 0.5);
    else
        scale(0.5 * camera.width, -0.5 * camera.height, 0.5 * camera.width, 0.5 * camera.height);
    return m;
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
    if (space == "screen" || space == "NDC" || space == "raster")
        return inverse_of(M44d(screen_from_camera(camera_)) * screen_to(camera_, space));
    return {};
}

std::optional<M44f> SceneSpaces::matrix(std::string_view from, std::string_view to) const {
    if (from == to) return M44f();
    const auto camera_from_first = camera_from(from);
    const auto camera_from_second = camera_from(to);
    if (!camera_from_first || !camera_from_second) return {};
    return M44f(*camera_from_first * inverse_of(*camera_from_second));
}

}  // namespace trapeze
