/// Planes: one float for each vertex of a grid, structure of arrays, as kernels and shaders use them.
/// 64-byte aligned; size() is the vertex count rounded up to kLanes, and the lanes past the last vertex
/// repeat it, so that kernels need no remainder and no lane meets a value that no vertex has.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

namespace trapeze {

inline constexpr size_t kLanes = 16;

constexpr size_t padded_size(size_t vertices) {
    return (vertices + kLanes - 1) / kLanes * kLanes;
}

using Plane = std::span<float>;
using ConstPlane = std::span<const float>;

/// Points, vectors, normals or colours.
struct Plane3 {
    Plane x, y, z;

    Plane operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
    size_t size() const { return x.size(); }
};

struct ConstPlane3 {
    ConstPlane x, y, z;

    ConstPlane3() = default;
    ConstPlane3(ConstPlane px, ConstPlane py, ConstPlane pz) : x(px), y(py), z(pz) {}
    ConstPlane3(const Plane3& p) : x(p.x), y(p.y), z(p.z) {}
    ConstPlane operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
    size_t size() const { return x.size(); }
};

/// Hands out planes for one grid at a time; memory is kept from grid to grid. One per thread.
class PlanePool {
  public:
    /// All planes handed out before are given back; those to come fit this many vertices.
    void start(size_t vertices);

    /// Contents are undefined.
    Plane take();
    Plane3 take3() { return {take(), take(), take()}; }
    size_t vertices() const { return vertices_; }

  private:
    struct Free {
        void operator()(float* p) const { std::free(p); }
    };
    std::vector<std::unique_ptr<float, Free>> planes_;
    size_t vertices_ = 0, capacity_ = 0, used_ = 0;
};

/// Copies a value for each vertex, or one for all, into a plane and fills its last lanes.
void load(std::span<const float> values, size_t vertices, Plane plane);
void fill(float value, Plane plane);

}  // namespace trapeze
