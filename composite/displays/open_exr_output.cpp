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

#include <algorithm>
#include <stdexcept>

#include "composite/displays/exr_attributes.h"

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

Imf::Header make_header(const PictureToWrite& picture) {
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

    const Imf::PixelType color = picture.plan.float_pixels ? Imf::FLOAT : Imf::HALF;
    if (picture.plan.rgb)
        for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(color));
    if (picture.plan.alpha) header.channels().insert("A", Imf::Channel(color));
    if (picture.plan.depth) header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    for (const std::string& name : aov_channel_names(picture.plan))
        header.channels().insert(name, Imf::Channel(color));
    if (picture.plan.id) header.channels().insert("id", Imf::Channel(Imf::UINT));

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

/// Converts to halves. What is larger becomes the largest finite half: no infinities in files.
void to_halves(const float* from, size_t count, Imath::half* to) {
    for (size_t i = 0; i < count; ++i) to[i] = Imath::half(std::clamp(from[i], -65504.0f, 65504.0f));
}

/// Writes some rows at a time, so that only those rows are ever there as halves.
class RowWriter {
  public:
    RowWriter(const PictureToWrite& picture, Imf::OutputFile& out) : picture_(picture), out_(out) {}

    void write(int y0, int y1) {
        const Image& image = picture_.image;
        const DisplayPlan& plan = picture_.plan;
        const size_t first = image.index(image.window.x0, y0),
                     count = image.index(image.window.x0, y1) - first;
        Imf::FrameBuffer buffer;
        if (plan.aov) {
            insert_aov(buffer, first, count, y0, y1);
        } else if (plan.float_pixels) {
            insert_colors(buffer, Imf::FLOAT, image.rgba.data() + 4 * first, y0, y1);
        } else if (plan.rgb || plan.alpha) {
            halves_.resize(4 * count);
            to_halves(image.rgba.data() + 4 * first, 4 * count, halves_.data());
            insert_colors(buffer, Imf::HALF, halves_.data(), y0, y1);
        }
        if (plan.depth) buffer.insert("Z", slice(Imf::FLOAT, image.z.data() + first, 1, y0, y1));
        if (plan.id) buffer.insert("id", slice(Imf::UINT, image.id.data() + first, 1, y0, y1));
        out_.setFrameBuffer(buffer);
        out_.writePixels(y1 - y0);
    }

  private:
    template <class Value>
    Imf::Slice slice(Imf::PixelType type, const Value* values, int values_per_pixel, int y0, int y1) const {
        const PixelRect& window = picture_.image.window;
        const size_t stride = sizeof(Value) * static_cast<size_t>(values_per_pixel);
        return Imf::Slice::Make(type, values, V2i(window.x0, y0), window.width(), y1 - y0, stride,
                                stride * static_cast<size_t>(window.width()));
    }
    template <class Value>
    void insert_colors(Imf::FrameBuffer& buffer, Imf::PixelType type, const Value* rgba, int y0,
                       int y1) const {
        const char* const names[] = {"R", "G", "B", "A"};
        for (int c = 0; c < 4; ++c)
            if (c < 3 ? picture_.plan.rgb : picture_.plan.alpha)
                buffer.insert(names[c], slice(type, rgba + c, 4, y0, y1));
    }

    void insert_aov(Imf::FrameBuffer& buffer, size_t first, size_t count, int y0, int y1) {
        const Image& image = picture_.image;
        const auto stride = static_cast<size_t>(image.aov_channels);
        const float* values = image.aovs.data() + stride * first;
        if (!picture_.plan.float_pixels) {
            halves_.resize(stride * count);
            to_halves(values, stride * count, halves_.data());
        }
        int channel = picture_.plan.aov->offset;
        for (const std::string& name : aov_channel_names(picture_.plan)) {
            buffer.insert(name, picture_.plan.float_pixels
                                    ? slice(Imf::FLOAT, values + channel, image.aov_channels, y0, y1)
                                    : slice(Imf::HALF, halves_.data() + channel, image.aov_channels, y0, y1));
            ++channel;
        }
    }

    const PictureToWrite& picture_;
    Imf::OutputFile& out_;
    std::vector<Imath::half> halves_;
};

void write_rows(const PictureToWrite& picture, OutputFile& file) {
    Stream stream(file, picture.plan.path);
    Imf::OutputFile out(stream, make_header(picture));
    RowWriter rows(picture, out);
    const PixelRect& window = picture.image.window;
    for (int y = window.y0; y < window.y1; y += kRowsAtOnce) {
        if (picture.context.is_cancelled()) throw std::runtime_error("cancelled");
        rows.write(y, std::min(y + kRowsAtOnce, window.y1));
    }
}

}  // namespace

std::string write_open_exr(const PictureToWrite& picture, OutputFile& file) {
    if (picture.plan.id && picture.image.id.empty()) return "no ids were recorded";
    if (lacks_variable(picture)) return kNoVariables;
    if (!file.open()) return file.error();
    try {
        write_rows(picture, file);
    } catch (const std::exception& failure) {
        return file.error().empty() ? failure.what() : file.error();
    }
    return file.commit() ? std::string() : file.error();
}

}  // namespace trapeze
