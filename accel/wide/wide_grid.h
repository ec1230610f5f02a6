/// A grid as a WideTree keeps it: where grids are small, what each of them takes decides the tree's size.
#pragma once

#include <cstdint>
#include <cstring>

#include "accel/wide/bfloat16.h"
#include "accel/wide/box_codes.h"

namespace trapeze {

/// A box that moves linearly: at time t its planes are at low + t * low_delta and high + t * high_delta.
struct MovingBox {
    float low[3], high[3], low_delta[3], high_delta[3];
};

/// The box that moves from one key's bounds to another's while time goes from 0 to 1.
inline MovingBox between(const KeyBounds& from, const KeyBounds& to) {
    MovingBox box;
    for (int k = 0; k < 3; ++k) {
        box.low[k] = from.low[k], box.low_delta[k] = to.low[k] - from.low[k];
        box.high[k] = from.high[k], box.high_delta[k] = to.high[k] - from.high[k];
    }
    return box;
}

/// The axes of a grid: unit vectors at right angles but for kLoss.
struct GridAxes {
    float axis[3][3];

    /// What two ways to write a vector in the axes differ by, of the sum of its coordinates there: twice
    /// what PackedAxes round away, by three axes.
    static constexpr float kLoss = 2e-4f;
};
/// The same axes in 16 bits a component, in steps of 1 / kOne. Bounds are made with the axes as unpacked, so
/// that what packing rounds away loosens no bound; it makes the axes a little less than orthogonal.
struct PackedAxes {
    /// The code of a component of 1.
    static constexpr float kOne = 32767;
    int16_t code[3][3];

    GridAxes unpacked() const {
        GridAxes axes;
        for (int k = 0; k < 3; ++k)
            for (int c = 0; c < 3; ++c) axes.axis[k][c] = static_cast<float>(code[k][c]) * (1 / kOne);
        return axes;
    }
};

/// The record of a grid. What it has at its keys lies apart, in bytes:
///
///   the grid's bounds in its axes, over all keys; where it has segments, those in camera space besides;
///   for each key, where it moves, the same as codes between those, low x, y, z, high x, y, z;
///   for each key the codes of all its boxes, between its bounds in the axes at that key: low x of all
///   boxes, low y, low z, high x, high y, high z.
struct WideGrid {
    const float* planes;  ///< Grid::positions
    uint32_t first_pair;  ///< of bytes, of its keys
    uint32_t leaf;        ///< where the top level has its box: node * WideNode::kChildren + child
    /// bfloat16, rounded up: the largest extent of a micropolygon along each axis of space, and the largest
    /// |coordinate| of vertices in space and in the axes; infinite where a grid has no bounds.
    uint16_t extent[3], coordinate;
    PackedAxes axes;
    uint8_t nu, nv;
    uint8_t key_count;
    uint8_t facing : 4, opaque : 4;

    bool moves() const { return key_count > 1; }
    float largest_extent(int axis) const { return from_bfloat16(extent[axis]); }
    /// How far before the depth at which a camera ray enters a box a hit may lie [decision 0004].
    float slack() const { return largest_extent(2); }
    float largest_coordinate() const { return from_bfloat16(coordinate); }
    /// Tiles as in GridShape: of vertices, so that one tile more may follow the last block.
    int tiles_u() const { return (nu + 4) / 4; }
    int tiles_v() const { return (nv + 4) / 4; }
    size_t plane_size() const { return static_cast<size_t>(tiles_u() * tiles_v()) * 16; }
    int blocks_u() const { return (nu + 3) / 4; }
    int blocks_v() const { return (nv + 3) / 4; }
    int block_count() const { return blocks_u() * blocks_v(); }
    /// A ribbon's blocks, four micropolygons each, share boxes: memory counts there.
    int blocks_per_box() const { return nu == 1 || nv == 1 ? kRibbonBlocksPerBox : 1; }
    int box_count() const { return (block_count() + blocks_per_box() - 1) / blocks_per_box(); }
    /// Whether it moves in several segments: then each has bounds of its own in camera space, too. What turns
    /// fast, as wheels do, is nearly everywhere during the shutter, and somewhere in each segment.
    bool has_segments() const { return key_count > 2; }

    /// Sizes in bytes of the header, of a key's bounds, of a key with its boxes, of all. All even, so that
    /// first_pair can count pairs.
    size_t header_bytes() const { return (has_segments() ? 2 : 1) * sizeof(KeyBounds); }
    size_t bounds_bytes() const { return has_segments() ? 12 : moves() ? 6 : 0; }
    size_t key_bytes() const { return bounds_bytes() + static_cast<size_t>(box_count()) * 6; }
    size_t keys_bytes() const { return header_bytes() + key_count * key_bytes(); }

    /// Four boxes a ribbon instead of one saved no time and cost memory [decision 0006].
    static constexpr int kRibbonBlocksPerBox = 4;
};

static_assert(sizeof(WideGrid) == 48, "hair has one for every 16 micropolygons");

/// Reads what a grid has at its keys. The bytes need no alignment.
class GridKeys {
  public:
    GridKeys(const WideGrid& grid, const uint8_t* bytes) : grid_(grid), bytes_(bytes) {}

    /// Rows of codes of its boxes.
    const uint8_t* box_codes(int key) const { return of_key(key) + grid_.bounds_bytes(); }
    /// The grid's bounds at a key in its axes: what box_codes() are between.
    KeyBounds oriented(int key) const { return grid_.moves() ? decoded(0, of_key(key)) : header(0); }
    /// The grid's bounds at a key in camera space; only of a grid that has_segments().
    KeyBounds aligned(int key) const { return decoded(1, of_key(key) + 6); }

    /// Where the bytes of one key begin: its bounds, then the codes of boxes.
    const uint8_t* of_key(int key) const {
        return bytes_ + grid_.header_bytes() + static_cast<size_t>(key) * grid_.key_bytes();
    }

  private:
    /// Bounds over all keys: 0 in the axes, 1 in camera space.
    KeyBounds header(size_t which) const {
        KeyBounds bounds;
        std::memcpy(&bounds, bytes_ + which * sizeof(bounds), sizeof(bounds));
        return bounds;
    }
    /// Bounds from codes between header(which).
    KeyBounds decoded(size_t which, const uint8_t* codes) const {
        return KeyBoundsScale(header(which)).bounds(codes);
    }

    const WideGrid& grid_;
    const uint8_t* bytes_;
};

/// A whole grid in its axes in one segment of its motion; times are local to it.
struct OrientedSegment {
    GridAxes axes;
    KeyBounds at[2];   ///< the segment's begin and its end
    MovingBox box;     ///< between them
    float beyond = 0;  ///< vectors of four are stored
};

}  // namespace trapeze
