#include "pipeline/cli/commands/world_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "composite/displays/display_plan.h"
#include "core/colors/transfer.h"
#include "core/scene/adaptive_sampling.h"
#include "core/scene/light_groups.h"
#include "pipeline/cli/support/named_aovs.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

/// A pass that makes a depth map for the worlds after it. What the command line says of the picture is not
/// for it.
bool is_shadow_pass(const Options& options) {
    return !options.displays.empty() && makes_depth_map(options.displays.front());
}

/// Displays that share an OpenEXR file with the first stay with it, where it is still one.
void rename_layers(const Display& before, const Display& now, std::vector<Display>& displays) {
    if (file_format(before) != FileFormat::OpenExr || file_format(now) != FileFormat::OpenExr) return;
    for (Display& other : displays)
        if (&other != &now && other.name == before.name && file_format(other) == FileFormat::OpenExr)
            rename(other, now.name);
}

}  // namespace

WorldOutputs::WorldOutputs(const Arguments& arguments, Access& access, Diagnostics& diagnostics)
    : arguments_(arguments),
      tile_(arguments.tile()),
      access_(access),
      diagnostics_(diagnostics),
      kept_(diagnostics),
      names_(arguments.output) {}

bool WorldOutputs::prepare(Scene& scene) {
    renamed_.reset();
    passes_.write_last();
    const bool is_tile = makes_tile(scene.options);
    if (!arguments_.transfer.empty()) set_transfer(scene.options, arguments_.transfer);
    if (is_shadow_pass(scene.options)) {
        show_shadow_pass(scene.options);
    } else {
        override_options(scene.options);
        override_displays(scene, is_tile);
    }
    return is_tile;
}

/// Writes a pass as `-o` says: the next picture takes its place; where none comes, what the light sees is
/// what there is to see.
void WorldOutputs::show_shadow_pass(Options& options) {
    if (names_.empty() || names_.is_taken(options.frame) || !arguments_.driver.empty() || tile_) return;
    Display picture{with_frame_number(arguments_.output, options.frame), "file", "rgba", {}, {}};
    encode_for_viewing(picture, options);
    access_.allow_writing(picture.name);
    kept_.forget(picture.name);
    options.displays.push_back(std::move(picture));
}

/// Puts the command line's values in place of the scene's options.
void WorldOutputs::override_options(Options& options) const {
    if (arguments_.resolution) std::tie(options.width, options.height) = *arguments_.resolution;
    if (arguments_.crop) options.crop_window = *arguments_.crop;
    if (arguments_.samples) {
        const auto& [least, most] = *arguments_.samples;
        options.samples_x = static_cast<float>(most.first);
        options.samples_y = static_cast<float>(most.second);
        options.adaptive = least.has_value();
        if (least) options.least_samples = static_cast<float>(std::min(least->first, least->second));
    }
    if (arguments_.variance) options.pixel_variance = *arguments_.variance, options.adaptive = true;
    if (arguments_.samples && arguments_.samples->least && !(options.pixel_variance > 0))
        diagnostics_.warning({},
                             "nothing says which variance pixels are to have: --variance does, and "
                             "PixelVariance of the scene; they all have MAX samples",
                             "no-variance");
    if (arguments_.variance && !adaptive_sampling(options).is_on())
        diagnostics_.warning({}, "adaptive sampling takes at least 3x3 samples; all pixels have all",
                             "too-few-samples");
    if (arguments_.most_layers > 0)
        options.hider_parameters.set({"maxvpdepth",
                                      {StorageClass::Uniform, ValueType::Integer, 1},
                                      {static_cast<float>(arguments_.most_layers)},
                                      {}});
}

/// What the scene would keep in floats, and the command line wants as a file of 8 bits, is to be looked at:
/// by the curve of screens, where nobody says how. Whether it is.
bool WorldOutputs::encode_for_viewing(Display& display, const Options& options) const {
    const bool is_said = options.user.find("color", "transfer");
    const bool is_managed = replaced(color_request_of(options), arguments_.colors).asks();
    if (is_said || is_managed || display.parameters.find("colorspace")) return false;
    display.parameters.set({"colorspace", {StorageClass::Uniform, ValueType::String, 1}, {}, {"auto"}});
    Diagnostics unheard;
    const auto plan = plan_display(display, options, aov_layout(options), unheard);
    if (!plan || !plan->srgb) return false;
    diagnostics_.note({},
                      "\"" + display.name +
                          "\" is for viewing: its colours are encoded by the sRGB curve (--transfer linear "
                          "writes the scene's numbers)",
                      "encoded for viewing");
    return true;
}

/// The first display's file, as `-o` has it.
void WorldOutputs::name_output(Scene& scene) {
    Display& first = scene.options.displays.front();
    const bool for_viewing = arguments_.driver.empty() && !asks_for_whole_numbers(first, scene.options);
    renamed_ = first;
    const std::string name = names_.take(first.name, scene.options.frame);
    rename(first, tile_ ? with_tile_number(name, *tile_) : name);
    rename_layers(*renamed_, first, scene.options.displays);
    if (first.mode == "z" && !holds_depth(first.name)) first.mode = "rgba";
    access_.allow_writing(first.name);
    kept_.forget(first.name);
    encoded_.erase(first.name);
    if (for_viewing && encode_for_viewing(first, scene.options)) encoded_.insert(first.name);
}

/// Whether the first display, which `-o` has renamed, has other values in its file than its own would have.
bool WorldOutputs::has_another_form(const Display& display) const {
    const auto own = file_format(*renamed_);
    return arguments_.driver.empty() && own &&
           (own != file_format(display) || renamed_->mode != display.mode || encoded_.contains(display.name));
}

/// Whether a tile alone is made of a world, with options as the scene has them: those that maps are made of
/// are rendered whole.
bool WorldOutputs::makes_tile(const Options& options) const {
    if (!tile_ || options.displays.empty()) return tile_.has_value();
    return !is_shadow_pass(options) && !map_pictures_.contains(options.displays.front().name);
}

/// Gives the tile's files their names. Depth maps are whole or of no use.
void WorldOutputs::name_tile(Options& options) {
    for (Display& display : options.displays) {
        // -o has named the first display's file, which others may share.
        const bool is_named = !names_.empty() && display.name == options.displays.front().name;
        tiles_made_.insert(is_named && renamed_ ? renamed_->name : display.name);
        if (makes_depth_map(display)) {
            diagnostics_.warning(display.location,
                                 "depth map \"" + display.name +
                                     "\" is not written, for it would be of a tile alone; a run without "
                                     "--tiles writes it",
                                 "depth-map-in-tile " + display.name);
            display.type = "null";
        } else if (!is_named) {
            Diagnostics unheard;
            const auto plan = plan_display(display, options, aov_layout(options), unheard);
            // A display without a name has one in its plan.
            const std::string& name = display.name.empty() && plan ? plan->path : display.name;
            display.name = with_tile_number(name, *tile_);
        }
    }
}

/// Whether the picture has the tile that is to be made; if not, an error says so.
bool WorldOutputs::has_tile(const Scene& scene) {
    const PixelRect crop = make_camera(scene.options).crop;
    if (crop.empty() || can_divide(crop, *tile_)) return true;
    diagnostics_.error({}, fmt::format("--tiles: {}x{} pixels can be divided into {}x{} tiles at most, not "
                                       "into {}x{}",
                                       crop.width(), crop.height(), crop.width(), crop.height(),
                                       tile_->columns, tile_->rows));
    return false;
}

/// Adds the layers of --aov.
void WorldOutputs::add_asked_aovs(Scene& scene) {
    std::vector<Display>& displays = scene.options.displays;
    std::string known_good;
    const std::string file =
        add_aovs(displays_of_aovs(arguments_.aovs, &known_good), light_groups(scene), displays);
    if (file == displays.front().name) return;
    // Beside what the user names the user may write.
    if (renamed_) access_.allow_writing(file);
    kept_.forget(file);
    diagnostics_.note({},
                      fmt::format("\"{}\" holds no layers; --aov writes \"{}\"", displays.front().name, file),
                      "aov-beside " + file);
}

/// Puts -o, --driver and the default display in place of the scene's displays.
void WorldOutputs::override_displays(Scene& scene, bool is_tile) {
    std::vector<Display>& displays = scene.options.displays;
    if (displays.empty()) {
        // RISpec's default display is one picture of a fixed name; ours has the scene's. What shows nothing,
        // nowhere, is none where there is a picture.
        const std::string& input = arguments_.inputs.front();
        const std::string stem = input == "-" ? "stdin" : fs::path(input).stem().string();
        const bool is_none = scene.primitives.empty() && names_.is_taken(scene.options.frame);
        displays.push_back({stem + ".exr", is_none ? "null" : "file", "rgba", {}, {}});
        if (is_none) return;
    }
    if (!names_.empty() && is_tile == tile_.has_value()) name_output(scene);
    if (!arguments_.driver.empty())
        for (Display& display : displays) display.type = arguments_.driver;
    if (!arguments_.aovs.empty()) add_asked_aovs(scene);
    if (is_tile) name_tile(scene.options);
}

void WorldOutputs::wrote(const std::vector<std::string>& files, bool shows_something) {
    if (renamed_ && !shows_something && !tile_) names_.take_back(renamed_->name);
    for (const std::string& file : files)
        if (!renamed_ || file != renamed_->name) passes_.forget(file), names_.forget(file);
}

std::optional<std::string> WorldOutputs::pass_of(const Scene& scene) const {
    if (!renamed_ || !has_another_form(scene.options.displays.front())) return {};
    return renamed_->name;
}

void WorldOutputs::keep_pass(const RenderContext& context, Image image) {
    passes_.keep(*renamed_, context, std::move(image));
}

/// A picture that a map is made of was a pass, whatever `-o` has made of it: it is read as its own Display
/// has it, or else under the name that `-o` gave it, which the next picture takes.
bool WorldOutputs::find_pictures(MapRequest& request, Access& access) {
    for (std::string& picture : request.pictures) {
        if (tiles_made_.contains(picture)) {
            diagnostics_.error(
                request.location,
                fmt::format("cannot make \"{}\": of \"{}\" there is only a tile", request.map, picture));
            return false;
        }
        const auto own = passes_.file_of(picture);
        picture = names_.take_back(picture).value_or(picture);
        kept_.forget(picture);
        if (own) {
            picture = *own;
            // Nobody else can read it: it is gone with the run.
            access.record_reads({});
        } else if (encoded_.contains(picture)) {
            request.colorspace = Transfer::Srgb;
        }
    }
    passes_.allow_reading(access);
    return true;
}

}  // namespace trapeze
