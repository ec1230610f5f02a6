#include "pipeline/cli/commands/run_checkpoint.h"

#include <filesystem>

#include "pipeline/cli/support/output_names.h"
#include "pipeline/cli/support/recorded_options.h"
#include "pipeline/cli/support/revision.h"
#include "pipeline/frame/kept_pictures.h"
#include "pipeline/frame/version.h"

namespace trapeze {
namespace {

/// From one save to the next, where nobody says how long.
constexpr double kUsualSeconds = 300;

}  // namespace

std::string checkpoint_path(const Arguments& a) {
    std::string name = a.output;
    if (name.empty()) name = std::filesystem::path(a.inputs.front()).stem().string() + ".exr";
    if (a.frames && !a.frames->empty()) {
        const int frame = a.frames->front().first;
        const std::string of_frame = with_frame_number(name, frame);
        name = of_frame == name ? numbered(name, frame) : of_frame;
    }
    if (const auto tile = a.tile()) name = with_tile_number(name, *tile);
    return name + ".checkpoint";
}

std::unique_ptr<Checkpoint> checkpoint_of(const Arguments& a, std::shared_ptr<const ReadNames> reads,
                                          Diagnostics& diagnostics) {
    if (!a.checkpoint && !a.resume) return {};
    CheckpointSettings settings;
    settings.path = checkpoint_path(a);
    settings.interval = a.checkpoint.value_or(kUsualSeconds);
    settings.resumes = a.resume;
    settings.origin.version = kVersion, settings.origin.revision = revision();
    settings.origin.options = recorded_options(a);
    return std::make_unique<Checkpoint>(std::move(settings), std::move(reads), diagnostics);
}

}  // namespace trapeze
