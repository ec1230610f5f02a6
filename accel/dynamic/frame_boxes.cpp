#include "accel/dynamic/frame_boxes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "accel/builders/grid_pose.h"
#include "accel/builders/micropolygon_boxes.h"
#include "core/hyper_trapezoid.h"

namespace trapeze {
namespace {

/// What a frame's grids have in common, and one grid's part of it.
struct ShutterExtent {
    float absolute_max = 0, quad_extent = 0;
};

/// Sets the boxes of a grid's micropolygons.
ShutterExtent boxes_of_shutter(const Grid& grid, KeyBox* boxes) {
    ShutterExtent extent;
    std::fill_n(boxes, grid.shape.micropolygon_count(), empty_box());
    GridPose vertices;
    for (int key = 0; key < grid.key_count; ++key) {
        extent.absolute_max = std::max(extent.absolute_max, vertices.read(grid, key));
        vertices.for_each_box([&](int i, const Box3f& pose) {
            const V3f size = pose.max - pose.min;
            extent.quad_extent = std::max({extent.quad_extent, size.x, size.y, size.z});
            const Box3f grown = grown_for_rounding(pose);
            for (int k = 0; k < 3; ++k) {
                boxes[i].low[k] = std::min(boxes[i].low[k], grown.min[k]);
                boxes[i].high[k] = std::max(boxes[i].high[k], grown.max[k]);
            }
        });
    }
    return extent;
}

}  // namespace

void FrameBoxes::read(const Grids& frame) {
    grids = &frame;
    const size_t count = frame.grids.size();
    std::vector<uint32_t>& first = first_;
    first.assign(count + 1, 0);
    for (size_t g = 0; g < count; ++g)
        first[g + 1] = first[g] + static_cast<uint32_t>(frame.grids[g].shape.micropolygon_count());
    boxes.resize(first[count]);
    ids.resize(first[count]);
    std::vector<ShutterExtent> extents(count);
    tbb::parallel_for(size_t{0}, count, [&](size_t g) {
        const Grid& grid = frame.grids[g];
        for (int i = 0; i < grid.shape.micropolygon_count(); ++i)
            ids[first[g] + static_cast<uint32_t>(i)] = micropolygon_of_grid(g, grid.shape, i);
        extents[g] = boxes_of_shutter(grid, boxes.data() + first[g]);
    });
    // Grids that cannot be bounded are taken out, and what comes after them moves up: objects count without
    // gaps.
    unbounded.clear();
    absolute_max = quad_extent = 0;
    size_t kept = 0;
    for (size_t g = 0; g < count; ++g) {
        const auto from = static_cast<std::ptrdiff_t>(first[g]),
                   to = static_cast<std::ptrdiff_t>(first[g + 1]);
        if (!std::isfinite(extents[g].absolute_max)) {
            unbounded.insert(unbounded.end(), ids.begin() + from, ids.begin() + to);
            continue;
        }
        absolute_max = std::max(absolute_max, extents[g].absolute_max);
        quad_extent = std::max(quad_extent, extents[g].quad_extent);
        if (kept < first[g]) {
            std::copy(ids.begin() + from, ids.begin() + to, ids.begin() + static_cast<std::ptrdiff_t>(kept));
            std::copy(boxes.begin() + from, boxes.begin() + to,
                      boxes.begin() + static_cast<std::ptrdiff_t>(kept));
        }
        kept += first[g + 1] - first[g];
    }
    ids.resize(kept);
    boxes.resize(kept);
}

bool FrameBoxes::reread(const Grids& frame, std::span<const uint32_t> changed) {
    if (!grids || frame.grids.size() + 1 != first_.size() || !unbounded.empty()) return false;
    std::vector<KeyBox> fresh;
    std::vector<ShutterExtent> extents;
    for (const uint32_t g : changed) {
        const Grid& grid = frame.grids[g];
        const auto count = static_cast<uint32_t>(grid.shape.micropolygon_count());
        if (first_[g + 1] - first_[g] != count) return false;
        fresh.resize(fresh.size() + count);
        const ShutterExtent extent = boxes_of_shutter(grid, fresh.data() + fresh.size() - count);
        if (!std::isfinite(extent.absolute_max)) return false;
        extents.push_back(extent);
    }
    // All boxes of the changed grids are made by now: only from here on is anything overwritten.
    grids = &frame;
    const KeyBox* from = fresh.data();
    for (const uint32_t g : changed)
        for (uint32_t object = first_[g]; object < first_[g + 1]; ++object) boxes[object] = *from++;
    for (const ShutterExtent& extent : extents) {
        absolute_max = std::max(absolute_max, extent.absolute_max);
        quad_extent = std::max(quad_extent, extent.quad_extent);
    }
    return true;
}

KeyBox empty_box() {
    KeyBox box;
    for (int k = 0; k < 3; ++k)
        box.low[k] = std::numeric_limits<float>::infinity(), box.high[k] = -box.low[k];
    return box;
}

bool is_empty(const KeyBox& box) {
    return box.low[0] > box.high[0];
}

KeyBox joined(const KeyBox& a, const KeyBox& b) {
    KeyBox box;
    for (int k = 0; k < 4; ++k) {
        box.low[k] = b.low[k] < a.low[k] ? b.low[k] : a.low[k];
        box.high[k] = b.high[k] > a.high[k] ? b.high[k] : a.high[k];
    }
    return box;
}

bool holds(const KeyBox& outer, const KeyBox& inner) {
    bool all = true;
    for (int k = 0; k < 3; ++k) all &= (outer.low[k] <= inner.low[k]) & (inner.high[k] <= outer.high[k]);
    return all;
}

bool same_box(const KeyBox& a, const KeyBox& b) {
    bool all = true;
    for (int k = 0; k < 3; ++k) all &= (a.low[k] == b.low[k]) & (a.high[k] == b.high[k]);
    return all;
}

float half_area_of(const KeyBox& box) {
    if (is_empty(box)) return 0;
    const float x = box.high[0] - box.low[0], y = box.high[1] - box.low[1], z = box.high[2] - box.low[2];
    return x * y + y * z + z * x;
}

}  // namespace trapeze
