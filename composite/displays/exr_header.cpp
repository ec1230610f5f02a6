#include "composite/displays/exr_header.h"

#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <cmath>

#include "composite/displays/cryptomatte_header.h"
#include "composite/displays/exr_attributes.h"
#include "core/colors/color_management.h"

namespace trapeze {
namespace {

/// OpenEXR's compression of a name; `usual` where no name is given.
Imf::Compression compression_of(const std::string& name, Imf::Compression usual) {
    constexpr std::pair<std::string_view, Imf::Compression> kNames[] = {
        {"none", Imf::NO_COMPRESSION},  {"rle", Imf::RLE_COMPRESSION},   {"zips", Imf::ZIPS_COMPRESSION},
        {"zip", Imf::ZIP_COMPRESSION},  {"piz", Imf::PIZ_COMPRESSION},   {"pxr24", Imf::PXR24_COMPRESSION},
        {"b44", Imf::B44_COMPRESSION},  {"b44a", Imf::B44A_COMPRESSION}, {"dwaa", Imf::DWAA_COMPRESSION},
        {"dwab", Imf::DWAB_COMPRESSION}};
    const auto found = std::find_if(std::begin(kNames), std::end(kNames),
                                    [&](const auto& row) { return row.first == name; });
    return found == std::end(kNames) ? usual : found->second;
}

/// The matrix to OpenEXR's NDC, which runs from (0, 0) at the upper left of the display window to (1, 1) at
/// the lower right (ImfStandardAttributes.h, worldToNDC); screen space has (0, 0) in the middle and y up.
M44f ndc_from_camera(const Camera& camera) {
    const M44f ndc_from_screen(0.5f, 0, 0, 0, 0, -0.5f, 0, 0, 0, 0, 1, 0, 0.5f, 0.5f, 0, 1);
    return screen_from_camera(camera) * ndc_from_screen;
}

void add_camera(const PictureToWrite& picture, Imf::Header& header) {
    const Camera& camera = picture.context.camera;
    const Scene& scene = *picture.context.scene;
    const Options& options = scene.options;
    Imf::addWorldToCamera(header, scene.camera_from_world);
    Imf::addWorldToNDC(header, scene.camera_from_world * ndc_from_camera(camera));
    header.insert("shutter", Imf::V2fAttribute(V2f(options.shutter_open, options.shutter_close)));
    if (!camera.has_lens()) return;
    Imf::addAperture(header, options.f_stop);
    header.insert("focalLength", Imf::FloatAttribute(options.focal_length));
    header.insert("focalDistance", Imf::FloatAttribute(options.focal_distance));
}

/// Whether some channels are colours, which are in the working space.
bool has_colors(const PictureToWrite& picture) {
    const auto is_of_colors = [](const DisplayPlan& plan) { return plan.rgb || plan.aov_is_color; };
    return is_of_colors(picture.plan) || std::ranges::any_of(picture.further, is_of_colors);
}

/// Of pictures of light, whose numbers Exposure's gamma has not bent. Where no config is asked for nobody
/// says what the scene's colours mean: they are taken for ITU-R BT.709's, as most are. A config's working
/// space has a name.
void add_color_space(const PictureToWrite& picture, Imf::Header& header) {
    if (!has_colors(picture)) return;
    if (picture.context.colors) {
        header.insert("workingSpace", Imf::StringAttribute(picture.context.colors->names().working_space));
        return;
    }
    if (picture.context.scene->options.exposure_gamma != 1) return;
    Imf::addChromaticities(header, Imf::Chromaticities());
    header.insert("colorInteropID", Imf::StringAttribute("lin_rec709_scene"));
}

void add_facts(const OutputInfo& info, Imf::Header& header) {
    header.insert("software", Imf::StringAttribute(info.software));
    for (const auto& [name, value] : info.metadata)
        if (!name.empty() && header.find(name.c_str()) == header.end())
            header.insert(name.c_str(), Imf::StringAttribute(value));
    if (info.frame) header.insert("frame", Imf::IntAttribute(*info.frame));
    if (!info.scene.empty()) header.insert("scene", Imf::StringAttribute(info.scene));
    if (!info.stats.empty()) header.insert("renderStats", Imf::StringAttribute(info.stats));
    if (info.date.empty()) return;
    Imf::addCapDate(header, info.date);
    Imf::addUtcOffset(header, 0);
}

}  // namespace

Imf::Header make_exr_header(const PictureToWrite& picture, Imf::Compression usual) {
    const Camera& camera = picture.context.camera;
    const PixelRect& window = picture.image.window;
    const Box2i display(V2i(0, 0), V2i(picture.image.width - 1, picture.image.height - 1));
    const Box2i data(V2i(window.x0, window.y0), V2i(window.x1 - 1, window.y1 - 1));
    const V2f center((camera.left + camera.right) / 2 * camera.tan_half_fov,
                     (camera.bottom + camera.top) / 2 * camera.tan_half_fov);
    const float width = std::abs(camera.right - camera.left) * camera.tan_half_fov;
    Imf::Header header(display, data, picture.context.scene->options.pixel_aspect, center, width,
                       Imf::INCREASING_Y, compression_of(picture.plan.compression, usual));
    add_camera(picture, header);
    add_color_space(picture, header);
    add_facts(picture.info, header);
    add_matte_attributes(picture, header);
    add_attributes(header, picture.plan.attributes);
    return header;
}

}  // namespace trapeze
