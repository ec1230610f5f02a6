/// A sequence of frames that trees follow, and what that costs them.
#pragma once

#include <string>
#include <vector>

#include "core/grid.h"
#include "core/scene/render_context.h"
#include "pipeline/study/moving_figures.h"
#include "pipeline/study/study_bench.h"

namespace trapeze {

/// Frames of one camera and shutter, with the same objects where nothing else is said.
struct Sequence {
    std::string label;
    const RenderContext* context = nullptr;  ///< one sample a pixel
    PixelRect pixels;                        ///< whose samples are taken
    std::vector<const Grids*> frames;
    /// Of each frame, the grids in which it differs from the one before; empty: nobody knows.
    std::vector<std::vector<uint32_t>> changed{};
};

/// A row of the tables. Of a tree that cannot be updated, each frame's is built.
struct SequenceRow {
    const char *name, *method;
    bool told = true;  ///< which grids have changed; else it looks at all
};

/// The first three are those of the report's table [DynBvh06 table 1].
inline constexpr SequenceRow kSequenceRows[] = {
    {"inserted anew (Goldsmith-Salmon)", "raytrace:tree=gs"},
    {"updated (dynamic)", "raytrace:tree=dynamic"},
    {"loose", "raytrace:tree=loose"},
    {"updated, nodes thinned at 1.2", "raytrace:tree=dynamic,thinning=1.2"},
    {"updated, inserted at the root", "raytrace:tree=dynamic,reinsert=root"},
    {"updated, marked parts built anew", "raytrace:tree=dynamic,reinsert=rebuilt"},
    {"updated, not told what moves", "raytrace:tree=dynamic", false},
    {"loose, all at the lowest level", "raytrace:tree=loose,place=lowest"},
    {"two levels, loose for what moves", "raytrace:tree=twolevel"},
    {"refitted", "raytrace:tree=refit,bundle=off"},
    {"interpolated boxes, built anew", "raytrace:tree=interpolated,bundle=off"},
    {"linear, built anew", "raytrace:tree=lbvh,bundle=off"},
    {"hyper-trapezoids, built anew", "raytrace:tree=paper,bundle=off"},
    {"Trapeze's wide tree, built anew", "raytrace"}};
inline constexpr size_t kSequenceRowCount = std::size(kSequenceRows), kRefittedRow = 9, kInterpolatedRow = 10;

/// What the rows cost on a sequence: seconds by row, then frame, then round.
struct SequenceTimes {
    explicit SequenceTimes(size_t frames);

    std::vector<std::vector<std::vector<double>>> update, trace;
    std::vector<std::vector<uint64_t>> seen;  ///< by row, then frame: a hash of the hits
    std::vector<double> nodes, tests;         ///< a ray, by row: means of the frames
    /// By row, then frame; 0 where a tree does not count it.
    std::vector<std::vector<double>> sah;

    /// Medians of the rounds.
    paper::SequenceCosts costs(size_t row, size_t frame) const;
    /// Means of the frames but the first, which is built by all.
    paper::SequenceCosts mean_costs(size_t row) const;
};

/// Follows the sequence once with one row's tree, and adds what that costs.
void follow(const StudyBench& bench, const Sequence& sequence, size_t row, SequenceTimes& times);

}  // namespace trapeze
