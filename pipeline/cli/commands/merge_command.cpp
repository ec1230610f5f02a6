#include "composite/merge/merge_tiles.h"

#include "pipeline/cli/commands/commands.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/interrupt.h"

namespace trapeze {

int merge_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    const Interrupt interrupt;
    const MergeOptions options{arguments.merge.allow_missing, &interrupt.requested()};
    switch (merge_tiles(arguments.merge.tiles, arguments.output, options, diagnostics)) {
        case MergeOutcome::Written:
            break;
        case MergeOutcome::Unreadable:
            return kExitNoInput;
        case MergeOutcome::NoPicture:
            return kExitNothingRendered;
        case MergeOutcome::Unwritable:
            return kExitNoOutput;
        case MergeOutcome::Cancelled:
            return interrupt.exit_code();
    }
    terminal.say_on_terminal("wrote " + arguments.output);
    return kExitOk;
}

}  // namespace trapeze
