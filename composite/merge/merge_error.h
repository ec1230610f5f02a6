/// How functions that join tiles give up.
#pragma once

#include <stdexcept>
#include <string>

#include "composite/merge/merge_tiles.h"
#include "composite/merge/tile_headers.h"

namespace trapeze {

/// Caught by merge_tiles(), which reports the text.
struct MergeError : std::runtime_error {
    MergeError(MergeOutcome what, const std::string& text) : std::runtime_error(text), outcome(what) {}

    MergeOutcome outcome;
};

/// The error of a tile that OpenEXR's library cannot read, whose exceptions often begin with the file's name.
inline MergeError unreadable(const std::string& path, const std::string& reason) {
    return {MergeOutcome::Unreadable, "cannot read \"" + path + "\": " + reason};
}

/// The error of two tiles that have different values for a pixel that both have.
inline MergeError differing_pixel(const TileFile& one, const TileFile& other, const std::string& channel,
                                  int x, int y) {
    return {MergeOutcome::NoPicture, "\"" + one.path + "\" and \"" + other.path +
                                         "\" have different pixels at " + std::to_string(x) + " " +
                                         std::to_string(y) + ", in channel \"" + channel + "\""};
}

}  // namespace trapeze
