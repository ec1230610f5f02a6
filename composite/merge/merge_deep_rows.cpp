#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineInputFile.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>

#include <cstring>

#include "composite/displays/exr_stream.h"
#include "composite/merge/merge_rows.h"
#include "composite/merge/open_tiles.h"

namespace trapeze {
namespace {

/// In memory at a time. No compression of deep files packs rows together.
constexpr int kDeepRowsOfBand = 16;

/// A window's pixels: how many samples each has, and where each channel's samples of it are.
class TileDeepRows {
  public:
    TileDeepRows(const std::vector<TileChannel>& channels, const Box2i& window)
        : channels_(channels),
          window_(window),
          counts_(width() * height()),
          samples_(channels.size(), std::vector<char*>(counts_.size())),
          values_(channels.size()) {}

    size_t width() const { return static_cast<size_t>(window_.max.x - window_.min.x) + 1; }
    size_t height() const { return static_cast<size_t>(window_.max.y - window_.min.y) + 1; }
    const Box2i& window() const { return window_; }
    size_t index(int x, int y) const {
        return static_cast<size_t>(y - window_.min.y) * width() + static_cast<size_t>(x - window_.min.x);
    }
    uint32_t& count(size_t pixel) { return counts_[pixel]; }
    char*& samples(size_t channel, size_t pixel) { return samples_[channel][pixel]; }

    void read(Imf::DeepScanLineInputFile& input) {
        input.setFrameBuffer(frame_buffer());
        input.readPixelSampleCounts(window_.min.y, window_.max.y);
        size_t all = 0;
        for (const uint32_t count : counts_) all += count;
        for (size_t c = 0; c < channels_.size(); ++c) {
            values_[c].resize(all * channels_[c].bytes);
            char* at = values_[c].data();
            for (size_t pixel = 0; pixel < counts_.size(); ++pixel) {
                samples_[c][pixel] = at;
                at += counts_[pixel] * channels_[c].bytes;
            }
        }
        input.readPixels(window_.min.y, window_.max.y);
    }

    Imf::DeepFrameBuffer frame_buffer() {
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(
            Imf::Slice::Make(Imf::UINT, counts_.data(), window_.min, static_cast<int64_t>(width()),
                             static_cast<int64_t>(height()), sizeof counts_[0], sizeof counts_[0] * width()));
        for (size_t c = 0; c < channels_.size(); ++c) {
            // The place of the pixel (0, 0), as OpenEXR wants it, by a slice of as large elements.
            const Imf::Slice place =
                Imf::Slice::Make(Imf::UINT, samples_[c].data(), window_.min, static_cast<int64_t>(width()),
                                 static_cast<int64_t>(height()), sizeof(char*), sizeof(char*) * width());
            buffer.insert(channels_[c].name, Imf::DeepSlice(channels_[c].type, place.base, sizeof(char*),
                                                            sizeof(char*) * width(), channels_[c].bytes));
        }
        return buffer;
    }

  private:
    const std::vector<TileChannel>& channels_;
    Box2i window_;
    std::vector<uint32_t> counts_;
    std::vector<std::vector<char*>> samples_;  ///< of each channel, by pixels
    std::vector<std::vector<char>> values_;    ///< of a tile
};

/// A band of the picture: its samples are those of the tiles that have been added, which stay here.
class DeepBand {
  public:
    DeepBand(const std::vector<TileChannel>& channels, const std::vector<TileFile>& files,
             const Box2i& window)
        : channels_(channels),
          files_(files),
          rows_(channels, window),
          owners_(rows_.width() * rows_.height()) {}

    TileDeepRows& rows() { return rows_; }

    void add(size_t file, std::unique_ptr<TileDeepRows> tile) {
        const Box2i& window = tile->window();
        for (int y = window.min.y; y <= window.max.y; ++y)
            for (int x = window.min.x; x <= window.max.x; ++x) {
                const size_t from = tile->index(x, y), to = rows_.index(x, y);
                if (const TileFile* const owner = owners_[to]) compare(*tile, from, to, *owner, file, x, y);
                owners_[to] = &files_[file];
                rows_.count(to) = tile->count(from);
                for (size_t c = 0; c < channels_.size(); ++c) rows_.samples(c, to) = tile->samples(c, from);
            }
        tiles_.push_back(std::move(tile));
    }

  private:
    void compare(TileDeepRows& tile, size_t from, size_t to, const TileFile& owner, size_t file, int x,
                 int y) {
        const size_t count = tile.count(from);
        for (size_t c = 0; c < channels_.size(); ++c)
            if (count != rows_.count(to) ||
                std::memcmp(tile.samples(c, from), rows_.samples(c, to), count * channels_[c].bytes) != 0)
                throw differing_pixel(owner, files_[file], channels_[c].name, x, y);
    }

    const std::vector<TileChannel>& channels_;
    const std::vector<TileFile>& files_;
    TileDeepRows rows_;
    std::vector<const TileFile*> owners_;  ///< of each pixel; null: none yet
    std::vector<std::unique_ptr<TileDeepRows>> tiles_;
};

}  // namespace

void merge_deep_rows(const TileHeaders& tiles, const Imf::Header& header, const MergeOptions& options,
                     OutputFile& file, const std::string& name) {
    const std::vector<TileChannel> channels = channels_of(header.channels());
    const Box2i& window = header.dataWindow();
    ExrStream stream(file, name);
    Imf::DeepScanLineOutputFile out(stream, header, 0);
    OpenTiles<Imf::DeepScanLineInputFile> open(tiles.files());
    for (int64_t y = window.min.y; y <= window.max.y; y += kDeepRowsOfBand) {
        if (options.is_cancelled()) throw MergeError(MergeOutcome::Cancelled, "cancelled");
        const RowBand rows{static_cast<int>(y),
                           static_cast<int>(std::min<int64_t>(y + kDeepRowsOfBand - 1, window.max.y))};
        DeepBand band(channels, tiles.files(), {V2i(window.min.x, rows.from), V2i(window.max.x, rows.to)});
        open.for_each_in(rows, [&](size_t i, Imf::DeepScanLineInputFile& input, const RowBand& part) {
            const Box2i& whole = tiles.files()[i].window;
            auto tile = std::make_unique<TileDeepRows>(
                channels, Box2i(V2i(whole.min.x, part.from), V2i(whole.max.x, part.to)));
            tile->read(input);
            band.add(i, std::move(tile));
        });
        out.setFrameBuffer(band.rows().frame_buffer());
        out.writePixels(rows.to - rows.from + 1);
    }
}

}  // namespace trapeze
