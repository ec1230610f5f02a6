/// The file of `--stats`; docs/manual.md documents its keys.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/frame/cost/frame_stats.h"

namespace trapeze {

/// What is true of a whole run rather than of one of its frames.
struct RunFacts {
    std::vector<std::string> words;  ///< the command line, without the program's name
    std::vector<std::string> files;  ///< that were read, archives among them
    uint64_t errors = 0, warnings = 0;
    std::vector<FrameStats::Output> maps;  ///< that requests made
};

/// The file's text. An object, or an array of objects where there is more than one frame; without a frame, an
/// object with what is true of the run.
std::string stats_json(const std::vector<FrameStats>& frames, const RunFacts& facts);

}  // namespace trapeze
