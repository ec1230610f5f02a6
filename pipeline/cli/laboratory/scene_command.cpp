#include <tuple>

#include "pipeline/cli/laboratory/laboratory.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/standard_streams.h"
#include "pipeline/cli/support/text_files.h"
#include "pipeline/study/scenes/scenes.h"

namespace trapeze {

int scene_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    SceneParameters parameters = arguments.scene.parameters;
    if (arguments.resolution) std::tie(parameters.width, parameters.height) = *arguments.resolution;
    const std::string text = scene_text(arguments.scene.name, parameters);
    if (arguments.output.empty()) {
        print_text(text);
        return kExitOk;
    }
    return write_text(arguments.output, text, terminal, diagnostics) ? kExitOk : kExitNoOutput;
}

}  // namespace trapeze
