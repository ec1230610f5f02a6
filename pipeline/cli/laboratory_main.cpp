/// The laboratory: what compares and measures, and makes scenes for it. It is a program of its own, which the
/// renderer becomes for its commands, so that who renders need not build it.
#include "pipeline/cli/laboratory/laboratory.h"
#include "pipeline/cli/program.h"
#include "pipeline/cli/support/exit_codes.h"

int main(int argc, char** argv) {
    using namespace trapeze;
    constexpr CommandFunction kFunctions[] = {{Command::Compare, compare_command},
                                              {Command::Study, study_command},
                                              {Command::Scene, scene_command}};
    const auto not_here = [](char**) {
        Terminal({}).show(
            {Severity::Error, "this is the program of compare, study and scene; call trapeze", {}, {}, {}});
        return static_cast<int>(kExitUsage);
    };
    return run_program(argc, argv, kFunctions, not_here);
}
