/// Some of a surface's faces, evenly spread over it, which stand for all where a factor is a wish and no
/// bound.
#pragma once

#include <algorithm>

namespace trapeze {

/// Calls visit(face) for 64 to 127 of the faces, or all of fewer.
template <typename Visit>
void for_some_faces(int face_count, const Visit& visit) {
    constexpr int kLeast = 64;
    for (int face = 0, step = std::max(1, face_count / kLeast); face < face_count; face += step) visit(face);
}

}  // namespace trapeze
