/// The frame: the whole algorithm on one page [Cook87].
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "composite/film/film.h"
#include "core/files/access.h"
#include "core/picture_tile.h"
#include "core/scene/color_request.h"
#include "core/scene/render_context.h"
#include "pipeline/frame/cull_hidden.h"
#include "pipeline/frame/film_keeper.h"
#include "pipeline/frame/film_watcher.h"
#include "pipeline/frame/frame_stats.h"

namespace trapeze {

/// How to render, beside what the scene says.
struct RenderSettings {
    std::string sampler = "raytrace";  ///< visibility method, as choose_sampler() reads it
    std::string pattern;               ///< sample pattern; empty: the method's natural one
    size_t memory_bytes = 0;           ///< for grids and tree together; 0: three quarters of the machine's
    int regions_at_least = 1;          ///< tests force a split that memory would not ask for
    CullHidden cull_hidden = CullHidden::Auto;
    uint32_t seed = 0;
    std::optional<PictureTile> tile;  ///< the part of the scene's crop to make; nothing: all of it
    ColorRequest colors;              ///< what the user asks for in place of Option "ocio"
    /// Called now and then from any thread, one at a time, with the part done in [0, 1].
    std::function<void(double)> on_progress;
    /// Called at the beginning of each stage, by its name in the statistics; grids are diced while they
    /// shade.
    std::function<void(std::string_view)> on_stage;
    /// Rendering ends early when this becomes true; null: never.
    const std::atomic<bool>* cancelled = nullptr;
    const Access* access = &kEverything;  ///< to the files that the scene names
    FilmKeeper* keeper = nullptr;         ///< of finished tiles; null: nobody
    FilmWatcher* watcher = nullptr;       ///< for whom tiles come in coarse order; null: nobody
};

/// The picture of a frame and what it cost.
struct FrameResult {
    Image image;
    FrameStats stats;
};

/// Three quarters of the machine's memory, in bytes.
size_t default_memory_budget();

/// The Diagnostic::kind of the error that the machine's memory cannot hold the picture.
inline constexpr const char* kPictureTooLarge = "picture-too-large";

/// Whether the machine's memory can hold the picture, asked before it is made; if not, an error says what
/// would help.
bool picture_fits(const RenderContext& context, const RenderSettings& settings);

/// The context of a scene's render: camera, with the tile as its crop, sample counts (rounded to at least 1),
/// whether anything moves, colour management. It refers to the scene and to diagnostics.
RenderContext make_context(const Scene& scene, const RenderSettings& settings, Diagnostics& diagnostics);

/// Renders with the threads of the calling task arena. Empty when cancelled, or (reported) when the picture
/// is too large or the context lacks its colours. `context` is make_context's.
std::optional<FrameResult> render_frame(const RenderContext& context, const RenderSettings& settings);

}  // namespace trapeze
