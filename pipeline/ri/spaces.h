/// The transformations that RiTransformPoints asks for (RISpec 4.3), followed beside the requests that are
/// written.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/math.h"
#include "core/scene/scene.h"
#include "pipeline/rib/state/moving_transform.h"

namespace trapeze::ri {

/// The spaces at one time: of a motion block the first key counts. Transformations that archives make are not
/// seen. Matrices are for row vectors.
class Spaces {
  public:
    /// What RISpec's options say of the camera.
    Options camera;

    /// Puts a transformation request (Translate, Rotate...) in front of the current transformation.
    void concat(rib::TransformKind kind, const rib::TransformArguments& arguments);
    /// Sets the current transformation: Identity, or Transform's matrix.
    void set(const M44d& matrix) { current_ = matrix; }
    /// Begins the camera's transformation at Projection: what came before belongs to the screen.
    void begin_camera() { current_ = M44d(); }
    void begin_world();
    void end_world();
    /// Begins an object's definition, whose current space is the object's.
    void begin_object() { current_ = M44d(); }

    /// CoordinateSystem: gives the current space a name.
    void name_current(const std::string& name) { named_[name] = camera_from_current(); }
    /// CoordSysTransform: makes a named space the current one. False when there is none of that name.
    bool use(const std::string& name);

    const M44d& current() const { return current_; }
    void restore(const M44d& current) { current_ = current; }

    /// The matrix from one space to another; nothing for a space that is not known or cannot be inverted.
    std::optional<M44d> between(const std::string& from, const std::string& to) const;

  private:
    M44d camera_from_current() const;
    std::optional<M44d> camera_from(const std::string& name) const;
    std::optional<M44d> from_camera(const std::string& name) const;
    /// The matrix from the camera's space to screen, NDC or raster space.
    std::optional<M44d> projected(const std::string& name) const;

    M44d current_;  ///< from the current space to the world; before WorldBegin, to the camera
    M44d camera_from_world_;
    bool in_world_ = false;
    std::map<std::string, M44d> named_;  ///< from each named space to the camera
};

}  // namespace trapeze::ri
