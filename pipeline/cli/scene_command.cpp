#include <fmt/format.h>

#include <cstdio>
#include <tuple>

#include "composite/output_file.h"
#include "pipeline/cli/commands.h"
#include "pipeline/cli/exit_codes.h"

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
    OutputFile file(arguments.output);
    if (file.open() && file.write(text.data(), text.size()) && file.commit()) return kExitOk;
    diagnostics.error({}, fmt::format("cannot write \"{}\": {}", arguments.output, file.error()));
    return kExitNoOutput;
}

}  // namespace trapeze
