#include "composite/displays/open_exr_output.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <algorithm>
#include <stdexcept>

#include "composite/displays/exr_channels.h"
#include "composite/displays/exr_header.h"
#include "composite/displays/exr_stream.h"
#include "core/half.h"

namespace trapeze {
namespace {

constexpr int kRowsAtOnce =
    64;  ///< between looks at whether the render is cancelled; a multiple of a ZIP block's 16 rows

Imf::PixelType pixel_type(ExrChannel::Type type) {
    using Type = ExrChannel::Type;
    return type == Type::Half ? Imf::HALF : type == Type::Float ? Imf::FLOAT : Imf::UINT;
}

/// ZIP is what most readers expect of files without loss.
Imf::Header make_header(const PictureToWrite& picture, const std::vector<ExrChannel>& channels) {
    Imf::Header header = make_exr_header(picture, Imf::ZIP_COMPRESSION);
    for (const ExrChannel& channel : channels)
        header.channels().insert(channel.name, Imf::Channel(pixel_type(channel.type)));
    if (const int side = picture.plan.tile_side; side > 0)
        header.setTileDescription(
            Imf::TileDescription(static_cast<unsigned>(side), static_cast<unsigned>(side)));
    return header;
}

/// Rows of the picture's window as OpenEXR takes them: floats and ids from where they are, halves from a copy
/// of some rows at a time.
class RowBuffer {
  public:
    RowBuffer(const PictureToWrite& picture, const std::vector<ExrChannel>& channels)
        : window_(picture.image.window), channels_(channels) {}

    Imf::FrameBuffer rows(int y0, int y1) {
        const auto width = static_cast<size_t>(window_.width());
        const size_t first = width * static_cast<size_t>(y0 - window_.y0),
                     count = width * static_cast<size_t>(y1 - y0);
        const auto half_channels = std::count_if(channels_.begin(), channels_.end(), [](const ExrChannel& c) {
            return c.type == ExrChannel::Type::Half;
        });
        halves_.resize(static_cast<size_t>(half_channels) * count);
        Imath::half* copy = halves_.data();
        Imf::FrameBuffer buffer;
        for (const ExrChannel& channel : channels_) {
            if (channel.type == ExrChannel::Type::Uint) {
                buffer.insert(channel.name, slice(Imf::UINT, channel.ids + first, 1, y0, y1));
                continue;
            }
            const float* const values = channel.floats + channel.stride * first;
            if (channel.type == ExrChannel::Type::Float) {
                buffer.insert(channel.name, slice(Imf::FLOAT, values, channel.stride, y0, y1));
                continue;
            }
            for (size_t i = 0; i < count; ++i) copy[i] = to_half(values[channel.stride * i]);
            buffer.insert(channel.name, slice(Imf::HALF, copy, 1, y0, y1));
            copy += count;
        }
        return buffer;
    }

  private:
    template <class Value>
    Imf::Slice slice(Imf::PixelType type, const Value* values, size_t stride, int y0, int y1) const {
        const size_t bytes = sizeof(Value) * stride;
        return Imf::Slice::Make(type, values, V2i(window_.x0, y0), window_.width(), y1 - y0, bytes,
                                bytes * static_cast<size_t>(window_.width()));
    }

    PixelRect window_;
    const std::vector<ExrChannel>& channels_;
    std::vector<Imath::half> halves_;
};

/// Calls write(y0, y1) for a number of rows at a time; throws when the render is cancelled.
template <class Write>
void for_rows(const PictureToWrite& picture, int rows_at_once, const Write& write) {
    const PixelRect& window = picture.image.window;
    for (int y = window.y0; y < window.y1; y += rows_at_once) {
        if (picture.context.is_cancelled()) throw std::runtime_error("cancelled");
        write(y, std::min(y + rows_at_once, window.y1));
    }
}

void write_pixels(const PictureToWrite& picture, OutputFile& file) {
    const std::vector<ExrChannel> channels = exr_channels(picture);
    const Imf::Header header = make_header(picture, channels);
    RowBuffer buffer(picture, channels);
    ExrStream stream(file, picture.plan.path);
    if (picture.plan.tile_side > 0) {
        Imf::TiledOutputFile out(stream, header);
        for_rows(picture, picture.plan.tile_side, [&](int y0, int y1) {
            out.setFrameBuffer(buffer.rows(y0, y1));
            const int row = (y0 - picture.image.window.y0) / picture.plan.tile_side;
            out.writeTiles(0, out.numXTiles() - 1, row, row);
        });
        return;
    }
    Imf::OutputFile out(stream, header);
    for_rows(picture, kRowsAtOnce, [&](int y0, int y1) {
        out.setFrameBuffer(buffer.rows(y0, y1));
        out.writePixels(y1 - y0);
    });
}

/// What the picture lacks of what a display shows; empty: nothing.
std::string missing(const Image& image, const DisplayPlan& plan) {
    if (plan.id && image.id.empty()) return "no ids were recorded";
    if (plan.matte && image.mattes.empty()) return "no mattes were recorded";
    return lacks_variable(image, plan) ? kNoVariables : "";
}

}  // namespace

std::string write_open_exr(const PictureToWrite& picture, OutputFile& file) {
    std::string problem = missing(picture.image, picture.plan);
    for (const DisplayPlan& plan : picture.further)
        if (problem.empty()) problem = missing(picture.image, plan);
    if (!problem.empty()) return problem;
    return write_whole(file, [&] { write_pixels(picture, file); });
}

}  // namespace trapeze
