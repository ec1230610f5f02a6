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

/// Those at one time: of a motion block the first key counts. What archives do is not seen.
class Spaces {
  public:
    /// The camera: what RISpec's options say of it.
    Options camera;

    void concat(rib::TransformKind kind, const rib::TransformArguments& arguments);
    /// Identity, or Transform's matrix.
    void set(const M44d& matrix) { current_ = matrix; }
    /// Projection: what came before belongs to the screen.
    void begin_camera() { current_ = M44d(); }
    void begin_world();
    void end_world();
    /// The current space of an object's definition is the object's.
    void begin_object() { current_ = M44d(); }

    void name_current(const std::string& name) { named_[name] = camera_from_current(); }
    /// False when there is none of that name.
    bool use(const std::string& name);

    const M44d& current() const { return current_; }
    void restore(const M44d& current) { current_ = current; }

    /// Row vectors; nothing for a space that is not known or cannot be inverted.
    std::optional<M44d> between(const std::string& from, const std::string& to) const;

  private:
    M44d camera_from_current() const;
    std::optional<M44d> camera_from(const std::string& name) const;
    std::optional<M44d> from_camera(const std::string& name) const;
    /// Screen, NDC or raster space from the camera's.
    std::optional<M44d> projected(const std::string& name) const;

    M44d current_;  ///< to the world, or to the camera before it
    M44d camera_from_world_;
    bool in_world_ = false;
    std::map<std::string, M44d> named_;  ///< to the camera
};

}  // namespace trapeze::ri
