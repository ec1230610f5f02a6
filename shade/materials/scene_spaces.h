/// Coordinate systems by name, as shaders know them (RISpec 3.2, table 4.1 and section 15.4).
#pragma once

#include "core/scene/camera.h"
#include "core/scene/scene.h"
#include "shade/vm/context.h"

namespace trapeze {

class SceneSpaces : public vm::Spaces {
  public:
    /// Of a shader on a primitive, both of which may be null; at shutter open. All must outlive this.
    SceneSpaces(const Scene& scene, const Camera& camera, const ShaderInstance* shader,
                const Primitive* primitive)
        : scene_(scene), camera_(camera), shader_(shader), primitive_(primitive) {}

    std::optional<M44f> matrix(std::string_view from, std::string_view to) const override;

  private:
    std::optional<M44d> camera_from(std::string_view space) const;

    const Scene& scene_;
    const Camera& camera_;
    const ShaderInstance* shader_;
    const Primitive* primitive_;
};

}  // namespace trapeze
