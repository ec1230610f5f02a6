/// The studies of Hou et al. 2010 and of the papers on trees for what moves, repeated on this machine with
/// scenes of our own.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "pipeline/study/study_result.h"

namespace trapeze {

/// The Diagnostic::kind of the error that a study has no scene of a name that StudySettings ask for.
inline constexpr const char* kNoSuchScene = "study-scene";

struct StudySettings {
    bool quick = false;       ///< a quarter of the pixels, fewer samples: minutes instead of hours
    int rounds = 3;           ///< in which every method takes its turn; medians count
    size_t memory_bytes = 0;  ///< for grids; 0: three quarters of the machine's
    std::vector<std::string> scenes = {};  ///< names, or parts of them, in any case; empty: all
    std::string bart_folder = {};  ///< that has kitchen/aff and museum/aff; empty: they are not to be had
    const std::atomic<bool>* cancelled = nullptr;
    std::function<void(const std::string& what)> on_stage = {};
    std::function<void(double)> on_progress = {};  ///< of the stage
    /// What a method took on a scene, as soon as it is known: a study at full size may take hours.
    std::function<void(const std::string& line)> on_figure = {};
};

/// Runs a study with the threads of the calling task arena. Empty for an unknown name, when cancelled, and
/// (reported) when a scene does not fit the memory, or the study has none of a name that is asked for.
std::optional<StudyResult> run_study(std::string_view name, const StudySettings& settings,
                                     Diagnostics& diagnostics);

}  // namespace trapeze
