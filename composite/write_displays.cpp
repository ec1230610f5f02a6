#include "composite/write_displays.h"

#include <fmt/format.h>

#include "composite/image_output.h"
#include "composite/open_exr_output.h"
#include "composite/output_file.h"

namespace trapeze {

bool write_displays(const Image& image, const RenderContext& context, const OutputInfo& info,
                    std::vector<std::string>* written) {
    Diagnostics& diagnostics = *context.diagnostics;
    const AovLayout layout = aov_layout(context.scene->options);
    bool good = true;
    for (const Display& display : context.scene->options.displays) {
        if (context.is_cancelled()) return false;
        const auto plan = plan_display(display, context.scene->options, layout, diagnostics);
        if (!plan) continue;
        std::string error;
        if (image.window.empty()) {
            error = "the crop window holds no pixels";
        } else {
            make_folder_of(plan->path);
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
