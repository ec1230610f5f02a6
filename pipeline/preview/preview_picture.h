/// A picture as viewers see it while it is made: a copy of what is finished so far, which outlives the film.
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "core/pixel_rect.h"

namespace trapeze {

/// What is known of a picture before it has pixels.
struct PreviewFacts {
    std::string name;           ///< of its first file
    int width = 0, height = 0;  ///< of the whole picture
    PixelRect window;           ///< the pixels that are made: the crop
    /// As in an OpenEXR file of all its layers: R G B A Z, then N.X and so on.
    std::vector<std::string> channels;
};

/// Where a picture has its numbers, channel by channel in the order of PreviewFacts::channels.
struct PixelSource {
    struct Channel {
        const float* first = nullptr;  ///< of the window's first pixel
        size_t stride = 1;             ///< floats from a pixel to the next
    };
    PixelRect window;  ///< that is there; it may be more than the picture's
    std::vector<Channel> channels;
};

/// Pixels in squares of kTileSide, as those of a film. All functions but the constructor are thread-safe.
class PreviewPicture {
  public:
    explicit PreviewPicture(PreviewFacts facts);

    const PreviewFacts& facts() const { return facts_; }
    /// Of its pixels' values.
    size_t bytes() const;

    /// Takes pixels of one tile, in addition to those that it has or in place of them.
    void put(const PixelRect& pixels, const PixelSource& source);
    /// Takes the whole picture. Tiles that are there with the same bits have not changed.
    void finish(const PixelSource& source);
    /// The picture is broken off: there will be no more pixels. Nothing changes where it is finished.
    void close();
    bool is_finished() const;
    /// Finished or broken off.
    bool is_closed() const;

    /// Tiles that have changed, the earliest first.
    struct Changes {
        std::vector<PixelRect> pixels;
        std::vector<uint64_t> versions;  ///< of each: after it, the changes are those behind it
    };
    /// Those since a version; after 0, all that are there.
    Changes changes_after(uint64_t version) const;
    /// The version that the last change made; 0: there was none.
    uint64_t version() const;
    /// Values of pixels, channel after channel, each row by row; NaN where nothing is finished.
    std::vector<float> values(const PixelRect& pixels, std::span<const int> channels) const;

  private:
    struct Tile {
        PixelRect pixels;      ///< that have values
        uint64_t version = 0;  ///< of its last change
    };
    size_t index(int x, int y) const {
        return static_cast<size_t>(y - facts_.window.y0) * static_cast<size_t>(facts_.window.width()) +
               static_cast<size_t>(x - facts_.window.x0);
    }
    PixelRect square(size_t tile) const;
    Tile& tile_of(const PixelRect& pixels);
    bool copy(const PixelRect& pixels, const PixelSource& source);

    const PreviewFacts facts_;
    int first_column_ = 0, first_row_ = 0, columns_ = 0;
    mutable std::mutex mutex_;
    std::vector<Tile> tiles_;
    std::vector<std::vector<float>> channels_;  ///< of each, the window's pixels
    uint64_t version_ = 0;
    bool finished_ = false, closed_ = false;
};

}  // namespace trapeze
