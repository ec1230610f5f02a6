/// Grids and samples in raster space for tests of this room: a micropolygon covers a pixel (or so), rays run
/// along z, and what a sample sees follows from its position, so that no visibility method is needed.
#pragma once

#include <cmath>
#include <cstring>
#include <functional>
#include <vector>

#include "composite/image.h"
#include "core/grid.h"
#include "core/hit_buffer.h"
#include "core/random.h"
#include "core/samples.h"
#include "core/scene/render_context.h"

namespace trapeze::testing {

/// A scene of nothing but options, with its context.
struct RasterScene {
    Scene scene;
    Diagnostics diagnostics;
    RenderContext context;

    RasterScene(int width, int height, int samples_side) {
        scene.options.width = width, scene.options.height = height;
        scene.options.samples_x = scene.options.samples_y = static_cast<float>(samples_side);
        update();
    }
    RasterScene(const RasterScene&) = delete;

    /// After a change of the options.
    void update() {
        context.scene = &scene;
        context.camera = make_camera(scene.options);
        context.samples_x = static_cast<int>(scene.options.samples_x);
        context.samples_y = static_cast<int>(scene.options.samples_y);
        context.diagnostics = &diagnostics;
    }
    PixelRect sampled() const { return sampled_pixels(context.camera, scene.options); }
};

inline int floor_to_tile(int pixel) {
    return static_cast<int>(std::floor(static_cast<float>(pixel) / kTileSide)) * kTileSide;
}

inline std::vector<PixelRect> tiles_of(const PixelRect& pixels) {
    std::vector<PixelRect> tiles;
    for (int y = floor_to_tile(pixels.y0); y < pixels.y1; y += kTileSide)
        for (int x = floor_to_tile(pixels.x0); x < pixels.x1; x += kTileSide)
            tiles.push_back(intersection({x, y, x + kTileSide, y + kTileSide}, pixels));
    return tiles;
}

/// Jittered samples whose positions depend on pixel and index alone.
inline SampleTile make_samples(const RasterScene& scene, const PixelRect& pixels) {
    SampleTile tile;
    tile.pixels = pixels;
    const int nx = scene.context.samples_x, ny = scene.context.samples_y;
    tile.samples_per_pixel = nx * ny;
    tile.resize(static_cast<size_t>(pixels.width()) * pixels.height() * tile.samples_per_pixel);
    size_t at = 0;
    for (int py = pixels.y0; py < pixels.y1; ++py)
        for (int px = pixels.x0; px < pixels.x1; ++px)
            for (int s = 0; s < nx * ny; ++s, ++at) {
                const auto jitter = [&](uint32_t dimension) {
                    return unit_float(hash(static_cast<uint32_t>(px), static_cast<uint32_t>(py),
                                           static_cast<uint32_t>(s), dimension));
                };
                tile.x[at] = static_cast<float>(px) +
                             (static_cast<float>(s % nx) + jitter(0)) / static_cast<float>(nx);
                tile.y[at] = static_cast<float>(py) +
                             (static_cast<float>(s / nx) + jitter(1)) / static_cast<float>(ny);
                tile.time[at] = jitter(2);
                tile.rays[at] = {tile.x[at], tile.y[at], 0, 0, 0, tile.time[at]};
            }
    return tile;
}

struct GridLook {
    std::function<V3f(int x, int y)> color, opacity;  ///< of the vertex at raster (x, y); no opacity: opaque
    bool smooth = false;
    uint8_t matte = 0;
    float depth = 1;
    uint32_t primitive = 0;
    int aov_channels = 0;
    std::function<float(int x, int y, int channel)> aov;  ///< of the vertex at raster (x, y)
};

/// Asks for an output variable.
inline Display aov_display(std::string name, ValueType type, std::string file = {}) {
    Display display{std::move(file), "exr", "varying ...", {}, {}};
    display.variable = DisplayVariable{std::move(name), type};
    return display;
}

/// Static grids of one-pixel micropolygons that tile the pixels (0, 0) .. (16 * columns, 16 * rows),
/// appended.
inline void add_grids(Grids& grids, int columns, int rows, const GridLook& look) {
    GridArena arena;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            Grid grid;
            grid.shape = {kMaxGridSide, kMaxGridSide};
            grid.opaque = !look.opacity;
            grid.smooth = look.smooth;
            grid.matte = look.matte;
            grid.primitive = look.primitive;
            grid.ordinal = grids.grids.size();
            grid.aov_channels = static_cast<uint8_t>(look.aov_channels);
            arena.allocate(grid);
            const int n = grid.shape.vertex_count();
            for (int j = 0; j <= kMaxGridSide; ++j)
                for (int i = 0; i <= kMaxGridSide; ++i) {
                    const int x = column * kMaxGridSide + i, y = row * kMaxGridSide + j;
                    const int tiled = grid.shape.tiled_index(i, j), at = grid.shape.row_index(i, j);
                    grid.plane(0, 0)[tiled] = static_cast<float>(x);
                    grid.plane(0, 1)[tiled] = static_cast<float>(y);
                    grid.plane(0, 2)[tiled] = look.depth;
                    const V3f color = look.color(x, y), opacity = look.opacity ? look.opacity(x, y) : V3f(1);
                    for (int c = 0; c < look.aov_channels; ++c) grid.aov_plane(c)[at] = look.aov(x, y, c);
                    for (int c = 0; c < 3; ++c) {
                        grid.half_colors()[c * n + at] = color[c];
                        if (look.opacity) grid.half_colors()[(3 + c) * n + at] = opacity[c];
                    }
                }
            grids.grids.push_back(grid);
        }
    grids.arenas.push_back(std::move(arena));
}

/// What each sample sees of one layer of grids (those of an add_grids that began at `first`), where `covers`
/// says so.
inline HitBuffer make_hits(const SampleTile& samples, const Grids& grids, int columns, int rows,
                           const std::function<bool(float x, float y)>& covers, uint32_t first = 0) {
    HitBuffer hits;
    hits.first.push_back(0);
    for (size_t s = 0; s < samples.size(); ++s) {
        const int x = static_cast<int>(std::floor(samples.x[s])),
                  y = static_cast<int>(std::floor(samples.y[s]));
        const int column = x / kMaxGridSide, row = y / kMaxGridSide;
        if (x >= 0 && y >= 0 && column < columns && row < rows &&
            (!covers || covers(samples.x[s], samples.y[s]))) {
            const MicropolygonId id{first + static_cast<uint32_t>(row * columns + column),
                                    static_cast<uint8_t>(x % kMaxGridSide),
                                    static_cast<uint8_t>(y % kMaxGridSide)};
            hits.hits.push_back({grids.grids[id.grid].plane(0, 2)[0], id.packed()});
        }
        hits.first.push_back(static_cast<uint32_t>(hits.hits.size()));
    }
    return hits;
}

/// Whether a pixel of both windows has the same colour, depth, id and variables, bit for bit.
inline bool same_pixel(const Image& a, const Image& b, int x, int y) {
    const auto same = [&](const auto& of_a, const auto& of_b, int channels) {
        const auto count = static_cast<size_t>(channels);
        return std::memcmp(of_a.data() + count * a.index(x, y), of_b.data() + count * b.index(x, y),
                           count * sizeof of_a[0]) == 0;
    };
    return same(a.rgba, b.rgba, 4) && same(a.z, b.z, 1) && (a.id.empty() || same(a.id, b.id, 1)) &&
           (a.aov_channels == 0 || same(a.aovs, b.aovs, a.aov_channels));
}

}  // namespace trapeze::testing
