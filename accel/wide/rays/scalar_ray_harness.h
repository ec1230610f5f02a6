/// The scalar twin of accel/wide/rays/single_ray.h: a ray through a WideTree in plain C++, one child, one box
/// and one micropolygon after another. What tests compare vectors with and benchmarks measure them by.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "accel/grid_block.h"
#include "accel/hit_policies.h"
#include "accel/slabs.h"
#include "accel/wide/bfloat16.h"
#include "accel/wide/wide_tree.h"

namespace trapeze::testing {

/// Closest or any hit, by what the policy keeps.
template <class Policy>
class ScalarRay {
  public:
    static Policy traced(const WideTree& tree, const SpaceRay& space, DepthRange range) {
        TraceRay ray = TraceRay::turned(axis_ray(space), range);
        Policy policy;
        ScalarRay(tree, ray, policy).run();
        return policy;
    }

  private:
    struct Child {
        float depth;
        uint32_t link;
    };
    /// Micropolygons from (u, v) on.
    struct Rectangle {
        int u, v, nu, nv;
    };

    ScalarRay(const WideTree& tree, TraceRay& ray, Policy& policy)
        : tree_(tree),
          ray_(ray),
          policy_(policy),
          pad_(ray.rounding(tree.absolute_max())),
          slack_(tree.max_extent() + pad_) {
        for (int k = 0; k < 3; ++k) origin_[k] = ray.origin[k], inverse_[k] = inverse_of(ray.direction[k]);
    }

    void run() {
        for (const uint32_t grid : tree_.unbounded_grids()) {
            const GridShape& shape = tree_.grids().grids[grid].shape;
            test_micropolygons(grid, {0, 0, shape.nu, shape.nv});
        }
        if (tree_.node_count() > 0) visit(0);
    }

    /// One over a component of a direction, finite even where that is 0.
    static float inverse_of(float direction) {
        return 1.0f / (std::abs(direction) < kLeastDirection ? kLeastDirection : direction);
    }

    /// The depths between which the ray is inside a box at a time; all bounds grown by `pad_`. Null deltas:
    /// the box stands still.
    DepthInterval slab_depths(const float* low, const float* high, const float* low_delta,
                              const float* high_delta, size_t stride, float time, const float* origin,
                              const float* inverse) const {
        DepthInterval inside{-HUGE_VALF, HUGE_VALF};
        for (size_t k = 0; k < 3; ++k) {
            const float l = low[k * stride] + (low_delta ? time * low_delta[k * stride] : 0.0f) - pad_;
            const float h = high[k * stride] + (high_delta ? time * high_delta[k * stride] : 0.0f) + pad_;
            const float a = (l - origin[k]) * inverse[k], b = (h - origin[k]) * inverse[k];
            inside.near = std::max(inside.near, std::min(a, b));
            inside.far = std::min(inside.far, std::max(a, b));
        }
        return inside;
    }

    /// A node's children that the ray may hit, from near to far; ends when the nearest hit is in front of the
    /// rest.
    void visit(uint32_t index) {
        const WideNode& node = tree_.nodes()[index];
        float low_delta[3][WideNode::kChildren], high_delta[3][WideNode::kChildren];
        const bool moves = tree_.moves();
        for (int k = 0; moves && k < 3; ++k)
            for (int i = 0; i < WideNode::kChildren; ++i) {
                low_delta[k][i] = from_bfloat16(tree_.node_motions()[index].low[k][i]);
                high_delta[k][i] = from_bfloat16(tree_.node_motions()[index].high[k][i]);
            }
        std::array<Child, WideNode::kChildren> met;
        int count = 0;
        for (int i = 0; i < WideNode::kChildren && node.child[i] != kNoLink; ++i) {
            float depth;
            if (slab_depths(&node.low[0][i], &node.high[0][i], moves ? &low_delta[0][i] : nullptr,
                            moves ? &high_delta[0][i] : nullptr, WideNode::kChildren, ray_.axis.time, origin_,
                            inverse_)
                    .meets(ray_, slack_, depth))
                met[static_cast<size_t>(count++)] = {depth, node.child[i]};
        }
        std::sort(met.begin(), met.begin() + count, [](const Child& a, const Child& b) {
            return a.depth < b.depth || (a.depth == b.depth && a.link < b.link);
        });
        for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
            if (met[i].depth > ray_.t_max) return;
            if (met[i].link & kGridLink)
                visit_grid(met[i].link & ~kGridLink);
            else
                visit(met[i].link);
        }
    }

    /// The ray in the grid's axes against its boxes at the ray's time, one after another, then against all
    /// micropolygons in those it meets.
    void visit_grid(uint32_t index) {
        const WideGrid& record = tree_.grid(index);
        const MotionSegment segment = segment_at(ray_.axis.time, record.key_count);
        BoxPlanes boxes;
        tree_.decode(record, segment.index, boxes);
        const GridAxes axes = record.axes.unpacked();
        constexpr size_t kStride = BoxPlanes::kMost;
        float origin[3], inverse[3];
        for (int k = 0; k < 3; ++k) {
            const float* a = axes.axis[k];
            origin[k] = a[0] * ray_.origin.x + a[1] * ray_.origin.y + a[2] * ray_.origin.z;
            inverse[k] =
                inverse_of(a[0] * ray_.direction.x + a[1] * ray_.direction.y + a[2] * ray_.direction.z);
        }
        for (int box = 0; box < record.box_count(); ++box) {
            const float* at = boxes.values + box;
            float depth;
            if (!slab_depths(at, at + 3 * kStride, record.moves() ? at + 6 * kStride : nullptr,
                             record.moves() ? at + 9 * kStride : nullptr, kStride, segment.local, origin,
                             inverse)
                     .meets(ray_, slack_, depth))
                continue;
            const int first = box * record.blocks_per_box();
            const int last = std::min(first + record.blocks_per_box(), record.block_count());
            for (int block = first; block < last; ++block) {
                const int u = block % record.blocks_u() * 4, v = block / record.blocks_u() * 4;
                test_micropolygons(index, {u, v, std::min(4, record.nu - u), std::min(4, record.nv - v)});
            }
        }
    }

    /// Shows the policy which micropolygons of a grid the ray hits.
    void test_micropolygons(uint32_t index, const Rectangle& some) {
        const Grid& grid = tree_.grids().grids[index];
        for (int v = some.v; v < some.v + some.nv; ++v)
            for (int u = some.u; u < some.u + some.nu; ++u) {
                const Quad quad =
                    grid.quad(u, v, ray_.axis.time, ray_.planes[0], ray_.planes[1], ray_.planes[2]);
                float z;
                if (!hit_micropolygon(ray_.axis, quad, facing_along(grid.facing, ray_.sign), &z)) continue;
                const MicropolygonId id{index, static_cast<uint8_t>(u), static_cast<uint8_t>(v)};
                const Hit hit{ray_.depth_of(z), id.packed()};
                if (hit.depth >= ray_.t_min && hit.depth <= ray_.t_max)
                    policy_.consider(hit, grid.opaque, ray_);
            }
    }

    const WideTree& tree_;
    TraceRay& ray_;
    Policy& policy_;
    float pad_, slack_;
    float origin_[3], inverse_[3];
};

}  // namespace trapeze::testing
