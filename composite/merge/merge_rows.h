/// Copies the rows of tiles into the picture's file, a band of rows at a time.
#pragma once

#include "composite/merge/merge_tiles.h"
#include "composite/merge/tile_headers.h"
#include "core/files/output_file.h"

namespace trapeze {

/// A file of `header` with the pixels of the tiles, which are flat or deep. They throw a MergeError where a
/// tile cannot be read, or two tiles have different values for a pixel; another exception where the output
/// cannot be written.
void merge_flat_rows(const TileHeaders& tiles, const Imf::Header& header, const MergeOptions& options,
                     OutputFile& file, const std::string& name);
void merge_deep_rows(const TileHeaders& tiles, const Imf::Header& header, const MergeOptions& options,
                     OutputFile& file, const std::string& name);

}  // namespace trapeze
