/// Shadow maps: percentage-closer filtering [Reeves87, "Rendering Antialiased Shadows with Depth Maps"].
///
/// A lookup compares depths at `samples` places, jittered in a grid over the region of the map that a
/// micropolygon covers, times width, plus blur; it is at least a texel wide, so that edges are smooth close
/// up.
///
/// Departs from the paper: what is compared with a texel is not the depth of P but that of the plane through
/// P along dPdu and dPdv, at the texel's middle. Surfaces seen at a slant then do not shadow themselves
/// however wide the region is, and the bias need only cover what a depth map's samples vary by inside a
/// texel, for which half the plane's change over a texel is added to it. On a plane the depth (orthographic)
/// or its inverse (perspective) is linear in the map.
#include <algorithm>
#include <array>
#include <bit>

#include "core/random.h"
#include "shade/maps/map_lanes.h"
#include "shade/maps/map_space.h"
#include "shade/maps/openimageio/map_cache.h"

namespace trapeze {
namespace {

using map_lanes::value;

/// The bias where none is asked for, as a part of P's depth.
constexpr float kDefaultBias = 1e-3f;
/// A plane seen nearly edge on is followed no farther than to this part of P's depth, nearer or farther.
constexpr float kPlaneReach = 0.25f;

/// Depths through the cache. The last tile of each of four is held, where a region's four corners mostly lie.
class DepthReader {
  public:
    DepthReader(OIIO::ImageCache& cache, OIIO::ImageCache::Perthread* thread, const MapCache::ShadowMap& map)
        : cache_(cache),
          thread_(thread),
          image_(static_cast<const CachedMap&>(map.map).image),
          map_(map.view) {}
    ~DepthReader() {
        for (const Tile& tile : tiles_) release(tile);
    }
    DepthReader(const DepthReader&) = delete;
    DepthReader& operator=(const DepthReader&) = delete;

    /// The depth of a pixel; kInfinity outside the file.
    float at(int x, int y) {
        if (x < map_.x0 || x >= map_.x1 || y < map_.y0 || y >= map_.y1) return kInfinity;
        Tile& tile = tiles_[static_cast<size_t>((x / kTile & 1) + 2 * (y / kTile & 1))];
        const OIIO::ROI& roi = tile.roi;
        if (x < roi.xbegin || x >= roi.xend || y < roi.ybegin || y >= roi.yend) fetch(x, y, tile);
        if (!tile.pixels) return kInfinity;
        const float depth = tile.pixels[static_cast<size_t>(y - roi.ybegin) * roi.width() +
                                        static_cast<size_t>(x - roi.xbegin)];
        return depth > 0 && depth < kInfinity ? depth : kInfinity;
    }
    bool failed() const { return failed_; }

  private:
    static constexpr int kTile = 64;  ///< pixels along a side of most files' tiles
    struct Tile {
        OIIO::ImageCache::Tile* held = nullptr;
        const float* pixels = nullptr;
        OIIO::ROI roi{0, 0, 0, 0};
    };

    void release(const Tile& tile) {
        if (tile.held) cache_.release_tile(tile.held);
    }
    void fetch(int x, int y, Tile& tile) {
        release(tile);
        tile = {};
        tile.held = cache_.get_tile(image_, thread_, 0, 0, x, y, 0, 0, 1);
        OIIO::TypeDesc format;
        const void* pixels = tile.held ? cache_.tile_pixels(tile.held, format) : nullptr;
        if (!pixels || format != OIIO::TypeDesc::FLOAT) {
            failed_ = true;
            return;
        }
        tile.pixels = static_cast<const float*>(pixels);
        tile.roi = cache_.tile_roi(tile.held);
    }

    OIIO::ImageCache& cache_;
    OIIO::ImageCache::Perthread* thread_;
    OIIO::ImageCache::ImageHandle* image_;
    const DepthView& map_;
    std::array<Tile, 4> tiles_;
    bool failed_ = false;
};

/// Where a lookup's samples lie, and the plane they are compared with.
struct Receiver {
    MapPoint at;
    float half_x = 0, half_y = 0;    ///< pixels
    float slope_x = 0, slope_y = 0;  ///< of `linear`, per pixel
    float least = 0, most = 0;       ///< bounds of the plane's depth
    bool perspective = true;

    /// Whether a depth is nearer than the plane at a place.
    bool is_behind(float depth, float x, float y) const {
        if (depth >= most) return false;
        if (depth < least) return true;
        const float plane = at.linear + slope_x * (x - at.x) + slope_y * (y - at.y);
        return perspective ? depth * plane < 1 : depth < plane;
    }
};

/// The region of a lookup and the plane through P, from the map's places of P and of its neighbours along u
/// and v.
Receiver make_receiver(const DepthView& map, const MapSpace& space, const MapPoint& at,
                       const std::array<V3f, 2>& neighbours, const MapOptions& options, size_t lane) {
    Receiver r;
    r.at = at, r.perspective = map.perspective;
    r.least = at.depth * (1 - kPlaneReach), r.most = at.depth * (1 + kPlaneReach);
    const MapPoint u = space(neighbours[0]), v = space(neighbours[1]);
    if (u.seen && v.seen) {
        const float ux = u.x - at.x, uy = u.y - at.y, vx = v.x - at.x, vy = v.y - at.y;
        r.half_x = 0.5f * (std::fabs(ux) + std::fabs(vx)) * std::max(options.swidth.at(lane), 0.0f);
        r.half_y = 0.5f * (std::fabs(uy) + std::fabs(vy)) * std::max(options.twidth.at(lane), 0.0f);
        const float area = ux * vy - uy * vx;
        const float du = u.linear - at.linear, dv = v.linear - at.linear;
        const float slope_x = (du * vy - dv * uy) / area, slope_y = (dv * ux - du * vx) / area;
        if (std::isfinite(slope_x) && std::isfinite(slope_y)) r.slope_x = slope_x, r.slope_y = slope_y;
    }
    const auto region = [](float half, float blur, float size) {
        return std::clamp(half + 0.5f * std::max(blur, 0.0f) * size, 0.5f, size);
    };
    r.half_x = region(r.half_x, options.sblur.at(lane), map.full_width);
    r.half_y = region(r.half_y, options.tblur.at(lane), map.full_height);
    return r;
}

constexpr float kHalfWord = 1.0f / 65536;

int floor_of(float x) {
    const int whole = static_cast<int>(x);
    return whole - (static_cast<float>(whole) > x ? 1 : 0);
}

/// The part of the samples that is hidden.
float hidden_part(DepthReader& depths, const Receiver& r, float bias, int samples, uint32_t seed) {
    const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<float>(samples))));
    const int rows = (samples + columns - 1) / columns;
    const float slope = 0.5f * (std::fabs(r.slope_x) + std::fabs(r.slope_y));
    bias += std::min(r.perspective ? slope * r.at.depth * r.at.depth : slope, r.at.depth * kPlaneReach);
    const float step_x = 2 * r.half_x / static_cast<float>(columns);
    const float step_y = 2 * r.half_y / static_cast<float>(rows);
    const float left = r.at.x - r.half_x, top = r.at.y - r.half_y;
    int hidden = 0;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const uint32_t bits = hash(seed++);
            const float jitter_x = static_cast<float>(bits >> 16) * kHalfWord;
            const float jitter_y = static_cast<float>(bits & 0xffff) * kHalfWord;
            const int x = floor_of(left + (static_cast<float>(column) + jitter_x) * step_x);
            const int y = floor_of(top + (static_cast<float>(row) + jitter_y) * step_y);
            const float depth = depths.at(x, y) + bias;
            if (r.is_behind(depth, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f)) ++hidden;
        }
    return static_cast<float>(hidden) / static_cast<float>(rows * columns);
}

/// A seed that follows from a point alone, so that it is shaded the same wherever and whenever it is looked
/// up.
uint32_t seed_of(const V3f& p) {
    return hash(std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y), std::bit_cast<uint32_t>(p.z));
}

bool may_reach(const DepthView& map, const Receiver& r) {
    return r.at.x + r.half_x > static_cast<float>(map.x0) && r.at.x - r.half_x < static_cast<float>(map.x1) &&
           r.at.y + r.half_y > static_cast<float>(map.y0) && r.at.y - r.half_y < static_cast<float>(map.y1);
}

}  // namespace

void OpenImageIoCache::shadow(const ShadowMap& map, const ShadowLookup& at, const M44f& camera_from_world,
                              const MapOptions& options, Lanes lanes, Plane out, const ReadFailed& failed) {
    const ThreadState thread(*this);
    DepthReader depths(*cache_, thread.of_cache(), map);
    const MapSpace space(map.view, camera_from_world);
    for (size_t i = 0; i < lanes.count; ++i) {
        if (!map_lanes::is_on(lanes, i)) continue;
        out[i] = 0;
        const V3f P = value(at.P, i);
        const MapPoint here = space(P);
        if (!here.seen) continue;
        const Receiver receiver =
            make_receiver(map.view, space, here, {P + value(at.dPdu, i), P + value(at.dPdv, i)}, options, i);
        if (!may_reach(map.view, receiver)) continue;
        const float own = options.bias.at(i), asked = own >= 0 ? own : map.bias;
        const float bias = asked >= 0 ? asked : kDefaultBias * here.depth;
        const auto samples =
            static_cast<int>(std::clamp(options.samples.at(i), 1.0f, static_cast<float>(kMostShadowSamples)));
        out[i] = hidden_part(depths, receiver, bias, samples, seed_of(P));
    }
    if (depths.failed()) failed(cache_->geterror());
    map_lanes::pad(lanes, out);
}

}  // namespace trapeze
