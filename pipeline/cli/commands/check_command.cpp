#include <fmt/format.h>

#include "composite/displays/display_plan.h"
#include "pipeline/cli/commands/commands.h"
#include "pipeline/cli/commands/made_files.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/interrupt.h"
#include "pipeline/cli/support/missing_shaders.h"
#include "pipeline/cli/support/read_settings.h"
#include "pipeline/frame/make_context.h"
#include "pipeline/frame/make_map.h"
#include "pipeline/frame/render_frame.h"
#include "pipeline/rib/read_rib.h"
#include "shade/check_looks.h"

namespace trapeze {

namespace {

uint64_t total(const std::map<std::string, uint64_t>& counts) {
    uint64_t sum = 0;
    for (const auto& [name, count] : counts) sum += count;
    return sum;
}

/// Reads scenes, and looks for what their worlds and requests name.
class CheckJob {
  public:
    CheckJob(const Arguments& arguments, const Interrupt& interrupt, Diagnostics& diagnostics)
        : arguments_(arguments), interrupt_(interrupt), diagnostics_(diagnostics) {}

    ReadSummary run() {
        ReadOptions options = read_options(arguments_, access_);
        options.cancelled = &interrupt_.requested();
        options.on_map = [this](const MapRequest& request) { take_map(request); };
        return read_rib(arguments_.inputs, options, diagnostics_,
                        [this](Scene&& scene) { take_world(scene); });
    }

  private:
    void take_world(const Scene& scene);
    void take_map(const MapRequest& request);

    const Arguments& arguments_;
    const Interrupt& interrupt_;
    Diagnostics& diagnostics_;
    Access access_ = scene_access(arguments_);
    MadeFiles made_;
};

/// Checks a world's shaders and maps, and remembers the pictures that its displays would have made.
void CheckJob::take_world(const Scene& scene) {
    if (interrupt_.requested()) return;
    RenderSettings settings;
    settings.cancelled = &interrupt_.requested();
    settings.access = &access_;
    const RenderContext context = make_context(scene, settings, diagnostics_);
    const auto texture_folders = scene.options.search_paths.find("texture");
    const std::vector<std::string> none;
    const std::vector<std::string>& folders =
        texture_folders == scene.options.search_paths.end() ? none : texture_folders->second;
    check_looks(
        context, [&](std::string_view name) { return made_.has(name, folders); }, access_);
    const AovLayout layout = aov_layout(scene.options);
    for (const Display& display : scene.options.displays)
        if (const auto plan = plan_display(display, scene.options, layout, diagnostics_))
            made_.add(plan->path);
}

/// Reports the pictures of a map request that neither are there nor would have been made.
void CheckJob::take_map(const MapRequest& request) {
    for (const std::string& picture : missing_pictures(request, access_))
        if (!made_.has(picture, request.folders))
            diagnostics_.error(
                request.location,
                fmt::format("cannot make \"{}\" from \"{}\": it is not found", request.map, picture));
    made_.add(request.map);
}

}  // namespace

int check_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    const Interrupt interrupt(arguments.time_limit);
    if (!inputs_exist(arguments.inputs, diagnostics)) return kExitNoInput;
    const ReadSummary summary = CheckJob(arguments, interrupt, diagnostics).run();
    if (interrupt.requested()) return interrupt.exit_code();
    terminal.say(fmt::format("{} errors, {} warnings; {} requests not supported, {} settings without effect",
                             diagnostics.count(Severity::Error), diagnostics.count(Severity::Warning),
                             total(summary.unsupported), total(summary.without_effect)));
    for (const auto& [name, count] : summary.unsupported) fmt::print("unsupported {} {}\n", name, count);
    for (const auto& [name, count] : summary.without_effect) fmt::print("no effect {} {}\n", name, count);
    for (const auto& [name, count] : summary.not_needed) fmt::print("not needed {} ({})\n", name, count);
    if (arguments.strict && has_missing_shader(diagnostics)) return kExitShaderMissing;
    const bool all_honoured = diagnostics.count(Severity::Warning) == 0 && summary.unsupported.empty() &&
                              summary.without_effect.empty();
    const bool bad = diagnostics.count(Severity::Error) > 0 || (arguments.strict && !all_honoured);
    return bad ? kExitErrors : kExitOk;
}

}  // namespace trapeze
