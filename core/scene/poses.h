/// Matrices of what moves, at evenly spaced keys of the shutter: mixed between them, and without the motion
/// of a camera (Scene::held_from_camera).
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/math.h"
#include "core/motion_keys.h"

namespace trapeze {

/// The keys that what has none of its own gets from a moving camera.
inline constexpr int kHeldKeys = 17;

/// The matrix at a time: matrices are mixed linearly between their keys, as points move between them. Exact
/// at shutter open. At least one key.
template <class Matrix>
Matrix pose_at(std::span<const Matrix> keys, float time01) {
    if (keys.size() == 1 || time01 == 0) return keys.front();
    using Number = typename Matrix::BaseType;
    const MotionSegment at = segment_at(time01, static_cast<int>(keys.size()));
    const auto part = static_cast<Number>(at.local);
    const auto index = static_cast<size_t>(at.index);
    return keys[index] * (1 - part) + keys[index + 1] * part;
}

/// camera_from_object at the keys of a primitive: 1 or 2^m + 1 evenly spaced ones of the shutter. Never
/// changed once made, so that primitives of one place share them.
class SharedPoses {
  public:
    SharedPoses() = default;
    explicit SharedPoses(const M44f& only) : size_(1), keys_(std::make_shared<M44f[]>(1, only)) {}
    SharedPoses(std::span<const M44f> keys) : size_(keys.size()) {
        const auto made = std::make_shared<M44f[]>(keys.size());
        std::ranges::copy(keys, made.get());
        keys_ = made;
    }
    SharedPoses(const std::vector<M44f>& keys) : SharedPoses(std::span(keys)) {}
    SharedPoses(std::initializer_list<M44f> keys) : SharedPoses(std::span(keys.begin(), keys.size())) {}

    size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const M44f* data() const { return keys_.get(); }
    const M44f* begin() const { return data(); }
    const M44f* end() const { return data() + size_; }
    const M44f& front() const { return keys_[0]; }
    const M44f& back() const { return (*this)[size_ - 1]; }
    const M44f& operator[](size_t key) const { return data()[key]; }
    bool operator==(const SharedPoses& other) const { return std::ranges::equal(*this, other); }

  private:
    size_t size_ = 0;
    std::shared_ptr<const M44f[]> keys_;
};

/// Scene::held_from_camera at one of `keys` keys; at shutter open it is exactly the identity.
inline M44f held_at(std::span<const M44f> held, int key, int keys) {
    if (key == 0 || keys < 2) return M44f();
    return held[static_cast<size_t>(key) * (held.size() - 1) / static_cast<size_t>(keys - 1)];
}

/// Whether poses differ by no more than rounding, which is no motion: vertices that hardly move cost as much
/// as those that do.
inline bool is_same_pose(const M44f& a, const M44f& b) {
    constexpr float kSame = 0x1p-18f;  // as a part of the largest number in them
    float largest = 0, difference = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            largest = std::max(largest, std::abs(a[i][j]));
            difference = std::max(difference, std::abs(a[i][j] - b[i][j]));
        }
    return difference <= kSame * largest;
}

/// Poses (camera_from_..., one or more keys) as a camera that stays where it is at shutter open has them;
/// one, where nothing moves then.
inline std::vector<M44f> held_poses(std::span<const M44f> poses, std::span<const M44f> held) {
    const int keys = poses.size() > 1 ? static_cast<int>(poses.size()) : held.empty() ? 1 : kHeldKeys;
    std::vector<M44f> all;
    for (int key = 0; key < keys; ++key) {
        const M44f& pose = poses[poses.size() > 1 ? static_cast<size_t>(key) : 0];
        all.emplace_back(held.empty() ? pose : M44f(M44d(pose) * M44d(held_at(held, key, keys))));
    }
    if (std::ranges::all_of(all, [&](const M44f& pose) { return is_same_pose(pose, poses.front()); }))
        return {poses.front()};
    return all;
}

}  // namespace trapeze
