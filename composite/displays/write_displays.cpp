#include "composite/displays/write_displays.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <set>

#include "composite/displays/image_output.h"
#include "composite/displays/open_exr_output.h"
#include "core/files/output_file.h"

namespace trapeze {
namespace {

/// The name for a variable N whose file "a.exr" another display of the picture has: "a.N.exr".
std::string beside(const DisplayPlan& plan, const Display& display, const std::set<std::string>& places) {
    const std::filesystem::path path(plan.path);
    const std::string shown = plan.aov ? plan.aov->name : display.mode.empty() ? "rgba" : display.mode;
    std::string apart;
    for (int number = 1; apart.empty() || places.contains(apart); ++number)
        apart = (path.parent_path() / fmt::format("{}.{}{}{}", path.stem().string(), shown,
                                                  number > 1 ? std::to_string(number) : "",
                                                  path.extension().string()))
                    .string();
    return apart;
}

/// Writes one file. Returns what went wrong, or nothing.
std::string write_picture(const PictureToWrite& picture, const OutputPlace& place) {
    if (!place.problem.empty()) return place.problem;
    OutputFile file(place.path);
    return picture.plan.format == FileFormat::OpenExr ? write_open_exr(picture, file)
                                                      : write_image(picture, file);
}

}  // namespace

bool write_displays(const Image& image, const RenderContext& context, const OutputInfo& info,
                    std::vector<WrittenFile>* written) {
    Diagnostics& diagnostics = *context.diagnostics;
    const AovLayout layout = aov_layout(context.scene->options);
    bool good = true;
    std::set<std::string> places;  // taken so far, so that no display overwrites another's file
    for (const Display& display : context.scene->options.displays) {
        if (context.is_cancelled()) return false;
        const auto begin = std::chrono::steady_clock::now();
        auto plan = plan_display(display, context.scene->options, layout, diagnostics);
        if (!plan) continue;
        std::string error;
        if (image.window.empty()) {
            error = "the crop window holds no pixels";
        } else {
            OutputPlace place = place_to_write(plan->path, *info.access, display.location, diagnostics);
            // Pictures that were meant for folders of other machines all go into the working folder: of
            // several with the same name there only the first can have it.
            if (place.name == plan->path || !places.contains(place.name))
                plan->path = place.name;
            else
                place.problem = fmt::format("there is no folder \"{}\"",
                                            std::filesystem::path(plan->path).parent_path().string());
            if (places.contains(plan->path)) {
                const std::string apart = beside(*plan, display, places);
                diagnostics.warning(display.location,
                                    fmt::format("\"{}\" is another display's; \"{}\" is written beside it",
                                                plan->path, apart),
                                    "display-twice " + apart);
                plan->path = apart;
                const Access::Writing writing = info.access->may_write(apart);
                place = {apart, writing.path, writing.problem};
            }
            places.insert(plan->path);
            if (place.problem.empty() && info.before_picture && !plan->depth_map)
                info.before_picture(plan->path, display.location);
            error = write_picture({image, context, *plan, info}, place);
        }
        // A file that was given up because the user stopped the render is no error.
        if (context.is_cancelled() && !error.empty()) return false;
        if (error.empty()) {
            const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
            if (written) written->push_back({plan->path, seconds.count(), plan->depth_map});
            continue;
        }
        diagnostics.error(display.location, fmt::format("cannot write \"{}\": {}", plan->path, error));
        good = false;
    }
    return good;
}

void remove_partial_outputs() {
    OutputFile::remove_partials();
}

}  // namespace trapeze
