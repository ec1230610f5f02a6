#include "composite/write_displays.h"

#include <fmt/format.h>

#include <set>

#include "composite/image_output.h"
#include "composite/open_exr_output.h"
#include "core/output_file.h"

namespace trapeze {

bool write_displays(const Image& image, const RenderContext& context, const OutputInfo& info,
                    std::vector<std::string>* written) {
    Diagnostics& diagnostics = *context.diagnostics;
    const AovLayout layout = aov_layout(context.scene->options);
    bool good = true;
    std::set<std::string> places;
    for (const Display& display : context.scene->options.displays) {
        if (context.is_cancelled()) return false;
        auto plan = plan_display(display, context.scene->options, layout, diagnostics);
        if (!plan) continue;
        std::string error;
        if (image.window.empty()) {
            error = "the crop window holds no pixels";
        } else {
            std::string place = place_to_write(plan->path);
            if (place != plan->path && !places.contains(place)) {
                diagnostics.warning(
                    display.location,
                    fmt::format("there is no folder for \"{}\"; it is written as \"{}\"", plan->path, place),
                    "no-folder");
                plan->path = std::move(place);
            }
            places.insert(plan->path);
            OutputFile file(plan->path);
            const PictureToWrite picture{image, context, *plan, info};
            error = plan->format == FileFormat::OpenExr ? write_open_exr(picture, file)
                                                        : write_image(picture, file);
        }
        if (context.is_cancelled() && !error.empty()) return false;
        if (error.empty()) {
            if (written) written->push_back(plan->path);
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
