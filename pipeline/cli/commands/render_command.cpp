#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "core/colors/transfer.h"
#include "core/files/output_file.h"
#include "pipeline/cli/commands/commands.h"
#include "pipeline/cli/commands/pictures_of_maps.h"
#include "pipeline/cli/commands/run_checkpoint.h"
#include "pipeline/cli/commands/run_preview.h"
#include "pipeline/cli/commands/world_outputs.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/interrupt.h"
#include "pipeline/cli/support/missing_shaders.h"
#include "pipeline/cli/support/on_threads.h"
#include "pipeline/cli/support/read_settings.h"
#include "pipeline/cli/support/stats_json.h"
#include "pipeline/cli/support/text_files.h"
#include "pipeline/frame/cost/stopwatch.h"
#include "pipeline/frame/frame_memory.h"
#include "pipeline/frame/make_context.h"
#include "pipeline/frame/make_map.h"
#include "pipeline/frame/open_colors.h"
#include "pipeline/frame/render_frame.h"
#include "pipeline/frame/write_frame.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

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
          checkpoint_(checkpoint_of(arguments, reads_, diagnostics)),
          interrupt_(arguments.time_limit,
                     [this] {
                         if (checkpoint_) checkpoint_->save_at_end();
                     }),
          outputs_(arguments, access_, diagnostics) {
        if (checkpoint_) access_.record_reads(reads_);
        for (const auto* files : {&arguments.inputs, &arguments.plugins})
            for (const std::string& file : *files) reads_->add(file);
    }

    int run();

  private:
    int render();
    void render_world(Scene&& scene);
    bool was_rendered(size_t index);
    FinishedWorld make_pictures(const Scene& scene, bool is_tile, double read_seconds);
    bool ends_early() const { return interrupt_.requested() || (checkpoint_ && checkpoint_->refused()); }
    bool open_checkpoint();
    void close_checkpoint();
    RenderSettings settings_of_world(bool is_tile);
    void say_what_is_written(const FrameStats& stats);
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
    const std::shared_ptr<ReadNames> reads_ = std::make_shared<ReadNames>();
    const std::unique_ptr<Checkpoint> checkpoint_;  ///< null where none is asked for
    Interrupt interrupt_;
    double render_seconds_ = 0, last_read_seconds_ = 0;
    Stopwatch total_;
    std::vector<FrameStats> frames_;
    std::vector<FrameStats::Output> maps_;
    int worlds_ = 0, worlds_before_ = 0;  ///< that were rendered, of them, by an earlier run
    int map_requests_ = 0;
    WorldOutputs outputs_;
    std::unique_ptr<Preview> preview_;  ///< null where nobody watches
    bool output_failed_ = false;
};

void RenderJob::make_map_of_pictures(MapRequest request) {
    Access access = access_;
    const int index = map_requests_++;
    if (!outputs_.find_pictures(request, access) || (checkpoint_ && checkpoint_->has_made_map(index))) return;
    if (const auto transfer = transfer_named(arguments_.transfer)) request.transfer = *transfer;
    if (arguments_.resume) OutputFile::remove_leftovers(request.map);
    Stopwatch watch;
    std::string map;
    if (!make_map(request, access, diagnostics_, &map)) output_failed_ = true;
    if (map.empty()) return;
    if (checkpoint_) checkpoint_->finish_map(index, map);
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
    settings.keeper = checkpoint_.get();
    settings.watcher = preview_.get();
    settings.on_progress = [this](double fraction) {
        terminal_.progress(fraction);
        if (preview_) preview_->progress(fraction);
    };
    settings.on_stage = [this](std::string_view name) {
        terminal_.stage(name);
        if (preview_) preview_->begin_stage(name);
    };
    return settings;
}

/// Renders one world and writes its pictures. Shadow passes keep the scene's own options and displays.
void RenderJob::render_world(Scene&& scene) {
    if (ends_early()) return;
    Stopwatch watch;
    const double read_seconds = total_.elapsed() - render_seconds_;
    ++worlds_;
    const bool is_tile = outputs_.prepare(scene);
    if (was_rendered(static_cast<size_t>(worlds_) - 1)) return;
    FinishedWorld world = make_pictures(scene, is_tile, read_seconds);
    if (checkpoint_ && !ends_early()) checkpoint_->finish_world(std::move(world), outputs_.kept().frames());
    render_seconds_ += watch.lap();
}

/// Whether an earlier run has written the world's pictures, so that it is enough to know what they are
/// called.
bool RenderJob::was_rendered(size_t index) {
    const FinishedWorld* const world = checkpoint_ ? checkpoint_->begin_world(index) : nullptr;
    if (!world || world->failed) return false;
    outputs_.wrote(world->pictures, world->shows_something);
    const CheckpointState& state = checkpoint_->state();
    if (index + 1 == state.worlds.size()) outputs_.kept().set_frames(state.kept);
    ++worlds_before_;
    return true;
}

FinishedWorld RenderJob::make_pictures(const Scene& scene, bool is_tile, double read_seconds) {
    FinishedWorld world;
    if (is_tile && !outputs_.has_tile(scene)) return world;
    if (arguments_.resume)
        for (const Display& display : scene.options.displays) OutputFile::remove_leftovers(display.name);
    const RenderSettings settings = settings_of_world(is_tile);
    const std::string& picture = scene.options.displays.front().name;
    terminal_.begin_progress(picture, {picture, "tessellate", scene.options.frame});
    const RenderContext context = make_context(scene, settings, diagnostics_);
    std::optional<FrameResult> result = render_frame(context, settings);
    terminal_.end_progress();
    if (!result) return world;
    FrameStats& stats = result->stats;
    world.failed = !write_frame(*result, context, access_, arguments_.inputs, &outputs_.kept());
    if (world.failed) output_failed_ = true;
    stats.seconds.read = read_seconds - last_read_seconds_;
    stats.seconds.total += stats.seconds.read;
    last_read_seconds_ = read_seconds;
    for (const FrameStats::Output& file : stats.outputs) world.pictures.push_back(file.path);
    world.shows_something = stats.shows_something;
    outputs_.wrote(world.pictures, world.shows_something);
    if (const auto pass = outputs_.pass_of(scene)) {
        if (checkpoint_) checkpoint_->keeps_pass(*pass);
        outputs_.keep_pass(context, std::move(result->image));
    }
    say_what_is_written(stats);
    frames_.push_back(stats);
    return world;
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
    if (checkpoint_ && checkpoint_->refused()) return kExitNoInput;
    if (output_failed_) return kExitNoOutput;
    if (diagnostics_.kinds().contains(kPictureTooLarge)) return kExitNoMemory;
    if (diagnostics_.kinds().contains(kNoColors)) return kExitNoInput;
    if (frames_.empty() && maps_.empty() && worlds_before_ == 0) return kExitNothingRendered;
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
    return can_write({arguments_.stats_file, writes_output ? output : ""}, diagnostics_) &&
           (!checkpoint_ || checkpoint_->can_write());
}

/// A config that the user names need not wait for the scene to be found wrong. Names in it may belong to what
/// the scene says: a view to its display.
bool RenderJob::colors_are_possible() const {
    ColorRequest request = arguments_.colors;
    if (request.config.empty()) return true;
    if (request.display.empty()) request.view.clear();
    return !open_colors({}, request, access_, diagnostics_).failed;
}

/// Whether the run may begin; what it goes on with, if anything, is known then.
bool RenderJob::open_checkpoint() {
    if (!checkpoint_) return true;
    if (!checkpoint_->open()) return false;
    // What a map is made of the run that rendered it has had in another form than its file's.
    const std::set<std::string>& passes = checkpoint_->state().passes;
    if (passes.empty()) return true;
    for (const std::string& picture : pictures_of_maps(arguments_, interrupt_.requested()))
        if (passes.contains(picture)) {
            checkpoint_->begin_anew(fmt::format("a map is made of \"{}\"", picture));
            break;
        }
    return true;
}

/// Nobody needs a checkpoint of what is complete.
void RenderJob::close_checkpoint() {
    if (!checkpoint_ || checkpoint_->refused()) return;
    if (interrupt_.requested())
        diagnostics_.note({}, checkpoint_->save_at_end());
    else if (!output_failed_)
        checkpoint_->remove();
}

int RenderJob::run() {
    try {
        return render();
    } catch (const std::bad_alloc&) {
        if (checkpoint_ && !checkpoint_->refused()) diagnostics_.note({}, checkpoint_->save_at_end());
        throw;
    }
}

int RenderJob::render() {
    if (!outputs_are_possible()) return kExitNoOutput;
    if (!colors_are_possible() || !open_checkpoint()) return kExitNoInput;
    ReadOptions options = read_options(arguments_, access_);
    options.cancelled = &interrupt_.requested();
    if (!options.defaults_file.empty()) reads_->add(options.defaults_file);
    options.on_wait = [this](const std::string& what, int seconds) {
        terminal_.wait("waiting for " + what + ", " + std::to_string(seconds) + " s");
    };
    options.shading_rate = arguments_.shading_rate;
    preview_ = preview_of(arguments_, terminal_, diagnostics_);
    options.on_map = [this](const MapRequest& request) {
        if (!ends_early()) make_map_of_pictures(request);
    };
    terminal_.begin_progress(arguments_.inputs.front(), {arguments_.inputs.front(), "read", 0});
    if (tile_) outputs_.set_map_pictures(pictures_of_maps(arguments_, interrupt_.requested()));
    int worlds_read = 0;
    on_threads(arguments_.threads, [&] {
        worlds_read = read_rib(arguments_.inputs, options, diagnostics_, [&](Scene&& scene) {
                          render_world(std::move(scene));
                      }).worlds;
    });
    terminal_.end_progress();
    close_checkpoint();
    if (!ends_early()) {
        if (worlds_ == 0 && maps_.empty())
            diagnostics_.error({}, worlds_read
                                       ? "none of the frames asked for is in the input; nothing rendered"
                                       : "no WorldBegin block was found in the input; nothing rendered");
        if (!(frames_.empty() && maps_.empty()) && !write_stats()) output_failed_ = true;
    }
    // Viewers may take a while to have all that they are to keep: by now all is written and known.
    const int code = exit_code();
    if (!interrupt_.requested()) interrupt_.lift_time_limit();
    preview_.reset();
    return code;
}

}  // namespace

int render_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    if (!inputs_exist(arguments.inputs, diagnostics)) return kExitNoInput;
    return RenderJob(arguments, terminal, diagnostics).run();
}

}  // namespace trapeze
