#include "pipeline/farm/farm_job.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/shell_word.h"

namespace trapeze {

std::vector<FarmFile> common_files(const FarmJob& job) {
    std::vector<std::string> scenes;
    // A name that begins with a dash would be an option.
    for (const std::string& scene : job.scenes)
        scenes.push_back(shell_word(scene.starts_with('-') ? "./" + scene : scene));
    const bool in_tiles = job.tile_count() > 1;
    const std::string picture = job.path((in_tiles ? "tiles/" : "") + job.name + ".####.exr");
    const std::string tiles =
        in_tiles ? fmt::format("--tiles {}x{} --tile \"$2\" ", job.tiles.first, job.tiles.second) : "";
    std::vector<FarmFile> files{
        {job.path("render"),
         fmt::format("#!/usr/bin/env bash\n"
                     "# {}: render FRAME TILE, from the folder in which the job was made.\n"
                     "# Whatever an earlier run of the same tile has finished is not rendered again.\n"
                     "exec \"${{TRAPEZE:-trapeze}}\" render {} -f \"$1\" {}-o {} --resume {}\n",
                     kFarmMark, fmt::join(scenes, " "), tiles, shell_word(picture), job.options),
         true}};
    if (in_tiles)
        files.push_back(
            {job.path("merge"),
             fmt::format(
                 "#!/usr/bin/env bash\n"
                 "# {}: merge FRAME joins the frame's tiles; those that are missing are "
                 "named, and nothing is written.\n"
                 "frame=$(printf %04d \"$1\")\n"
                 "exec \"${{TRAPEZE:-trapeze}}\" merge {}.\"$frame\".tile*.exr -o {}.\"$frame\".exr\n",
                 kFarmMark, shell_word(job.path("tiles/" + job.name)), shell_word(job.path(job.name))),
             true});
    return files;
}

}  // namespace trapeze
