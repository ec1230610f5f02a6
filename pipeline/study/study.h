/// The studies of Hou et al. 2010 and of the papers on trees for what moves, repeated on this machine with
/// scenes of our own.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string_view>

#include "core/diagnostics.h"
#include "pipeline/study/study_result.h"

namespace trapeze {

struct StudySettings {
    bool quick = false;            ///< a quarter of the pixels, fewer samples: minutes instead of hours
    int rounds = 3;                ///< in which every method takes its turn; medians count
    size_t memory_bytes = 0;       ///< for grids; 0: three quarters of the machine's
    std::string bart_folder = {};  ///< that has kitchen/aff and museum/aff; empty: they are not to be had
    const std::atomic<bool>* cancelled = nullptr;
    std::function<void(const std::string& what)> on_stage = {};
    std::function<void(double)> on_progress = {};  ///< of the stage
    /// What a method took on a scene, as soon as it is known: a study at full size may take hours.
    std::function<void(const std::string& line)> on_figure = {};
};

/// Runs a study with the threads of the calling task arena. Empty for an unknown name, when cancelled, and
/// (reported) when a scene does not fit the memory.
std::optional<StudyResult> run_study(std::string_view name, const StudySettings& settings,
                                     Diagnostics& diagnostics);

}  // namespace trapeze
