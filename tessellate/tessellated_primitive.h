/// One primitive of a tessellation: placed, measured and split.
#pragma once

#include <atomic>
#include <memory>

#include "core/scene/render_context.h"
#include "tessellate/dice.h"
#include "tessellate/relisting.h"
#include "tessellate/tessellate.h"

namespace trapeze {

/// A primitive's part of a Tessellation. The surface may be shared with other primitives; all else is its
/// own, since rates depend on where it is.
struct TessellatedPrimitive {
    std::shared_ptr<const Surface> surface;
    std::unique_ptr<PlacedSurface> placed;
    VertexTable vertices;
    EdgeTessellations surface_edges;
    Splits splits;
    size_t first_subpatch = 0;
    float pixels_per_segment = 1;
    FlatCuts flat_cuts;
    bool displaced = false;
    bool left_whole = false;  ///< it has no subpatches of its own
    /// How to list again what is not in `splits`, where that is wanted.
    std::unique_ptr<Relisting> relisting;
    size_t first_block = 0;  ///< of the relisting's, among those of all primitives
    bool is_listed = true;   ///< else its lists take too much

    /// `lists`: those of the subpatch.
    DiceContext dice_context(const ScreenMetric& metric, const Splits& lists) const {
        return {placed.get(),       {surface.get(), &surface_edges, &lists.made_lines, &lists.made},
                &vertices,          &metric,
                pixels_per_segment, displaced,
                flat_cuts};
    }
    size_t subpatch_count() const {
        return relisting ? relisting->subpatch_count() : splits.subpatches.size();
    }
    size_t edge_bytes() const { return vertices.bytes() + surface_edges.bytes(); }
    size_t bytes() const { return edge_bytes() + splits.bytes() + (relisting ? relisting->bytes() : 0); }
    /// Frees all; a primitive without subpatches stays in its place, so that indices hold.
    void leave_out() {
        placed.reset();
        vertices = {};
        surface_edges = {};
        splits = {};
        relisting.reset();
    }
};

/// What all primitives of a tessellation share.
struct TessellatePlan {
    const RenderContext& context;
    const ScreenMetric& metric;
    const RasterBound& raster;
    const TessellationOptions& options;
    size_t most_listed;           ///< bytes of whole lists, where others are made again
    std::atomic<size_t>& listed;  ///< so far, of all
};

/// Places, measures and splits one primitive, whose surface is set. What cannot be diced is left out, with a
/// diagnostic. Where lists can be made again, what is too much is not listed (is_listed).
void tessellate_primitive(const TessellatePlan& plan, const Primitive& primitive, TessellatedPrimitive& out);

/// Counts the subpatches of a primitive that is not listed, so that blocks of it can be, of at most so many
/// bytes; else tells why it is left out, and does so.
void count_instead_of_listing(const TessellatePlan& plan, const Primitive& primitive, size_t most_bytes,
                              TessellatedPrimitive& out);

}  // namespace trapeze
