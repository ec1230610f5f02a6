/// A render of many frames and tiles as files for the schedulers that studios have. None of them is ours, and
/// no process of ours stays: a task is one run of the program, which its own checkpoint makes safe to repeat.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace trapeze {

/// What is to be rendered. Scripts run in the folder in which the job is made, and name files from there.
struct FarmJob {
    std::vector<std::string> scenes;
    std::vector<int> frames;          ///< in order, each once
    std::pair<int, int> tiles{1, 1};  ///< columns and rows
    std::string folder;               ///< gets the job's files, and the pictures
    std::string name;                 ///< of the job, and of its pictures before their frames' numbers
    std::string options;              ///< words for `trapeze render`, as a shell reads them; may be empty
    int retries = 3;                  ///< of a task whose process a signal has killed

    int tile_count() const { return tiles.first * tiles.second; }
    std::string path(const std::string& file) const { return folder + "/" + file; }
};

/// A file of a job.
struct FarmFile {
    std::string path, text;
    bool is_program = false;
};

/// Begins a line of every file, but for JSON and lists of commands.
inline constexpr const char* kFarmMark = "Written by trapeze farm";

/// The scripts that all schedulers call: DIR/render FRAME TILE, and DIR/merge FRAME where there are tiles.
std::vector<FarmFile> common_files(const FarmJob& job);

/// Slurm 20.02 or later: DIR/submit submits arrays of tasks, and a merge for each frame that runs after them.
std::vector<FarmFile> slurm_files(const FarmJob& job);
/// GNU parallel: DIR/run, and its lists of commands.
std::vector<FarmFile> parallel_files(const FarmJob& job);
/// Open Job Description, jobtemplate-2023-09: DIR/template.json. `here`: the folder in which the job is made.
std::vector<FarmFile> open_job_files(const FarmJob& job, const std::string& here);

}  // namespace trapeze
