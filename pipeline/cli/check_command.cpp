#include <fmt/format.h>

#include <filesystem>

#include "pipeline/cli/commands.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/interrupt.h"
#include "pipeline/cli/read_settings.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze {

namespace {

uint64_t total(const std::map<std::string, uint64_t>& counts) {
    uint64_t sum = 0;
    for (const auto& [name, count] : counts) sum += count;
    return sum;
}

}  // namespace

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
    const Interrupt interrupt;
    if (!inputs_exist(arguments, diagnostics)) return kExitNoInput;
    ReadOptions options = read_options(arguments);
    options.keep_geometry = false;
    const ReadSummary summary = read_rib(arguments.inputs, options, diagnostics, [](Scene&&) {});
    terminal.say(fmt::format("{} errors, {} warnings; {} requests not supported, {} settings without effect",
                             diagnostics.count(Severity::Error), diagnostics.count(Severity::Warning),
                             total(summary.unsupported), total(summary.without_effect)));
    for (const auto& [name, count] : summary.unsupported) fmt::print("unsupported {} {}\n", name, count);
    for (const auto& [name, count] : summary.without_effect) fmt::print("no effect {} {}\n", name, count);
    for (const auto& [name, count] : summary.settled) fmt::print("not needed {} ({})\n", name, count);
    const bool all_honoured = diagnostics.count(Severity::Warning) == 0 && summary.unsupported.empty() &&
                              summary.without_effect.empty();
    const bool bad = diagnostics.count(Severity::Error) > 0 || (arguments.strict && !all_honoured);
    return bad ? kExitErrors : kExitOk;
}

}  // namespace trapeze
