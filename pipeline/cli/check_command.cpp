#include <fmt/format.h>

#include <filesystem>

#include "pipeline/cli/commands.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze {

bool inputs_exist(const Arguments& arguments, Diagnostics& diagnostics) {
    bool all = true;
    for (const std::string& input : arguments.inputs) {
        std::error_code error;
        const auto status = std::filesystem::status(input, error);
        if (input == "-" || (std::filesystem::exists(status) && !std::filesystem::is_directory(status)))
            continue;
        diagnostics.error({}, std::filesystem::is_directory(status) ? "\"" + input + "\" is a folder"
                                                                    : "no such file: \"" + input + "\"");
        all = false;
    }
    return all;
}

int check_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    if (!inputs_exist(arguments, diagnostics)) return kExitNoInput;
    ReadOptions options;
    options.keep_geometry = false;
    const ReadSummary summary = read_rib(arguments.inputs, options, diagnostics, [](Scene&&) {});
    uint64_t unsupported = 0;
    for (const auto& [name, count] : summary.unsupported) unsupported += count;
    terminal.say(fmt::format("{} errors, {} warnings; {} requests not supported",
                             diagnostics.count(Severity::Error), diagnostics.count(Severity::Warning),
                             unsupported));
    for (const auto& [name, count] : summary.unsupported) fmt::print("unsupported {} {}\n", name, count);
    const bool bad = diagnostics.count(Severity::Error) > 0 ||
                     (arguments.strict && diagnostics.count(Severity::Warning) > 0);
    return bad ? kExitErrors : kExitOk;
}

}  // namespace trapeze
