/// From a tile's samples to the film or another sink, with no more hits in memory than there is room for.
/// Where layers of surfaces that are not opaque take more, they come in passes, front to back: each finds the
/// nearest ones behind where the one before has ended [decision 0032, Hou10 sec. 4].
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "composite/film/sample_sink.h"
#include "composite/layers/layer_stack.h"
#include "core/scene/layer_limit.h"
#include "sample/visibility.h"

namespace trapeze {

/// What bounds the layers of samples.
struct LayerLimits {
    uint32_t most = kAllLayers;  ///< a sample sees the nearest so many
    /// Hits that a thread may hold at once; but one of each sample of a tile that has only opaque grids.
    size_t room = std::numeric_limits<size_t>::max();

    /// Limits for threads that share some bytes.
    static LayerLimits of(uint32_t most, size_t bytes, int threads);
};

/// Where samples look and where they go.
struct LayerTask {
    const Visibility& visibility;
    const Grids& grids;
    bool all_opaque;  ///< every grid is
    const LayerLimits& limits;
    SampleSink& sink;
};

/// What passes have cost.
struct LayerCosts {
    double trace_seconds = 0, composite_seconds = 0;
    uint64_t further_passes = 0;  ///< beyond the first of each tile
    uint64_t list_bytes = 0;      ///< the most that lists of hits took
    bool shows_something = false;
};

/// A thread's working memory, used again from tile to tile.
class LayerPasses {
  public:
    /// Finds what a tile's samples see and adds it to the sink. Other members of the scratch than its window
    /// are the caller's to set.
    void add_tile(const LayerTask& task, const SampleTile& samples, SampleScratch& scratch,
                  SampleStats& stats);

    const LayerCosts& costs() const { return costs_; }

  private:
    void find(const LayerTask& task, const SampleTile& samples, SampleScratch& scratch, SampleStats& stats);
    void add_to_stack(const LayerTask& task, const SampleTile& samples, const SampleScratch& scratch,
                      std::vector<uint32_t>& which);
    void find_rest(const LayerTask& task, const SampleTile& samples, SampleScratch& scratch,
                   SampleStats& stats);

    HitBuffer hits_;
    LayerStack stack_;
    std::vector<Hit> resume_;        ///< sample -> its hits behind this are still to come; or kBehindAll
    std::vector<Hit> behind_;        ///< the same of the samples that a pass is for
    std::vector<uint32_t> taken_;    ///< sample -> layers that it has had
    std::vector<uint32_t> group_;    ///< samples that a pass is for, in order
    std::vector<uint32_t> put_off_;  ///< samples that have been in a group that was too large
    LayerCosts costs_;
};

}  // namespace trapeze
