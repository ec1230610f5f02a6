/// Joins the tiles of a picture, OpenEXR files whose data windows are parts of it, to one file.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "core/diagnostics.h"

namespace trapeze {

struct MergeOptions {
    bool allow_missing = false;                    ///< pixels of no tile are left empty, with a warning
    const std::atomic<bool>* cancelled = nullptr;  ///< ends the work when it becomes true; null: never

    bool is_cancelled() const { return cancelled && cancelled->load(std::memory_order_relaxed); }
};

enum class MergeOutcome {
    Written,
    Unreadable,  ///< a tile is not there, no OpenEXR file, or damaged
    NoPicture,   ///< the tiles are not all of one picture, or some are missing
    Unwritable,  ///< the output
    Cancelled,
};

/// Writes the file `output` with the pixels of all tiles, bit for bit as the picture's file has them that is
/// rendered at once: of any channels, flat or deep. The data window is the smallest around all tiles. What
/// the header says is what the first tile's says, but for what others say otherwise. What goes wrong is
/// reported by the names of files, and nothing is written then. `tiles` has at least one name.
MergeOutcome merge_tiles(const std::vector<std::string>& tiles, const std::string& output,
                         const MergeOptions& options, Diagnostics& diagnostics);

}  // namespace trapeze
