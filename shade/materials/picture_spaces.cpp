#include "shade/materials/picture_spaces.h"

namespace trapeze {
namespace {

/// The matrix from screen_from_camera()'s -1..1 to a raster-like space: the screen window, NDC (0..1, y down)
/// or raster (pixels, y down).
M44d screen_to(const Camera& camera, std::string_view space) {
    M44d m;
    const auto scale = [&](double sx, double sy, double tx, double ty) {
        m[0][0] = sx, m[1][1] = sy, m[3][0] = tx, m[3][1] = ty;
    };
    const auto& [left, right, bottom, top] = camera.screen_window;
    if (space == "screen")
        scale((right - left) / 2, (top - bottom) / 2, (right + left) / 2, (top + bottom) / 2);
    else if (space == "NDC")
        scale(0.5, -0.5, 0.5, 0.5);
    else
        scale(0.5 * camera.width, -0.5 * camera.height, 0.5 * camera.width, 0.5 * camera.height);
    return m;
}

}  // namespace

std::optional<M44d> camera_from_picture(const Camera& camera, std::string_view space) {
    if (space != "screen" && space != "NDC" && space != "raster") return {};
    return (M44d(screen_from_camera(camera)) * screen_to(camera, space)).inverse();
}

}  // namespace trapeze
