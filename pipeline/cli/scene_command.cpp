#include <cstdio>
#include <tuple>

#include "pipeline/cli/commands.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/text_files.h"

namespace trapeze {

int scene_command(const Arguments& arguments, Terminal&, Diagnostics& diagnostics) {
    SceneParameters parameters = arguments.scene.parameters;
    if (arguments.resolution) std::tie(parameters.width, parameters.height) = *arguments.resolution;
    const std::string text = scene_text(arguments.scene.name, parameters);
    if (arguments.output.empty()) {
        const bool written =
            std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
        if (!written) diagnostics.error({}, "cannot write to standard output");
        return written ? kExitOk : kExitNoOutput;
    }
    return write_text(arguments.output, text, diagnostics) ? kExitOk : kExitNoOutput;
}

}  // namespace trapeze
