/// The command line as a value.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/colors/color_request.h"
#include "core/picture_tile.h"
#include "pipeline/cli/support/parse_values.h"
#include "pipeline/preview/viewer_address.h"
#include "pipeline/study/scenes/scenes.h"

namespace trapeze {

enum class Command { Render, Check, Info, Cat, Compare, Scene, Study, Shader, Compliance, Merge, Farm };

/// What `trapeze compare` alone has.
struct CompareArguments {
    std::string samplers;                      ///< as parse_samplers() reads it; empty: all
    std::vector<std::pair<int, int>> samples;  ///< rates to compare at; empty: the scene's own
    int reference_side = 32;
    int rounds = 3;
    std::string report, json, csv;  ///< files; empty: none
    std::string folder;             ///< for pictures; empty: none
    std::string replay;             ///< a JSON of compare that is repeated; empty: none
};

/// What `trapeze scene` alone has; the picture's size is Arguments::resolution.
struct SceneArguments {
    std::string name;
    SceneParameters parameters;
};

/// What `trapeze study` alone has.
struct StudyArguments {
    std::string name;
    bool quick = false;
    int rounds = 3;
    std::string report, json, csv;    ///< files; empty: none
    std::vector<std::string> scenes;  ///< empty: all
    std::string bart;                 ///< the folder of BART's scenes; empty: there is none
};

/// What `trapeze cat` alone has; the file to write is Arguments::output, empty or "-": standard output.
struct CatArguments {
    bool binary = false;
    bool gzip = false;           ///< also when the output's name ends with .gz
    bool keep_archives = false;  ///< ReadArchive stays as it is
};

/// What `trapeze merge` alone has; the file to write is Arguments::output.
struct MergeArguments {
    std::vector<std::string> tiles;  ///< files
    bool allow_missing = false;
};

/// What `trapeze farm` alone has; its folder is Arguments::output.
struct FarmArguments {
    std::string scheduler;                     ///< slurm, parallel or openjd
    std::optional<std::pair<int, int>> tiles;  ///< columns and rows of each frame
    std::string options;                       ///< for `trapeze render`, as a shell reads them
    int retries = 3;                           ///< of a task that a signal has killed
};

/// What `trapeze shader` alone has.
struct ShaderArguments {
    std::string file;  ///< - is standard input
    std::vector<std::string> include_folders;
    std::vector<std::string> defines;  ///< NAME or NAME=TEXT
    bool parameters = false;           ///< print them
    bool code = false;
};

/// All options and words of a command line. Which of them a command reads, command_options.cpp says.
struct Arguments {
    Command command = Command::Render;
    std::vector<std::string> words;  ///< as they were given, without the program's name
    std::vector<std::string> inputs;
    std::string output;  ///< empty: as the scene says
    std::string aovs;    ///< as displays_of_aovs() reads it; empty: none
    std::string driver;  ///< replaces every Display's type; "null" writes nothing
    std::optional<std::pair<int, int>> resolution;
    std::optional<SampleRates> samples;
    std::optional<float> variance;             ///< of pixels, that adaptive sampling is to reach
    std::optional<std::array<float, 4>> crop;  ///< x0 x1 y0 y1, as parts of the picture
    std::optional<std::pair<int, int>> tiles;  ///< columns and rows that the crop is divided into
    int tile_number = 0;                       ///< of them, the one to make, from 1; 0: not said
    std::optional<float> shading_rate;
    int most_layers = 0;  ///< of each sample; 0: as the scene says
    std::optional<std::vector<FrameRange>> frames;
    std::string sampler = "raytrace";
    std::vector<std::string> plugins;  ///< files of visibility methods, which have been loaded
    std::string pattern;               ///< empty: the sampler's natural one
    std::string transfer;              ///< as transfer_named() reads it; empty: as the scene says
    ColorRequest colors;               ///< in place of the scene's
    std::string simd = "best";         ///< as limit_simd() reads it
    int threads = 0;                   ///< 0: all; negative: all but so many
    uint32_t seed = 0;
    size_t memory_bytes = 0;  ///< for grids and trees; 0: three quarters of the machine's memory
    int regions_at_least = 1;
    std::string cull_hidden = "auto";
    std::string progress = "auto";
    std::string stats_file;
    CatArguments cat;
    CompareArguments compare;
    SceneArguments scene;
    StudyArguments study;
    ShaderArguments shader;
    MergeArguments merge;
    FarmArguments farm;
    std::string scenes_folder = "scenes";  ///< of `trapeze compliance`: tiny and gallery are in it
    std::vector<std::string> first_rib;    ///< lines of RIB that are executed before the inputs
    bool allow_programs = false;           ///< whether programs that scenes name are run
    double program_seconds = 10;           ///< seconds without an answer after which a program is ended
    bool safe = false;                     ///< scenes are confined (core/files/access.h)
    std::optional<double> time_limit;      ///< seconds
    std::optional<double> checkpoint;      ///< seconds from one save to the next; nothing: none are asked for
    bool resume = false;                   ///< goes on with what was saved
    std::vector<ViewerAddress> previews;   ///< viewers that show pictures while they are made
    bool strict = false, quiet = false, color = true;

    /// The tile to make; nothing: the whole crop.
    std::optional<PictureTile> tile() const {
        return tiles ? std::optional(PictureTile{tiles->first, tiles->second, tile_number}) : std::nullopt;
    }
};

bool is_command(std::string_view name);

/// Reads the command line. When it says to stop (help, version, usage errors), prints what is asked for and
/// returns the exit code; else nothing.
std::optional<int> parse_arguments(int argc, char** argv, Arguments& arguments);

/// Reads a command's options and words into arguments that have been read before, as if they stood on that
/// command line, too. Returns what is wrong, or nothing.
std::string parse_more_of_compare(const std::vector<std::string>& words, Arguments& arguments);

}  // namespace trapeze
