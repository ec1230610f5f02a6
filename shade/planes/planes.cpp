#include "shade/planes/planes.h"

#include <algorithm>
#include <new>

namespace trapeze {

void PlanePool::start(size_t vertices) {
    vertices_ = vertices;
    used_ = 0;
    if (padded_size(vertices) <= capacity_) return;
    capacity_ = padded_size(vertices);
    planes_.clear();
}

Plane PlanePool::take() {
    if (used_ == planes_.size()) {
        void* memory = std::aligned_alloc(64, std::max<size_t>(capacity_, kLanes) * sizeof(float));
        if (!memory) throw std::bad_alloc();
        planes_.emplace_back(static_cast<float*>(memory));
    }
    return {planes_[used_++].get(), padded_size(vertices_)};
}

void load(std::span<const float> values, size_t vertices, Plane plane) {
    const size_t count = std::min({values.size(), vertices, plane.size()});
    std::copy_n(values.begin(), count, plane.begin());
    std::fill(plane.begin() + count, plane.end(), count ? values[count - 1] : 0.0f);
}

void fill(float value, Plane plane) {
    std::fill(plane.begin(), plane.end(), value);
}

}  // namespace trapeze
