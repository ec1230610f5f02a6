#include "pipeline/cli/program.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "core/simd/simd_limit.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/interrupt.h"
#include "pipeline/cli/support/memory_limit.h"
#include "pipeline/cli/support/read_settings.h"
#include "pipeline/cli/support/standard_streams.h"
#include "pipeline/ri/serve_procedural.h"

namespace trapeze {
namespace {

/// Messages of a confined run that are shown, at most: a stranger's shader may print at every vertex.
constexpr uint64_t kMostSafeMessages = 10'000;

/// Bounds the process of a confined run, as opposed to what its scenes may reach (Access).
void be_safe(const Arguments& arguments) {
    limit_memory(arguments.memory_bytes);
    // Where OpenImageIO looks for libraries to load, beside the loader, which is done.
    unsetenv("OIIO_LIBRARY_PATH");
    unsetenv("LD_LIBRARY_PATH");
}

int run(const CommandFunction& function, const Arguments& arguments, Terminal& terminal) {
    Diagnostics diagnostics([&](const Diagnostic& diagnostic) { terminal.show(diagnostic); });
    const int code = function.run(arguments, terminal, diagnostics);
    if (code == kExitTimeLimit) diagnostics.error({}, time_limit_message());
    terminal.summarise(diagnostics);
    return code;
}

}  // namespace

int run_program(int argc, char** argv, std::span<const CommandFunction> functions,
                int (*otherwise)(char** argv)) {
    if (argc == 3 && std::string_view(argv[1]) == kServeProcedural) return serve_procedural(argv[2]);
    prepare_standard_streams();
    Arguments arguments;
    if (const auto code = parse_arguments(argc, argv, arguments)) {
        Terminal terminal({});
        return *code == kExitOk && !printed_all(terminal) ? kExitNoOutput : *code;
    }
    const auto function = std::ranges::find(functions, arguments.command, &CommandFunction::command);
    if (function == functions.end()) return otherwise(argv);
    if (arguments.safe) be_safe(arguments);
    Terminal terminal({progress_style(arguments.progress), arguments.color, arguments.quiet,
                       arguments.safe ? kMostSafeMessages : Terminal::Settings().most_messages});
    if (const std::string_view lacking = lacking_simd(); !lacking.empty()) {
        terminal.show({Severity::Error,
                       "this program was built on a machine with " + std::string(lacking) +
                           ", which this one lacks; remove build/release, and ./trapeze builds it anew",
                       {},
                       {},
                       {}});
        return kExitUsage;
    }
    std::string wrong;
    if (!limit_simd(arguments.simd, &wrong)) {
        terminal.show({Severity::Error, "--simd: " + wrong, {}, {}, {}});
        return kExitUsage;
    }
    try {
        const int code = run(*function, arguments, terminal);
        const bool is_worse = code == kExitOk || code == kExitErrors;
        return !printed_all(terminal) && is_worse ? kExitNoOutput : code;
    } catch (const std::bad_alloc&) {
        terminal.show({Severity::Error, "out of memory; what was being made is not written", {}, {}, {}});
        return kExitNoMemory;
    } catch (const std::exception& error) {
        if (!printed_all(terminal)) return kExitNoOutput;  // what prints throws where it cannot
        terminal.show({Severity::Error, std::string("internal error: ") + error.what(), {}, {}, {}});
        return kExitInternal;
    }
}

}  // namespace trapeze
