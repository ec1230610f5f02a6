/// Makes a subpatch's grid.
#pragma once

#include "tessellate/split.h"
#include "tessellate/tessellate.h"

namespace trapeze {

/// What dicing a primitive reads.
struct DiceContext {
    const PlacedSurface* surface = nullptr;
    Edges edges;
    const VertexTable* vertices = nullptr;
    const ScreenMetric* metric = nullptr;
    float pixels_per_segment = 1;  ///< the wished length of a micropolygon's side
    bool displaced = false;        ///< grids are to have borders by which they stay together
};

struct DiceScratch::State {
    EvaluationScratch evaluation;
    std::vector<V2f> uv;
    std::vector<V3f> P, dPdu, dPdv, border;
    std::vector<int> degenerate;      ///< vertices without a normal
    std::vector<Triples> spare_keys;  ///< P of grids with more keys than the present one
};

/// The grid's shape, key_count and primitive are set here too; ordinal and primitive_index are the caller's.
void dice_subpatch(const DiceContext& context, const Subpatch& subpatch, ShadingGrid& grid,
                   DiceScratch::State& scratch);

}  // namespace trapeze
