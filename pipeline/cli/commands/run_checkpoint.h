/// The checkpoint that a command line asks for.
#pragma once

#include <memory>

#include "pipeline/checkpoint/checkpoint.h"
#include "pipeline/cli/support/arguments.h"

namespace trapeze {

/// Where the run of a command line keeps its checkpoint: beside the picture that `-o` names, or the one that
/// is named after the scene, "out.exr.checkpoint"; with the tile's number, and with that of the first frame
/// of
/// `--frames`, so that runs of other tiles and frames have others.
std::string checkpoint_path(const Arguments& arguments);

/// Null where none is asked for. Neither reads nor writes yet.
std::unique_ptr<Checkpoint> checkpoint_of(const Arguments& arguments, std::shared_ptr<const ReadNames> reads,
                                          Diagnostics& diagnostics);

}  // namespace trapeze
