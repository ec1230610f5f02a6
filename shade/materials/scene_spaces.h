/// Coordinate systems by name, as shaders know them (RISpec 3.2, table 4.1 and section 15.4).
#pragma once

#include "core/scene/camera.h"
#include "core/scene/scene.h"
#include "shade/vm/context.h"

namespace trapeze {

class SceneSpaces : public vm::Spaces {
    /// The named spaces of one shader on one primitive.
  public:
    /// The shader and the primitive may be null: "shader" and "object" are then the world. Spaces that move
    /// are taken as the shutter opens. All must outlive this.
    SceneSpaces(const Scene& scene, const Camera& camera, const ShaderInstance* shader,
                const Primitive* primitive)
        : scene_(scene), camera_(camera), shader_(shader), primitive_(primitive) {}

    /// The matrix that takes points (row vectors) from one space to the other; nothing for a name that is not
    /// known.
    std::optional<M44f> matrix(std::string_view from, std::string_view to) const override;

  private:
    std::optional<M44d> camera_from(std::string_view space) const;

    const Scene& scene_;
    const Camera& camera_;
    const ShaderInstance* shader_;
    const Primitive* primitive_;
};

}  // namespace trapeze
