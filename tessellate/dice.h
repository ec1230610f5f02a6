/// Makes a subpatch's grid [Cook87]: its vertices evenly over the subpatch, those on its border at the shared
/// points of its edges [decision 0002].
#pragma once

#include "tessellate/split.h"
#include "tessellate/tessellate.h"

namespace trapeze {

/// What dicing a primitive reads: all of it outlives the call and is not changed. `edges` are views of the
/// primitive's own and of those that splitting has made.
struct DiceContext {
    const PlacedSurface* surface = nullptr;
    Edges edges;
    const VertexTable* vertices = nullptr;
    const ScreenMetric* metric = nullptr;
    float pixels_per_segment = 1;  ///< the wished length of a micropolygon's side
    bool displaced = false;        ///< grids are to have borders by which they stay together
    FlatCuts flat_cuts = {};       ///< SplitContext::flat_cuts
};

/// A border vertex of the grid and the shared point that it takes. Several vertices may take one point, where
/// the grid is finer than its edge. Corners belong to two sides and are listed for both.
struct BorderVertex {
    int vertex = 0;  ///< of the grid
    int point = 0;   ///< of the subpatch's border points
    int side = 0;
    int corner = -1;  ///< the grid's corner that takes the same point; -1: none
};

/// Memory for one grid at a time. P: key by key, a grid's vertices row by row; dPdu and dPdv at the first
/// key, by the face's parameters. All camera space.
struct DiceScratch::State {
    EvaluationScratch evaluation;
    std::vector<V2f> uv;
    std::vector<V3f> P, dPdu, dPdv, border;
    std::vector<int> degenerate;      ///< vertices without a normal
    std::vector<Triples> spare_keys;  ///< P of grids with more keys than the present one
    std::array<BorderPoint, kMaxBorderPoints> points, wanted;  ///< of the border
    std::array<BorderVertex, kMaxBorderPoints> border_vertices;
};

/// Dices a subpatch into `grid`, whose earlier contents are replaced and whose memory is reused. The grid's
/// shape, key_count and primitive are set here too; ordinal and primitive_index are the caller's. Same bits
/// whenever it is done and whoever does it.
void dice_subpatch(const DiceContext& context, const Subpatch& subpatch, ShadingGrid& grid,
                   DiceScratch::State& scratch, DiceFor wanted = DiceFor::Shaders);

/// Makes a grid of one micropolygon, as large as those that the subpatch dices to, or would if it were not
/// flat, with a vertex at a place of it (in its unit square); returns the vertex. It lies within the
/// subpatch, or, of a flat face, within what its parameters mean (Surface::last_parameter).
int dice_point(const DiceContext& context, const Subpatch& subpatch, const V2f& at, ShadingGrid& grid,
               DiceScratch::State& scratch);

}  // namespace trapeze
