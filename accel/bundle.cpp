#include "accel/bundle.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "accel/bundle_scratch.h"
#include "accel/grid_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/bundle.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#ifndef TRAPEZE_ACCEL_BUNDLE_ONCE
#define TRAPEZE_ACCEL_BUNDLE_ONCE
namespace trapeze::bundle_detail {

/// Directions nearer to a slab's plane than this are taken as this.
inline constexpr float kLeastDirection = 1e-18f;

/// Fewer active rays than this go through a grid one by one, lanes being blocks.
inline constexpr size_t kFewInGrid = 4;
/// Finding a block's slabs pays for so many rays.
inline constexpr size_t kFewForSlabs = 12;
/// Fewer rays than this are tested one by one, lanes being micropolygons.
inline constexpr size_t kFewInBlock = 3;

/// Unsigned integers in the order of the floats.
inline uint32_t ordered_bits(float value) {
    const auto bits = std::bit_cast<uint32_t>(value);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}
inline float from_ordered_bits(uint32_t bits) {
    return std::bit_cast<float>(bits & 0x80000000u ? bits & 0x7fffffffu : ~bits);
}

struct TraceInput {
    const WideTree& tree;
    DepthRange range;
    float inverse_focal;
    RayBundle& rays;
    BundleScratch& scratch;
    SampleStats& stats;
};

}  // namespace trapeze::bundle_detail
#endif

#include "accel/block_hits-inl.h"
#include "accel/block_slabs-inl.h"
#include "accel/compact_lanes-inl.h"
#include "accel/ray_intervals-inl.h"
#include "accel/sharp_packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace bundle_detail;

constexpr size_t kLanes = hn::MaxLanes(F32());
constexpr uint32_t kAllLanes = (1u << kLanes) - 1;
constexpr size_t kMaskBytes = (kLanes + 7) / 8;
constexpr size_t kMetStride = BundleScratch::kMetStride;
constexpr int kRayFloats = sizeof(AxisRay) / sizeof(float);

HWY_INLINE uint32_t mask_bits(MF mask) {
    uint8_t bytes[8] = {};
    hn::StoreMaskBits(F32(), mask, bytes);
    return static_cast<uint32_t>(bytes[0] | bytes[1] << 8);
}

HWY_INLINE float largest(VF v) {
    return hn::GetLane(hn::MaxOfLanes(F32(), v));
}
HWY_INLINE float least(VF v) {
    return hn::GetLane(hn::MinOfLanes(F32(), v));
}

/// One bundle's way through a tree. kMotion: something in the tree moves; kLens: rays do not start in one
/// point.
template <bool kMotion, bool kLens>
class BundleTrace {
  public:
    explicit BundleTrace(const TraceInput& in)
        : tree_(in.tree),
          range_(in.range),
          inverse_focal_(in.inverse_focal),
          rays_(in.rays),
          s_(in.scratch),
          stats_(in.stats),
          nearest_(in.range.min - in.tree.max_slack()),
          packets_((in.rays.count + kLanes - 1) / kLanes) {}

    void run() {
        begin();
        for (const uint32_t grid : tree_.unbounded_grids()) test_unbounded(grid);
        for (size_t p = 0; p < packets_; ++p) refresh_packet(p);
        refresh_farthest();
        collect_candidates();
        std::sort(s_.candidates.begin(), s_.candidates.end());
        for (size_t i = 0; i < s_.candidates.size(); ++i) {
            const float depth = from_ordered_bits(static_cast<uint32_t>(s_.candidates[i] >> 32));
            if (depth > farthest_) break;
            if (i + 1 < s_.candidates.size()) prefetch(static_cast<uint32_t>(s_.candidates[i + 1]));
            visit_grid(static_cast<uint32_t>(s_.candidates[i]), depth);
        }
        stats_.rays += rays_.count;
    }

  private:
    void prefetch(uint32_t grid) const {
        const char* record = reinterpret_cast<const char*>(&tree_.grid(grid));
        __builtin_prefetch(record);
        __builtin_prefetch(record + 64);
        __builtin_prefetch(&tree_.grid_box(grid));
    }

    /// Nothing is hit yet; packets' intervals. Lanes past the end repeat the last ray and never count.
    void begin() {
        const F32 d;
        const hn::RebindToUnsigned<F32> du;
        const size_t end = packets_ * kLanes;
        for (size_t i = rays_.count; i < end; ++i) {
            rays_.ox[i] = rays_.ox[rays_.count - 1], rays_.oy[i] = rays_.oy[rays_.count - 1];
            rays_.ux[i] = rays_.ux[rays_.count - 1], rays_.uy[i] = rays_.uy[rays_.count - 1];
            rays_.time[i] = rays_.time[rays_.count - 1];
        }
        const VF focal = hn::Set(d, inverse_focal_);
        for (size_t p = 0; p < packets_; ++p) {
            const size_t i = p * kLanes;
            hn::Store(hn::Set(d, range_.max), d, rays_.depth + i);
            hn::Store(hn::Set(du, RayBundle::kNone), du, rays_.id + i);
            const VF ox = hn::Load(d, rays_.ox + i), oy = hn::Load(d, rays_.oy + i);
            const VF dx = hn::MulAdd(ox, focal, hn::Load(d, rays_.ux + i));
            const VF dy = hn::MulAdd(oy, focal, hn::Load(d, rays_.uy + i));
            set_interval(RayIntervals::kDxMin, p, dx);
            set_interval(RayIntervals::kDyMin, p, dy);
            if constexpr (kLens) {
                set_interval(RayIntervals::kOxMin, p, ox);
                set_interval(RayIntervals::kOyMin, p, oy);
            }
            if constexpr (kMotion) set_interval(RayIntervals::kTimeMin, p, hn::Load(d, rays_.time + i));
        }
        for (size_t i = rays_.count; i < end; ++i) rays_.depth[i] = -HUGE_VALF;  // look at nothing
        for (size_t p = packets_; p < packets_ + kLanes; ++p) {
            for (auto& row : s_.intervals.row) row[p] = row[packets_ - 1];
            s_.farthest[p] = -HUGE_VALF;
        }
        if constexpr (kMotion)
            first_time_ = of_all(RayIntervals::kTimeMin), last_time_ = of_all(RayIntervals::kTimeMax);
    }

    void set_interval(int row, size_t packet, VF v) {
        s_.intervals.row[row][packet] = least(v);
        s_.intervals.row[row + 1][packet] = largest(v);
    }

    /// A row of the intervals of the bundle as a whole.
    float of_all(int row) const {
        const float* values = s_.intervals.row[row];
        return row & 1 ? *std::max_element(values, values + packets_)
                       : *std::min_element(values, values + packets_);
    }

    /// The grids that the bundle as a whole may meet, each with a lower bound of its depths.
    void collect_candidates() {
        s_.candidates.clear();
        if (tree_.node_count() == 0) return;
        const F32 d;
        const auto q =
            IntervalLanes::of<kMotion, kLens>([&](int row) HWY_ATTR { return hn::Set(d, of_all(row)); });
        const VF nearest = hn::Set(d, nearest_), focal = hn::Set(d, inverse_focal_);
        s_.stack.assign(1, 0);
        while (!s_.stack.empty()) {
            const uint32_t index = s_.stack.back();
            s_.stack.pop_back();
            ++stats_.nodes_visited;
            const WideNode& node = tree_.nodes()[index];
            for (size_t i = 0; i < WideNode::kChildren; i += kLanes) {
                VF low[3], high[3];
                for (int k = 0; k < 3; ++k) {
                    low[k] = hn::Load(d, node.low[k] + i), high[k] = hn::Load(d, node.high[k] + i);
                    if constexpr (kMotion) {
                        const WideNodeMotion& motion = tree_.node_motions()[index];
                        low[k] = lowest(low[k], hn::Load(d, motion.low[k] + i), q.time);
                        high[k] = highest(high[k], hn::Load(d, motion.high[k] + i), q.time);
                    }
                }
                uint32_t met = mask_bits(meets<kLens>(d, q, low, high, nearest, focal));
                if (met == 0) continue;
                HWY_ALIGN float depth[kLanes];
                hn::Store(low[2], d, depth);
                for (; met != 0; met &= met - 1) {
                    const int lane = std::countr_zero(met);
                    const uint32_t link = node.child[i + static_cast<size_t>(lane)];
                    if (link & kGridLink)
                        s_.candidates.push_back(uint64_t{ordered_bits(depth[lane])} << 32 |
                                                (link & ~kGridLink));
                    else
                        s_.stack.push_back(link);
                }
            }
        }
    }

    /// A block and what its hits are called.
    struct Block {
        BlockView view;
        int columns;
        Facing facing;
        bool opaque;
        uint32_t id;  ///< of its first micropolygon
        float slack;
    };

    void visit_grid(uint32_t index, float depth) {
        const WideGrid& grid = tree_.grid(index);
        if constexpr (kHasSharpPackets && !kLens && !kMotion) {
            visit_sharp(index, grid);
            return;
        }
        if (!grid.moves()) {
            collect_active<false>({tree_.grid_box(index), grid.framed}, grid, 0, depth);
            test_active<false>(index, grid, 0);
            return;
        }
        if constexpr (kMotion) {
            if (!grid.has_segments()) {
                collect_active<true>({tree_.grid_box(index), grid.framed}, grid, 0, depth);
                test_active<true>(index, grid, 0);
                return;
            }
            const int first = segment_at(first_time_, grid.key_count).index;
            const int last = segment_at(last_time_, grid.key_count).index;
            for (int segment = first; segment <= last; ++segment) {
                collect_active<true>(tree_.segment_bounds(grid, segment), grid, segment, depth);
                test_active<true>(index, grid, segment);
            }
        }
    }

#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
    /// Packets whose intervals meet the grid's axis-aligned box, one by one as they lie.
    void visit_sharp(uint32_t index, const WideGrid& grid) {
        const F32 d;
        const MovingBox& box = tree_.grid_box(index);
        VF low[3], high[3];
        for (int k = 0; k < 3; ++k) low[k] = hn::Set(d, box.low[k]), high[k] = hn::Set(d, box.high[k]);
        bool nearer = false;
        for (size_t p = 0; p < packets_; p += kLanes) {
            const auto q = IntervalLanes::of<false, false>(
                [&](int row) HWY_ATTR { return hn::Load(d, s_.intervals.row[row] + p); });
            const MF looks = hn::Ge(hn::Load(d, s_.farthest + p), low[2]);
            uint32_t met = mask_bits(hn::And(
                looks, meets<false>(d, q, low, high, hn::Set(d, nearest_), hn::Set(d, inverse_focal_))));
            for (; met != 0; met &= met - 1)
                nearer |= visit_packet(index, grid, box, p + static_cast<size_t>(std::countr_zero(met)));
        }
        if (nearer) refresh_farthest();
    }

    /// Whether the packet's farthest depth may have become nearer.
    bool visit_packet(uint32_t index, const WideGrid& grid, const MovingBox& box, size_t packet) {
        const auto& row = s_.intervals.row;
        const PacketSlopes slopes{row[RayIntervals::kDxMin][packet], row[RayIntervals::kDxMax][packet],
                                  row[RayIntervals::kDyMin][packet], row[RayIntervals::kDyMax][packet]};
        uint32_t boxes = boxes_met(grid, tree_.box_planes(grid, 0), slopes, std::max(box.low[2], nearest_),
                                   box.high[2], s_.farthest[packet]);
        const auto rays = std::min(kLanes, rays_.count - packet * kLanes);
        stats_.nodes_visited += rays;
        if (rays_.nodes) count_packet(rays_.nodes, packet * kLanes, 1);
        bool nearer = false;
        const int blocks_u = grid.blocks_u(), per_box = grid.blocks_per_box();
        for (; boxes != 0; boxes &= boxes - 1) {
            const int first = std::countr_zero(boxes) * per_box,
                      last = std::min(first + per_box, grid.block_count());
            for (int b = first; b < last; ++b) {
                stats_.leaves_visited += rays;
                nearer |= test_packet(block_of(grid, 0, b % blocks_u, b / blocks_u, index), packet, slopes);
            }
        }
        if (nearer) refresh_packet(packet);
        return nearer;
    }

    /// A packet against the micropolygons of a block that it may hit; whether something nearer was found.
    bool test_packet(const Block& block, size_t packet, const PacketSlopes& slopes) {
        const F32 d;
        const hn::RebindToUnsigned<F32> du;
        const size_t i = packet * kLanes, rays = std::min(kLanes, rays_.count - i);
        const VF ux = hn::Load(d, rays_.ux + i), uy = hn::Load(d, rays_.uy + i);
        const MF valid = hn::FirstN(d, rays);
        bool nearer = false;
        for (uint32_t met = micropolygons_met(block.view, slopes); met != 0; met &= met - 1) {
            const int m = std::countr_zero(met), u = m & 3, v = m >> 2;
            stats_.predicate_tests += rays;
            if (rays_.tests) count_packet(rays_.tests, i, 1);
            const QuadLanes<VF> quad = quad_from_origin(block.view, u, v, ux, uy);
            MF hit = hn::And(inside(d, quad), valid);
            if (hn::AllFalse(d, hit)) continue;
            VF depth;
            hit = hn::And(hit, depth_inside(d, quad, block.facing, depth));
            hit = hn::And(
                hit, hn::And(hn::Ge(depth, hn::Set(d, range_.min)), hn::Le(depth, hn::Set(d, range_.max))));
            stats_.predicate_hits += hn::CountTrue(d, hit);
            const VF nearest = hn::Load(d, rays_.depth + i);
            const auto ids = hn::Load(du, rays_.id + i),
                       id = hn::Set(du, block.id + static_cast<uint32_t>(v << 4 | u));
            const MF kept =
                hn::And(hit, hn::Or(hn::Lt(depth, nearest),
                                    hn::And(hn::Eq(depth, nearest), hn::RebindMask(d, hn::Lt(id, ids)))));
            if (!block.opaque) {
                add_layers(i, hn::And(hit, hn::Le(depth, nearest)), depth,
                           block.id + static_cast<uint32_t>(v << 4 | u));
                continue;
            }
            if (hn::AllFalse(d, kept)) continue;
            hn::Store(hn::IfThenElse(kept, depth, nearest), d, rays_.depth + i);
            hn::Store(hn::IfThenElse(hn::RebindMask(du, kept), id, ids), du, rays_.id + i);
            nearer = true;
        }
        return nearer;
    }

    void add_layers(size_t first, MF hit, VF depth, uint32_t id) {
        HWY_ALIGN float depths[kLanes];
        hn::Store(depth, F32(), depths);
        for (uint32_t lanes = mask_bits(hit); lanes != 0; lanes &= lanes - 1) {
            const int lane = std::countr_zero(lanes);
            rays_.layers.push_back(
                {static_cast<uint32_t>(first) + static_cast<uint32_t>(lane), depths[lane], id});
        }
    }
#else
    void visit_sharp(uint32_t, const WideGrid&) {}
#endif

    /// Packets whose intervals meet the grid's axis-aligned box, then those of their rays that meet its
    /// oriented one (and, of a moving grid, look in the segment).
    template <bool kMoves>
    void collect_active(const SegmentBounds& bounds, const WideGrid& grid, int segment, float depth) {
        const F32 d;
        const MovingBox& box = bounds.box;
        s_.active.count = 0;
        s_.touched.clear();
        for (size_t p = 0; p < packets_; p += kLanes) {
            auto q = IntervalLanes::of<kMoves, kLens>(
                [&](int row) HWY_ATTR { return hn::Load(d, s_.intervals.row[row] + p); });
            VF low[3], high[3];
            MF looks = hn::FirstN(d, kLanes);
            if constexpr (kMoves) {
                if (grid.has_segments()) looks = to_segment(grid.key_count, segment, q.time);
            }
            for (int k = 0; k < 3; ++k) {
                low[k] = hn::Set(d, box.low[k]), high[k] = hn::Set(d, box.high[k]);
                if constexpr (kMoves) {
                    low[k] = lowest(low[k], hn::Set(d, box.low_delta[k]), q.time);
                    high[k] = highest(high[k], hn::Set(d, box.high_delta[k]), q.time);
                }
            }
            looks = hn::And(looks, hn::Ge(hn::Load(d, s_.farthest + p), low[2]));
            uint32_t met = mask_bits(hn::And(
                looks, meets<kLens>(d, q, low, high, hn::Set(d, nearest_), hn::Set(d, inverse_focal_))));
            for (; met != 0; met &= met - 1)
                collect_packet<kMoves>(grid, bounds.framed, p + static_cast<size_t>(std::countr_zero(met)),
                                       segment, depth);
        }
    }

    /// From times of the shutter to local ones; false where none is in the segment.
    static HWY_INLINE MF to_segment(int key_count, int segment, Interval& time) {
        const F32 d;
        const VF scale = hn::Set(d, static_cast<float>(key_count - 1)),
                 start = hn::Set(d, static_cast<float>(segment));
        const VF low = hn::MulSub(time.low, scale, start), high = hn::MulSub(time.high, scale, start);
        const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        time = {hn::Max(low, zero), hn::Min(high, one)};
        // A little more than the segment, for times round.
        return hn::And(hn::Le(low, hn::Set(d, 1.0f + 0x1p-12f)), hn::Ge(high, hn::Set(d, -0x1p-12f)));
    }

    template <bool kMoves>
    void collect_packet(const WideGrid& grid, const MovingBox& framed, size_t packet, int segment,
                        float depth) {
        const F32 d;
        const size_t i = packet * kLanes;
        const VF ox = kLens ? hn::Load(d, rays_.ox + i) : hn::Zero(d),
                 oy = kLens ? hn::Load(d, rays_.oy + i) : hn::Zero(d);
        const VF ux = hn::Load(d, rays_.ux + i), uy = hn::Load(d, rays_.uy + i);
        VF local = kMoves ? hn::Load(d, rays_.time + i) : hn::Zero(d);
        MF met = hn::FirstN(d, kLanes);
        if constexpr (kMoves) {
            if (grid.has_segments()) met = in_segment(local, grid.key_count, segment, local);
        }
        const VF limit = hn::Add(hn::Load(d, rays_.depth + i), hn::Set(d, grid.slack));
        VF inverse[3], offset[3], near = hn::Set(d, depth), far = limit;
        for (int k = 0; k < 3; ++k) {
            const float* axis = grid.axis[k];
            const VF x = hn::Set(d, axis[0]), y = hn::Set(d, axis[1]);
            inverse[k] = reciprocal(hn::MulAdd(x, ux, hn::MulAdd(y, uy, hn::Set(d, axis[2]))));
            offset[k] = kLens ? hn::Mul(hn::MulAdd(x, ox, hn::Mul(y, oy)), inverse[k]) : hn::Zero(d);
            VF low = hn::Set(d, framed.low[k]), high = hn::Set(d, framed.high[k]);
            if constexpr (kMoves) {
                low = hn::MulAdd(local, hn::Set(d, framed.low_delta[k]), low);
                high = hn::MulAdd(local, hn::Set(d, framed.high_delta[k]), high);
            }
            const VF a = hn::MulSub(low, inverse[k], offset[k]), b = hn::MulSub(high, inverse[k], offset[k]);
            near = hn::Max(near, hn::Min(a, b)), far = hn::Min(far, hn::Max(a, b));
        }
        met = hn::And(met, hn::Le(near, far));
        const size_t count = hn::CountTrue(d, met);
        stats_.nodes_visited += kLanes;
        if (rays_.nodes) count_packet(rays_.nodes, i, 1);
        if (count == 0) return;
        ActiveRays& to = s_.active;
        const size_t at = to.count;
        const CompactLanes compact(met);
        if constexpr (kLens) compact.store(ox, to.ox + at), compact.store(oy, to.oy + at);
        compact.store(ux, to.ux + at), compact.store(uy, to.uy + at);
        if constexpr (kMoves) compact.store(local, to.local + at);
        for (int k = 0; k < 3; ++k) {
            compact.store(inverse[k], to.inverse[k] + at);
            if constexpr (kLens) compact.store(offset[k], to.offset[k] + at);
        }
        compact.store(limit, to.limit + at);
        const hn::RebindToUnsigned<F32> du;
        compact.store(hn::Iota(du, static_cast<uint32_t>(i)), to.ray + at);
        to.count += count;
        s_.touched.push_back(static_cast<uint32_t>(packet));
    }

    /// segment_at() in lanes: whether a time is in a segment, and where.
    HWY_INLINE MF in_segment(VF time, int key_count, int segment, VF& local) const {
        const F32 d;
        const I32 di;
        const VF scaled = hn::Mul(time, hn::Set(d, static_cast<float>(key_count - 1)));
        const VI index =
            hn::Min(hn::Max(hn::ConvertTo(di, scaled), hn::Zero(di)), hn::Set(di, key_count - 2));
        local = hn::Sub(scaled, hn::ConvertTo(d, index));
        return hn::RebindMask(d, hn::Eq(index, hn::Set(di, segment)));
    }

    /// The boxes of a grid that active rays meet, and the blocks in them.
    template <bool kMoves>
    void test_active(uint32_t index, const WideGrid& grid, int segment) {
        ActiveRays& active = s_.active;
        if (active.count == 0) return;
        const F32 d;
        const float* planes = tree_.box_planes(grid, segment);
        // Lanes past the end meet nothing, whatever an earlier bundle has left there: infinities would.
        hn::StoreU(hn::Set(d, -HUGE_VALF), d, active.limit + active.count);
        if constexpr (kMoves) hn::StoreU(hn::Zero(d), d, active.local + active.count);
        for (int k = 0; k < 3; ++k) {
            hn::StoreU(hn::Zero(d), d, active.inverse[k] + active.count);
            if constexpr (kLens) hn::StoreU(hn::Zero(d), d, active.offset[k] + active.count);
        }
        const int blocks_u = grid.blocks_u(), boxes = grid.box_count(), per_box = grid.blocks_per_box();
        meet_boxes<kMoves>(planes, boxes);
        const float rounding = tree_.rounding(absolute_max(tree_.grid_box(index)));
        for (int b = 0; b < grid.block_count(); ++b) {
            const uint8_t* met = s_.met + static_cast<size_t>(b / per_box) * kMetStride;
            const Block block = block_of(grid, segment, b % blocks_u, b / blocks_u, index);
            const size_t count = collect_block<kMoves>(block, met, rounding);
            if (count != 0) test_block_rays<kMoves>(block, count);
        }
        if (!grid.opaque) return;
        for (const uint32_t packet : s_.touched) refresh_packet(packet);
        refresh_farthest();
    }

    void refresh_packet(size_t packet) {
        s_.farthest[packet] = largest(hn::Load(F32(), rays_.depth + packet * kLanes));
    }
    void refresh_farthest() {
        const F32 d;
        VF farthest = hn::Load(d, s_.farthest);
        for (size_t p = kLanes; p < packets_; p += kLanes)
            farthest = hn::Max(farthest, hn::Load(d, s_.farthest + p));
        farthest_ = largest(farthest);
    }

    static void count_packet(uint32_t* counts, size_t first, uint32_t count) {
        for (size_t i = 0; i < kLanes; ++i) counts[first + i] += count;
    }

    static Block block_of(const WideGrid& grid, int segment, int u, int v, uint32_t index) {
        const int tiles_u = grid.tiles_u, tiles_v = (grid.nv + 4) / 4;
        Block block;
        block.view.plane = grid.plane_size;
        block.view.tile = grid.planes + static_cast<size_t>(segment) * 6 * grid.plane_size +
                          static_cast<size_t>(v * tiles_u + u) * 16;
        block.view.right = u + 1 < tiles_u ? 16 : 3;
        block.view.down = v + 1 < tiles_v ? tiles_u * 16 : 12;
        block.view.rows = std::min(4, grid.nv - 4 * v);
        block.columns = std::min(4, grid.nu - 4 * u);
        block.facing = static_cast<Facing>(grid.facing);
        block.opaque = grid.opaque != 0;
        block.id = index << 8 | static_cast<uint32_t>(v) << 6 | static_cast<uint32_t>(u) << 2;
        block.slack = grid.slack;
        return block;
    }

    /// Which active rays meet which boxes: a bit for each ray in a row for each box.
    template <bool kMoves>
    void meet_boxes(const float* planes, int boxes) {
        const F32 d;
        const ActiveRays& active = s_.active;
        for (size_t i = 0; i < active.count; i += kLanes) {
            const uint32_t valid = active.count - i < kLanes ? (1u << (active.count - i)) - 1 : kAllLanes;
            int sides[3];
            bool alike = true;
            for (int k = 0; k < 3; ++k) {
                const VF inverse = hn::Load(d, active.inverse[k] + i);
                const uint32_t backward = mask_bits(predicate_lanes::negative(d, inverse)) & valid;
                sides[k] = backward != 0;
                alike = alike && (backward == 0 || backward == valid);
            }
            uint8_t* met = s_.met + i / kLanes * kMaskBytes;
            if (alike)
                meet_boxes_of<kMoves, true>(i, planes, boxes, sides, met);
            else
                meet_boxes_of<kMoves, false>(i, planes, boxes, sides, met);
        }
        stats_.nodes_visited += active.count * static_cast<size_t>(boxes);
    }

    /// Those of a vector of rays. kAlike: along each axis all look to the same side, so that it is known
    /// which plane of a box comes first.
    template <bool kMoves, bool kAlike>
    void meet_boxes_of(size_t i, const float* planes, int boxes, const int* sides, uint8_t* met) {
        const F32 d;
        const ActiveRays& active = s_.active;
        const auto stride = static_cast<size_t>(boxes);
        const VF local = kMoves ? hn::Load(d, active.local + i) : hn::Zero(d);
        const VF limit = hn::Load(d, active.limit + i);
        VF inverse[3], offset[3];
        const float *first[3], *last[3];
        for (size_t k = 0; k < 3; ++k) {
            inverse[k] = hn::Load(d, active.inverse[k] + i);
            offset[k] = kLens ? hn::Load(d, active.offset[k] + i) : hn::Zero(d);
            first[k] = planes + (k + (kAlike && sides[k] ? 3 : 0)) * stride;
            last[k] = planes + (k + (kAlike && sides[k] ? 0 : 3)) * stride;
        }
        for (int b = 0; b < boxes; ++b, met += kMetStride) {
            VF near, far;
            for (int k = 0; k < 3; ++k) {
                VF from = hn::Set(d, first[k][b]), to = hn::Set(d, last[k][b]);
                if constexpr (kMoves) {
                    from = hn::MulAdd(local, hn::Set(d, first[k][b + 6 * boxes]), from);
                    to = hn::MulAdd(local, hn::Set(d, last[k][b + 6 * boxes]), to);
                }
                VF enter = kLens ? hn::MulSub(from, inverse[k], offset[k]) : hn::Mul(from, inverse[k]);
                VF leave = kLens ? hn::MulSub(to, inverse[k], offset[k]) : hn::Mul(to, inverse[k]);
                if constexpr (!kAlike) {
                    const VF a = enter;
                    enter = hn::Min(a, leave), leave = hn::Max(a, leave);
                }
                near = k == 0 ? enter : hn::Max(near, enter);
                far = k == 0 ? hn::Min(leave, limit) : hn::Min(far, leave);
            }
            hn::StoreMaskBits(d, hn::Le(near, far), met);
        }
    }

    /// Lists the active rays whose bits are set in the row of a block's box and that do not pass the block
    /// by; how many.
    template <bool kMoves>
    size_t collect_block(const Block& block, const uint8_t* met, float rounding) {
        const F32 d;
        const hn::RebindToUnsigned<F32> du;
        const ActiveRays& active = s_.active;
        BlockRays& to = s_.block;
        const size_t candidates = count_bits(met, (active.count + kLanes - 1) / kLanes * kMaskBytes);
        if (candidates == 0) return 0;
        BlockSlabs slabs;
        const bool has_slabs = candidates >= kFewForSlabs && slabs_of<kMoves>(block.view, rounding, slabs);
        if (has_slabs) stats_.nodes_visited += candidates;
        size_t count = 0;
        for (size_t i = 0; i < active.count; i += kLanes, met += kMaskBytes) {
            uint32_t bits = 0;
            std::memcpy(&bits, met, kMaskBytes);
            if (bits == 0) continue;
            MF here = hn::LoadMaskBits(d, met);
            RayLanes r;
            if constexpr (kLens) r.ox = hn::Load(d, active.ox + i), r.oy = hn::Load(d, active.oy + i);
            r.ux = hn::Load(d, active.ux + i), r.uy = hn::Load(d, active.uy + i);
            if constexpr (kMoves) r.local = hn::Load(d, active.local + i);
            if (has_slabs) {
                here = hn::AndNot(misses<kMoves, kLens>(slabs, r), here);
                bits = mask_bits(here);
                if (bits == 0) continue;
            }
            const CompactLanes compact(here);
            if constexpr (kLens) compact.store(r.ox, to.ox + count), compact.store(r.oy, to.oy + count);
            compact.store(r.ux, to.ux + count), compact.store(r.uy, to.uy + count);
            if constexpr (kMoves) compact.store(r.local, to.local + count);
            compact.store(hn::Iota(du, static_cast<uint32_t>(i)), to.active + count);
            count += static_cast<size_t>(std::popcount(bits));
        }
        return count;
    }

    /// Of a row of meet_boxes(), whose unused bits are 0.
    static size_t count_bits(const uint8_t* row, size_t bytes) {
        size_t count = 0, i = 0;
        for (; i + 8 <= bytes; i += 8) {
            uint64_t word;
            std::memcpy(&word, row + i, 8);
            count += static_cast<size_t>(std::popcount(word));
        }
        for (; i < bytes; ++i) count += static_cast<size_t>(std::popcount(row[i]));
        return count;
    }

    static float absolute_max(const MovingBox& box) {
        float most = 0;
        for (int k = 0; k < 3; ++k)
            for (const float at :
                 {box.low[k], box.high[k], box.low[k] + box.low_delta[k], box.high[k] + box.high_delta[k]})
                most = std::max(most, std::abs(at));
        return most;
    }

    template <bool kMoves>
    void test_block_rays(const Block& block, size_t count) {
        const F32 d;
        const BlockRays& from = s_.block;
        const auto micropolygons = static_cast<uint64_t>(block.view.rows * block.columns);
        stats_.leaves_visited += count;
        stats_.predicate_tests += count * micropolygons;
        if (rays_.tests)
            for (size_t i = 0; i < count; ++i)
                rays_.tests[s_.active.ray[from.active[i]]] += static_cast<uint32_t>(micropolygons);
        for (size_t i = 0; i < count; i += kLanes) {
            const size_t left = count - i;
            if (left < kFewInBlock) {
                for (size_t k = i; k < count; ++k) test_one_ray<kMoves>(block, k);
                return;
            }
            RayLanes r;
            if constexpr (kLens) r.ox = hn::Load(d, from.ox + i), r.oy = hn::Load(d, from.oy + i);
            r.ux = hn::Load(d, from.ux + i), r.uy = hn::Load(d, from.uy + i);
            if constexpr (kMoves) r.local = hn::Load(d, from.local + i);
            const BlockBits bits = block.columns == 1 ? block_bits<kMoves, kLens, 1>(block.view, r)
                                                      : block_bits<kMoves, kLens, 4>(block.view, r);
            const MF valid = hn::FirstN(d, left);
            const MF any = hn::And(predicate_lanes::negative(d, bits.any), valid);
            if (hn::AllFalse(d, any)) continue;
            const MF several = hn::And(predicate_lanes::negative(d, bits.several), valid);
            VI u, v;
            decode(bits, u, v);
            VF depth = hn::Zero(d);
            const MF faces =
                depth_inside(d, quads_at<kMoves, kLens>(block.view, r, u, v), block.facing, depth);
            const MF hit = hn::AndNot(several, hn::And(any, faces));
            settle(block, i, hit, u, v, depth);
            for (uint32_t more = mask_bits(several); more != 0; more &= more - 1)
                test_one_ray<kMoves>(block, i + static_cast<size_t>(std::countr_zero(more)));
        }
    }

    /// Keeps the hits of lanes of rays, block rays from `first` on.
    void settle(const Block& block, size_t first, MF hit, VI u, VI v, VF depth) {
        const F32 d;
        const I32 di;
        hit = hn::And(hit,
                      hn::And(hn::Ge(depth, hn::Set(d, range_.min)), hn::Le(depth, hn::Set(d, range_.max))));
        uint32_t lanes = mask_bits(hit);
        if (lanes == 0) return;
        HWY_ALIGN float depths[kLanes];
        HWY_ALIGN int32_t uv[kLanes];
        hn::Store(depth, d, depths);
        hn::Store(hn::Or(u, hn::ShiftLeft<4>(v)), di, uv);
        for (; lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<size_t>(std::countr_zero(lanes));
            keep(block, s_.block.active[first + lane], depths[lane],
                 block.id + static_cast<uint32_t>(uv[lane]));
        }
    }

    HWY_INLINE void keep(const Block& block, uint32_t active, float depth, uint32_t id) {
        if (keep_hit(s_.active.ray[active], depth, id, block.opaque))
            s_.active.limit[active] = depth + block.slack;
    }

    /// Whether it is the nearest opaque hit now.
    HWY_INLINE bool keep_hit(uint32_t ray, float depth, uint32_t id, bool opaque) {
        ++stats_.predicate_hits;
        float& nearest = rays_.depth[ray];
        if (!opaque) {
            if (depth <= nearest) rays_.layers.push_back({ray, depth, id});
            return false;
        }
        if (!(depth < nearest || (depth == nearest && id < rays_.id[ray]))) return false;
        nearest = depth;
        rays_.id[ray] = id;
        return true;
    }

    /// One block ray against all micropolygons of its block: lanes are micropolygons.
    template <bool kMoves>
    void test_one_ray(const Block& block, size_t which) {
        const F32 d;
        const I32 di;
        const BlockRays& from = s_.block;
        RayLanes r;
        if constexpr (kLens) r.ox = hn::Set(d, from.ox[which]), r.oy = hn::Set(d, from.oy[which]);
        r.ux = hn::Set(d, from.ux[which]), r.uy = hn::Set(d, from.uy[which]);
        if constexpr (kMoves) r.local = hn::Set(d, from.local[which]);
        for (int m = 0; m < 4 * block.view.rows; m += static_cast<int>(kLanes)) {
            const VI number = hn::Iota(di, m), u = hn::And(number, hn::Set(di, 3)),
                     v = hn::ShiftRight<2>(number);
            VF depth = hn::Zero(d);
            const QuadLanes<VF> q = quads_at<kMoves, kLens>(block.view, r, u, hn::And(v, hn::Set(di, 3)));
            MF hit = inside(d, q);
            if (hn::AllFalse(d, hit)) continue;
            hit = hn::And(hit, depth_inside(d, q, block.facing, depth));
            hit = hn::And(hit, hn::RebindMask(d, hn::And(hn::Lt(u, hn::Set(di, block.columns)),
                                                         hn::Lt(v, hn::Set(di, block.view.rows)))));
            hit = hn::And(
                hit, hn::And(hn::Ge(depth, hn::Set(d, range_.min)), hn::Le(depth, hn::Set(d, range_.max))));
            uint32_t lanes = mask_bits(hit);
            if (lanes == 0) continue;
            HWY_ALIGN float depths[kLanes];
            hn::Store(depth, d, depths);
            for (; lanes != 0; lanes &= lanes - 1) {
                const int lane = std::countr_zero(lanes), micropolygon = m + lane;
                keep(block, from.active[which], depths[lane],
                     block.id + static_cast<uint32_t>((micropolygon & 3) | micropolygon >> 2 << 4));
            }
        }
    }

    /// A grid that no box can hold, by the scalar predicate.
    void test_unbounded(uint32_t index) {
        const Grid& grid = tree_.grids().grids[index];
        for (size_t i = 0; i < rays_.count; ++i) {
            const AxisRay ray{rays_.ox[i], rays_.oy[i], 0, rays_.ux[i], rays_.uy[i], rays_.time[i]};
            for (int v = 0; v < grid.shape.nv; ++v)
                for (int u = 0; u < grid.shape.nu; ++u) {
                    ++stats_.predicate_tests;
                    float depth;
                    if (!hit_micropolygon(ray, grid.quad(u, v, ray.time), grid.facing, &depth)) continue;
                    if (!(depth >= range_.min && depth <= range_.max)) continue;
                    keep_hit(
                        static_cast<uint32_t>(i), depth,
                        static_cast<uint32_t>(
                            MicropolygonId{index, static_cast<uint8_t>(u), static_cast<uint8_t>(v)}.packed()),
                        grid.opaque);
                }
        }
    }

    const WideTree& tree_;
    DepthRange range_;
    float inverse_focal_;
    RayBundle& rays_;
    BundleScratch& s_;
    SampleStats& stats_;
    float nearest_;  ///< no box before this depth matters
    size_t packets_;
    float first_time_ = 0, last_time_ = 0;
    float farthest_ = 0;  ///< some ray still looks as far as this
};

void trace(const TraceInput& in, bool motion, bool lens) {
    if (motion) {
        if (lens)
            BundleTrace<true, true>(in).run();
        else
            BundleTrace<true, false>(in).run();
    } else {
        if (lens)
            BundleTrace<false, true>(in).run();
        else
            BundleTrace<false, false>(in).run();
    }
}

/// Gathers a component of rays as they lie; 0 when it is not wanted.
void fill_component(const float* component, std::span<const uint32_t> order, bool wanted, float* to) {
    const F32 d;
    const I32 di;
    const size_t count = order.size();
    size_t i = 0;
    for (; i + kLanes <= count; i += kLanes) {
        if (!wanted) {
            hn::Store(hn::Zero(d), d, to + i);
            continue;
        }
        const VI ray = hn::LoadU(di, reinterpret_cast<const int32_t*>(order.data() + i));
        hn::Store(hn::GatherIndex(d, component, hn::Mul(ray, hn::Set(di, kRayFloats))), d, to + i);
    }
    for (; i < count; ++i) to[i] = wanted ? component[order[i] * size_t{kRayFloats}] : 0.0f;
}

void fill(std::span<const AxisRay> rays, std::span<const uint32_t> order, bool lens, bool motion,
          RayBundle& bundle) {
    const auto* floats = reinterpret_cast<const float*>(rays.data());
    bundle.count = order.size();
    fill_component(floats + offsetof(AxisRay, ox) / sizeof(float), order, lens, bundle.ox);
    fill_component(floats + offsetof(AxisRay, oy) / sizeof(float), order, lens, bundle.oy);
    fill_component(floats + offsetof(AxisRay, ux) / sizeof(float), order, true, bundle.ux);
    fill_component(floats + offsetof(AxisRay, uy) / sizeof(float), order, true, bundle.uy);
    fill_component(floats + offsetof(AxisRay, time) / sizeof(float), order, motion, bundle.time);
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {

HWY_EXPORT(trace);
HWY_EXPORT(fill);

BundleScratchPointer make_bundle_scratch() {
    return BundleScratchPointer(new BundleScratch);
}
void DeleteBundleScratch::operator()(BundleScratch* scratch) const {
    delete scratch;
}

void fill_bundle(std::span<const AxisRay> rays, std::span<const uint32_t> order, bool lens, bool motion,
                 RayBundle& bundle) {
    HWY_DYNAMIC_DISPATCH(fill)(rays, order, lens, motion, bundle);
}

void trace_bundle(const WideTree& tree, DepthRange range, bool lens, float focal_distance, RayBundle& rays,
                  BundleScratch& scratch, SampleStats& stats) {
    rays.layers.clear();
    if (rays.count == 0) return;
    const bundle_detail::TraceInput in{tree, range, lens ? 1 / focal_distance : 0.0f, rays, scratch, stats};
    HWY_DYNAMIC_DISPATCH(trace)(in, tree.moves(), lens);
}

}  // namespace trapeze
#endif  // HWY_ONCE
