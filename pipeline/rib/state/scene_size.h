/// What parts of a scene take in memory, about: for a limit, not for accounts.
#pragma once

#include <cstddef>

#include "core/scene/scene.h"

namespace trapeze::rib {

size_t bytes_of(const Shape& shape);
/// Bytes of attributes without what many share: shaders and lights.
size_t bytes_of(const Attributes& attributes);
/// Bytes of a primitive without its shapes, poses and attributes.
size_t bytes_of(const Primitive& primitive);

}  // namespace trapeze::rib
