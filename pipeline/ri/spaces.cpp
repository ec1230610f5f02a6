#include "pipeline/ri/spaces.h"

#include <cmath>

#include "core/scene/camera.h"

namespace trapeze::ri {
namespace {

std::optional<M44d> inverse_of(const M44d& matrix) {
    const double determinant = matrix.determinant();
    if (determinant == 0 || !std::isfinite(determinant)) return {};
    return matrix.inverse();
}

/// The matrix from the space in which the screen window spans [-1, 1] to NDC, 0 to 1 and y down.
M44d ndc_from_window() {
    return M44d(0.5, 0, 0, 0, 0, -0.5, 0, 0, 0, 0, 1, 0, 0.5, 0.5, 0, 1);
}

}  // namespace

void Spaces::concat(rib::TransformKind kind, const rib::TransformArguments& arguments) {
    current_ = rib::transform_matrix(kind, arguments) * current_;
}

void Spaces::begin_world() {
    camera_from_world_ = current_;
    current_ = M44d();
    in_world_ = true;
}

void Spaces::end_world() {
    current_ = camera_from_world_;
    in_world_ = false;
}

bool Spaces::use(const std::string& name) {
    const auto to_camera = camera_from(name);
    const auto from_root = in_world_ ? inverse_of(camera_from_world_) : std::optional(M44d());
    if (!to_camera || !from_root) return false;
    current_ = *to_camera * *from_root;
    return true;
}

M44d Spaces::camera_from_current() const {
    return in_world_ ? current_ * camera_from_world_ : current_;
}

std::optional<M44d> Spaces::camera_from(const std::string& name) const {
    if (const auto named = named_.find(name); named != named_.end()) return named->second;
    if (name == "current" || name == "object" || name == "shader") return camera_from_current();
    if (name == "camera") return M44d();
    if (name == "world") return in_world_ ? camera_from_world_ : camera_from_current();
    const auto matrix = projected(name);
    return matrix ? inverse_of(*matrix) : std::nullopt;
}

std::optional<M44d> Spaces::projected(const std::string& name) const {
    if (name != "screen" && name != "NDC" && name != "raster") return {};
    const Camera made = make_camera(camera);
    const M44d window(screen_from_camera(made));
    if (name == "NDC") return window * ndc_from_window();
    if (name == "raster")
        return window * ndc_from_window() * M44d().setScale(V3d(made.width, made.height, 1));
    const double width = double{made.right} - made.left, height = double{made.top} - made.bottom;
    return window * M44d(width / 2, 0, 0, 0, 0, height / 2, 0, 0, 0, 0, 1, 0, (made.left + made.right) / 2.0,
                         (made.bottom + made.top) / 2.0, 0, 1);
}

std::optional<M44d> Spaces::from_camera(const std::string& name) const {
    if (const auto matrix = projected(name)) return matrix;
    const auto matrix = camera_from(name);
    return matrix ? inverse_of(*matrix) : std::nullopt;
}

std::optional<M44d> Spaces::between(const std::string& from, const std::string& to) const {
    const auto first = camera_from(from);
    const auto second = from_camera(to);
    if (!first || !second) return {};
    return *first * *second;
}

}  // namespace trapeze::ri
