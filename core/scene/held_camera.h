/// Scene::held_from_camera, read at the keys of what moves.
#pragma once

#include <span>

#include "core/math.h"
#include "core/motion_keys.h"

namespace trapeze {

/// The keys that what has none of its own gets from a moving camera.
inline constexpr int kHeldKeys = 17;

/// At one of `keys` keys; at shutter open it is exactly the identity.
inline M44f held_at(std::span<const M44f> held, int key, int keys) {
    if (key == 0 || keys < 2) return M44f();
    return held[static_cast<size_t>(key) * (held.size() - 1) / static_cast<size_t>(keys - 1)];
}

}  // namespace trapeze
