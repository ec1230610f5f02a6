#include "composite/displays/display_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "composite/displays/compressions.h"
#include "composite/displays/exr_attributes.h"
#include "composite/displays/pixel_types.h"
#include "composite/displays/small_letters.h"
#include "core/scene/deep_pictures.h"
#include "core/scene/light_groups.h"

namespace trapeze {
namespace {

/// In small letters: names of drivers and extensions are compared without regard to case.
struct NamedFormat {
    std::string_view name;
    FileFormat format;
};

// The first of a format is the one that a display without a name gets.
constexpr NamedFormat kExtensions[] = {{".exr", FileFormat::OpenExr}, {".tif", FileFormat::Tiff},
                                       {".tiff", FileFormat::Tiff},   {".png", FileFormat::Png},
                                       {".jpg", FileFormat::Jpeg},    {".jpeg", FileFormat::Jpeg},
                                       {".tga", FileFormat::Targa},   {".bmp", FileFormat::Bmp}};
constexpr NamedFormat kDrivers[] = {{"openexr", FileFormat::OpenExr}, {"exr", FileFormat::OpenExr},
                                    {"deepexr", FileFormat::OpenExr}, {"tiff", FileFormat::Tiff},
                                    {"png", FileFormat::Png},         {"jpeg", FileFormat::Jpeg},
                                    {"targa", FileFormat::Targa},     {"bmp", FileFormat::Bmp}};
// "exrheader_NAME" of a Display becomes the attribute NAME of its OpenEXR file.
constexpr std::string_view kAttributePrefix = "exrheader_";
// Drivers of other renderers that open a window, which this program does not.
constexpr std::string_view kWindowDrivers[] = {
    "framebuffer", "it",    "x11",     "windows", "idisplay", "piqsl",     "houdini",
    "rgl",         "mplay", "xwindow", "window",  "agshow",   "i-display", "zframebuffer"};

template <class Table>
std::optional<FileFormat> look_up(const Table& table, std::string_view name) {
    for (const NamedFormat& row : table)
        if (row.name == name) return row.format;
    return {};
}

std::optional<FileFormat> format_by_extension(const std::string& file) {
    return look_up(kExtensions, in_small_letters(std::filesystem::path(file).extension().string()));
}

/// Whether the driver would open a window, which this program does not.
bool opens_window(const Display& display) {
    return std::find(std::begin(kWindowDrivers), std::end(kWindowDrivers), in_small_letters(display.type)) !=
           std::end(kWindowDrivers);
}

/// Whether two displays show the same of the picture, whether with alpha or without.
bool show_the_same(const Display& a, const Display& b) {
    const auto without_alpha = [](const Display& display) {
        const std::string mode = in_small_letters(display.mode.empty() ? "rgba" : display.mode);
        return mode.starts_with("rgba") ? mode.substr(0, 3) + mode.substr(4) : mode;
    };
    return without_alpha(a) == without_alpha(b);
}

/// The file beside a window, of the same name or of the same picture, as many scenes have it: the window is
/// to be looked at, not to be kept. Null: none.
const Display* file_beside_window(const Display& display, const Options& options) {
    if (!opens_window(display)) return nullptr;
    const auto found =
        std::find_if(options.displays.begin(), options.displays.end(), [&](const Display& other) {
            return (other.name == display.name || show_the_same(other, display)) && !opens_window(other) &&
                   !other.has_driver("null");
        });
    return found == options.displays.end() ? nullptr : &*found;
}

/// The file of a display without a name.
std::string usual_path(const DisplayPlan& plan) {
    const auto row = std::find_if(std::begin(kExtensions), std::end(kExtensions),
                                  [&](const NamedFormat& named) { return named.format == plan.format; });
    return "untitled" + std::string(plan.depth_map ? ".z" : row->name);
}

/// Chooses format and path by driver and extension. False for driver "null".
bool choose_format(const Display& display, Diagnostics& diagnostics, DisplayPlan& plan) {
    const std::string driver = in_small_letters(display.type);
    if (driver == "null") return false;
    plan.path = display.name;
    plan.depth_map = makes_depth_map(display);
    plan.deep = is_deep(display);
    const auto by_driver = plan.depth_map ? std::optional(FileFormat::Tiff) : look_up(kDrivers, driver);
    const auto by_extension = format_by_extension(display.name);
    plan.format = by_driver.value_or(by_extension.value_or(FileFormat::OpenExr));
    if (plan.path.empty()) plan.path = usual_path(plan);
    if (by_driver) return true;
    if (opens_window(display)) {
        if (!by_extension && !display.name.empty()) plan.path += ".exr";
        diagnostics.warning(
            display.location,
            fmt::format("Display \"{}\": no window is opened; \"{}\" is written instead", driver, plan.path),
            "display-window " + plan.path);
    } else if (driver != "file" && !driver.empty()) {
        diagnostics.warning(
            display.location,
            fmt::format("Display driver \"{}\" is not known; \"{}\" is written as {}", display.type,
                        plan.path, by_extension ? "its extension says" : "OpenEXR"),
            "display-driver " + plan.path);
    } else if (!by_extension) {
        diagnostics.note(display.location,
                         fmt::format("\"{}\" has no known extension; it is written as OpenEXR", plan.path),
                         "display-extension " + plan.path);
    }
    return true;
}

/// The name of a variable's layer. That of a group of lights is light_NAME, which programs can show that take
/// a colon for something else.
std::string layer_name(const Display& display, const Aov& aov) {
    if (!display.layer.empty() && display.layer != aov.name) return display.layer;
    if (!aov.name.starts_with(kLightGroupPrefix)) return aov.name;
    std::string name = "light_" + aov.name.substr(kLightGroupPrefix.size());
    const auto is_odd = [](unsigned char c) { return c < 128 && !std::isalnum(c); };
    std::replace_if(name.begin(), name.end(), is_odd, '_');
    return name;
}

/// The variable that the mode names.
bool choose_variable(const Display& display, const AovLayout& layout, Diagnostics& diagnostics,
                     DisplayPlan& plan) {
    plan.rgb = plan.alpha = false;
    if (const Aov* aov = layout.find(*display.variable)) {
        plan.aov = *aov;
        plan.aov_is_color = display.variable->type == ValueType::Color;
        plan.layer = layer_name(display, *aov);
        return true;
    }
    diagnostics.warning(
        display.location,
        fmt::format("displays ask for more than {} channels of variables; \"{}\" is not written",
                    kMostAovChannels, plan.path),
        "display-variables " + plan.path);
    return false;
}

/// What only OpenEXR files hold.
bool needs_open_exr(const Display& display, Diagnostics& diagnostics, const DisplayPlan& plan) {
    if (plan.format == FileFormat::OpenExr) return true;
    diagnostics.warning(
        display.location,
        fmt::format("mode \"{}\" needs OpenEXR; \"{}\" is not written", display.mode, plan.path),
        "display-mode-format " + plan.path);
    return false;
}

/// A deep picture has colour, alpha and the depths of its samples, whatever the mode says of z.
bool choose_deep_channels(const Display& display, Diagnostics& diagnostics, DisplayPlan& plan) {
    const std::string_view mode = display.mode;
    plan.rgb = plan.alpha = plan.depth = true;
    if (mode.empty() || mode == "rgb" || mode == "rgba" || mode == "rgbaz" || mode == "rgbz") return true;
    plan.rgb = false;
    if (mode == "a" || mode == "az") return true;
    diagnostics.warning(
        display.location,
        fmt::format("deep pictures are of colour and alpha; \"{}\" is not written", plan.path),
        "display-deep " + plan.path);
    return false;
}

/// rgb, a and z in this order, each or not; or "id"; or a layer of Cryptomatte.
bool choose_channels(const Display& display, Diagnostics& diagnostics, DisplayPlan& plan) {
    if (plan.deep) return choose_deep_channels(display, diagnostics, plan);
    plan.matte = matte_layer_named(display.mode);
    if (plan.matte) {
        plan.rgb = plan.alpha = false;
        return needs_open_exr(display, diagnostics, plan);
    }
    const bool depth = plan.depth_map || (display.variable && is_depth(*display.variable));
    std::string_view mode = depth ? "z" : std::string_view(display.mode);
    const auto take = [&](std::string_view channels) {
        if (!mode.starts_with(channels)) return false;
        mode.remove_prefix(channels.size());
        return true;
    };
    if (mode.empty()) mode = "rgba";
    plan.id = take("id");
    plan.rgb = !plan.id && take("rgb");
    plan.alpha = !plan.id && take("a");
    plan.depth = !plan.id && take("z");
    if (!mode.empty()) {
        diagnostics.warning(display.location,
                            fmt::format("Display mode \"{}\" is not supported; it is left out of \"{}\"",
                                        display.mode, plan.path),
                            "display-mode " + plan.path);
        return false;
    }
    if (plan.format == FileFormat::OpenExr) return true;
    const bool depth_fits = !plan.depth || (plan.format == FileFormat::Tiff && !plan.rgb && !plan.alpha);
    if (plan.id || (!depth_fits && !plan.rgb && !plan.alpha))
        return needs_open_exr(display, diagnostics, plan);
    if (!depth_fits) {
        plan.depth = false;
        diagnostics.warning(display.location, fmt::format("\"{}\" cannot hold z; it is left out", plan.path),
                            "display-z-format " + plan.path);
    }
    return true;
}

/// "exrcompression" is OpenEXR's alone and comes before "compression". Empty: what the format usually has.
void choose_compression(const Display& display, Diagnostics& diagnostics, DisplayPlan& plan) {
    const Parameter* asked = display.parameters.find("exrcompression");
    if (plan.format != FileFormat::OpenExr || !asked || asked->strings.empty())
        asked = display.parameters.find("compression");
    if (!asked || asked->strings.empty()) return;
    const std::string& name = asked->strings.front();
    const auto compression = compression_named(plan.format, in_small_letters(name));
    if (compression && plan.deep && !holds_deep(*compression)) {
        diagnostics.warning(
            display.location,
            fmt::format("\"{}\" is deep, which \"{}\" does not compress: none, rle and zips do; zips is "
                        "used",
                        plan.path, name),
            "display-compression " + name + ' ' + plan.path);
        return;
    }
    if (compression) {
        plan.compression = *compression;
        return;
    }
    diagnostics.warning(
        display.location,
        fmt::format("\"{}\" is no compression of \"{}\", whose format has {}; the usual one is used", name,
                    plan.path, compression_names(plan.format)),
        "display-compression " + name + ' ' + plan.path);
}

/// "string storage" "tiled", with "int tilesize" [64].
void choose_storage(const Display& display, Diagnostics& diagnostics, DisplayPlan& plan) {
    constexpr int kUsualTileSide = 64, kMostTileSide = 4096;
    const std::string storage = in_small_letters(display.parameters.string_or("storage", "scanline"));
    const bool is_tiled = storage == "tiled";
    if (!is_tiled && storage == "scanline") return;
    if (!is_tiled || plan.format != FileFormat::OpenExr) {
        diagnostics.warning(
            display.location,
            is_tiled ? fmt::format("only OpenEXR files are written in tiles; \"{}\" is in rows", plan.path)
                     : fmt::format("storage \"{}\" is neither tiled nor scanline; \"{}\" is in rows", storage,
                                   plan.path),
            "display-storage " + plan.path);
        return;
    }
    float side = display.parameters.float_or("tilesize", kUsualTileSide);
    if (!(side >= 1 && side <= kMostTileSide)) {
        diagnostics.warning(display.location,
                            fmt::format("tiles are 1 to {} pixels wide; those of \"{}\" are {}",
                                        kMostTileSide, plan.path, kUsualTileSide),
                            "display-tilesize " + plan.path);
        side = kUsualTileSide;
    }
    plan.tile_side = static_cast<int>(side);
}

/// "deeptolerance" (core/scene/deep_pictures.h).
void check_deep_tolerance(const Display& display, Diagnostics& diagnostics, const DisplayPlan& plan) {
    const float tolerance = display.parameters.float_or("deeptolerance", kUsualDeepTolerance);
    if (!plan.deep || (tolerance >= 0 && tolerance <= 1)) return;
    diagnostics.warning(display.location,
                        fmt::format("\"{}\": a deeptolerance of {} is not between 0 and 1; it is {}",
                                    plan.path, tolerance, tolerance > 1 ? 1 : 0),
                        "display-deeptolerance " + plan.path);
}

/// Attributes that the scene asks for; each that cannot be written is left out with a warning.
void take_attributes(const Display& display, Diagnostics& diagnostics, DisplayPlan& plan) {
    for (const Parameter& parameter : display.parameters.values) {
        if (!parameter.name.starts_with(kAttributePrefix)) continue;
        Parameter attribute = parameter;
        attribute.name.erase(0, kAttributePrefix.size());
        const std::string problem = plan.format == FileFormat::OpenExr
                                        ? problem_of_attribute(attribute)
                                        : fmt::format("needs OpenEXR, which \"{}\" is not", plan.path);
        if (problem.empty())
            plan.attributes.push_back(std::move(attribute));
        else
            diagnostics.warning(display.location,
                                fmt::format("\"{}\" {}; it is left out", parameter.name, problem),
                                "display-attribute " + parameter.name + ' ' + plan.path);
    }
}

}  // namespace

bool holds_depth(const std::string& file) {
    const FileFormat format = format_by_extension(file).value_or(FileFormat::OpenExr);
    return format == FileFormat::OpenExr || format == FileFormat::Tiff;
}

bool makes_depth_map(const Display& display) {
    return display.has_driver("zfile") || display.has_driver("shadow");
}

std::optional<FileFormat> file_format(const Display& display) {
    // plan_display() will say all that is to be said, once.
    Diagnostics unheard;
    DisplayPlan plan;
    return choose_format(display, unheard, plan) ? std::optional(plan.format) : std::nullopt;
}

void rename(Display& display, std::string name) {
    const auto before = file_format(display);
    const bool was_deep = is_deep(display);
    display.name = std::move(name), display.type = "file";
    if (was_deep && file_format(display) == FileFormat::OpenExr) display.type = "deepexr";
    // Another format has other compressions, and perhaps no attributes.
    if (file_format(display) == before) return;
    std::erase_if(display.parameters.values, [](const Parameter& parameter) {
        return parameter.name == "compression" || parameter.name == "exrcompression" ||
               parameter.name.starts_with(kAttributePrefix);
    });
}

bool asks_for_whole_numbers(const Display& display, const Options& options) {
    const auto format = file_format(display);
    if (!format) return false;
    if (const Parameter* own = own_quantization(display)) return own->floats[0] != own->floats[1];
    if (const Parameter* given = given_quantization(options, "rgba")) return given->floats[0] != 0;
    return *format != FileFormat::OpenExr && !opens_window(display);
}

bool holds_more_than_halves(const Options& options) {
    const AovLayout layout = aov_layout(options);
    return std::any_of(options.displays.begin(), options.displays.end(), [&](const Display& display) {
        Diagnostics unheard;  // what is to be said is said where the display is written
        const auto plan = plan_display(display, options, layout, unheard);
        return plan && (plan->rgb || plan->alpha) &&
               (plan->format != FileFormat::OpenExr || plan->float_pixels);
    });
}

std::vector<std::string> channel_names(const DisplayPlan& plan, bool is_layer) {
    std::vector<std::string> names;
    if (plan.rgb) names = {"R", "G", "B"};
    if (plan.alpha) names.emplace_back("A");
    if (plan.depth) names.emplace_back("Z");
    if (plan.id) names.emplace_back(is_layer ? "id.Y" : "id");
    if (plan.matte)
        for (int i = 0; i < kMatteFloats; ++i)
            names.push_back(fmt::format("{}{:02}.{}", matte_layer_name(*plan.matte), i / 4, "RGBA"[i % 4]));
    if (!plan.aov) return names;
    const bool is_vector = plan.aov->channels == 3 && !plan.aov_is_color;
    const std::string prefix = is_layer || is_vector ? (is_layer ? plan.layer : plan.aov->name) + '.' : "";
    for (const char letter : std::string_view(plan.aov->channels == 1 ? "Y" : is_vector ? "XYZ" : "RGB"))
        names.push_back(prefix + letter);
    return names;
}

std::optional<DisplayPlan> plan_display(const Display& display, const Options& options,
                                        const AovLayout& layout, Diagnostics& diagnostics) {
    DisplayPlan plan;
    if (const Display* file = file_beside_window(display, options)) {
        const std::string which = display.name.empty() ? "" : fmt::format(" of \"{}\"", display.name);
        diagnostics.warning(display.location,
                            fmt::format("Display{}: no window (\"{}\") is opened; see \"{}\"", which,
                                        in_small_letters(display.type), file->name),
                            fmt::format("display-window {} beside {}", display.name, file->name));
        return {};
    }
    if (!choose_format(display, diagnostics, plan)) return {};
    const bool variable = display.variable && !is_depth(*display.variable) && !plan.depth_map && !plan.deep;
    if (!(variable ? choose_variable(display, layout, diagnostics, plan)
                   : choose_channels(display, diagnostics, plan)))
        return {};
    choose_pixel_type(display, options, diagnostics, plan);
    choose_compression(display, diagnostics, plan);
    choose_storage(display, diagnostics, plan);
    check_deep_tolerance(display, diagnostics, plan);
    take_attributes(display, diagnostics, plan);
    return plan;
}

}  // namespace trapeze
