/// The options of each command, as the parser takes them: of one that is repeated the last counts.
#pragma once

#include "pipeline/cli/support/arguments.h"

namespace CLI {
class App;
}

namespace trapeze {

void add_render_options(CLI::App& app, Arguments& arguments);
void add_merge_options(CLI::App& app, Arguments& arguments);
void add_farm_options(CLI::App& app, Arguments& arguments);
void add_check_options(CLI::App& app, Arguments& arguments);
void add_info_options(CLI::App& app, Arguments& arguments);
void add_cat_options(CLI::App& app, Arguments& arguments);
void add_compare_options(CLI::App& app, Arguments& arguments);
void add_scene_options(CLI::App& app, Arguments& arguments);
void add_study_options(CLI::App& app, Arguments& arguments);
void add_shader_options(CLI::App& app, Arguments& arguments);
void add_compliance_options(CLI::App& app, Arguments& arguments);

}  // namespace trapeze
