#include "composite/displays/open_exr_output.h"

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <algorithm>
#include <stdexcept>

#include "composite/displays/exr_attributes.h"
#include "composite/displays/exr_channels.h"

namespace trapeze {
namespace {

constexpr int kRowsAtOnce =
    64;  ///< between looks at whether the render is cancelled; a multiple of a ZIP block's 16 rows

/// A stream, as OpenEXR wants it, on a file of ours. OutputFile remembers failures that OpenEXR's destructors
/// swallow.
class Stream : public Imf::OStream {
  public:
    Stream(OutputFile& file, const std::string& name) : Imf::OStream(name.c_str()), file_(file) {}

    void write(const char bytes[], int count) override {
        check(file_.write(bytes, static_cast<size_t>(count)));
    }
    uint64_t tellp() override { return file_.position(); }
    void seekp(uint64_t position) override { check(file_.seek(position)); }

  private:
    void check(bool good) const {
        if (!good) throw std::runtime_error(file_.error());
    }
    OutputFile& file_;
};

/// OpenEXR's compression of a name; ZIP where no name is given: lossless, and what most readers expect.
Imf::Compression compression_of(const std::string& name) {
    constexpr std::pair<std::string_view, Imf::Compression> kNames[] = {
        {"none", Imf::NO_COMPRESSION},   {"rle", Imf::RLE_COMPRESSION},     {"zips", Imf::ZIPS_COMPRESSION},
        {"piz", Imf::PIZ_COMPRESSION},   {"pxr24", Imf::PXR24_COMPRESSION}, {"b44", Imf::B44_COMPRESSION},
        {"b44a", Imf::B44A_COMPRESSION}, {"dwaa", Imf::DWAA_COMPRESSION},   {"dwab", Imf::DWAB_COMPRESSION}};
    const auto found = std::find_if(std::begin(kNames), std::end(kNames),
                                    [&](const auto& row) { return row.first == name; });
    return found == std::end(kNames) ? Imf::ZIP_COMPRESSION : found->second;
}

/// The matrix to OpenEXR's NDC, which runs from (0, 0) at the upper left of the display window to (1, 1) at
/// the lower right (ImfStandardAttributes.h, worldToNDC); screen space has (0, 0) in the middle and y up.
M44f ndc_from_camera(const Camera& camera) {
    const M44f ndc_from_screen(0.5f, 0, 0, 0, 0, -0.5f, 0, 0, 0, 0, 1, 0, 0.5f, 0.5f, 0, 1);
    return screen_from_camera(camera) * ndc_from_screen;
}

Imf::PixelType pixel_type(ExrChannel::Type type) {
    using Type = ExrChannel::Type;
    return type == Type::Half ? Imf::HALF : type == Type::Float ? Imf::FLOAT : Imf::UINT;
}

Imf::Header make_header(const PictureToWrite& picture, const std::vector<ExrChannel>& channels) {
    const Camera& camera = picture.context.camera;
    const Scene& scene = *picture.context.scene;
    const PixelRect& window = picture.image.window;
    const Box2i display(V2i(0, 0), V2i(picture.image.width - 1, picture.image.height - 1));
    const Box2i data(V2i(window.x0, window.y0), V2i(window.x1 - 1, window.y1 - 1));
    const V2f center((camera.left + camera.right) / 2 * camera.tan_half_fov,
                     (camera.bottom + camera.top) / 2 * camera.tan_half_fov);
    const float width = std::abs(camera.right - camera.left) * camera.tan_half_fov;
    Imf::Header header(display, data, scene.options.pixel_aspect, center, width, Imf::INCREASING_Y,
                       compression_of(picture.plan.compression));

    for (const ExrChannel& channel : channels)
        header.channels().insert(channel.name, Imf::Channel(pixel_type(channel.type)));
    if (const int side = picture.plan.tile_side; side > 0)
        header.setTileDescription(
            Imf::TileDescription(static_cast<unsigned>(side), static_cast<unsigned>(side)));

    Imf::addWorldToCamera(header, scene.camera_from_world);
    Imf::addWorldToNDC(header, scene.camera_from_world * ndc_from_camera(camera));
    header.insert("software", Imf::StringAttribute(picture.info.software));
    for (const auto& [name, value] : picture.info.metadata)
        if (!name.empty() && header.find(name.c_str()) == header.end())
            header.insert(name.c_str(), Imf::StringAttribute(value));
    if (picture.info.frame) header.insert("frame", Imf::IntAttribute(*picture.info.frame));
    if (!picture.info.scene.empty()) header.insert("scene", Imf::StringAttribute(picture.info.scene));
    if (!picture.info.date.empty()) {
        Imf::addCapDate(header, picture.info.date);
        Imf::addUtcOffset(header, 0);
    }
    add_attributes(header, picture.plan.attributes);
    return header;
}

/// What is larger becomes the largest finite half: no infinities in files.
Imath::half to_half(float value) {
    return Imath::half(std::clamp(value, -65504.0f, 65504.0f));
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
    Stream stream(file, picture.plan.path);
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
    return lacks_variable(image, plan) ? kNoVariables : "";
}

}  // namespace

std::string write_open_exr(const PictureToWrite& picture, OutputFile& file) {
    std::string problem = missing(picture.image, picture.plan);
    for (const DisplayPlan& plan : picture.further)
        if (problem.empty()) problem = missing(picture.image, plan);
    if (!problem.empty()) return problem;
    if (!file.open()) return file.error();
    try {
        write_pixels(picture, file);
    } catch (const std::exception& failure) {
        return file.error().empty() ? failure.what() : file.error();
    }
    return file.commit() ? std::string() : file.error();
}

}  // namespace trapeze
