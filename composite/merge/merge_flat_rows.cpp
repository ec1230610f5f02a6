#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <fmt/format.h>

#include <cstring>

#include "composite/displays/exr_stream.h"
#include "composite/image.h"
#include "composite/merge/merge_rows.h"
#include "composite/merge/open_tiles.h"
#include "core/half.h"
#include "core/scene/scene.h"

namespace trapeze {
namespace {

/// Of the rows that are in memory at a time, about; and the most rows, which are as many as any compression
/// packs together.
constexpr size_t kBytesOfBand = size_t{64} << 20;
constexpr size_t kMostRowsOfBand = 256;
constexpr int32_t kNoTile = -1;

template <class Value>
void fill_with(std::vector<char>& plane, Value value) {
    for (size_t at = 0; at < plane.size(); at += sizeof value) std::memcpy(&plane[at], &value, sizeof value);
}

/// The values of pixels that show nothing, as the renderer writes them: no colour, the largest depth, no
/// primitive.
void fill_empty(const TileChannel& channel, std::vector<char>& plane) {
    const bool is_id = channel.name == "id" || channel.name.starts_with("id.");
    if (channel.name == "Z" && channel.type == Imf::FLOAT)
        fill_with(plane, kInfinity);
    else if (channel.name == "Z" && channel.type == Imf::HALF)
        fill_with(plane, Imath::half(kLargestHalf));
    else if (is_id && channel.type == Imf::UINT)
        fill_with(plane, kNoPrimitive);
    else
        std::fill(plane.begin(), plane.end(), char{0});
}

/// A window's pixels, each channel's by themselves, row by row.
class FlatRows {
  public:
    explicit FlatRows(const std::vector<TileChannel>& channels)
        : channels_(channels), planes_(channels.size()) {}

    void begin(const Box2i& window) {
        window_ = window;
        for (size_t c = 0; c < channels_.size(); ++c) planes_[c].resize(pixels() * channels_[c].bytes);
    }
    void clear() {
        for (size_t c = 0; c < channels_.size(); ++c) fill_empty(channels_[c], planes_[c]);
    }
    const Box2i& window() const { return window_; }
    size_t width() const { return static_cast<size_t>(window_.max.x - window_.min.x) + 1; }
    size_t height() const { return static_cast<size_t>(window_.max.y - window_.min.y) + 1; }
    size_t pixels() const { return width() * height(); }
    size_t index(int x, int y) const {
        return static_cast<size_t>(y - window_.min.y) * width() + static_cast<size_t>(x - window_.min.x);
    }
    char* value(size_t channel, int x, int y) {
        return &planes_[channel][index(x, y) * channels_[channel].bytes];
    }
    Imf::FrameBuffer frame_buffer() {
        Imf::FrameBuffer buffer;
        for (size_t c = 0; c < channels_.size(); ++c) {
            const size_t bytes = channels_[c].bytes;
            buffer.insert(channels_[c].name,
                          Imf::Slice::Make(channels_[c].type, planes_[c].data(), window_.min,
                                           static_cast<int64_t>(width()), static_cast<int64_t>(height()),
                                           bytes, bytes * width()));
        }
        return buffer;
    }

  private:
    const std::vector<TileChannel>& channels_;
    Box2i window_;
    std::vector<std::vector<char>> planes_;
};

/// A band of the picture, and which tile each pixel is of.
class FlatBand {
  public:
    FlatBand(const std::vector<TileChannel>& channels, const std::vector<TileFile>& files)
        : channels_(channels), files_(files), rows_(channels) {}

    void begin(const Box2i& window) {
        rows_.begin(window), rows_.clear();
        owners_.assign(rows_.pixels(), kNoTile);
    }
    FlatRows& rows() { return rows_; }

    void add(size_t file, FlatRows& tile) {
        const Box2i& window = tile.window();
        for (int y = window.min.y; y <= window.max.y; ++y) {
            int32_t* const owners = &owners_[rows_.index(window.min.x, y)];
            if (std::all_of(owners, owners + tile.width(), [](int32_t owner) { return owner == kNoTile; })) {
                copy(tile, window.min.x, y, tile.width());
            } else {
                for (int x = window.min.x; x <= window.max.x; ++x)
                    add_pixel(file, tile, x, y, owners_[rows_.index(x, y)]);
            }
            std::fill_n(owners, tile.width(), static_cast<int32_t>(file));
        }
    }

  private:
    void copy(FlatRows& tile, int x, int y, size_t count) {
        for (size_t c = 0; c < channels_.size(); ++c)
            std::memcpy(rows_.value(c, x, y), tile.value(c, x, y), count * channels_[c].bytes);
    }
    void add_pixel(size_t file, FlatRows& tile, int x, int y, int32_t owner) {
        for (size_t c = 0; owner != kNoTile && c < channels_.size(); ++c)
            if (std::memcmp(rows_.value(c, x, y), tile.value(c, x, y), channels_[c].bytes) != 0)
                throw differing_pixel(files_[static_cast<size_t>(owner)], files_[file], channels_[c].name, x,
                                      y);
        copy(tile, x, y, 1);
    }

    const std::vector<TileChannel>& channels_;
    const std::vector<TileFile>& files_;
    FlatRows rows_;
    std::vector<int32_t> owners_;
};

/// Rows of a band: the picture's and a tile's values are in memory, and a number for each pixel.
int rows_of_band(const std::vector<TileChannel>& channels, const Box2i& window) {
    size_t bytes = sizeof(int32_t);
    for (const TileChannel& channel : channels) bytes += 2 * channel.bytes;
    const size_t row = bytes * (static_cast<size_t>(window.max.x - window.min.x) + 1);
    return static_cast<int>(std::clamp<size_t>(kBytesOfBand / row, 1, kMostRowsOfBand));
}

/// Calls write(pixels, rows) for each band of the picture, of `step` rows, from the top.
template <class Write>
void for_each_band(const TileHeaders& tiles, const std::vector<TileChannel>& channels, int step,
                   const MergeOptions& options, const Write& write) {
    const Box2i window = tiles.window();
    OpenTiles<Imf::InputFile> open(tiles.files());
    FlatBand band(channels, tiles.files());
    FlatRows tile(channels);
    for (int64_t y = window.min.y; y <= window.max.y; y += step) {
        if (options.is_cancelled()) throw MergeError(MergeOutcome::Cancelled, "cancelled");
        const RowBand rows{static_cast<int>(y),
                           static_cast<int>(std::min<int64_t>(y + step - 1, window.max.y))};
        band.begin({V2i(window.min.x, rows.from), V2i(window.max.x, rows.to)});
        open.for_each_in(rows, [&](size_t i, Imf::InputFile& input, const RowBand& part) {
            const Box2i& whole = tiles.files()[i].window;
            tile.begin({V2i(whole.min.x, part.from), V2i(whole.max.x, part.to)});
            input.setFrameBuffer(tile.frame_buffer());
            input.readPixels(part.from, part.to);
            band.add(i, tile);
        });
        write(band.rows().frame_buffer(), rows);
    }
}

}  // namespace

void merge_flat_rows(const TileHeaders& tiles, const Imf::Header& header, const MergeOptions& options,
                     OutputFile& file, const std::string& name) {
    const std::vector<TileChannel> channels = channels_of(header.channels());
    const int step = rows_of_band(channels, tiles.window());
    ExrStream stream(file, name);
    if (tiles.is_stored_in_tiles()) {
        Imf::TiledOutputFile out(stream, header, 0);
        const auto side = static_cast<int>(out.tileYSize());
        const int sides = std::max(step / side, 1);
        int next = 0;  // row of OpenEXR's tiles
        for_each_band(tiles, channels, sides * side, options, [&](const auto& pixels, const RowBand&) {
            const int last = std::min(next + sides, out.numYTiles()) - 1;
            out.setFrameBuffer(pixels);
            out.writeTiles(0, out.numXTiles() - 1, next, last);
            next = last + 1;
        });
        return;
    }
    Imf::OutputFile out(stream, header, 0);
    for_each_band(tiles, channels, step, options, [&](const auto& pixels, const RowBand& rows) {
        out.setFrameBuffer(pixels);
        out.writePixels(rows.to - rows.from + 1);
    });
}

}  // namespace trapeze
