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

/// Vertices are padded to a multiple of this: 16 floats are a vector of AVX-512, and a cache line of 64
/// bytes.
inline constexpr size_t kLanes = 16;

/// The size of a plane for so many vertices.
constexpr size_t padded_size(size_t vertices) {
    return (vertices + kLanes - 1) / kLanes * kLanes;
}

using Plane = std::span<float>;
using ConstPlane = std::span<const float>;

/// Points, vectors, normals or colours, a plane for each component.
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

    /// A plane from the pool; its contents are undefined.
    Plane take();
    Plane3 take3() { return {take(), take(), take()}; }
    /// The number of vertices that start() was given, not rounded up.
    size_t vertices() const { return vertices_; }

  private:
    struct Free {
        void operator()(float* p) const { std::free(p); }
    };
    std::vector<std::unique_ptr<float, Free>> planes_;
    /// `capacity_`: vertices that every plane has room for; `used_`: planes handed out since start().
    size_t vertices_ = 0, capacity_ = 0, used_ = 0;
};

/// Copies a value for each vertex, or one for all, into a plane; lanes past the last value repeat it.
void load(std::span<const float> values, size_t vertices, Plane plane);
/// Sets all lanes to one value.
void fill(float value, Plane plane);

}  // namespace trapeze
