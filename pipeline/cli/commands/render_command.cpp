#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "composite/displays/display_plan.h"
#include "core/scene/adaptive_sampling.h"
#include "core/scene/light_groups.h"
#include "core/scene/transfer.h"
#include "pipeline/cli/commands/commands.h"
#include "pipeline/cli/commands/pictures_of_maps.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/interrupt.h"
#include "pipeline/cli/support/named_aovs.h"
#include "pipeline/cli/support/on_threads.h"
#include "pipeline/cli/support/output_names.h"
#include "pipeline/cli/support/pass_pictures.h"
#include "pipeline/cli/support/read_settings.h"
#include "pipeline/cli/support/stats_json.h"
#include "pipeline/cli/support/text_files.h"
#include "pipeline/frame/make_map.h"
#include "pipeline/frame/open_colors.h"
#include "pipeline/frame/render_frame.h"
#include "pipeline/frame/stopwatch.h"
#include "pipeline/frame/write_frame.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

bool has_missing_shader(const Diagnostics& diagnostics) {
    const auto kinds = diagnostics.kinds();
    return std::any_of(kinds.begin(), kinds.end(),
                       [](const auto& kind) { return kind.first.starts_with("missing-shader"); });
}

/// A pass that makes a depth map for the worlds after it. What the command line says of the picture is not
/// for it.
bool is_shadow_pass(const Options& options) {
    return !options.displays.empty() && makes_depth_map(options.displays.front());
}

/// The files that sources of messages are: scenes, archives, shaders.
std::vector<std::string> files_read(const Diagnostics& diagnostics) {
    std::set<std::string> files;
    std::error_code ignored;
    std::string name;
    for (uint32_t source = 1; !(name = diagnostics.source_name(source)).empty(); ++source)
        if (fs::exists(name, ignored)) files.insert(std::move(name));
    return {files.begin(), files.end()};
}

/// Renders the worlds of the input as they are read.
class RenderJob {
  public:
    RenderJob(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics)
        : arguments_(arguments),
          terminal_(terminal),
          diagnostics_(diagnostics),
          access_(scene_access(arguments)),
          interrupt_(arguments.time_limit),
          kept_(diagnostics),
          names_(arguments.output) {}

    int run();

  private:
    void render_world(Scene&& scene);
    void override_options(Options& options) const;
    void override_displays(Scene& scene, bool is_tile);
    RenderSettings settings_of_world(bool is_tile);
    void name_output(Scene& scene);
    void add_asked_aovs(Scene& scene);
    bool makes_tile(const Options& options) const;
    void name_tile(Options& options);
    bool has_tile(const Scene& scene);
    bool has_another_form(const Display& display) const;
    void say_what_is_written(const FrameStats& stats);
    bool encode_for_viewing(Display& display, const Options& options) const;
    void make_map_of_pictures(MapRequest request);
    bool outputs_are_possible() const;
    bool colors_are_possible() const;
    bool write_stats() const;
    int exit_code() const;

    const Arguments& arguments_;
    const std::optional<PictureTile> tile_ = arguments_.tile();
    Terminal& terminal_;
    Diagnostics& diagnostics_;
    Access access_;
    Interrupt interrupt_;
    double render_seconds_ = 0, last_read_seconds_ = 0;
    Stopwatch total_;
    std::vector<FrameStats> frames_;
    std::vector<FrameStats::Output> maps_;
    int worlds_ = 0;
    KeptPictures kept_;
    OutputNames names_;
    PassPictures passes_;
    std::optional<Display> renamed_;  ///< the world's first display, as the scene has it, if `-o` renames it
    std::set<std::string> encoded_;   ///< by the sRGB curve for viewing: files that `-o` names
    std::set<std::string> map_pictures_;  ///< of which the input makes maps, if a tile is to be made
    std::set<std::string> tiles_made_;  ///< pictures, as the scene calls them, of which only a tile is there
    bool output_failed_ = false;
};

/// Puts the command line's values in place of the scene's options.
void RenderJob::override_options(Options& options) const {
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
bool RenderJob::encode_for_viewing(Display& display, const Options& options) const {
    const auto color = options.user.find("color");
    const bool is_said = color != options.user.end() && color->second.find("transfer");
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

/// Displays that share an OpenEXR file with the first stay with it, where it is still one.
void rename_layers(const Display& before, const Display& now, std::vector<Display>& displays) {
    if (file_format(before) != FileFormat::OpenExr || file_format(now) != FileFormat::OpenExr) return;
    for (Display& other : displays)
        if (&other != &now && other.name == before.name && file_format(other) == FileFormat::OpenExr)
            rename(other, now.name);
}

/// The first display's file, as `-o` has it.
void RenderJob::name_output(Scene& scene) {
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
bool RenderJob::has_another_form(const Display& display) const {
    const auto own = file_format(*renamed_);
    return arguments_.driver.empty() && own &&
           (own != file_format(display) || renamed_->mode != display.mode || encoded_.contains(display.name));
}

/// Whether a tile alone is made of a world, with options as the scene has them: those that maps are made of
/// are rendered whole.
bool RenderJob::makes_tile(const Options& options) const {
    if (!tile_ || options.displays.empty()) return tile_.has_value();
    return !is_shadow_pass(options) && !map_pictures_.contains(options.displays.front().name);
}

/// Gives the tile's files their names. Depth maps are whole or of no use.
void RenderJob::name_tile(Options& options) {
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
bool RenderJob::has_tile(const Scene& scene) {
    const PixelRect crop = make_camera(scene.options).crop;
    if (crop.empty() || can_divide(crop, *tile_)) return true;
    diagnostics_.error({}, fmt::format("--tiles: {}x{} pixels can be divided into {}x{} tiles at most, not "
                                       "into {}x{}",
                                       crop.width(), crop.height(), crop.width(), crop.height(),
                                       tile_->columns, tile_->rows));
    return false;
}

/// Adds the layers of --aov.
void RenderJob::add_asked_aovs(Scene& scene) {
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
void RenderJob::override_displays(Scene& scene, bool is_tile) {
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

/// A picture that a map is made of was a pass, whatever `-o` has made of it: it is read as its own Display
/// has it, or else under the name that `-o` gave it, which the next picture takes.
void RenderJob::make_map_of_pictures(MapRequest request) {
    for (std::string& picture : request.pictures) {
        if (tiles_made_.contains(picture)) {
            diagnostics_.error(
                request.location,
                fmt::format("cannot make \"{}\": of \"{}\" there is only a tile", request.map, picture));
            return;
        }
        const auto own = passes_.file_of(picture);
        picture = names_.take_back(picture).value_or(picture);
        kept_.forget(picture);
        if (own)
            picture = *own;
        else if (encoded_.contains(picture))
            request.colorspace = Transfer::Srgb;
    }
    Access access = access_;
    passes_.allow_reading(access);
    if (const auto transfer = transfer_named(arguments_.transfer)) request.transfer = *transfer;
    Stopwatch watch;
    std::string map;
    if (!make_map(request, access, diagnostics_, &map)) output_failed_ = true;
    if (map.empty()) return;
    std::error_code unknown;
    const auto bytes = fs::file_size(map, unknown);
    maps_.push_back({map, unknown ? 0 : bytes, watch.lap()});
    terminal_.say_on_terminal(fmt::format("wrote {}, {:.1f} s", map, maps_.back().seconds));
}

void RenderJob::say_what_is_written(const FrameStats& stats) {
    for (const FrameStats::Output& file : stats.outputs)
        terminal_.say_on_terminal(fmt::format("wrote {}, {}x{}, {:.1f} s", file.path, stats.width,
                                              stats.height, stats.seconds.total));
}

RenderSettings RenderJob::settings_of_world(bool is_tile) {
    RenderSettings settings;
    if (is_tile) settings.tile = tile_;
    settings.sampler = arguments_.sampler;
    settings.pattern = arguments_.pattern;
    settings.memory_bytes = arguments_.memory_bytes;
    settings.regions_at_least = arguments_.regions_at_least;
    settings.seed = arguments_.seed;
    settings.colors = arguments_.colors;
    settings.cull_hidden = arguments_.cull_hidden == "on"    ? CullHidden::On
                           : arguments_.cull_hidden == "off" ? CullHidden::Off
                                                             : CullHidden::Auto;
    settings.cancelled = &interrupt_.requested();
    settings.access = &access_;
    settings.on_progress = [this](double fraction) { terminal_.progress(fraction); };
    settings.on_stage = [this](std::string_view name) { terminal_.stage(name); };
    return settings;
}

/// Renders one world and writes its pictures. Shadow passes keep the scene's own options and displays.
void RenderJob::render_world(Scene&& scene) {
    if (interrupt_.requested()) return;
    Stopwatch watch;
    const double read_seconds = total_.elapsed() - render_seconds_;
    ++worlds_;
    renamed_.reset();
    passes_.settle();
    const int frame = scene.options.frame;
    const bool is_tile = makes_tile(scene.options);
    if (!arguments_.transfer.empty()) set_transfer(scene.options, arguments_.transfer);
    if (!is_shadow_pass(scene.options)) {
        override_options(scene.options);
        override_displays(scene, is_tile);
    } else if (!names_.empty() && !names_.is_taken(frame) && arguments_.driver.empty() && !tile_) {
        // The next picture takes its place; where none comes, what the light sees is what there is to see.
        Display picture{with_frame_number(arguments_.output, frame), "file", "rgba", {}, {}};
        encode_for_viewing(picture, scene.options);
        access_.allow_writing(picture.name);
        kept_.forget(picture.name);
        scene.options.displays.push_back(std::move(picture));
    }

    if (is_tile && !has_tile(scene)) return;
    const RenderSettings settings = settings_of_world(is_tile);

    const std::string& picture = scene.options.displays.front().name;
    terminal_.begin_progress(picture, {picture, "tessellate", scene.options.frame});
    const RenderContext context = make_context(scene, settings, diagnostics_);
    std::optional<FrameResult> result = render_frame(context, settings);
    terminal_.end_progress();
    if (result) {
        FrameStats& stats = result->stats;
        if (!write_frame(*result, context, access_, arguments_.inputs, &kept_)) output_failed_ = true;
        stats.seconds.read = read_seconds - last_read_seconds_;
        stats.seconds.total += stats.seconds.read;
        last_read_seconds_ = read_seconds;
        if (renamed_ && !stats.shows_something && !tile_) names_.take_back(renamed_->name);
        for (const FrameStats::Output& file : stats.outputs)
            if (!renamed_ || file.path != renamed_->name) passes_.forget(file.path), names_.forget(file.path);
        if (renamed_ && has_another_form(scene.options.displays.front()))
            passes_.keep(*renamed_, context, std::move(result->image));
        say_what_is_written(stats);
        frames_.push_back(stats);
    }
    render_seconds_ += watch.lap();
}

bool RenderJob::write_stats() const {
    if (arguments_.stats_file.empty()) return true;
    const RunFacts facts{arguments_.words, files_read(diagnostics_), diagnostics_.count(Severity::Error),
                         diagnostics_.count(Severity::Warning), maps_};
    return write_text(arguments_.stats_file, stats_json(frames_, facts), terminal_, diagnostics_);
}

/// The exit code of the whole run: of the first of these reasons that applies.
int RenderJob::exit_code() const {
    if (interrupt_.requested()) return interrupt_.exit_code();
    if (output_failed_) return kExitNoOutput;
    if (diagnostics_.kinds().contains(kPictureTooLarge)) return kExitNoMemory;
    if (diagnostics_.kinds().contains(kNoColors)) return kExitNoInput;
    if (frames_.empty() && maps_.empty()) return kExitNothingRendered;
    if (arguments_.strict && has_missing_shader(diagnostics_)) return kExitShaderMissing;
    const bool warned = diagnostics_.count(Severity::Warning) > 0;
    return diagnostics_.count(Severity::Error) > 0 || (arguments_.strict && warned) ? kExitErrors : kExitOk;
}

/// Folders that scenes name are made where the pictures are written; one on the command line may be a
/// mistake, which is said before anything is rendered.
bool RenderJob::outputs_are_possible() const {
    const std::string& named = arguments_.output;
    const std::string output = tile_ && !named.empty() ? with_tile_number(named, *tile_) : named;
    // Its folder, too, may have the number.
    const bool is_of_a_frame = with_frame_number(named, 0) != named || named.find("<tile>") != named.npos;
    if (!may_write_report(arguments_.stats_file, access_, diagnostics_)) return false;
    const bool writes_output = arguments_.driver != "null" && !is_of_a_frame;
    return can_write({arguments_.stats_file, writes_output ? output : ""}, diagnostics_);
}

/// A config that the user names need not wait for the scene to be found wrong. Names in it may belong to what
/// the scene says: a view to its display.
bool RenderJob::colors_are_possible() const {
    ColorRequest request = arguments_.colors;
    if (request.config.empty()) return true;
    if (request.display.empty()) request.view.clear();
    return !open_colors({}, request, access_, diagnostics_).failed;
}

int RenderJob::run() {
    if (!outputs_are_possible()) return kExitNoOutput;
    if (!colors_are_possible()) return kExitNoInput;
    ReadOptions options = read_options(arguments_, access_);
    options.cancelled = &interrupt_.requested();
    options.on_wait = [this](const std::string& what, int seconds) {
        terminal_.wait("waiting for " + what + ", " + std::to_string(seconds) + " s");
    };
    options.shading_rate = arguments_.shading_rate;
    options.on_map = [this](const MapRequest& request) {
        if (!interrupt_.requested()) make_map_of_pictures(request);
    };
    terminal_.begin_progress(arguments_.inputs.front(), {arguments_.inputs.front(), "read", 0});
    if (tile_) map_pictures_ = pictures_of_maps(arguments_, interrupt_.requested());
    int worlds_read = 0;
    on_threads(arguments_.threads, [&] {
        worlds_read = read_rib(arguments_.inputs, options, diagnostics_, [&](Scene&& scene) {
                          render_world(std::move(scene));
                      }).worlds;
    });
    terminal_.end_progress();
    if (!interrupt_.requested()) {
        if (worlds_ == 0 && maps_.empty())
            diagnostics_.error({}, worlds_read
                                       ? "none of the frames asked for is in the input; nothing rendered"
                                       : "no WorldBegin block was found in the input; nothing rendered");
        if (!(frames_.empty() && maps_.empty()) && !write_stats()) output_failed_ = true;
    }
    return exit_code();
}

}  // namespace

int render_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    if (!inputs_exist(arguments.inputs, diagnostics)) return kExitNoInput;
    return RenderJob(arguments, terminal, diagnostics).run();
}

}  // namespace trapeze
