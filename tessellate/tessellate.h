/// Bound, split, dice [Cook87]: the room's door. A Tessellation holds a scene's surfaces and the list of
/// subpatches into which they were split, each of which dices to one grid. Splitting is done once a frame;
/// dicing when a region needs the grid, with the same bits each time.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/depth_height.h"
#include "core/scene/render_context.h"
#include "core/scene/shading_grid.h"
#include "core/stats.h"

namespace trapeze {

/// What scheduling needs to know of a subpatch without dicing it. One for every grid of the frame: kept
/// small.
struct SubpatchInfo {
    PixelRect
        bound;  ///< raster pixels that its samples may see, grown by motion, lens and displacement bound; not
                ///< by the pixel filter. Clamped to the picture grown by the filter's radius.
    GridShape shape;
    uint8_t key_count = 1;
    uint32_t primitive = 0;
};

/// A place of a subpatch, in its own unit square. Where a ray of a shader has hit, mostly.
struct SubpatchPoint {
    size_t subpatch = 0;  ///< its number in a Tessellation
    V2f at{0, 0};
    /// Whose place and attributes it has, by index in the scene: of the same shape as the subpatch's, and
    /// seen as that is. Nothing: the subpatch's own.
    std::optional<uint32_t> primitive = {};
};

/// For whom a scene is split. What rays of shaders meet is neither culled nor foreshortened: every primitive
/// that some kind of ray sees (RayAttributes), with micropolygons as large as a pixel is at their distance
/// from the eye.
enum class SeenBy : uint8_t { Camera, Rays };

/// What is wanted of a grid.
enum class DiceFor : uint8_t {
    Shaders,  ///< all that they read
    Hits,  ///< where it is, and its primitive's colour and opacity: rays that shade nothing at its vertices
};

class Tessellation;

/// How a scene is split.
struct TessellationOptions {
    /// Tells something of a primitive of the scene, by its index.
    using OfPrimitive = std::function<bool(uint32_t)>;

    /// Without it Blobbies that ask for depth maps are made as if there were none.
    FindDepthHeight depth_heights;
    /// For lists of subpatches, edges and vertices: of all primitives together, and of each.
    size_t most_bytes = std::numeric_limits<size_t>::max();
    /// Lists of subpatches that are too much are made again, a part at a time, when one is asked for; only
    /// lists of edges and vertices, which take about what the surfaces do, have to fit into three quarters.
    bool lists_again = false;
    OfPrimitive is_displaced;   ///< though it has no displacement shader
    OfPrimitive is_left_whole;  ///< not split: it is there for SubpatchPoint::primitive alone
    SeenBy seen_by = SeenBy::Camera;
    /// Sides of micropolygons wish to be so long at least, in pixels; the shading rate may say longer.
    float least_side = 0;
    /// Flat faces have larger micropolygons (tessellate/measure/flat_faces.h). Seen by rays alone, and for
    /// DiceFor::Hits.
    bool larger_where_flat = false;
    /// Another one of the same scene, whose surfaces are taken over; what it left out is left out. Null:
    /// they are made.
    const Tessellation* surfaces_of = nullptr;
};

/// A thread's memory for dicing one Tessellation. Not for another one: surfaces leave their own scratch here.
class DiceScratch {
  public:
    DiceScratch();
    DiceScratch(DiceScratch&&) noexcept;
    DiceScratch& operator=(DiceScratch&&) noexcept;
    ~DiceScratch();
    /// Defined in tessellate/dice.h, which only this room sees.
    struct State;
    std::unique_ptr<State> state;
};

/// A frame's primitives, split. Immutable once made: dicing reads it from many threads. The context's scene
/// outlives it.
class Tessellation {
  public:
    /// Splits all primitives, in parallel; the order of subpatches does not depend on the threads. A
    /// primitive that alone takes more than the most bytes is left out. When several together take more,
    /// those from the first one on with which it is too much are left out. Both are errors. Other bad
    /// primitives are left out one by one, each with a diagnostic.
    explicit Tessellation(const RenderContext& context, const TessellationOptions& options = {});
    ~Tessellation();

    /// Subpatches that may be seen, in the order that defines Grid::ordinal: primitive by primitive, face by
    /// face. None where makes_lists_again().
    const std::vector<SubpatchInfo>& subpatches() const { return infos_; }
    /// Whether some lists are not kept (TessellationOptions::lists_again).
    bool makes_lists_again() const;
    /// Whether some micropolygons are larger because they are flat (TessellationOptions::larger_where_flat).
    bool has_larger_flats() const;
    size_t subpatch_count() const { return static_cast<size_t>(stats_.subpatches); }
    /// The primitive of a subpatch, and the number behind the last one of that.
    uint32_t primitive_of(size_t subpatch) const;
    size_t end_of_primitive(size_t subpatch) const;
    GridShape shape_of(size_t subpatch) const;
    const TessellateStats& stats() const { return stats_; }
    /// Memory of the lists of subpatches, edges and vertices that are held now; surfaces themselves are not
    /// counted.
    size_t bytes() const;

    /// Dices one subpatch, by its number: positions at all keys (camera space), normals,
    /// derivatives, variables at shutter open; Ci and Oi are sized but not set. Thread-safe with a scratch
    /// per thread. For hits alone normals, derivatives and variables but Cs and Os are sized, not set.
    void dice(size_t subpatch, ShadingGrid& grid, DiceScratch& scratch,
              DiceFor wanted = DiceFor::Shaders) const;

    /// Makes a grid of one micropolygon with a vertex at a place of a subpatch, whose number is returned. Its
    /// sides are as long as those of the subpatch's grid. No vertex is moved to that of a neighbour: the
    /// place is on the limit surface. Thread-safe with a scratch per thread.
    int dice_point(const SubpatchPoint& point, ShadingGrid& grid, DiceScratch& scratch) const;

  private:
    struct Impl;
    /// A subpatch in its lists.
    struct Listed;
    Listed listed(size_t subpatch) const;
    void number_subpatches(size_t most_bytes);

    std::unique_ptr<Impl> impl_;
    std::vector<SubpatchInfo> infos_;
    TessellateStats stats_;
};

}  // namespace trapeze
