#include "pipeline/cli/support/read_settings.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "pipeline/frame/frame_memory.h"
#include "pipeline/rib/state/user_defaults.h"

namespace trapeze {

bool inputs_exist(const std::vector<std::string>& inputs, Diagnostics& diagnostics) {
    namespace fs = std::filesystem;
    bool all = true;
    for (const std::string& input : inputs) {
        if (input == "-") continue;
        std::error_code error;
        const auto status = fs::status(input, error);
        std::string problem;
        if (!fs::exists(status))
            problem = "no such file: \"" + input + "\"";
        else if (fs::is_directory(status))
            problem = "\"" + input + "\" is a folder";
        else if (access(input.c_str(), R_OK) != 0)
            problem = "cannot read \"" + input + "\": " + std::strerror(errno);
        if (problem.empty()) continue;
        diagnostics.error({}, problem);
        all = false;
    }
    return all;
}

Access scene_access(const Arguments& arguments) {
    namespace fs = std::filesystem;
    Access access = arguments.safe ? Access::confined() : Access();
    if (!arguments.output.empty()) access.allow_writing(arguments.output);
    std::error_code ignored;
    for (const std::string& input : arguments.inputs)
        if (fs::is_regular_file(input, ignored))
            access.allow_reading_below(fs::path(input).parent_path().string());
    return access;
}

ReadOptions read_options(const Arguments& arguments, Access& access) {
    ReadOptions options;
    options.access = &access;
    options.defaults_file = user_defaults_file();
    for (const std::string& rib : arguments.first_rib) options.first_texts.push_back({"--option", rib});
    // A file's bytes and the scene's primitives are in memory whole, before there are grids.
    const size_t memory = arguments.memory_bytes ? arguments.memory_bytes : default_memory_budget();
    options.max_source_bytes = std::min(options.max_source_bytes, memory);
    options.most_scene_bytes = memory;
    if (arguments.frames)
        options.wants_frame = [&frames = *arguments.frames](int frame) {
            return std::ranges::any_of(frames, [&](const FrameRange& range) { return range.has(frame); });
        };
    options.allow_programs = arguments.allow_programs;
    options.program_seconds = arguments.program_seconds;
    options.procedural_host = {"/proc/self/exe", kServeProcedural};
    return options;
}

}  // namespace trapeze
