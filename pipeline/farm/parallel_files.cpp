#include <fmt/format.h>

#include "core/shell_word.h"
#include "pipeline/farm/farm_job.h"

namespace trapeze {

std::vector<FarmFile> parallel_files(const FarmJob& job) {
    std::string renders, merges;
    const bool in_tiles = job.tile_count() > 1;
    const std::string folder = shell_word(job.folder);
    for (const int frame : job.frames) {
        for (int tile = 1; tile <= job.tile_count(); ++tile)
            renders += fmt::format("bash {}/render {} {}\n", folder, frame, tile);
        if (in_tiles) merges += fmt::format("bash {}/merge {}\n", folder, frame);
    }
    // Whoever ends it by SIGTERM twice gives the programs half a minute to save.
    const std::string parallel = "parallel --termseq TERM,30000,KILL,25 --resume-failed --joblog ";
    std::string run = fmt::format(
        "#!/usr/bin/env bash\n"
        "# {}: runs the job by GNU parallel, from the folder in which it was made; what has been\n"
        "# done is not done again.\n"
        "#   DIR/run [OPTION OF PARALLEL]..., as --jobs 4 --sshloginfile hosts --workdir .\n"
        "code=0\n"
        "{}{}/render.log \"$@\" <{}/render.jobs || code=$?\n",
        kFarmMark, parallel, folder, folder);
    if (in_tiles)
        run += fmt::format("{}{}/merge.log \"$@\" <{}/merge.jobs || code=$?\n", parallel, folder, folder);
    std::vector<FarmFile> files{{job.path("render.jobs"), renders, false},
                                {job.path("run"), run + "exit $code\n", true}};
    if (in_tiles) files.push_back({job.path("merge.jobs"), merges, false});
    return files;
}

}  // namespace trapeze
