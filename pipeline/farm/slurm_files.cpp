#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/shell_word.h"
#include "pipeline/farm/farm_job.h"

namespace trapeze {
namespace {

/// Seconds before its end at which a task is told to save what it has.
constexpr int kSecondsToSave = 120;

/// A task: one tile of one frame. The batch shell gets the signal, not the program, and passes it on; it
/// waits for the program, since Slurm ends the job with the shell.
std::string task_script(const FarmJob& job) {
    return fmt::format(
        "#!/usr/bin/env bash\n"
        "# {mark}: one tile of one frame, by DIR/submit. The argument is the number of the array's first task.\n"
        "#SBATCH --signal=B:TERM@{seconds}\n"
        "#SBATCH --requeue\n"
        "#SBATCH --open-mode=append\n"
        "frames=({frames})\n"
        "index=$(($1 + SLURM_ARRAY_TASK_ID))\n"
        "frame=${{frames[index / {tiles}]}} tile=$((index % {tiles} + 1))\n"
        "deaths={folder}/deaths/$frame.$tile\n"
        "\n"
        "bash {folder}/render \"$frame\" \"$tile\" &\n"
        "render=$!\n"
        "trap 'kill -TERM $render 2>/dev/null' TERM\n"
        "wait $render\n"
        "code=$?\n"
        "# A signal ends the wait, not yet the program.\n"
        "while kill -0 $render 2>/dev/null; do\n"
        "    wait $render\n"
        "    code=$?\n"
        "done\n"
        "\n"
        "again() {{ scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID\"; }}\n"
        "case $code in\n"
        "0) rm -f \"$deaths\" ;;\n"
        "8 | 143) again ;;  # it has saved what it had\n"
        "1[3-9][0-9])       # a signal: {retries} times\n"
        "    count=$(cat \"$deaths\" 2>/dev/null || echo 0)\n"
        "    echo $((count + 1)) >\"$deaths\"\n"
        "    if [ \"$count\" -lt {retries} ]; then again; fi ;;\n"
        "esac\n"
        "exit $code\n",
        fmt::arg("mark", kFarmMark), fmt::arg("seconds", kSecondsToSave),
        fmt::arg("frames", fmt::join(job.frames, " ")), fmt::arg("tiles", job.tile_count()),
        fmt::arg("folder", shell_word(job.folder)), fmt::arg("retries", job.retries));
}

std::string submit_script(const FarmJob& job) {
    const std::string folder = shell_word(job.folder);
    std::string text = fmt::format(
        "#!/usr/bin/env bash\n"
        "# {mark}: submits the job to Slurm, from the folder in which it was made.\n"
        "#   DIR/submit [OPTION OF SBATCH]..., as --time=2:00:00 --cpus-per-task=16 --partition=render\n"
        "set -euo pipefail\n"
        "tasks={tasks}\n"
        "# An array's numbers must be smaller than this.\n"
        "most=$(scontrol show config | sed -n 's/^MaxArraySize *= *//p')\n"
        "ids=()\n"
        "for ((first = 0; first < tasks; first += most)); do\n"
        "    last=$((first + most < tasks ? most - 1 : tasks - first - 1))\n"
        "    id=$(sbatch --parsable --job-name={name} --output={folder}/logs/%A_%a.log --array=0-$last \"$@\" \\\n"
        "        {folder}/task $first)\n"
        "    id=${{id%%;*}}\n"
        "    echo \"submitted tasks $first to $((first + last)) as job $id\"\n"
        "    for ((i = 0; i <= last; i++)); do ids+=(\"${{id}}_$i\"); done\n"
        "done\n",
        fmt::arg("mark", kFarmMark),
        fmt::arg("tasks", job.frames.size() * static_cast<size_t>(job.tile_count())),
        fmt::arg("name", shell_word(job.name)), fmt::arg("folder", folder));
    if (job.tile_count() == 1) return text;
    return text + fmt::format(
                      "frames=({})\n"
                      "for i in \"${{!frames[@]}}\"; do\n"
                      "    tiles=$(IFS=: && echo \"${{ids[*]:i * {}:{}}}\")\n"
                      "    sbatch --parsable --job-name={} --output={}/logs/merge.%j.log "
                      "--dependency=afterany:\"$tiles\" \\\n"
                      "        \"$@\" {}/merge \"${{frames[i]}}\" >/dev/null\n"
                      "done\n"
                      "echo \"submitted ${{#frames[@]}} merges, which run after their frames' tasks\"\n",
                      fmt::join(job.frames, " "), job.tile_count(), job.tile_count(),
                      shell_word("merge " + job.name), folder, folder);
}

}  // namespace

std::vector<FarmFile> slurm_files(const FarmJob& job) {
    return {{job.path("task"), task_script(job), false}, {job.path("submit"), submit_script(job), true}};
}

}  // namespace trapeze
