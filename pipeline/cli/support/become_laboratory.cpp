#include "pipeline/cli/support/become_laboratory.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/files/module.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/terminal.h"

namespace trapeze {

int become_laboratory(char** argv) {
    std::string problem;
    for (const std::string& folder : module_folders()) {
        const std::string path = folder + "/" + kLaboratory;
        execv(path.c_str(), argv);
        if (errno != ENOENT && errno != ENOTDIR && problem.empty())
            problem = path + ": " + std::strerror(errno);
    }
    if (problem.empty())
        problem = std::string(kLaboratory) + " is not beside the program, nor in ../lib/trapeze";
    Terminal({}).show(
        {Severity::Error, "this command is another program's, which cannot be run: " + problem, {}, {}, {}});
    return kExitInternal;
}

}  // namespace trapeze
