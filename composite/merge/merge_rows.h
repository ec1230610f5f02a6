/// Copies the rows of tiles into the picture's file, a band of rows at a time.
#pragma once

#include <OpenEXR/ImfChannelList.h>

#include <string>
#include <vector>

#include "composite/merge/merge_tiles.h"
#include "composite/merge/tile_headers.h"
#include "core/files/output_file.h"

namespace trapeze {

/// A channel of tiles: its values are copied as they are.
struct TileChannel {
    std::string name;
    Imf::PixelType type = Imf::HALF;
    size_t bytes = 2;  ///< of a value
};

/// The channels of a header's list, in its order.
inline std::vector<TileChannel> channels_of(const Imf::ChannelList& list) {
    std::vector<TileChannel> channels;
    for (auto i = list.begin(); i != list.end(); ++i)
        channels.push_back(
            {i.name(), i.channel().type, i.channel().type == Imf::HALF ? size_t{2} : size_t{4}});
    return channels;
}

/// A file of `header` with the pixels of the tiles, which are flat or deep. They throw a MergeError where a
/// tile cannot be read, or two tiles have different values for a pixel; another exception where the output
/// cannot be written.
void merge_flat_rows(const TileHeaders& tiles, const Imf::Header& header, const MergeOptions& options,
                     OutputFile& file, const std::string& name);
void merge_deep_rows(const TileHeaders& tiles, const Imf::Header& header, const MergeOptions& options,
                     OutputFile& file, const std::string& name);

}  // namespace trapeze
