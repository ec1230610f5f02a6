#include "pipeline/cli/read_settings.h"

#include <algorithm>

#include "pipeline/frame/render_frame.h"
#include "pipeline/rib/user_defaults.h"

namespace trapeze {

ReadOptions read_options(const Arguments& arguments) {
    ReadOptions options;
    options.defaults_file = user_defaults_file();
    for (const std::string& rib : arguments.first_rib) options.first_texts.push_back({"--option", rib});
    // A file's bytes and the scene's primitives are in memory whole, before there are grids.
    const size_t memory = arguments.memory_bytes ? arguments.memory_bytes : default_memory_budget();
    options.max_source_bytes = std::min(options.max_source_bytes, memory);
    options.most_scene_bytes = memory;
    options.allow_programs = arguments.allow_programs;
    options.procedural_host = {"/proc/self/exe", kServeProcedural};
    return options;
}

}  // namespace trapeze
