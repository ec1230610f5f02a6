/// A frame made once for many visibility methods: a scene and its shaded grids, of the whole picture as one
/// region.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/grid.h"
#include "core/scene/render_context.h"
#include "pipeline/frame/render_frame.h"
#include "tessellate/tessellate.h"

namespace trapeze {

/// Samples of a pixel.
struct SampleRate {
    int x = 1, y = 1;  ///< samples of a pixel along each axis

    int per_pixel() const { return x * y; }
    bool operator==(const SampleRate&) const = default;
};

struct SharedFrame {
    std::unique_ptr<const Scene> scene;
    RenderContext context;  ///< of that scene, at the scene's own sample rate
    PixelRect pixels;       ///< those whose samples count: the crop and what the filter reaches
    Grids grids;
    std::vector<SubpatchInfo> subpatches;  ///< that the grids are of, by Grid::ordinal
    FrameStats stats;                      ///< of tessellation and shading
    size_t memory_budget = ~size_t{0};     ///< in bytes, for grids and what a method makes of them

    /// The context at another sample rate. What is diced and shaded depends on no sample rate, so the grids
    /// serve every one.
    RenderContext context_at(SampleRate rate) const {
        RenderContext at_rate = context;
        at_rate.samples_x = rate.x, at_rate.samples_y = rate.y;
        return at_rate;
    }
    /// The context at which pixels take as many samples as a variance asks for, the rate's at most (rounded
    /// up to what has levels); with one level, where that is not possible at the rate.
    RenderContext adaptive_context(SampleRate most, float variance) const;
};

/// The Diagnostic::kind of the error that a frame does not fit the memory.
inline constexpr const char* kTooLittleMemory = "memory-budget";

/// Tessellates and shades with the threads of the calling task arena; of the settings, memory, seed, progress
/// and cancellation count. Empty when cancelled, or (reported) when the picture has no pixels or its grids
/// do not fit the memory.
std::optional<SharedFrame> share_frame(Scene&& scene, const RenderSettings& settings,
                                       Diagnostics& diagnostics);

}  // namespace trapeze
