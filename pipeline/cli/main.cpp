#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "core/simd/simd_limit.h"
#include "pipeline/cli/commands/commands.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/interrupt.h"
#include "pipeline/cli/support/memory_limit.h"
#include "pipeline/cli/support/read_settings.h"
#include "pipeline/cli/support/standard_streams.h"
#include "pipeline/ri/serve_procedural.h"

namespace {

/// Messages of a confined run that are shown, at most: a stranger's shader may print at every vertex.
constexpr uint64_t kMostSafeMessages = 10'000;

/// Bounds the process of a confined run, as opposed to what its scenes may reach (Access).
void be_safe(const trapeze::Arguments& arguments) {
    trapeze::limit_memory(arguments.memory_bytes);
    // Where OpenImageIO looks for libraries to load, beside the loader, which is done.
    unsetenv("OIIO_LIBRARY_PATH");
    unsetenv("LD_LIBRARY_PATH");
}

int run(const trapeze::Arguments& arguments, trapeze::Terminal& terminal) {
    using namespace trapeze;
    Diagnostics diagnostics([&](const Diagnostic& diagnostic) { terminal.show(diagnostic); });
    int code = kExitInternal;
    switch (arguments.command) {
        case Command::Render:
            code = render_command(arguments, terminal, diagnostics);
            break;
        case Command::Farm:
            code = farm_command(arguments, terminal, diagnostics);
            break;
        case Command::Merge:
            code = merge_command(arguments, terminal, diagnostics);
            break;
        case Command::Check:
            code = check_command(arguments, terminal, diagnostics);
            break;
        case Command::Info:
            code = info_command(arguments, terminal, diagnostics);
            break;
        case Command::Cat:
            code = cat_command(arguments, terminal, diagnostics);
            break;
        case Command::Compare:
            code = compare_command(arguments, terminal, diagnostics);
            break;
        case Command::Study:
            code = study_command(arguments, terminal, diagnostics);
            break;
        case Command::Shader:
            code = shader_command(arguments, terminal, diagnostics);
            break;
        case Command::Compliance:
            code = compliance_command(arguments, terminal, diagnostics);
            break;
        case Command::Scene:
            code = scene_command(arguments, terminal, diagnostics);
            break;
    }
    if (code == kExitTimeLimit) diagnostics.error({}, time_limit_message());
    terminal.summarise(diagnostics);
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    using namespace trapeze;
    if (argc == 3 && std::string_view(argv[1]) == kServeProcedural) return serve_procedural(argv[2]);
    prepare_standard_streams();
    Arguments arguments;
    if (const auto code = parse_arguments(argc, argv, arguments)) {
        Terminal terminal({});
        return *code == kExitOk && !printed_all(terminal) ? kExitNoOutput : *code;
    }
    if (arguments.safe) be_safe(arguments);
    Terminal terminal({progress_style(arguments.progress), arguments.color, arguments.quiet,
                       arguments.safe ? kMostSafeMessages : Terminal::Settings().most_messages});
    std::string wrong;
    if (!limit_simd(arguments.simd, &wrong)) {
        terminal.show({Severity::Error, "--simd: " + wrong, {}, {}, {}});
        return kExitUsage;
    }
    try {
        const int code = run(arguments, terminal);
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
