/// What rays that shaders trace meet [Hou10 sec. 4]: how the stage that shades asks the one that holds the
/// geometry for them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/math.h"
#include "core/scene/ray_ahead.h"
#include "core/scene/ray_facet.h"
#include "core/scene/ray_groups.h"
#include "core/scene/scene.h"
#include "core/scene/shading_grid.h"
#include "core/scene/surfels.h"

namespace trapeze {

/// What a ray is for: which primitives it meets follows from it (RayAttributes).
enum class RayKind : uint8_t { Diffuse, Specular, Transmission };

/// Which hits count for a ray.
struct RayFilter {
    /// Sides of surfaces: as Sides says, the outside (Front), the inside, or both.
    enum class Sides : uint8_t { OfAttributes, Front, Back, Both };
    Sides sides = Sides::OfAttributes;
    RaySubset subset;
    RaySubset excluded;  ///< does not count, unless it names nothing
    /// What has no Interior shader does not count, either; it may where it is a part of a solid.
    bool with_inside = false;
    std::optional<uint32_t> primitive;  ///< the only one that counts
    /// RaySurfaceHit::facet: as the ray meets it, or at all times.
    enum class Facets : uint8_t { NotTold, ThisTime, AllTimes };
    Facets facets = Facets::NotTold;

    /// Whether primitives that are in these groups count.
    bool admits(const std::vector<std::string>& groups) const {
        return subset.has(groups) && (excluded.names_none() || !excluded.has(groups));
    }
};

/// Of the geometry that rays meet: Option "trace" "levels".
inline constexpr int kMostRayLevels = 4;

/// How long sides of micropolygons are at least on a level of the geometry, in pixels; on level 0 they are as
/// long as the picture's.
inline float level_side(int level) {
    return level == 0 ? 0.0f : static_cast<float>(1 << (2 * level));
}

/// A place that surfaces may pass through of which nothing is known: micropolygons in whose planes it lies do
/// not count near to it.
struct LooseEnd {
    float most = -kInfinity;  ///< from it: where all hits count
    float half = 0;           ///< how far from it a plane passes in which it lies

    /// A quadrilateral's corners are 00, 10, 01 and 11. `displaced`: its surface is, and is rougher.
    bool lies_in(const std::array<V3f, 4>& corners, const V3f& place, bool displaced) const {
        constexpr float kRougher = 4;
        const auto& [p00, p10, p01, p11] = corners;
        const V3f normal = (p11 - p00).cross(p01 - p10), middle = (p00 + p10 + p01 + p11) / 4;
        const float height = std::abs((place - middle).dot(normal));
        return height <= half * (displaced ? kRougher : 1) * normal.length();
    }
};

/// The surface that a ray leaves, near its beginning. What rays meet of it lies within a slab along its
/// tangent plane: hits of micropolygons within the slab do not count (shade/rays/surface_slab.h).
struct LeftSurface {
    float most = 0;          ///< distances from which all hits count
    float half = kInfinity;  ///< of the slab's thickness; infinite: hits count from `most` on
    V3f normal{0, 0, 0};     ///< of the slab, unit length or 0
    LooseEnd loose = {};     ///< in place of all that, where the ray leaves no surface that is known
    /// With `loose`: a primitive that does not count either near the beginning, for it is left; else none.
    uint32_t own = ~uint32_t{0};

    /// From where on hits along a unit direction may count: where it has left the slab.
    float distance(const V3f& direction) const {
        const float rise = std::abs(direction.dot(normal));
        return half < most * rise ? half / rise : most;
    }
    /// Distances from where on all hits count.
    float sure() const { return std::max(most, loose.most); }
    /// Whether a way from the beginning leads out of the slab on the side of a direction.
    bool is_left(const V3f& way, const V3f& direction) const {
        const float height = way.dot(normal);
        return (direction.dot(normal) < 0 ? -height : height) > half;
    }
};

/// Which of all hits one is, for who goes on behind it or finds its place.
struct RayHitPlace {
    const void* grids = nullptr;     ///< in which it was found; null: nowhere
    const void* instance = nullptr;  ///< of what instances share
    float depth = 0;                 ///< there
    uint64_t id = 0;                 ///< MicropolygonId::packed()
};

/// The surfaces in one place that a ray has gone through. The last one's own next micropolygon may be met
/// there, too, and is the same surface; those of other primitives count.
class PassedSurfaces {
  public:
    /// Goes through a hit at a distance, whose surface ends at `until`; others may be met from `from` on,
    /// which is a little nearer than the hit. Returns from where on what is left of the ray counts: behind
    /// the place, where more surfaces are in it than are known apart.
    float add(uint32_t primitive, float distance, float from, float until, const RayHitPlace& hit) {
        if (distance < until_)
            until_ = std::max(until_, until);
        else
            from = std::max(from, until_), count_ = 0, until_ = until;
        last_ = hit;
        if (has(primitive, distance)) return from;
        if (count_ == kMost) return until_;
        primitives_[count_++] = primitive;
        return from;
    }
    bool has(uint32_t primitive, float distance) const {
        if (!(distance < until_)) return false;
        for (uint32_t i = 0; i < count_; ++i)
            if (primitives_[i] == primitive) return true;
        return false;
    }
    const RayHitPlace& last() const { return last_; }
    /// The ray begins behind a hit: what is met behind it counts, be it as near.
    void begin_behind(const RayHitPlace& hit) { last_ = hit; }

  private:
    static constexpr uint32_t kMost = 8;
    std::array<uint32_t, kMost> primitives_{};
    uint32_t count_ = 0;
    float until_ = -std::numeric_limits<float>::infinity();  ///< distance
    RayHitPlace last_;
};

/// Where a ray ends that leads to a place, not to a surface that is known.
struct ReachedPlace {
    float distance = kInfinity;  ///< from the ray's origin
    LooseEnd end = {};

    /// Distances up to where all hits count.
    float sure() const { return distance - end.most; }
};

/// A part of a ray, in camera space at shutter open: held there while the shutter is open, also where the
/// camera moves.
struct RaySegment {
    V3f origin, direction;                                        ///< of unit length
    float min = 0, max = std::numeric_limits<float>::infinity();  ///< distances from the origin that count
    float time = 0;                                               ///< 0 at shutter open, 1 at shutter close
    float spread = 0;   ///< how much wider it grows on each unit of its way: what it stands for is a cone
    uint8_t level = 0;  ///< of the geometry that it left; it meets none that is finer
    float number = 0;   ///< 0 to 1: which levels of detail in transition it sees (SeenNumbers)
    bool backwards = false;  ///< stands for light that goes the other way: what faces that way faces the ray
    LeftSurface left;
    ReachedPlace reached;
    PassedSurfaces passed;
    RayAhead* ahead = nullptr;        ///< what RayScene::closest() has found behind its last answers
    const RayFilter* only = nullptr;  ///< hits that count; null: all that the attributes let be seen
};

/// Where a ray meets a surface.
struct RaySurfaceHit {
    float distance = 0;
    uint32_t primitive = 0;                     ///< index in Scene::primitives
    const RayAttributes* attributes = nullptr;  ///< the primitive's
    bool from_outside = true;                   ///< else it comes from within the surface
    uint8_t level = 0;                          ///< of the geometry that was met: level_side() or longer
    bool of_solid = false;  ///< of a border of a solid, which may be made of several surfaces in one place
    bool keeps_opacity = true;           ///< no shader has to be asked for the opacity that hides others
    V3f opacity{1, 1, 1};                ///< the primitive's own, Os
    V3f color{1, 1, 1};                  ///< the primitive's own, Cs
    RayHitPlace place;                   ///< with `primitive` and `at`, what dice() finds it by
    V2f at{0, 0};                        ///< within the micropolygon
    std::optional<RayFacet> facet = {};  ///< where RayFilter::facets asks for it
};

/// The geometry that rays meet, at any time of the shutter. Immutable: threads share it.
class RayScene {
  public:
    virtual ~RayScene() = default;

    /// Whether any primitive is seen by rays of a kind.
    virtual bool has(RayKind kind) const = 0;
    /// hits[i]: the nearest hit within rays[i]. One-sided surfaces (Sides 1) are seen from outside only.
    /// Where geometry is made as rays come by it is made for all of them at once.
    virtual void closest(std::span<const RaySegment* const> rays, RayKind kind,
                         std::span<std::optional<RaySurfaceHit>> hits) const = 0;
    /// For RaySegment::ahead of a ray that goes on behind several surfaces; null: nothing is gained.
    virtual std::unique_ptr<RayAhead> look_ahead() const { return nullptr; }
    /// Whether something opaque is in the way of each; nothing where that cannot be told without its
    /// opacity.
    virtual void blocked(std::span<const RaySegment* const> rays, RayKind kind,
                         std::span<std::optional<bool>> blocked) const = 0;
    /// How many rays a thread should ask for at once, at least: more than otherwise where that spares making
    /// geometry again.
    virtual size_t rays_at_once() const = 0;
    /// Makes a grid of one micropolygon with a vertex at the hit, of which the number is returned, on the
    /// limit surface; at all its keys where it moves. Its sides are those of the ray's geometry.
    virtual int dice(const RaySurfaceHit& hit, ShadingGrid& grid) const = 0;
    /// A pixel's side at a point, camera space: rays know surfaces no better.
    virtual float spacing(const V3f& P) const = 0;
    /// All that rays of a kind meet as discs, at shutter open in camera space; the areas are smaller where
    /// surfaces are not opaque. Nothing where it takes more than `most_bytes`.
    virtual std::optional<Surfels> surfels(RayKind, size_t /*most_bytes*/) const { return {}; }
    /// As dice(), with the vertex in the middle of what a disc of surfels() stands for, by its id.
    virtual int dice_surfel(uint64_t /*id*/, ShadingGrid& /*grid*/) const { return -1; }
    /// Calls it in as many threads as there are, or in fewer; the thread that asks does nothing else
    /// meanwhile.
    virtual void in_parallel(const std::function<void()>& work) const { work(); }
};

}  // namespace trapeze
