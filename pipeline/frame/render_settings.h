/// How to render, beside what the scene says.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "core/colors/color_request.h"
#include "core/files/access.h"
#include "core/picture_tile.h"
#include "pipeline/frame/cull_hidden.h"
#include "pipeline/frame/film_keeper.h"
#include "pipeline/frame/film_watcher.h"

namespace trapeze {

/// What the user and the calling program choose for a frame.
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

}  // namespace trapeze
