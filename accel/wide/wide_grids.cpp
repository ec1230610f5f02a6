#include "accel/wide/wide_grids.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "accel/builders/grid_summary.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/wide/wide_grids.cpp"
#include <hwy/foreach_target.h>  // compiles this file once a target

#include <hwy/highway.h>

#ifndef TRAPEZE_ACCEL_WIDE_GRIDS_ONCE
#define TRAPEZE_ACCEL_WIDE_GRIDS_ONCE
namespace trapeze::wide_grids_detail {

inline constexpr int kMaxTiles = 25;  ///< of a grid of 16 x 16
inline constexpr int kMaxBlocks = 16;

/// The boxes of a grid's blocks at one key, in the grid's axes.
struct BlockBoxes {
    float low[3][kMaxBlocks], high[3][kMaxBlocks];
};

/// What a key adds to the whole grid's bounds: coordinates of camera space, then of the axes.
struct KeyBox6 {
    float low[6], high[6];
};

}  // namespace trapeze::wide_grids_detail
#endif

HWY_BEFORE_NAMESPACE();
namespace trapeze {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace wide_grids_detail;

/// Coordinates of all vertices, tile by tile, at a key: of camera space, then in the axes.
struct TiledCoordinates {
    HWY_ALIGN float c[6][kMaxTiles * 16];
};

/// Writes a key's vertices in camera space and in the axes of `axis`, and what they span. Whole planes are
/// read: places past the last row and column repeat vertices (core/grid.h), which changes no bound.
HWY_INLINE void place_vertices(const Grid& grid, int key, const float (*axis)[3], TiledCoordinates& out,
                               KeyBox6& box) {
    const hn::ScalableTag<float> d;
    // Planes hold where segments start and how far they go: the last key is the end of the last segment.
    const bool at_end = grid.moves() && key == grid.key_count - 1;
    const int segment = at_end ? key - 1 : key;
    const size_t count = grid.shape.plane_size(), lanes = hn::Lanes(d);
    using V = hn::Vec<decltype(d)>;
    V low[6], high[6];
    for (int k = 0; k < 6; ++k) low[k] = hn::Set(d, HUGE_VALF), high[k] = hn::Set(d, -HUGE_VALF);
    for (size_t i = 0; i < count; i += lanes) {
        V c[6];
        for (int k = 0; k < 3; ++k) {
            c[k] = hn::Load(d, grid.plane(segment, k) + i);
            if (at_end) c[k] = hn::Add(c[k], hn::Load(d, grid.plane(segment, 3 + k) + i));
        }
        for (int k = 0; k < 3; ++k)
            c[3 + k] =
                hn::MulAdd(hn::Set(d, axis[k][0]), c[0],
                           hn::MulAdd(hn::Set(d, axis[k][1]), c[1], hn::Mul(hn::Set(d, axis[k][2]), c[2])));
        for (int k = 0; k < 6; ++k) {
            hn::Store(c[k], d, out.c[k] + i);
            low[k] = hn::Min(low[k], c[k]), high[k] = hn::Max(high[k], c[k]);
        }
    }
    for (int k = 0; k < 6; ++k) {
        box.low[k] = hn::GetLane(hn::MinOfLanes(d, low[k]));
        box.high[k] = hn::GetLane(hn::MaxOfLanes(d, high[k]));
    }
}

/// Bounds of all blocks of 4 x 4 micropolygons, in the axes, not grown: of their tile's vertices and the
/// first row and column of the tiles behind.
HWY_INLINE void bound_blocks(const GridShape& shape, const TiledCoordinates& at, BlockBoxes& boxes) {
    const hn::CappedTag<float, 4> d4;
    using V = hn::Vec<decltype(d4)>;
    const size_t lanes = hn::Lanes(d4);
    const int tiles_u = shape.tiles_u(), tiles_v = shape.tiles_v();
    const int blocks_u = (shape.nu + 3) / 4, blocks_v = (shape.nv + 3) / 4;
    for (int k = 0; k < 3; ++k) {
        const float* c = at.c[3 + k];
        // Columns' extremes of each tile: column 0 is what the block to the left needs.
        HWY_ALIGN float column_low[kMaxTiles][4], column_high[kMaxTiles][4];
        for (int tile = 0; tile < tiles_u * tiles_v; ++tile)
            for (size_t i = 0; i < 4; i += lanes) {
                const float* rows = c + tile * 16 + i;
                const V a = hn::Load(d4, rows), b = hn::Load(d4, rows + 4);
                const V e = hn::Load(d4, rows + 8), f = hn::Load(d4, rows + 12);
                hn::Store(hn::Min(hn::Min(a, b), hn::Min(e, f)), d4, column_low[tile] + i);
                hn::Store(hn::Max(hn::Max(a, b), hn::Max(e, f)), d4, column_high[tile] + i);
            }
        for (int v = 0; v < blocks_v; ++v)
            for (int u = 0; u < blocks_u; ++u) {
                const int tile = v * tiles_u + u;
                // Where no tile follows, the tile's own first row or column counts again, which changes no
                // bound.
                const int right = u + 1 < tiles_u ? tile + 1 : tile;
                const int down = v + 1 < tiles_v ? tile + tiles_u : tile;
                const int corner = down + (right - tile);
                const float *row = c + down * 16, *last = c + corner * 16;
                float low = std::min(column_low[right][0], last[0]),
                      high = std::max(column_high[right][0], last[0]);
                for (int i = 0; i < 4; ++i) {
                    low = std::min(low, std::min(column_low[tile][i], row[i]));
                    high = std::max(high, std::max(column_high[tile][i], row[i]));
                }
                boxes.low[k][v * blocks_u + u] = low;
                boxes.high[k][v * blocks_u + u] = high;
            }
    }
}

/// The largest extent of a micropolygon along an axis, of which `tiled` are the vertices' coordinates.
HWY_INLINE float largest_extent(const GridShape& shape, const float* tiled) {
    const hn::ScalableTag<float> d;
    const hn::CappedTag<float, 4> d4;
    using V = hn::Vec<decltype(d)>;
    constexpr int kLanes = static_cast<int>(hn::MaxLanes(d));
    // A row of vertices, the last one repeated as far as vectors are loaded. What a pair of neighbours spans:
    // in this row (low, high), and in the row before.
    HWY_ALIGN float row[kMaxTiles + kMaxGridSide + kLanes];
    constexpr int kMostVectors = kMaxGridSide / kLanes;
    V low_before[kMostVectors], high_before[kMostVectors], largest = hn::Zero(d);
    const int tiles_u = shape.tiles_u();
    for (int v = 0; v <= shape.nv; ++v) {
        const float* from = tiled + v / 4 * tiles_u * 16 + v % 4 * 4;
        for (int tile = 0; tile < tiles_u; ++tile)
            for (size_t i = 0; i < 4; i += hn::Lanes(d4))
                hn::Store(hn::Load(d4, from + tile * 16 + i), d4, row + tile * 4 + i);
        hn::StoreU(hn::Set(d, row[tiles_u * 4 - 1]), d, row + tiles_u * 4);
        for (int i = 0; i * kLanes < shape.nu; ++i) {
            const V a = hn::Load(d, row + i * kLanes), b = hn::LoadU(d, row + i * kLanes + 1);
            const V low = hn::Min(a, b), high = hn::Max(a, b);
            if (v > 0)
                largest =
                    hn::Max(largest, hn::Sub(hn::Max(high, high_before[i]), hn::Min(low, low_before[i])));
            low_before[i] = low, high_before[i] = high;
        }
    }
    return hn::GetLane(hn::MaxOfLanes(d, largest));
}

/// Bounds of a grid at each of its keys: of the whole into wholes[key], of its blocks into blocks[key]; and
/// of its micropolygons' extents along the axes of space, at all keys.
void bound_keys(const Grid& grid, const float (*axis)[3], KeyBox6* wholes, BlockBoxes* blocks,
                float* extents) {
    TiledCoordinates coordinates;
    for (int k = 0; k < 3; ++k) extents[k] = 0;
    for (int key = 0; key < grid.key_count; ++key) {
        place_vertices(grid, key, axis, coordinates, wholes[key]);
        bound_blocks(grid.shape, coordinates, blocks[key]);
        for (int k = 0; k < 3; ++k)
            extents[k] = std::max(extents[k], largest_extent(grid.shape, coordinates.c[k]));
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace trapeze
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trapeze {
namespace {

using wide_grids_detail::BlockBoxes;
using wide_grids_detail::KeyBox6;

HWY_EXPORT(bound_keys);

/// The axes of a grid, from sums of edges along u and v at mid-shutter, to which interior vertices do not
/// contribute [Hou10 sec. 3.3]; every fourth row and column tells enough.
Axes axes_of_grid(const Grid& grid) {
    const GridShape& shape = grid.shape;
    V3f along_u(0), along_v(0);
    int rows = 0, columns = 0;
    for (int j = 0; j <= shape.nv; j += 4, ++rows)
        along_u += grid.vertex(shape.nu, j, 0.5f) - grid.vertex(0, j, 0.5f);
    for (int i = 0; i <= shape.nu; i += 4, ++columns)
        along_v += grid.vertex(i, shape.nv, 0.5f) - grid.vertex(i, 0, 0.5f);
    return axes_of(V3d(along_u) / (rows * shape.nu), V3d(along_v) / (columns * shape.nv));
}

/// Axes in 16 bits a component; those of space where some are no numbers.
PackedAxes packed(Axes exact) {
    for (int k = 0; k < 3; ++k)
        if (!std::isfinite(exact.axis[k].x + exact.axis[k].y + exact.axis[k].z)) exact = {};
    PackedAxes axes;
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c)
            axes.code[k][c] = static_cast<int16_t>(
                std::lround(std::clamp(exact.axis[k][c], -1.0f, 1.0f) * PackedAxes::kOne));
    return axes;
}

/// The line over the shutter below all keys' low (or above all keys' high) values of coordinate k: the line
/// from the first key to the last, moved out as far as some key lies beyond it. `ends`: its values at open
/// and close.
void line_around(const KeyBox6* wholes, int key_count, bool low, int k, float ends[2]) {
    const auto at = [&](int key) { return low ? wholes[key].low[k] : wholes[key].high[k]; };
    const float first = at(0), last = at(key_count - 1);
    float beyond = 0;
    for (int key = 1; key + 1 < key_count; ++key) {
        const float on_line =
            first + (last - first) * (static_cast<float>(key) / static_cast<float>(key_count - 1));
        beyond = std::max(beyond, low ? on_line - at(key) : at(key) - on_line);
    }
    ends[0] = low ? first - beyond : first + beyond;
    ends[1] = low ? last - beyond : last + beyond;
}

/// Joins the boxes of blocks that share one, in place: afterwards places 0 .. box_count() - 1 count.
void join_blocks(const WideGrid& record, BlockBoxes& boxes) {
    const int per_box = record.blocks_per_box(), blocks = record.block_count();
    for (int k = 0; k < 3; ++k)
        for (int box = 0; box < record.box_count(); ++box) {
            const int first = box * per_box, last = std::min(first + per_box, blocks);
            boxes.low[k][box] = *std::min_element(boxes.low[k] + first, boxes.low[k] + last);
            boxes.high[k][box] = *std::max_element(boxes.high[k] + first, boxes.high[k] + last);
        }
}

/// Writes the codes of a grid's boxes at a key, grown by `grow`, between the planes of `whole`.
void write_codes(const WideGrid& record, const KeyBounds& whole, const BlockBoxes& boxes, float grow,
                 uint8_t* out) {
    const int count = record.box_count();
    for (int k = 0; k < 3; ++k) {
        const CodeScale scale(whole.low[k], whole.high[k]);
        const float per_step = 1 / scale.step;
        for (int b = 0; b < count; ++b) {
            out[k * count + b] = code_below(scale, per_step, boxes.low[k][b] - grow);
            out[(3 + k) * count + b] = code_above(scale, per_step, boxes.high[k][b] + grow);
        }
    }
}

/// Bounds over some keys, grown: in camera space (`first` 0) or in the axes (3).
KeyBounds bounds_of_all(const KeyBox6* wholes, int key_count, int first, float grow) {
    KeyBounds all;
    for (int k = 0; k < 3; ++k) {
        float low = wholes[0].low[first + k], high = wholes[0].high[first + k];
        for (int key = 1; key < key_count; ++key)
            low = std::min(low, wholes[key].low[first + k]),
            high = std::max(high, wholes[key].high[first + k]);
        all.low[k] = low - grow, all.high[k] = high + grow;
    }
    return all;
}

/// Writes what a grid has at its keys, as WideGrid tells. All bounds grow by `grow`; what codes are between
/// grows by `more` than what they are of, once more for each level of codes, so that code_below() finds a
/// plane.
void write_keys(const WideGrid& record, const KeyBox6* wholes, const BlockBoxes* boxes, float grow,
                float more, uint8_t* out) {
    const int keys = record.key_count;
    const float whole_grow = grow + more, all_grow = record.moves() ? whole_grow + more : whole_grow;
    const KeyBounds oriented = bounds_of_all(wholes, keys, 3, all_grow),
                    aligned = bounds_of_all(wholes, keys, 0, all_grow);
    std::memcpy(out, &oriented, sizeof(oriented));
    if (record.has_segments()) std::memcpy(out + sizeof(oriented), &aligned, sizeof(aligned));
    uint8_t* at = out + record.header_bytes();
    for (int key = 0; key < keys; ++key, at += record.key_bytes()) {
        if (record.moves()) KeyBoundsScale(oriented).write(bounds_of_all(wholes + key, 1, 3, whole_grow), at);
        if (record.has_segments())
            KeyBoundsScale(aligned).write(bounds_of_all(wholes + key, 1, 0, whole_grow), at + 6);
        write_codes(record, GridKeys(record, out).oriented(key), boxes[key], grow,
                    at + record.bounds_bytes());
    }
}

}  // namespace

void bound_grid(const Grid& grid, float scale, float base, WideGrid& record, uint8_t* keys,
                GridExtent& extent) {
    record.axes = packed(axes_of_grid(grid));
    const GridAxes axes = record.axes.unpacked();
    record.planes = grid.positions;
    record.nu = grid.shape.nu, record.nv = grid.shape.nv;
    record.key_count = grid.key_count;
    record.facing = static_cast<uint8_t>(grid.facing) & 15;
    record.opaque = grid.opaque;

    KeyBox6 wholes[kMaxKeyCount];
    // Kept between calls, so that a grid allocates nothing.
    static thread_local std::vector<BlockBoxes> blocks;
    blocks.resize(grid.key_count);
    float extents[3];
    HWY_DYNAMIC_DISPATCH(bound_keys)(grid, axes.axis, wholes, blocks.data(), extents);

    float largest = 0;
    for (int key = 0; key < grid.key_count; ++key)
        for (int k = 0; k < 3; ++k)
            largest = std::max({largest, std::abs(wholes[key].low[k]), std::abs(wholes[key].high[k])});
    extent.absolute_max = largest <= kBoundableCoordinate ? largest : HUGE_VALF;
    const float grow = scale * largest + base;
    // What decoding may differ by on another target (box_codes-inl.h): boxes grow by it, too.
    const float code_rounding = kCodeRounding * largest;
    for (int k = 0; k < 3; ++k) {
        float low[2], high[2];
        line_around(wholes, grid.key_count, true, k, low);
        line_around(wholes, grid.key_count, false, k, high);
        for (int end = 0; end < 2; ++end) {
            extent.box.at[end].low[k] = low[end] - grow;
            extent.box.at[end].high[k] = high[end] + grow;
        }
    }
    extent.largest_micropolygon = std::max({extents[0], extents[1], extents[2]}) + grow;
    const bool bounded = largest <= kBoundableCoordinate;
    constexpr uint16_t kInfinite = 0x7f80;  // as bfloat16
    for (int k = 0; k < 3; ++k) record.extent[k] = bounded ? bfloat16_above(extents[k] + grow) : kInfinite;
    record.coordinate = bounded ? bfloat16_above(largest) : kInfinite;
    if (record.blocks_per_box() > 1)
        for (BlockBoxes& boxes : blocks) join_blocks(record, boxes);
    write_keys(record, wholes, blocks.data(), grow + code_rounding, code_rounding, keys);
}

}  // namespace trapeze
#endif  // HWY_ONCE
