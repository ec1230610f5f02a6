/// Options (RISpec 4.1).
#include <array>

#include "pipeline/ri/call.h"
#include "pipeline/ri/names.h"
#include "pipeline/ri/parameters.h"
#include "pipeline/rib/syntax/search_path.h"

namespace trapeze::ri {
namespace {

/// Writes a request of a name and parameters; RIE_NOTOPTIONS within a world.
void write_named_option(Context& context, const char* request, RtToken name, const RiArguments& arguments) {
    context.expect_options();
    required(name, "the name");
    const auto parameters = checked_parameters(context, arguments);
    context.writer().request(request);
    context.writer().string(name);
    write_parameters(context.writer(), parameters);
}

/// Carries out Option "rib" before RiBegin: the form of the files that follow. Tokens may carry their
/// declarations.
void set_next_format(const RiArguments& arguments) {
    for (int i = 0; i < arguments.count && i < 1000; ++i) {
        if (!arguments.tokens || !arguments.values || !arguments.tokens[i] || !arguments.values[i]) continue;
        const std::string token = arguments.tokens[i];
        const auto* const value = static_cast<const RtString*>(arguments.values[i]);
        const std::string text = *value ? *value : "";
        const std::string name = token.substr(token.find_last_of(' ') + 1);
        if (name == "format" && (text == "ascii" || text == "binary"))
            next_format().binary = text == "binary";
        else if (name == "compression" && (text == "none" || text == "gzip"))
            next_format().gzip = text == "gzip";
        else
            throw CallError{RIE_BADTOKEN, "\"rib\" has no \"" + name + "\" that is \"" + text + "\""};
    }
}

/// Where RiReadArchive looks for comments; the RIB's reader looks there again.
void keep_archive_folders(Context& context, const std::vector<RiParameter>& parameters) {
    for (const RiParameter& parameter : parameters)
        if (parameter.type == ValueType::String && parameter.count > 0 &&
            parameter.token.ends_with("archive"))
            context.archive_folders = rib::expand_search_path(*static_cast<const RtString*>(parameter.values),
                                                              context.archive_folders, {});
}

/// The perspective's angle, wherever it stands.
float field_of_view(const std::vector<RiParameter>& parameters) {
    for (const RiParameter& parameter : parameters)
        if (parameter.type == ValueType::Float && parameter.token.ends_with("fov"))
            return *static_cast<const float*>(parameter.values);
    return 90;
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiFormat(RtInt xresolution, RtInt yresolution, RtFloat pixelaspect) {
    call("RiFormat", [&](Context& context) {
        context.expect_options();
        trapeze::Options& camera = context.spaces.camera;
        if (xresolution > 0) camera.width = xresolution;
        if (yresolution > 0) camera.height = yresolution;
        if (pixelaspect > 0) camera.pixel_aspect = pixelaspect;
        context.writer().request("Format");
        context.writer().number(xresolution);
        context.writer().number(yresolution);
        context.writer().number(pixelaspect);
    });
}

RtVoid RiFrameAspectRatio(RtFloat aspect) {
    call("RiFrameAspectRatio", [&](Context& context) {
        context.expect_options();
        if (!(aspect > 0)) throw CallError{RIE_RANGE, "the ratio must be positive"};
        context.spaces.camera.frame_aspect = aspect;
        context.writer().request("FrameAspectRatio");
        context.writer().number(aspect);
    });
}

RtVoid RiScreenWindow(RtFloat left, RtFloat right, RtFloat bottom, RtFloat top) {
    call("RiScreenWindow", [&](Context& context) {
        context.expect_options();
        if (left == right || bottom == top) throw CallError{RIE_RANGE, "the window is empty"};
        context.spaces.camera.screen_window = std::array<float, 4>{left, right, bottom, top};
        context.writer().request("ScreenWindow");
        for (const float side : {left, right, bottom, top}) context.writer().number(side);
    });
}

RtVoid RiCropWindow(RtFloat xmin, RtFloat xmax, RtFloat ymin, RtFloat ymax) {
    write_option("CropWindow", {xmin, xmax, ymin, ymax});
}

RtVoid RiClipping(RtFloat hither, RtFloat yon) {
    call("RiClipping", [&](Context& context) {
        context.expect_options();
        if (!(hither >= 0 && hither < yon)) throw CallError{RIE_RANGE, "needs 0 <= hither < yon"};
        context.spaces.camera.near_clip = std::max(hither, trapeze::kEpsilon);
        context.spaces.camera.far_clip = std::min(yon, trapeze::kInfinity);
        context.writer().request("Clipping");
        context.writer().number(hither);
        context.writer().number(yon);
    });
}

RtVoid RiClippingPlane(RtFloat x, RtFloat y, RtFloat z, RtFloat nx, RtFloat ny, RtFloat nz) {
    write_option("ClippingPlane", {x, y, z, nx, ny, nz});
}

RtVoid RiDepthOfField(RtFloat fstop, RtFloat focallength, RtFloat focaldistance) {
    write_option("DepthOfField", {fstop, focallength, focaldistance});
}

RtVoid RiShutter(RtFloat opentime, RtFloat closetime) {
    write_option("Shutter", {opentime, closetime});
}

RtVoid RiPixelVariance(RtFloat variance) {
    write_option("PixelVariance", {variance});
}

RtVoid RiPixelSamples(RtFloat xsamples, RtFloat ysamples) {
    write_option("PixelSamples", {xsamples, ysamples});
}

RtVoid RiPixelFilter(RtFilterFunc filter, RtFloat xwidth, RtFloat ywidth) {
    call("RiPixelFilter", [&](Context& context) {
        context.expect_options();
        const char* const name = filter_name(filter);
        context.writer().request("PixelFilter");
        context.writer().string(name);
        context.writer().number(xwidth);
        context.writer().number(ywidth);
    });
}

RtVoid RiExposure(RtFloat gain, RtFloat gamma) {
    write_option("Exposure", {gain, gamma});
}

RtVoid RiQuantize(RtToken type, RtInt one, RtInt min, RtInt max, RtFloat dither) {
    call("RiQuantize", [&](Context& context) {
        context.expect_options();
        required(type, "the type");
        context.writer().request("Quantize");
        context.writer().string(type);
        for (const RtInt number : {one, min, max}) context.writer().number(number);
        context.writer().number(dither);
    });
}

RtVoid RiColorSamples(RtInt n, RtFloat nRGB[], RtFloat RGBn[]) {
    call("RiColorSamples", [&](Context& context) {
        constexpr RtInt kMostSamples = 1000;  // as the reader
        context.expect_options();
        if (n < 1 || n > kMostSamples) throw CallError{RIE_RANGE, "needs 1 to 1000 samples"};
        const auto to_rgb = array_of(nRGB, 3 * n, "nRGB"), from_rgb = array_of(RGBn, 3 * n, "RGBn");
        context.counting.samples_per_color = n;
        context.writer().request("ColorSamples");
        context.writer().numbers(to_rgb);
        context.writer().numbers(from_rgb);
    });
}

RtVoid RiRelativeDetail(RtFloat relativedetail) {
    write_option("RelativeDetail", {relativedetail});
}

RtVoid RiProjectionV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiProjection", [&](Context& context) {
        context.expect_options();
        const std::string projection = name ? name : "null";  // RISpec: RI_NULL is a projection
        const auto parameters = checked_parameters(context, {n, tokens, values});
        trapeze::Options& camera = context.spaces.camera;
        camera.projection = projection == "perspective" ? projection : "orthographic";
        if (const float fov = field_of_view(parameters); fov > 0 && fov < 180) camera.fov = fov;
        context.spaces.begin_camera();
        context.writer().request("Projection");
        context.writer().string(projection);
        write_parameters(context.writer(), parameters);
    });
}

RtVoid RiImagerV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiImager", [&](Context& context) {
        write_named_option(context, "Imager", name ? name : "null", {n, tokens, values});
    });
}

RtVoid RiDisplayV(RtToken name, RtToken type, RtToken mode, RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiDisplay", [&](Context& context) {
        context.expect_options();
        required(name, "the name"), required(type, "the type"), required(mode, "the mode");
        const auto parameters = checked_parameters(context, {n, tokens, values}, "display");
        context.writer().request("Display");
        for (const RtToken text : {name, type, mode}) context.writer().string(text);
        write_parameters(context.writer(), parameters);
    });
}

RtVoid RiDisplayChannelV(RtToken channel, RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiDisplayChannel", [&](Context& context) {
        write_named_option(context, "DisplayChannel", channel, {n, tokens, values});
    });
}

RtVoid RiHiderV(RtToken type, RtInt n, RtToken tokens[], RtPointer values[]) {
    call("RiHider", [&](Context& context) {
        context.expect_options();
        required(type, "the type");
        const auto parameters = checked_parameters(context, {n, tokens, values}, "hidden");
        context.writer().request("Hider");
        context.writer().string(type);
        write_parameters(context.writer(), parameters);
    });
}

RtVoid RiOptionV(RtToken name, RtInt n, RtToken tokens[], RtPointer values[]) {
    const RiArguments arguments{n, tokens, values};
    if (!current_context() && name && std::string(name) == "rib")
        return guarded("RiOption", [&] { set_next_format(arguments); });
    call("RiOption", [&](Context& context) {
        context.expect_options();
        const std::string category = required(name, "the name");
        const auto parameters = checked_parameters(context, arguments, category);
        context.writer().request("Option");
        context.writer().string(category);
        write_parameters(context.writer(), parameters);
        if (category == "searchpath") keep_archive_folders(context, parameters);
    });
}
