#include "composite/displays/image_output.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "composite/displays/srgb.h"
#include "core/random.h"

namespace trapeze {
namespace {

const char* format_name(FileFormat format) {
    switch (format) {
        case FileFormat::OpenExr:
            return "openexr";
        case FileFormat::Tiff:
            return "tiff";
        case FileFormat::Png:
            return "png";
        case FileFormat::Jpeg:
            return "jpeg";
        case FileFormat::Targa:
            return "targa";
        case FileFormat::Bmp:
            return "bmp";
    }
    return "";
}

/// Of a side; beyond, libjpeg ends the program.
constexpr int kMostJpegPixels = 65500;

/// How the picture's pixels become the file's.
struct Encoding {
    Quantization quantization;
    OIIO::TypeDesc type = OIIO::TypeDesc::UINT8;
    bool srgb = false, unassociated = false;
    int channels = 3;
    int first_channel = 0;          ///< 3 when alpha is alone
    const float* values = nullptr;  ///< of the window's first pixel
    int values_per_pixel = 4;
    bool depth = false;

    bool to_float() const { return type == OIIO::TypeDesc::FLOAT; }
};

Encoding encoding_of(const PictureToWrite& picture) {
    const DisplayPlan& plan = picture.plan;
    Encoding e;
    e.quantization = plan.quantization;
    e.type = e.quantization.to_float()      ? OIIO::TypeDesc::FLOAT
             : e.quantization.has_16_bits() ? OIIO::TypeDesc::UINT16
                                            : OIIO::TypeDesc::UINT8;
    e.srgb = plan.srgb;
    const bool takes_alpha = plan.format != FileFormat::Jpeg;
    e.channels = plan.rgb ? (plan.alpha && takes_alpha ? 4 : 3) : 1;
    e.first_channel = plan.rgb ? 0 : 3;
    e.unassociated = e.channels == 4 && plan.format != FileFormat::Tiff;
    e.depth = plan.depth;
    e.values = picture.image.rgba.data();
    if (!plan.aov) return e;
    e.channels = plan.aov->channels;
    e.first_channel = 0;
    e.unassociated = false;
    e.values = picture.image.aovs.data() + plan.aov->offset;
    e.values_per_pixel = picture.image.aov_channels;
    return e;
}

/// One channel of a pixel in the file's scale: 0..1 for what is quantized.
float encoded(const Encoding& e, const float* pixel, int channel) {
    if (channel == 3) return pixel[3];
    float value = pixel[channel];
    if (e.unassociated) value = pixel[3] > 0 ? value / pixel[3] : 0;
    return e.srgb ? srgb_encoded(value) : value;
}

/// Dither from the pixel's place, so that the file is the same for any order of work and any crop.
int quantized(const Quantization& q, float value, int x, int y, int channel) {
    const uint32_t bits =
        hash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(channel));
    const float level = q.zero + (q.one - q.zero) * value + q.dither * (2 * unit_float(bits) - 1);
    const float high = std::clamp(q.max, 0.0f, 65535.0f), low = std::clamp(q.min, 0.0f, high);
    return static_cast<int>(std::clamp(std::floor(level + 0.5f), low, high));
}

template <class Value>
std::vector<Value> encode_pixels(const Image& image, const Encoding& e) {
    std::vector<Value> out;
    out.reserve(image.z.size() * static_cast<size_t>(e.channels));
    for (int y = image.window.y0; y < image.window.y1; ++y)
        for (int x = image.window.x0; x < image.window.x1; ++x) {
            const float* pixel = e.values + static_cast<size_t>(e.values_per_pixel) * image.index(x, y);
            for (int c = e.first_channel; c < e.first_channel + e.channels; ++c) {
                const float value = encoded(e, pixel, c);
                if constexpr (std::is_same_v<Value, float>)
                    out.push_back(value);
                else
                    out.push_back(static_cast<Value>(quantized(e.quantization, value, x, y, c)));
            }
        }
    return out;
}

/// How numbers of colours stand for light; empty for others.
std::string transfer_text(const PictureToWrite& picture, const Encoding& e) {
    const bool is_aov = picture.plan.aov.has_value();
    if (!(is_aov ? picture.plan.aov_is_color : picture.plan.rgb)) return {};
    if (e.srgb) return "srgb";
    const float gamma = picture.context.scene->options.exposure_gamma;
    return gamma == 1 || is_aov ? "linear" : fmt::format("gamma {:g}", gamma);
}

/// "name: value; name: value"
std::string description(const PictureToWrite& picture, const Encoding& e) {
    auto metadata = picture.info.metadata;
    if (picture.info.frame) metadata.emplace_back("frame", std::to_string(*picture.info.frame));
    if (!picture.info.scene.empty()) metadata.emplace_back("scene", picture.info.scene);
    if (std::string transfer = transfer_text(picture, e); !transfer.empty())
        metadata.emplace_back("transfer", std::move(transfer));
    std::string text;
    for (const auto& [name, value] : metadata)
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", name, value);
    return text;
}

OIIO::ImageSpec make_spec(const PictureToWrite& picture, const Encoding& e) {
    const Image& image = picture.image;
    OIIO::ImageSpec spec(image.window.width(), image.window.height(), e.channels, e.type);
    spec.x = image.window.x0, spec.y = image.window.y0;
    spec.full_width = image.width, spec.full_height = image.height;
    if (picture.plan.aov) {
        spec.channelnames = aov_channel_names(picture.plan);
        spec.alpha_channel = -1;
    } else if (!picture.plan.rgb) {
        spec.channelnames = {e.depth ? "Z" : "A"};
        spec.alpha_channel = e.depth ? -1 : 0;
    }
    spec.attribute("PixelAspectRatio", picture.context.scene->options.pixel_aspect);
    spec.attribute("Software", picture.info.software);
    spec.attribute("ImageDescription", description(picture, e));
    if (!picture.info.date.empty()) spec.attribute("DateTime", picture.info.date);
    if (e.unassociated) spec.attribute("oiio:UnassociatedAlpha", 1);
    const std::string& compression = picture.plan.compression;
    if (picture.plan.format == FileFormat::Png && compression == "none")
        spec.attribute("png:compressionLevel", 0);
    else if (!compression.empty())
        spec.attribute("compression", compression);
    if (picture.plan.format == FileFormat::Tiff) {
        const M44f screen =
            picture.context.scene->camera_from_world * screen_from_camera(picture.context.camera);
        spec.attribute("worldtocamera", OIIO::TypeMatrix, &picture.context.scene->camera_from_world);
        spec.attribute("worldtoscreen", OIIO::TypeMatrix, &screen);
        if (picture.plan.depth_map) spec.attribute("textureformat", "Shadow");
    } else {
        // In a TIFF this would be Exif data, which OpenImageIO 2.4 cannot write to memory; readers take whole
        // numbers there for sRGB anyway.
        spec.attribute("oiio:ColorSpace", e.srgb ? "sRGB" : "");
    }
    return spec;
}

bool write_pixels(OIIO::ImageOutput& out, const Image& image, const Encoding& e) {
    if (e.depth) return out.write_image(OIIO::TypeDesc::FLOAT, image.z.data());
    if (e.type == OIIO::TypeDesc::FLOAT)
        return out.write_image(e.type, encode_pixels<float>(image, e).data());
    if (e.type == OIIO::TypeDesc::UINT16)
        return out.write_image(e.type, encode_pixels<uint16_t>(image, e).data());
    return out.write_image(e.type, encode_pixels<uint8_t>(image, e).data());
}

}  // namespace

std::string write_image(const PictureToWrite& picture, OutputFile& file) {
    if (lacks_variable(picture)) return kNoVariables;
    const PixelRect& window = picture.image.window;
    if (picture.plan.format == FileFormat::Jpeg &&
        std::max(window.width(), window.height()) > kMostJpegPixels)
        return fmt::format("JPEG files have at most {} pixels along a side", kMostJpegPixels);
    if (!file.open()) return file.error();
    // Into memory first: not every format's code notices a full disk, OutputFile does.
    OIIO::Filesystem::IOVecOutput memory;
    const char* format = format_name(picture.plan.format);
    const auto out = OIIO::ImageOutput::create(format);
    if (!out) return OIIO::geterror();
    const Encoding encoding = encoding_of(picture);
    const bool good = out->set_ioproxy(&memory) && out->open(format, make_spec(picture, encoding)) &&
                      write_pixels(*out, picture.image, encoding) && out->close();
    if (!good) return out->geterror();
    const std::vector<unsigned char>& bytes = memory.buffer();
    return file.write(bytes.data(), bytes.size()) && file.commit() ? std::string() : file.error();
}

}  // namespace trapeze
