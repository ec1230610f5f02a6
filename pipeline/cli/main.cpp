/// The renderer.
#include "pipeline/cli/commands/commands.h"
#include "pipeline/cli/program.h"
#include "pipeline/cli/support/become_laboratory.h"

int main(int argc, char** argv) {
    using namespace trapeze;
    constexpr CommandFunction kFunctions[] = {
        {Command::Render, render_command}, {Command::Farm, farm_command},
        {Command::Merge, merge_command},   {Command::Check, check_command},
        {Command::Info, info_command},     {Command::Cat, cat_command},
        {Command::Shader, shader_command}, {Command::Compliance, compliance_command},
    };
    return run_program(argc, argv, kFunctions, become_laboratory);
}
