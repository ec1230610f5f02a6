#include "composite/displays/write_displays.h"

#include <fmt/format.h>

#include <chrono>

#include "composite/displays/deep_exr_output.h"
#include "composite/displays/image_output.h"
#include "composite/displays/open_exr_output.h"
#include "composite/displays/shared_files.h"
#include "core/files/output_file.h"

namespace trapeze {
namespace {

/// Writes one file. Returns what went wrong, or nothing.
std::string write_picture(const PictureToWrite& picture, const OutputPlace& place) {
    if (!place.problem.empty()) return place.problem;
    OutputFile file(place.path);
    if (picture.plan.deep) return write_deep_exr(picture, file);
    return picture.plan.format == FileFormat::OpenExr ? write_open_exr(picture, file)
                                                      : write_image(picture, file);
}

}  // namespace

bool write_displays(const Image& image, const RenderContext& context, const OutputInfo& info,
                    std::vector<WrittenFile>* written) {
    Diagnostics& diagnostics = *context.diagnostics;
    bool good = true;
    if (context.is_cancelled()) return false;
    for (const SharedFile& file : files_of_displays(context.scene->options, *info.access, diagnostics)) {
        if (context.is_cancelled()) return false;
        const auto begin = std::chrono::steady_clock::now();
        const DisplayPlan& plan = file.plans.front();
        std::string error = "the crop window holds no pixels";
        if (!image.window.empty()) {
            if (file.place.problem.empty() && info.before_picture && !plan.depth_map)
                info.before_picture(plan.path, file.location);
            error = write_picture({image, context, plan, info, std::span(file.plans).subspan(1)}, file.place);
        }
        // A file that was given up because the user stopped the render is no error.
        if (context.is_cancelled() && !error.empty()) return false;
        if (error.empty()) {
            const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
            if (written) written->push_back({plan.path, seconds.count(), plan.depth_map});
            continue;
        }
        diagnostics.error(file.location, fmt::format("cannot write \"{}\": {}", plan.path, error));
        good = false;
    }
    return good;
}

void remove_partial_outputs() {
    OutputFile::remove_partials();
}

}  // namespace trapeze
