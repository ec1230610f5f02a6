/// RISpec 4.1: the camera, the film, the hider. Displays are in display_requests.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "core/scene/layer_limit.h"
#include "core/scene/ray_scene.h"
#include "pipeline/rib/reader/file_search.h"
#include "pipeline/rib/reader/open_files.h"
#include "pipeline/rib/requests/colorspaces.h"
#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/requests/ri_values.h"
#include "pipeline/rib/state/recognised_names.h"

namespace trapeze::rib {
namespace {

constexpr int kLargestPicture = 65536;  ///< pixels along a side
constexpr float kMostSamples = 64;      ///< along a side of a pixel
constexpr float kMostRayDepth = 100;    ///< Option "trace" "maxdepth"
/// A path tracer's noise wants more samples than a surface that is shaded before it is sampled.
constexpr float kMostHiderSamples = 64;
constexpr size_t kMostColorSamples = 1000;

/// RISpec's and the usual others; composite/filters/filters.cpp has what they mean.
constexpr std::string_view kFilters[] = {"gaussian", "box",     "triangle",        "catmull-rom",
                                         "sinc",     "disk",    "bessel",          "mitchell",
                                         "b-spline", "lanczos", "blackman-harris", "separable-catmull-rom"};

/// A condition on arguments, with what is said where it does not hold.
void require(bool holds, const char* text) {
    if (!holds) throw RequestError{text, {}};
}

/// Format xresolution yresolution [pixelaspectratio]: pixels, and the width of one over its height.
void format(OptionContext& r, ArgumentCursor& c) {
    const auto v = c.numbers(2, 3, "the format");
    const float width = v[0], height = v[1], aspect = v.size() > 2 ? v[2] : 1;
    require(width <= kLargestPicture && height <= kLargestPicture,
            "the picture is larger than 65536 pixels along a side");
    Options& o = changeable_options(r);
    // RISpec: a resolution below 1 asks for the default; so does an aspect that is not positive.
    if (width >= 1) o.width = static_cast<int>(width);
    if (height >= 1) o.height = static_cast<int>(height);
    if (aspect > 0) o.pixel_aspect = aspect;
}

/// FrameAspectRatio width/height of the picture; without it that of Format.
void frame_aspect_ratio(OptionContext& r, ArgumentCursor& c) {
    const float aspect = c.number("the ratio");
    require(std::isfinite(aspect), "the ratio must be finite");
    // Later RenderMans write -1 for that of the picture, which is the default.
    changeable_options(r).frame_aspect = aspect > 0 ? std::optional(aspect) : std::nullopt;
}

/// Four numbers, with brackets or without.
std::array<float, 4> four(ArgumentCursor& c, const char* what) {
    const auto v = c.numbers(4, what);
    return {v[0], v[1], v[2], v[3]};
}

/// ScreenWindow left right bottom top, in screen coordinates: the part of the plane z = 1, seen by the angle
/// of Projection, that fills the picture. A left greater than the right mirrors it.
void screen_window(OptionContext& r, ArgumentCursor& c) {
    const auto w = four(c, "the window");
    require(w[0] != w[1] && w[2] != w[3], "the window is empty");
    changeable_options(r).screen_window = w;
}

/// CropWindow xmin xmax ymin ymax: parts of the picture, from 0 to 1. What is outside is not rendered.
void crop_window(OptionContext& r, ArgumentCursor& c) {
    auto w = four(c, "the window");
    for (float& v : w) v = std::clamp(v, 0.0f, 1.0f);
    require(w[0] < w[1] && w[2] < w[3], "the window is empty");
    changeable_options(r).crop_window = w;
}

/// Whether a transformation scales and shifts x and y, and does nothing else to them.
bool keeps_axes(const M44d& m) {
    for (const auto& [row, column] : {std::pair{0, 1}, {1, 0}, {2, 0}, {2, 1}, {0, 3}, {1, 3}, {2, 3}})
        if (m[row][column] != 0) return false;
    constexpr double kLeast = 1e-20, kMost = 1e20;  // so that windows stay numbers
    for (const int axis : {0, 1}) {
        const double scale = std::abs(m[axis][axis] / m[3][3]), shift = std::abs(m[3][axis] / m[3][3]);
        if (!(scale > kLeast && scale < kMost && shift < kMost)) return false;
    }
    return true;
}

/// RISpec 4.1.1: what came before Projection transforms the screen, what follows places the world before the
/// camera. Of the former scales and shifts of x and y count; z is only depth there. What is left of a world
/// before has placed that world, and is dropped.
void transform_screen(OptionContext& r) {
    const MovingTransform transform = std::exchange(r.state.current().transform, MovingTransform());
    if (std::exchange(r.state.scope().has_projection, true)) return;
    Options& o = r.state.options();
    const M44d screen = transform.at(o.shutter_open);
    if (transform.moves_between(o.shutter_open, o.shutter_close))
        r.report.warn_once("the screen does not move; what comes before is taken as the shutter opens",
                           "moving-screen");
    if (!keeps_axes(screen))
        return r.report.warn_once(
            "of what comes before, Scale and Translate change the screen; this is ignored", "turned-screen");
    for (const int axis : {0, 1}) {
        const auto i = static_cast<size_t>(axis);
        o.screen_scale[i] = static_cast<float>(screen[axis][axis] / screen[3][3]);
        o.screen_offset[i] = static_cast<float>(screen[3][axis] / screen[3][3]);
    }
}

/// Projection name parameters: "perspective" with "fov" in degrees along the smaller side, or "orthographic".
void projection(OptionContext& r, ArgumentCursor& c) {
    constexpr float kWidest = 120;  // degrees, of what stands for wider projections
    Options& o = changeable_options(r);
    std::string name = c.string("the projection's name");
    if (name == "PxrCamera" || name == "PxrPerspective") name = "perspective";  // RIS's plugins
    if (name == "PxrOrthographic") name = "orthographic";
    const ParameterList parameters = r.parameters(c);
    float fov = parameters.float_or("fov", 90);
    if (name.empty() || name == "null") name = "orthographic";
    if (name != "perspective" && name != "orthographic") {
        // Others see all around, or nearly: of that what lies ahead.
        r.report.warn_once(in_quotes(name) + " is not supported; perspective is used", "projection-" + name);
        name = "perspective";
        if (fov > 0) fov = std::min(fov, kWidest);
    }
    require(fov > 0 && fov < 180, "\"fov\" must be between 0 and 180");
    o.projection = name;
    o.fov = fov;
    // PxrCamera's lens.
    const float f_stop = parameters.float_or("fStop", 0), length = parameters.float_or("focalLength", 0),
                distance = parameters.float_or("focalDistance", 0);
    if (f_stop > 0 && f_stop < kInfinity && length > 0 && distance > 0)
        o.f_stop = f_stop, o.focal_length = length, o.focal_distance = distance;
    if (!r.state.in_world()) transform_screen(r);
}

/// Clipping near far: distances in camera space. A near plane of 0 is put just before the eye, where
/// perspective still has a depth.
void clipping(OptionContext& r, ArgumentCursor& c) {
    const auto v = c.numbers(2, "the planes");
    const float near = v[0], far = v[1];
    require(near >= 0 && near < far, "needs 0 <= near < far");
    Options& o = changeable_options(r);
    o.near_clip = std::max(near, kEpsilon);
    o.far_clip = std::min(far, kInfinity);
}

/// DepthOfField fstop focallength focaldistance, lengths in camera space; the lens is focallength / fstop
/// wide.
void depth_of_field(OptionContext& r, ArgumentCursor& c) {
    Options& o = changeable_options(r);
    if (c.done() || c.next_is_string()) {  // "-" in older files, or nothing: a pinhole
        if (!c.done()) c.string("f-stop");
        o.f_stop = kInfinity;
        return;
    }
    const auto v = c.numbers(3, "the lens");
    const float f_stop = v[0], length = v[1], distance = v[2];
    if (f_stop >= kInfinity || length == 0) {  // a pinhole; the rest may be anything
        o.f_stop = kInfinity;
        return;
    }
    require(f_stop > 0 && length >= 0 && distance > 0, "needs a positive f-stop and focal distance");
    o.f_stop = f_stop, o.focal_length = length, o.focal_distance = distance;
}

/// Shutter min max: seconds of the scene, the unit of MotionBegin's times.
void shutter(OptionContext& r, ArgumentCursor& c) {
    const auto v = c.numbers(2, "the shutter");
    const float open = v[0], close = v[1];
    require(open <= close, "closes before it opens");
    require(std::isfinite(close - open), "is open for too long");
    require(!r.state.in_world(), "options cannot change inside a world");  // paths have been cut at its times
    changeable_options(r).shutter_open = open;
    r.state.options().shutter_close = close;
}

/// PixelSamples x y: samples along the sides of a pixel, which RIB allows to be fractions.
void pixel_samples(OptionContext& r, ArgumentCursor& c) {
    const auto v = c.numbers(2, "the samples");
    const float x = v[0], y = v[1];
    require(x >= 1 && y >= 1, "needs at least one sample along each side");
    if (x > kMostSamples || y > kMostSamples)
        r.report.error("more than 64 samples along a side; 64 are used");
    changeable_options(r).samples_x = std::min(x, kMostSamples);
    r.state.options().samples_y = std::min(y, kMostSamples);
    r.state.scope().has_pixel_samples = true;
}

/// PRMan's path tracer takes a pixel's samples from its hider: as many as it may take at most, as a square.
/// Without that, at least as many as it asks for. With both, pixels are sampled as PixelVariance says.
void set_samples_of_hider(OptionContext& r) {
    const ParameterList& given = r.state.options().hider_parameters;
    const float least = given.float_or("minsamples", 0), most = given.float_or("maxsamples", 0);
    r.state.options().adaptive = least >= 1 && most > least;
    r.state.options().least_samples = least >= 1 ? std::sqrt(least) : 0;
    const float samples = std::max(most, least);
    if (!(samples >= 1) || r.state.scope().has_pixel_samples) return;
    const float side = std::ceil(std::sqrt(std::min(samples, kMostHiderSamples)));
    r.state.options().samples_x = r.state.options().samples_y = side;
}

/// "aperture": blades, angle, roundness and density (core/scene/aperture.h); left out where it is wrong.
void check_aperture(OptionContext& r, ParameterList& given) {
    const Parameter* aperture = given.find("aperture");
    if (!aperture) return;
    const std::vector<float>& v = aperture->floats;
    if (v.size() != 4 || !std::all_of(v.begin(), v.end(), [](float x) { return std::isfinite(x); })) {
        r.report.error("\"aperture\" needs 4 numbers: blades, angle, roundness and density; left out");
        std::erase_if(given.values, [](const Parameter& value) { return value.name == "aperture"; });
        return;
    }
    if (v[0] != std::floor(v[0]) || (v[0] != 0 && v[0] < 3))
        r.report.warn_once(
            "\"aperture\" has 3 blades or more, in whole numbers, or 0 for a disk: fewer are a disk, too, and "
            "parts of a blade are left out",
            "hider-aperture-blades");
    if (std::abs(v[2]) > 1 || std::abs(v[3]) > 1) {
        r.report.warn_once("roundness and density of \"aperture\" are from -1 to 1; they are clamped",
                           "hider-aperture");
    }
}

/// "maxvpdepth": -1, or how many layers a sample sees; left out where it is neither.
void check_layer_limit(OptionContext& r, ParameterList& given) {
    const Parameter* limit = given.find("maxvpdepth");
    if (!limit) return;
    const float most = given.float_or("maxvpdepth", 0);
    if (most == -1 || (most >= 1 && most <= kMostLayers)) return;
    r.report.error("\"maxvpdepth\" is a number of layers from 1 to 1000000, or -1 for all; left out");
    std::erase_if(given.values, [](const Parameter& value) { return value.name == "maxvpdepth"; });
}

/// PixelFilter name xwidth ywidth: whole widths, in pixels.
void pixel_filter(OptionContext& r, ArgumentCursor& c) {
    std::string name = c.string("the filter's name");
    const auto v = c.numbers(2, "the widths");
    const float x = v[0], y = v[1];
    require(x > 0 && y > 0 && x <= 64 && y <= 64, "widths must be positive and at most 64 pixels");
    Options& o = changeable_options(r);
    if (std::find(std::begin(kFilters), std::end(kFilters), name) == std::end(kFilters)) {
        r.report.warn_once(in_quotes(name) + " is not known; gaussian is used", "filter-" + name);
        name = "gaussian";
    }
    o.filter = {name, x, y};
}

/// Exposure gain gamma: colours times gain, to the power 1 / gamma (RISpec 4.1.2).
void exposure(OptionContext& r, ArgumentCursor& c) {
    const auto v = c.numbers(2, "the exposure");
    const float gain = v[0], gamma = v[1];
    require(gain >= 0, "needs a gain that is not negative");
    require(gamma > 0, "needs a positive gamma");
    changeable_options(r).exposure_gain = gain;
    r.state.options().exposure_gamma = gamma;
}

/// Quantize type one min max dither: colour value 1 becomes `one`; 0 keeps floats.
void quantize(OptionContext& r, ArgumentCursor& c) {
    Parameter value;
    value.name = c.string("the type");
    value.floats = c.numbers(4, "one, min, max and dither");
    if (value.name == "rgb") value.name = "rgba";  // as scenes in the world write it
    if (!(value.floats[1] <= value.floats[2]))
        throw RequestError{
            fmt::format("its least value, {}, is above its largest, {}", value.floats[1], value.floats[2]),
            {}};
    r.state.scope().quantized.try_emplace(value.name, r.report.at());
    value.declaration.array_length = 4;
    changeable_options(r).quantize.set(std::move(value));
}

/// PRMan's own background has a color and an alpha, which no parameter of a shader can be called.
void rename_background(ParameterList& parameters) {
    for (Parameter& parameter : parameters.values) {
        if (parameter.name == "color") parameter.name = "bgcolor";
        if (parameter.name == "alpha") parameter.name = "bgalpha";
    }
}

/// Imager name parameters: a shader of pixels, after the surfaces'. Glow takes no other's place.
void imager(OptionContext& r, ArgumentCursor& c) {
    auto instance = std::make_shared<ShaderInstance>(r.shader(c, "imager"));
    instance->parameters = r.shader_parameters(c);
    if (instance->name == "background") rename_background(instance->parameters);
    Options& o = changeable_options(r);
    if (instance->name == "glow")
        o.glow = std::move(instance);
    else if (instance->name.empty() || instance->name == "null")
        o.imager = nullptr, o.glow = nullptr;
    else
        o.imager = std::move(instance);
}

/// Hider type parameters: the samples of a path tracer's count where PixelSamples has not been given. What it
/// is called does not choose a method of visibility: that is the command line's, as hiders of other renderers
/// have names of their own. What they find is the same; others', RISpec's painter among them, is not.
void hider(OptionContext& r, ArgumentCursor& c) {
    Options& o = changeable_options(r);
    o.hider = c.string("the hider's name");
    constexpr std::string_view kAlike[] = {"hidden", "raytrace", "stochastic", "zbuffer"};
    if (std::ranges::find(kAlike, o.hider) == std::end(kAlike))
        r.report.warn_once(
            "there is no hider " + in_quotes(o.hider) + "; what is nearest is seen, as by \"hidden\"",
            "hider-" + o.hider);
    o.hider_parameters = r.parameters(c, Undeclared::Guess);
    for (const Parameter& value : o.hider_parameters.values)
        if (!recognises_hider_parameter(value.name))
            r.report.count_without_effect(' ' + in_quotes(value.name));
    check_aperture(r, o.hider_parameters);
    check_layer_limit(r, o.hider_parameters);
    set_samples_of_hider(r);
}

/// Whether a value is a string, which is said where it is not.
bool is_text(RequestReport& report, const Parameter& value) {
    if (!value.strings.empty()) return true;
    report.error(in_quotes(value.name) + " of \"ocio\" is a string; left out");
    return false;
}

/// Option "trace" "maxdepth": bounces of rays.
int ray_depth(RequestReport& report, float given) {
    const auto depth = static_cast<int>(std::clamp(given, 0.0f, kMostRayDepth));
    if (given > kMostRayDepth)
        report.warn_once("\"maxdepth\" of rays is at most " + std::to_string(depth) + ", which is taken",
                         "ray-depth");
    return depth;
}

/// Option category parameters: kept for shaders too, like attributes; a colour transfer that is not known is
/// not kept.
void option(OptionContext& r, ArgumentCursor& c) {
    Options& o = changeable_options(r);
    const std::string category = c.string("the category");
    const ParameterList values = r.parameters(c, Undeclared::Guess);
    if (category == "ocio") o.colors_location = r.report.at();
    for (const Parameter& value : values.values) {
        if (category == "searchpath" && !value.strings.empty())
            r.search.set_search_path(value.name, value.strings[0]);
        if (category == "color" && value.name == "transfer" && !names_transfer(r.report, value)) continue;
        if (category == "ocio" && !is_text(r.report, value)) continue;
        const bool is_executed = category == "Ri" && execute_ri_value(r, value);
        if (!is_executed && !recognises_option(category, value.name))
            r.report.count_without_effect(' ' + in_quotes(category) + ' ' + in_quotes(value.name));
        if (category == "trace" && value.name == "maxdepth" && !value.floats.empty())
            o.max_ray_depth = ray_depth(r.report, value.floats[0]);
        if (category == "trace" && value.name == "levels" && !value.floats.empty())
            o.ray_levels = static_cast<int>(std::clamp(value.floats[0], 0.0f, float{kMostRayLevels}));
        o.user.set(category, value);
    }
}

/// RelativeDetail factor: areas of Detail are multiplied by it.
void relative_detail(OptionContext& r, ArgumentCursor& c) {
    const float factor = c.number("the factor");
    require(factor >= 0, "the factor must not be negative");
    changeable_options(r);
    r.state.scope().relative_detail = factor;
}

/// PixelVariance v: what adaptive sampling is to reach, where the hider or the command line asks for that.
void pixel_variance(OptionContext& r, ArgumentCursor& c) {
    const float variance = c.number("the variance");
    require(variance >= 0, "is below 0");
    changeable_options(r).pixel_variance = variance;
}

/// RISpec 4.1.1: the half space on the side to which the normal points is cut away.
void clipping_plane(OptionContext& r, ArgumentCursor& c) {
    const auto v = c.numbers(6, "the plane");
    const ReadPlane plane{r.state.current().transform, V3d(v[0], v[1], v[2]), V3d(v[3], v[4], v[5])};
    require(plane.normal.length() > 0, "the normal is 0");
    changeable_options(r);
    ClippingPlane::Key key;
    require(plane.at(r.state.options().shutter_open, key), "the space is singular");
    r.state.scope().clipping_planes.push_back(plane);
}

/// RISpec 4.1.4. The matrix back from RGB is for displays of samples, which nobody makes.
void color_samples(OptionContext& r, ArgumentCursor& c) {
    ColorSamples samples{0, c.number_array("the matrix to RGB")};
    const std::vector<float> back = c.number_array("the matrix from RGB");
    samples.samples = samples.rgb_from_samples.size() / 3;
    require(samples.samples > 0 && samples.samples <= kMostColorSamples &&
                samples.rgb_from_samples.size() % 3 == 0 && back.size() == samples.rgb_from_samples.size(),
            "needs two matrices, of 3 numbers for each of at most 1000 samples");
    changeable_options(r);
    r.state.scope().color_samples = std::move(samples);
}

/// Options that wait in a motion block are carried out at its end, as attributes are (RequestGroup).
constexpr RequestRow kOptionRequests[] = {
    {"Format", format},
    {"FrameAspectRatio", frame_aspect_ratio},
    {"ScreenWindow", screen_window},
    {"CropWindow", crop_window},
    {"Projection", projection},
    {"Clipping", clipping},
    {"DepthOfField", depth_of_field},
    {"Shutter", shutter},
    {"PixelSamples", pixel_samples},
    {"PixelFilter", pixel_filter},
    {"PixelVariance", pixel_variance},
    {"Exposure", exposure},
    {"Quantize", quantize},
    {"Imager", imager},
    {"Hider", hider},
    {"Option", option},
    {"RelativeDetail", relative_detail},
    {"ClippingPlane", clipping_plane},
    {"ColorSamples", color_samples},
};

}  // namespace

/// RISpec fixes options at WorldBegin. Files that set some just after it mean this world; an archive that is
/// read within a world was a whole scene, and must not change the picture around it.
Options& changeable_options(OptionContext& context) {
    if (context.state.in_world()) {
        if (context.files.are_below_world()) throw RequestError{"options cannot change inside a world", {}};
        context.report.warn_once("an option, which belongs before WorldBegin; it is taken for this world",
                                 "option-in-world");
    }
    return context.state.options();
}

std::span<const RequestRow> option_requests() {
    return kOptionRequests;
}

}  // namespace trapeze::rib
