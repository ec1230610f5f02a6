/// A shaded micropolygon grid, as visibility methods and the resolver read it [decision 0016].
///
/// Positions are in camera space, in planes of tiles of 4x4 vertices (16 floats, 64-byte aligned), so that a
/// vector register holds a tile:
///
///     vertex (i, j) of a plane is at tile (i / 4, j / 4), lane (j % 4) * 4 + i % 4; tiles run along u first.
///
/// Lanes past the last row or column repeat it. A static grid has the planes X Y Z; a moving one has, for
/// each of its key_count - 1 segments, X Y Z at the segment's first key and then DX DY DZ to its next key; a
/// vertex is at position_at(x, dx, local_time). Colours are row by row (no tiles): Ci red green blue, then Oi
/// unless opaque, in halves, or in floats where a picture is to hold more than halves; after them come the
/// channels of output variables (aov.h), if any, in floats: a half is too coarse for positions.
#pragma once

#include <Imath/half.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "core/hit_micropolygon.h"
#include "core/math.h"
#include "core/motion_keys.h"

namespace trapeze {

/// A grid has at most this many micropolygons along a side, so that MicropolygonId packs u and v into four
/// bits each.
inline constexpr int kMaxGridSide = 16;  ///< micropolygons along u or v
inline constexpr int kMaxGridVertices = (kMaxGridSide + 1) * (kMaxGridSide + 1);

/// nu x nv micropolygons, (nu + 1) x (nv + 1) vertices.
struct GridShape {
    uint8_t nu = 1, nv = 1;

    int vertices_u() const { return nu + 1; }
    int vertices_v() const { return nv + 1; }
    int vertex_count() const { return vertices_u() * vertices_v(); }
    int micropolygon_count() const { return nu * nv; }
    int tiles_u() const { return (nu + 4) / 4; }
    int tiles_v() const { return (nv + 4) / 4; }
    int plane_size() const { return tiles_u() * tiles_v() * 16; }  ///< floats
    /// The place of vertex (i, j) in a plane of tiles; row_index(): in a plane of rows.
    int tiled_index(int i, int j) const {
        return ((j >> 2) * tiles_u() + (i >> 2)) * 16 + (j & 3) * 4 + (i & 3);
    }
    int row_index(int i, int j) const { return j * vertices_u() + i; }
    bool operator==(const GridShape&) const = default;
};

/// A micropolygon within a frame's (or region's) grids: index of the grid, then v * 16 + u within it. The
/// order of these numbers is the order of the grids' ordinals, which breaks ties of equal depth the same way
/// for any region split.
struct MicropolygonId {
    uint32_t grid = 0;
    uint8_t u = 0, v = 0;

    static constexpr uint64_t kNone = ~uint64_t{0};
    uint64_t packed() const { return uint64_t{grid} << 8 | uint64_t{v} << 4 | u; }
    /// The inverse of packed().
    static MicropolygonId unpack(uint64_t id) {
        return {static_cast<uint32_t>(id >> 8), static_cast<uint8_t>(id & 15),
                static_cast<uint8_t>(id >> 4 & 15)};
    }
};

/// One grid. The memory belongs to a GridArena; a Grid is cheap to copy.
struct Grid {
    GridShape shape;
    uint8_t key_count = 1;
    Facing facing = Facing::Both;
    bool opaque = true;           ///< Oi is 1 everywhere and there is no Oi plane
    bool float_colors = false;    ///< colours are floats, else halves; alike for all grids of a frame
    bool smooth = false;          ///< colours are interpolated in a micropolygon, else vertex 00's holds
    uint8_t matte = 0;            ///< 1: holds out
    uint8_t aov_channels = 0;     ///< of output variables; 0 unless Displays ask for some
    uint32_t primitive = 0;       ///< index in Scene::primitives
    uint64_t ordinal = 0;         ///< place in the order of the whole frame's grids
    float* positions = nullptr;   ///< plane_count() * shape.plane_size() floats
    std::byte* colors = nullptr;  ///< color_count() halves or floats, then aov_plane()s

    bool moves() const { return key_count > 1; }
    int plane_count() const { return moves() ? 6 * (key_count - 1) : 3; }
    int color_plane_count() const { return opaque ? 3 : 6; }
    size_t color_count() const { return static_cast<size_t>(color_plane_count()) * shape.vertex_count(); }
    /// Bytes before the planes of output variables, which are aligned as floats.
    size_t color_bytes() const {
        return (color_count() * (float_colors ? sizeof(float) : sizeof(Imath::half)) + 3) & ~size_t{3};
    }

    /// component 0..2: X Y Z at the segment's first key; 3..5: DX DY DZ over it (moving grids only).
    float* plane(int segment, int component) const {
        return positions + static_cast<size_t>(segment * 6 + component) * shape.plane_size();
    }

    /// Position of a vertex at a time, by the arithmetic all methods share.
    V3f vertex(int i, int j, float time01) const {
        const int at = shape.tiled_index(i, j);
        if (!moves()) return {plane(0, 0)[at], plane(0, 1)[at], plane(0, 2)[at]};
        const MotionSegment s = segment_at(time01, key_count);
        return {position_at(plane(s.index, 0)[at], plane(s.index, 3)[at], s.local),
                position_at(plane(s.index, 1)[at], plane(s.index, 4)[at], s.local),
                position_at(plane(s.index, 2)[at], plane(s.index, 5)[at], s.local)};
    }

    /// Position of a vertex at a key of a possibly finer set of keys (key_count - 1 divides keys - 1, or is
    /// static).
    V3f vertex_at_key(int i, int j, int key, int keys) const {
        return vertex(i, j, keys <= 1 ? 0.0f : static_cast<float>(key) / static_cast<float>(keys - 1));
    }

    /// The four corners of micropolygon (u, v) at a time, with axes turned as asked (see TurnedRay): what
    /// vertex() says of each, found at once.
    Quad quad(int u, int v, float time01, int x_plane = 0, int y_plane = 1, int z_plane = 2) const {
        const MotionSegment s = segment_at(time01, key_count);
        const float* x = plane(s.index, x_plane);
        const float* y = plane(s.index, y_plane);
        const float* z = plane(s.index, z_plane);
        const size_t to_change = 3 * shape.plane_size();
        Quad q;
        for (int corner = 0; corner < 4; ++corner) {
            const size_t at = static_cast<size_t>(shape.tiled_index(u + (corner & 1), v + (corner >> 1)));
            q.x[corner] = x[at], q.y[corner] = y[at], q.z[corner] = z[at];
            if (!moves()) continue;
            q.x[corner] = position_at(q.x[corner], x[at + to_change], s.local);
            q.y[corner] = position_at(q.y[corner], y[at + to_change], s.local);
            q.z[corner] = position_at(q.z[corner], z[at + to_change], s.local);
        }
        return q;
    }

    V3f color(int i, int j) const { return color_at(0, i, j); }
    V3f opacity(int i, int j) const { return opaque ? V3f(1, 1, 1) : color_at(3, i, j); }

    /// The colours where they are halves, and where they are floats.
    Imath::half* half_colors() const { return reinterpret_cast<Imath::half*>(colors); }
    float* full_colors() const { return reinterpret_cast<float*>(colors); }

    /// shape.vertex_count() floats, row by row, of channel 0 .. aov_channels - 1.
    float* aov_plane(int channel) const {
        return reinterpret_cast<float*>(colors + color_bytes()) +
               static_cast<size_t>(channel) * shape.vertex_count();
    }

    size_t bytes() const {
        return sizeof(Grid) + sizeof(float) * static_cast<size_t>(plane_count()) * shape.plane_size() +
               color_bytes() + sizeof(float) * static_cast<size_t>(aov_channels) * shape.vertex_count();
    }

  private:
    V3f color_at(int first_plane, int i, int j) const {
        const size_t n = shape.vertex_count(), at = first_plane * n + shape.row_index(i, j);
        if (const float* c = full_colors() + at; float_colors) return {c[0], c[n], c[2 * n]};
        const Imath::half* c = half_colors() + at;
        return {c[0], c[n], c[2 * n]};
    }
};

/// Where grids' planes live: large 64-byte aligned chunks, freed together. One per thread while dicing.
class GridArena {
  public:
    GridArena() = default;
    /// Takes memory by as much at a time, or by what a grid needs.
    explicit GridArena(size_t chunk_bytes) : chunk_bytes_(chunk_bytes) {}
    GridArena(GridArena&&) noexcept = default;
    GridArena& operator=(GridArena&&) noexcept = default;

    /// Sets positions and colors of a grid whose shape, key_count, opaque, float_colors and aov_channels are
    /// set.
    void allocate(Grid& grid);
    size_t bytes() const { return bytes_; }

  private:
    static constexpr size_t kDefaultChunk = size_t{1} << 20;  ///< bytes

    /// 64-byte aligned memory, from the present chunk or a new one.
    std::byte* take(size_t size);

    struct Free {
        void operator()(std::byte* p) const;
    };
    std::vector<std::unique_ptr<std::byte, Free>> chunks_;
    std::byte* next_ = nullptr;
    size_t left_ = 0, bytes_ = 0;
    size_t chunk_bytes_ = kDefaultChunk;
};

/// The shaded grids of a region, sorted by ordinal.
struct Grids {
    std::vector<Grid> grids;
    std::vector<GridArena> arenas;

    uint64_t micropolygon_count() const;
    size_t bytes() const;
    /// The keys of the grid that has the most; 1 without grids.
    int max_key_count() const;
};

}  // namespace trapeze
