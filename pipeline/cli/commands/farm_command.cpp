#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "pipeline/cli/commands/commands.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/read_settings.h"
#include "pipeline/cli/support/text_files.h"
#include "pipeline/farm/farm_job.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

/// Tasks of a job, at most: a list of more is nobody's wish.
constexpr size_t kMostTasks = 1000000;

/// The numbers of all frames, in order; nothing when there are more than a job may have.
std::optional<std::vector<int>> frames_of(const std::vector<FrameRange>& ranges, size_t tiles) {
    std::set<int> frames;
    for (const FrameRange& range : ranges)
        for (int64_t frame = range.first; frame <= range.last; frame += range.step) {
            frames.insert(static_cast<int>(frame));
            if (frames.size() * tiles > kMostTasks) return {};
        }
    return std::vector<int>(frames.begin(), frames.end());
}

/// Whether a job's file may be written: nothing is there, or a job's file. Lists and templates are no
/// programs that anybody has written by hand.
bool may_be_replaced(const std::string& path, bool is_script) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) return true;
    std::ifstream file(path);
    std::string first, second;
    std::getline(file, first), std::getline(file, second);
    return !is_script || second.find(kFarmMark) != std::string::npos;
}

bool write_file(const FarmFile& file, Terminal& terminal, Diagnostics& diagnostics) {
    if (!write_text(file.path, file.text, terminal, diagnostics)) return false;
    std::error_code ignored;
    if (file.is_program)
        fs::permissions(file.path, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                        fs::perm_options::add, ignored);
    return true;
}

/// The folders of a job.
std::vector<std::string> folders_of(const FarmJob& job, const std::string& scheduler) {
    std::vector<std::string> folders{job.folder};
    if (job.tile_count() > 1) folders.push_back(job.path("tiles"));
    if (scheduler == "slurm") folders.push_back(job.path("logs")), folders.push_back(job.path("deaths"));
    return folders;
}

/// How the job is begun.
std::string how_to_run(const FarmJob& job, const std::string& scheduler) {
    if (scheduler == "slurm") return job.path("submit");
    return scheduler == "parallel" ? job.path("run") : "openjd run " + job.path("template.json");
}

}  // namespace

int farm_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    if (!inputs_exist(arguments.inputs, diagnostics)) return kExitNoInput;
    const FarmArguments& farm = arguments.farm;
    FarmJob job;
    job.scenes = arguments.inputs;
    job.tiles = farm.tiles.value_or(std::pair{1, 1});
    job.name = fs::path(arguments.inputs.front()).stem().string();
    job.folder = arguments.output.empty() ? job.name + ".farm" : arguments.output;
    while (job.folder.size() > 1 && job.folder.ends_with('/')) job.folder.pop_back();
    job.options = farm.options, job.retries = farm.retries;
    auto frames = frames_of(*arguments.frames, static_cast<size_t>(job.tile_count()));
    if (!frames) {
        diagnostics.error({}, fmt::format("more than {} tasks: too many for a job", kMostTasks));
        return kExitUsage;
    }
    job.frames = std::move(*frames);

    std::error_code ignored;
    std::vector<FarmFile> files = common_files(job);
    std::ranges::move(farm.scheduler == "slurm" ? slurm_files(job)
                      : farm.scheduler == "parallel"
                          ? parallel_files(job)
                          : open_job_files(job, fs::current_path(ignored).string()),
                      std::back_inserter(files));
    for (const FarmFile& file : files)
        if (!may_be_replaced(file.path, file.text.starts_with("#!"))) {
            diagnostics.error({},
                              fmt::format("cannot write \"{}\": what is there is no job's file", file.path));
            return kExitNoOutput;
        }
    for (const std::string& folder : folders_of(job, farm.scheduler))
        if (!make_folder(folder, diagnostics)) return kExitNoOutput;
    for (const FarmFile& file : files)
        if (!write_file(file, terminal, diagnostics)) return kExitNoOutput;
    terminal.say_on_terminal(fmt::format("wrote a job of {} tasks; {} begins it, from this folder",
                                         job.frames.size() * static_cast<size_t>(job.tile_count()),
                                         how_to_run(job, farm.scheduler)));
    return kExitOk;
}

}  // namespace trapeze
