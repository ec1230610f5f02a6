/// Where AVX-512 looks for a block's corners in two registers, on every machine: by arrays that permute as
/// the registers do.
#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <vector>

#include "core/simd/targets_harness.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/wide/two_registers_test.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include "accel/wide/block_hits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {

/// WideRegisters without a vector.
struct ArrayRegisters {
    using Floats = std::array<float, 16>;
    using Ints = std::array<int32_t, 16>;

    template <class T>
    static std::array<T, 16> load(const T* at) {
        std::array<T, 16> loaded;
        std::copy_n(at, 16, loaded.begin());
        return loaded;
    }
    static Floats load_unaligned(const float* at) { return load(at); }
    static Floats load_four(const float* at) {
        Floats four;
        four.fill(-1e30f);  // what the lanes behind are must not matter
        std::copy_n(at, 4, four.begin());
        return four;
    }
    static Ints numbers() {
        Ints lanes;
        std::iota(lanes.begin(), lanes.end(), 0);
        return lanes;
    }
    static Ints number_of(const Ints& u, const Ints& v) {
        Ints numbers;
        for (size_t i = 0; i < 16; ++i) numbers[i] = 4 * v[i] + u[i];
        return numbers;
    }
    template <class T>
    static std::array<T, 16> permuted(const Ints& at, const std::array<T, 16>& from) {
        std::array<T, 16> lanes;
        for (size_t i = 0; i < 16; ++i) lanes[i] = from[static_cast<size_t>(at[i] & 15)];
        return lanes;
    }
    static Floats picked(const Floats& a, const Ints& at, const Floats& b) {
        Floats lanes;
        for (size_t i = 0; i < 16; ++i) {
            const auto place = static_cast<size_t>(at[i]);
            lanes[i] = place < 16 ? a[place] : b[place - 16];
        }
        return lanes;
    }
    static Floats with_lane_8(Floats v, float value) {
        v[8] = value;
        return v;
    }
};

/// The vertex that `corner` of micropolygon (u, v) is at, in a plane, by the block's own account.
float vertex_of(const BlockView& block, int plane, int u, int v, int corner) {
    return block.tile[static_cast<size_t>(plane) * block.plane +
                      static_cast<size_t>(block.offset(u + (corner & 1), v + (corner >> 1)))];
}

/// How many corners are not where the block has them: of all micropolygons in their order, and of those that
/// lanes ask for.
int wrong_corners(const BlockView& block, const ArrayRegisters::Ints& u, const ArrayRegisters::Ints& v) {
    using Lookup = TwoRegisterLookup<ArrayRegisters>;
    int wrong = 0;
    const Lookup all(block), asked(block, u, v);
    for (int plane = 0; plane < 6; ++plane) {
        ArrayRegisters::Floats own, behind, corners[4];
        all.load(plane, own, behind);
        asked.get(plane, corners);
        for (int corner = 0; corner < 4; ++corner) {
            const ArrayRegisters::Floats found = corner == 0 ? own : all.corner(corner, own, behind);
            for (int i = 0; i < 16; ++i) {
                const auto lane = static_cast<size_t>(i);
                wrong += found[lane] != vertex_of(block, plane, i & 3, i >> 2, corner);
                wrong += corners[corner][lane] != vertex_of(block, plane, u[lane], v[lane], corner);
            }
        }
    }
    return wrong;
}

/// The same for what this target looks up by.
int wrong_lanes(const BlockView& block, const ArrayRegisters::Ints& u, const ArrayRegisters::Ints& v) {
    int wrong = 0;
    for (size_t first = 0; first < 16; first += kLanes) {
        const CornerLookup lookup(block, hn::LoadU(I32(), u.data() + first),
                                  hn::LoadU(I32(), v.data() + first));
        for (int plane = 0; plane < 6; ++plane) {
            VF corners[4];
            lookup.get(plane, corners);
            for (int corner = 0; corner < 4; ++corner) {
                float found[kLanes];
                hn::StoreU(corners[corner], F32(), found);
                for (size_t i = 0; i < kLanes; ++i)
                    wrong += found[i] != vertex_of(block, plane, u[first + i], v[first + i], corner);
            }
        }
    }
    return wrong;
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {
namespace {

using testing::for_each_target;

HWY_EXPORT(wrong_corners);
HWY_EXPORT(wrong_lanes);

/// Blocks with tiles behind them and at a grid's end, in planes of which every float is another.
TEST(TwoRegisters, FindEveryCornerOfABlock) {
    constexpr int kTilesU = 3;
    constexpr size_t kPlane = size_t{16} * kTilesU * 2;
    alignas(64) static std::array<float, 6 * kPlane + 16> planes;
    std::iota(planes.begin(), planes.end(), 1.0f);
    std::array<int32_t, 16> u{}, v{};
    for (int i = 0; i < 16; ++i) {
        u[static_cast<size_t>(i)] = i * 7 % 4;
        v[static_cast<size_t>(i)] = (i * 5 + i / 4) % 4;
    }
    for (const int right : {3, 16})
        for (const int down : {12, 16 * kTilesU}) {
            const BlockView block{planes.data() + 16, kPlane, right, down, 4};
            for_each_target([&] {
                EXPECT_EQ(HWY_DYNAMIC_DISPATCH(wrong_corners)(block, u, v), 0) << right << " " << down;
                EXPECT_EQ(HWY_DYNAMIC_DISPATCH(wrong_lanes)(block, u, v), 0) << right << " " << down;
            });
        }
}

}  // namespace
}  // namespace trapeze
#endif  // HWY_ONCE
