#include "sample/methods/moving_quad.h"

#include "sample/visibility.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sample/methods/moving_quad.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include "core/hit_micropolygon-inl.h"
#include "core/simd/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

/// find_hits() with corners that `vertex(component, corner, lane's segment, local time)` places. A lane's
/// segment and local time follow from its ray's time; what `place` does with them differs by the number of
/// keys, so that still quads load nothing and quads of two keys gather nothing.
template <class Place>
HWY_INLINE size_t find_hits_placed(const RayPlanes& rays, size_t first, size_t count, const MovingQuad& quad,
                                   uint32_t* found, float* found_depth, const Place& place) {
    const hn::ScalableTag<float> d;
    const size_t lanes = hn::Lanes(d);
    size_t hit_count = 0;
    for (size_t i = first; i < first + count; i += lanes) {
        const auto at = segments_at(d, hn::LoadU(d, rays.time + i), quad.key_count);
        const auto vertex = [&](int component, int corner)
                                HWY_ATTR { return place(d, component, corner, at.index, at.local); };
        auto depth = hn::Zero(d);
        auto hit = hit_micropolygon(d, hn::LoadU(d, rays.ox + i), hn::LoadU(d, rays.oy + i), hn::Zero(d),
                                    hn::LoadU(d, rays.ux + i), hn::LoadU(d, rays.uy + i), vertex, quad.facing,
                                    depth);
        hit = hn::And(hit, hn::FirstN(d, first + count - i));
        if (hn::AllFalse(d, hit)) continue;
        HWY_ALIGN float depths[hn::MaxLanes(d)];
        HWY_ALIGN float is_hit[hn::MaxLanes(d)];
        hn::Store(depth, d, depths);
        hn::Store(hn::IfThenElseZero(hit, hn::Set(d, 1.0f)), d, is_hit);
        for (size_t lane = 0; lane < lanes; ++lane) {
            if (is_hit[lane] == 0) continue;
            found[hit_count] = static_cast<uint32_t>(i + lane), found_depth[hit_count] = depths[lane];
            ++hit_count;
        }
    }
    return hit_count;
}

/// Three forms by the number of keys, since corners at a ray's time are most of the work: as they are, along
/// one segment, or by a look-up of the segment.
size_t find_hits(const RayPlanes& rays, size_t first, size_t count, const MovingQuad& quad, uint32_t* found,
                 float* depth) {
    if (quad.key_count == 1) {
        const auto still = [&quad](auto d, int component, int corner, auto, auto)
                               HWY_ATTR { return hn::Set(d, quad.start[component][corner][0]); };
        return find_hits_placed(rays, first, count, quad, found, depth, still);
    }
    if (quad.key_count == 2) {
        const auto linear = [&quad](auto d, int component, int corner, auto, auto local) HWY_ATTR {
            return position_at(hn::Set(d, quad.start[component][corner][0]),
                               hn::Set(d, quad.delta[component][corner][0]), local);
        };
        return find_hits_placed(rays, first, count, quad, found, depth, linear);
    }
    // Rays of one vector may be in different segments: each lane gathers its own.
    const auto piecewise = [&quad](auto d, int component, int corner, auto segment, auto local) HWY_ATTR {
        return position_at(hn::GatherIndex(d, quad.start[component][corner], segment),
                           hn::GatherIndex(d, quad.delta[component][corner], segment), local);
    };
    return find_hits_placed(rays, first, count, quad, found, depth, piecewise);
}

/// What HWY_DYNAMIC_DISPATCH chose, and so what all kernels of the program run on.
std::string_view target_name() {
    return hwy::TargetName(HWY_TARGET);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(find_hits);
HWY_EXPORT(target_name);

/// Corners in the order (0,0), (1,0), (0,1), (1,1) of the micropolygon; by segments of motion, each with its
/// start and the way to its end.
MovingQuad::MovingQuad(const Grid& grid, int u, int v) : key_count(grid.key_count), facing(grid.facing) {
    for (int corner = 0; corner < 4; ++corner) {
        const int at = grid.shape.tiled_index(u + (corner & 1), v + (corner >> 1));
        for (int segment = 0; segment < segment_count(key_count); ++segment)
            for (int k = 0; k < 3; ++k) {
                start[k][corner][segment] = grid.plane(segment, k)[at];
                delta[k][corner][segment] = grid.moves() ? grid.plane(segment, 3 + k)[at] : 0.0f;
            }
    }
}

size_t find_hits(const RayPlanes& rays, size_t first, size_t count, const MovingQuad& quad, uint32_t* found,
                 float* depth) {
    return HWY_DYNAMIC_DISPATCH(find_hits)(rays, first, count, quad, found, depth);
}

std::string_view simd_target_name() {
    return HWY_DYNAMIC_DISPATCH(target_name)();
}

}  // namespace trapeze
#endif  // HWY_ONCE
