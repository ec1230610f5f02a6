/// Splits faces into subpatches that dice to grids of at most 16x16: at parametric midpoints, as long as a
/// side is not inside one interval of its edge or the interior is too large [Fisher09]. What cannot be seen
/// is left out.
#pragma once

#include "core/stats.h"
#include "tessellate/border.h"
#include "tessellate/face_estimates.h"
#include "tessellate/raster_bound.h"

namespace trapeze {

/// Pieces of a rectangle along u and v between samples that are measured first.
inline constexpr int kCoarseLatticePieces = 2;

/// A rectangle [lo, hi] of a face, to be diced as `shape`. `sides`: where each of its sides lies on its edge,
/// within one interval of it. It is kept for the whole frame and diced whenever a region needs it: what is
/// not in here is a function of the surface.
struct Subpatch {
    int face = 0;
    GridShape shape;
    bool alone = false;  ///< a whole face that stands alone, as finely cut as its edges
    V2f lo{0, 0}, hi{1, 1};
    std::array<SurfaceSide, 4> sides;
};

/// What all splitting of a primitive reads.
struct SplitContext {
    const PlacedSurface* surface = nullptr;
    const EdgeTessellations* surface_edges = nullptr;
    const VertexTable* vertices = nullptr;
    const LineMeasure* measure = nullptr;
    const RasterBound* raster = nullptr;
    EdgeRate rate;
    FlatCuts flat_cuts;  ///< of faces whose rate is larger because they are flat
    float displacement_bound = 0;
    std::span<const FaceEstimate> estimates;      ///< of all faces, or none
    size_t most_parts_of_face = size_t{1} << 20;  ///< about; then its interior is not split further
};

/// What splitting gives: subpatches with the pixels that may see each, and the edges that were made between
/// them, numbered from the surface's edge count on.
struct Splits {
    std::vector<Subpatch> subpatches;
    std::vector<PixelRect> bounds;
    std::vector<EdgeLine> made_lines;
    EdgeTessellations made;
    uint64_t culled = 0;
    bool limited = false;  ///< by most_parts_of_face

    size_t bytes() const;
    /// Adds the splits of other faces; their made edges get the numbers after these. `surface_edges`: the
    /// surface's edge count, below which numbers stay.
    void append(Splits&& other, uint32_t surface_edges);
};

/// Splits faces first_face .. end_face - 1 (holes are left out). Depends on nothing but the face, so that
/// faces may be split in any tasks.
Splits split_faces(const SplitContext& context, int first_face, int end_face);

/// A part of a face that halving it again and again comes to: at step d its half number `path >> d & 1`.
struct FacePart {
    static constexpr int kMostDepth = 63;

    int face = 0;
    uint64_t path = 0;
    int depth = 0;  ///< of 0 it is the whole face
};

/// What a face is split into, known by how many there are.
struct FaceParts {
    struct Part {
        FacePart part;
        uint32_t subpatches;
    };
    std::vector<Part> parts;  ///< that have subpatches, in their order
    uint64_t micropolygons = 0, culled = 0;
    bool limited = false;  ///< as Splits::limited
};

/// Cuts faces first_face .. first_face + found.size() - 1 into parts of `most_subpatches` at most; into one,
/// whatever that has, where a face is limited by SplitContext::most_parts_of_face. The context has no
/// estimates, which change nothing but bounds on the screen. Takes little memory.
void find_parts(const SplitContext& context, int first_face, uint32_t most_subpatches,
                std::span<FaceParts> found);

/// What split_faces() gives of a part: the same subpatches, but for the numbers of edges.
Splits split_part(const SplitContext& context, const FacePart& part);

}  // namespace trapeze
