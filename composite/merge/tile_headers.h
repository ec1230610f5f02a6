/// The headers of a picture's tiles, and the one that they make together.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/math.h"
#include "core/picture_tile.h"

namespace trapeze {

/// A tile's file, as far as its header says.
struct TileFile {
    std::string path;
    Box2i window;                     ///< of its pixels, both corners included
    std::optional<PictureTile> tile;  ///< nothing: its file does not say
};

/// The headers, read one after another; only the first is kept.
class TileHeaders {
  public:
    /// Reads a file's header. Throws a MergeError where it cannot be read, or is of another picture than
    /// those before.
    void add(const std::string& path);

    const std::vector<TileFile>& files() const { return files_; }
    bool is_deep() const { return is_deep_; }
    /// Whether the first file is stored in tiles of OpenEXR's, of one resolution; the merged one is then,
    /// too.
    bool is_stored_in_tiles() const;
    const Imf::ChannelList& channels() const { return first_.channels(); }
    /// The smallest window around all tiles.
    Box2i window() const;
    /// Of the file with all tiles in it. Attributes that tiles have with different values are left
    /// out, which is said of those that do not differ from run to run.
    Imf::Header merged(Diagnostics& diagnostics) const;

  private:
    void add_first(const Imf::Header& header);
    void compare_with_first(const TileFile& file, const Imf::Header& header);

    Imf::Header first_;
    std::map<std::string, std::string> values_;     ///< of the first header's attributes: type and bytes
    std::map<std::string, std::string> different_;  ///< attributes that a file, by its path, has otherwise
    std::vector<TileFile> files_;
    bool is_deep_ = false;
};

}  // namespace trapeze
