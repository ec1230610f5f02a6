/// Things in the order of the faces that they are evaluated on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace trapeze {

/// The numbers of things, sorted by their faces in [0, face_count) and where these are equal by number. In a
/// time that grows with both counts.
inline std::vector<uint32_t> order_by_face(std::span<const int> faces, int face_count) {
    std::vector<uint32_t> next(static_cast<size_t>(face_count) + 1, 0);
    for (const int face : faces) ++next[face + 1];
    for (int face = 0; face < face_count; ++face) next[face + 1] += next[face];
    std::vector<uint32_t> order(faces.size());
    for (uint32_t i = 0; i < faces.size(); ++i) order[next[faces[i]]++] = i;
    return order;
}

}  // namespace trapeze
