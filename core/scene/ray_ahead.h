/// What a ray that goes on and on behind surfaces has found ahead of where it is.
#pragma once

namespace trapeze {

/// Made by a RayScene and read by it alone. It changes no answer.
class RayAhead {
  public:
    virtual ~RayAhead() = default;
};

}  // namespace trapeze
