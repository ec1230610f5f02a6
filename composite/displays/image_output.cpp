#include "composite/displays/image_output.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "composite/displays/image_library.h"
#include "composite/displays/srgb.h"
#include "core/colors/color_management.h"
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

/// Pixels of a JPEG's side, at most; beyond, libjpeg ends the program.
constexpr int kMostJpegPixels = 65500;

/// How the picture's pixels become the file's.
struct Encoding {
    Quantization quantization;
    NumberType type = NumberType::Uint8;
    bool srgb = false, unassociated = false;
    const ColorManagement* colors = nullptr;  ///< whose view colours are brought to, instead; null: none
    int channels = 3;
    int first_channel = 0;          ///< 3 when alpha is alone
    const float* values = nullptr;  ///< of the window's first pixel
    int values_per_pixel = 4;
    bool depth = false;

    bool to_float() const { return type == NumberType::Float; }
};

/// Colours are associated (premultiplied) in the picture and in TIFF; other formats with alpha want them
/// divided by it, and where it is 0, as in a glow, get them as they are (OpenImageIO does the same). JPEG
/// holds no alpha. A variable has its own channels and no alpha.
Encoding encoding_of(const PictureToWrite& picture) {
    const DisplayPlan& plan = picture.plan;
    Encoding e;
    e.quantization = plan.quantization;
    e.type = e.quantization.to_float()      ? NumberType::Float
             : e.quantization.has_16_bits() ? NumberType::Uint16
                                            : NumberType::Uint8;
    e.colors = plan.viewed ? picture.context.colors.get() : nullptr;
    e.srgb = plan.srgb && !e.colors;
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

/// One channel of a pixel in the file's scale: 0..1 for numbers that are quantized.
float encoded(const Encoding& e, const float* pixel, int channel) {
    if (channel == 3) return pixel[3];
    float value = pixel[channel];
    if (e.unassociated && pixel[3] > 0) value /= pixel[3];
    return e.srgb ? srgb_encoded(value) : value;
}

/// Quantizes a value. The dither follows from the pixel's place, so that the file is the same for any order
/// of work and any crop.
int quantized(const Quantization& q, float value, int x, int y, int channel) {
    const uint32_t bits =
        hash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(channel));
    const float level = q.zero + (q.one - q.zero) * value + q.dither * (2 * unit_float(bits) - 1);
    const float high = std::clamp(q.max, 0.0f, 65535.0f), low = std::clamp(q.min, 0.0f, high);
    return static_cast<int>(std::clamp(std::floor(level + 0.5f), low, high));
}

/// A row of the window as the view shows it, R G B and a number without meaning each; empty: none is asked
/// for.
std::vector<float> viewed_row(const Image& image, const Encoding& e, int y) {
    std::vector<float> row;
    if (!e.colors) return row;
    row.reserve(4 * static_cast<size_t>(image.window.width()));
    for (int x = image.window.x0; x < image.window.x1; ++x) {
        const float* pixel = e.values + static_cast<size_t>(e.values_per_pixel) * image.index(x, y);
        for (int c = 0; c < 3; ++c) row.push_back(encoded(e, pixel, c));
        row.push_back(1);
    }
    e.colors->view().apply(row.data(), row.size() / 4);
    return row;
}

/// The window's pixels, row by row, channels side by side, in the file's numbers.
template <class Value>
std::vector<Value> encode_pixels(const Image& image, const Encoding& e) {
    const auto row_values = static_cast<size_t>(image.window.width()) * static_cast<size_t>(e.channels);
    std::vector<Value> values(row_values * static_cast<size_t>(image.window.height()));
    tbb::parallel_for(image.window.y0, image.window.y1, [&](int y) {
        const std::vector<float> viewed = viewed_row(image, e, y);
        Value* out = values.data() + row_values * static_cast<size_t>(y - image.window.y0);
        for (int x = image.window.x0; x < image.window.x1; ++x) {
            const float* pixel = e.values + static_cast<size_t>(e.values_per_pixel) * image.index(x, y);
            const float* shown = viewed.empty() ? nullptr : viewed.data() + 4 * (x - image.window.x0);
            for (int c = e.first_channel; c < e.first_channel + e.channels; ++c) {
                const float value = shown && c < 3 ? shown[c] : encoded(e, pixel, c);
                if constexpr (std::is_same_v<Value, float>)
                    *out++ = value;
                else
                    *out++ = static_cast<Value>(quantized(e.quantization, value, x, y, c));
            }
        }
    });
    return values;
}

/// How numbers of colours stand for light, for the file's metadata; empty for other pictures.
std::vector<std::pair<std::string, std::string>> transfer_texts(const PictureToWrite& picture,
                                                                const Encoding& e) {
    const bool is_aov = picture.plan.aov.has_value();
    if (!(is_aov ? picture.plan.aov_is_color : picture.plan.rgb)) return {};
    std::vector<std::pair<std::string, std::string>> texts;
    if (const ColorManagement* colors = picture.context.colors.get())
        texts.emplace_back("workingSpace", colors->names().working_space);
    if (e.colors) {
        const ColorNames& names = e.colors->names();
        texts.insert(texts.end(), {{"display", names.display}, {"view", names.view}});
        if (!names.look.empty()) texts.emplace_back("look", names.look);
        return texts;
    }
    const float gamma = picture.context.scene->options.exposure_gamma;
    texts.emplace_back("transfer", e.srgb                 ? "srgb"
                                   : gamma == 1 || is_aov ? "linear"
                                                          : fmt::format("gamma {:g}", gamma));
    return texts;
}

/// The metadata in one text: "name: value; name: value".
std::string description(const PictureToWrite& picture, const Encoding& e) {
    auto metadata = picture.info.metadata;
    if (picture.info.frame) metadata.emplace_back("frame", std::to_string(*picture.info.frame));
    if (!picture.info.scene.empty()) metadata.emplace_back("scene", picture.info.scene);
    for (auto& text : transfer_texts(picture, e)) metadata.push_back(std::move(text));
    std::string text;
    for (const auto& [name, value] : metadata)
        text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", name, value);
    return text;
}

/// All that the file says besides its pixels. width and height are the crop window's, full_width and
/// full_height the whole picture's. The matrices of a TIFF say where the camera stood, for readers of shadow
/// maps.
ImageForm make_form(const PictureToWrite& picture, const Encoding& e) {
    const Image& image = picture.image;
    ImageForm form;
    form.format = format_name(picture.plan.format);
    form.width = image.window.width(), form.height = image.window.height();
    form.x = image.window.x0, form.y = image.window.y0;
    form.full_width = image.width, form.full_height = image.height;
    form.channels = e.channels;
    form.type = e.type;
    if (picture.plan.aov) {
        form.channel_names = channel_names(picture.plan, false);
    } else if (!picture.plan.rgb) {
        form.channel_names = {e.depth ? "Z" : "A"};
        form.alpha_channel = e.depth ? -1 : 0;
    }
    const auto add = [&form](const char* name, ImageForm::Value value) {
        form.attributes.emplace_back(name, std::move(value));
    };
    add("PixelAspectRatio", picture.context.scene->options.pixel_aspect);
    add("Software", picture.info.software);
    add("ImageDescription", description(picture, e));
    if (!picture.info.date.empty()) add("DateTime", picture.info.date);
    if (e.unassociated) add("oiio:UnassociatedAlpha", 1);
    const std::string& compression = picture.plan.compression;
    if (picture.plan.format == FileFormat::Png && compression == "none")
        add("png:compressionLevel", 0);
    else if (!compression.empty())
        add("compression", compression);
    if (picture.plan.format == FileFormat::Tiff) {
        const Scene& scene = *picture.context.scene;
        add("worldtocamera", scene.camera_from_world);
        add("worldtoscreen", scene.camera_from_world * screen_from_camera(picture.context.camera));
        if (picture.plan.depth_map) add("textureformat", std::string("Shadow"));
    } else {
        // In a TIFF this would be Exif data, which OpenImageIO 2.4 cannot write to memory; readers take whole
        // numbers there for sRGB anyway.
        const bool is_srgb = e.colors ? e.colors->view_is_srgb() : e.srgb;
        add("oiio:ColorSpace", std::string(is_srgb ? "sRGB" : ""));
    }
    return form;
}

/// Encodes the picture's file. Depth is written as it is; all else is first brought into the file's numbers.
ImageBytes encode(const ImageLibrary& library, const Image& image, const Encoding& e, const ImageForm& form) {
    if (e.depth) return library.encode(form, NumberType::Float, image.z.data());
    if (e.type == NumberType::Float)
        return library.encode(form, e.type, encode_pixels<float>(image, e).data());
    if (e.type == NumberType::Uint16)
        return library.encode(form, e.type, encode_pixels<uint16_t>(image, e).data());
    return library.encode(form, e.type, encode_pixels<uint8_t>(image, e).data());
}

}  // namespace

std::string write_image(const PictureToWrite& picture, OutputFile& file) {
    if (lacks_variable(picture.image, picture.plan)) return kNoVariables;
    const PixelRect& window = picture.image.window;
    if (picture.plan.format == FileFormat::Jpeg &&
        std::max(window.width(), window.height()) > kMostJpegPixels)
        return fmt::format("JPEG files have at most {} pixels along a side", kMostJpegPixels);
    if (!file.open()) return file.error();
    std::string problem;
    const ImageLibrary* const library = image_library(&problem);
    if (!library) return problem;
    const Encoding encoding = encoding_of(picture);
    // Into memory first: not every format's code notices a full disk, OutputFile does.
    const ImageBytes made = encode(*library, picture.image, encoding, make_form(picture, encoding));
    if (!made.problem.empty()) return made.problem;
    return file.write(made.bytes.data(), made.bytes.size()) && file.commit() ? std::string() : file.error();
}

}  // namespace trapeze
