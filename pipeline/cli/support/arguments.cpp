#include "pipeline/cli/support/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "core/simd/simd_limit.h"
#include "pipeline/cli/pages/pages.h"
#include "pipeline/cli/support/command_options.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/modern_spelling.h"
#include "pipeline/cli/support/revision.h"
#include "pipeline/cli/support/standard_streams.h"
#include "pipeline/cli/support/terminal.h"
#include "pipeline/frame/safe_mode.h"
#include "pipeline/frame/version.h"
#include "sample/sampler_list.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

struct CommandRow {
    const char* name;
    Command command;
    void (*add_options)(CLI::App& app, Arguments& arguments);
    const char* about;
};

constexpr CommandRow kCommands[] = {
    {"render", Command::Render, add_render_options, "renders scenes"},
    {"merge", Command::Merge, add_merge_options, "joins the tiles of a picture that --tiles has divided"},
    {"farm", Command::Farm, add_farm_options,
     "writes the files of a job that renders frames and tiles by Slurm, GNU parallel or Open Job Description"},
    {"check", Command::Check, add_check_options,
     "reads scenes and reports all that is wrong, missing or not supported; renders nothing"},
    {"info", Command::Info, add_info_options, "says what is in scenes"},
    {"cat", Command::Cat, add_cat_options,
     "writes scenes as one RIB file: ASCII or binary, archives read, conditions resolved"},
    {"compare", Command::Compare, add_compare_options,
     "measures visibility methods side by side on a scene: times, counts, errors"},
    {"scene", Command::Scene, add_scene_options, "writes a scene made for measurements, of any size, as RIB"},
    {"study", Command::Study, add_study_options,
     "repeats a table or figure of the micropolygon ray tracing paper on this machine"},
    {"shader", Command::Shader, add_shader_options, "checks a shader's source, and says what it takes"},
    {"compliance", Command::Compliance, add_compliance_options,
     "writes what of the RenderMan Interface is supported, as Markdown"},
};

/// Whether the methods and patterns asked for go together; says what is wrong.
bool samplers_are_right(const Arguments& a, std::string* error) {
    if (a.command != Command::Compare) return choose_sampler(a.sampler, a.pattern, error).has_value();
    return a.compare.samplers.empty() || parse_samplers(a.compare.samplers, a.pattern, error);
}

/// Whether two names are of the same file, if it exists.
bool is_one_file(const std::string& a, const std::string& b) {
    std::error_code failed;
    return !a.empty() && !b.empty() && (a == b || (std::filesystem::equivalent(a, b, failed) && !failed));
}

/// Files that would be written over each other or over what is read. `cat` may write over its input, which it
/// has read by then.
bool outputs_are_apart(const Arguments& a, std::string* error) {
    std::vector<std::pair<const char*, std::string>> outputs;
    if (a.command == Command::Render) outputs = {{"-o", a.output}, {"--stats", a.stats_file}};
    if (a.command == Command::Compare)
        outputs = {{"--report", a.compare.report}, {"--json", a.compare.json}, {"--csv", a.compare.csv}};
    if (a.command == Command::Study)
        outputs = {{"--report", a.study.report}, {"--json", a.study.json}, {"--csv", a.study.csv}};
    if (a.command == Command::Merge) outputs = {{"-o", a.output}};
    for (size_t i = 0; i < outputs.size(); ++i)
        for (size_t k = 0; k < i; ++k)
            if (is_one_file(outputs[k].second, outputs[i].second) && !outputs[k].second.starts_with("/dev/"))
                *error = std::string(outputs[k].first) + " and " + outputs[i].first + " name the same file";
    std::vector<std::string> inputs = a.command == Command::Merge ? a.merge.tiles : a.inputs;
    if (a.command == Command::Compare && !a.compare.replay.empty()) inputs.push_back(a.compare.replay);
    for (const auto& [option, file] : outputs)
        for (const std::string& input : inputs)
            if (is_one_file(file, input) && !file.starts_with("/dev/"))
                *error = std::string(option) + ": \"" + file + "\" is an input, which would be written over";
    return error->empty();
}

/// Where there is something to do: scenes, or what was recorded of them.
bool has_work(const Arguments& a, std::string* error) {
    if (a.command != Command::Compare || a.compare.replay.empty() != a.inputs.empty()) return true;
    *error = a.inputs.empty() ? "compare needs SCENE.rib, or --replay FILE.json"
                              : "--replay repeats the scenes that FILE.json names; SCENE.rib is one too many";
    return false;
}

bool crop_is_right(const Arguments& a, std::string* error) {
    if (!a.crop || ((*a.crop)[0] < (*a.crop)[1] && (*a.crop)[2] < (*a.crop)[3])) return true;
    *error = "--crop: X0 must be less than X1, and Y0 less than Y1";
    return false;
}

/// Whether both options that choose a tile are there, and the grid has the tile.
bool tile_is_right(const Arguments& a, std::string* error) {
    if (a.tiles && a.tile_number == 0) *error = "--tiles needs --tile, the number of the tile to render";
    if (!a.tiles && a.tile_number > 0) *error = "--tile needs --tiles, the grid of tiles that it is one of";
    if (const auto tile = a.tile(); tile && tile->number > tile->count())
        *error = "--tile: " + std::to_string(tile->number) + " is not a tile of " +
                 std::to_string(tile->columns) + "x" + std::to_string(tile->rows) + ", which are " +
                 std::to_string(tile->count());
    return error->empty();
}

/// The environment's word counts as the command line's. False, and why, when it cannot.
bool choose_safe_mode(Arguments& a, std::string* error) {
    a.safe = a.safe || safe_by_environment();
    if (!a.safe) return true;
    if (a.allow_programs) {
        *error = "--allow-programs and --safe (or TRAPEZE_SAFE) exclude each other";
        return false;
    }
    if (a.memory_bytes == 0) a.memory_bytes = safe_memory_budget();
    if (!a.time_limit) a.time_limit = kSafeSeconds;
    return true;
}

/// Whether -o is a file's name: pictures cannot go to standard output. All of these functions say why not.
bool output_is_a_file(const Arguments& a, std::string* error) {
    if ((a.command != Command::Render && a.command != Command::Merge) || a.output != "-") return true;
    *error =
        "-o -: pictures are not written to standard output, for they are whole or not at all; name a file";
    return false;
}

/// What is gone on with is read again.
bool can_be_resumed(const Arguments& a, std::string* error) {
    const bool saves = a.checkpoint || a.resume;
    if (saves && std::ranges::find(a.inputs, "-") != a.inputs.end())
        *error = "--checkpoint and --resume need files: standard input cannot be read again";
    return error->empty();
}

/// What is wrong with options that are right each by itself; empty: nothing. Also sets what --safe implies.
std::string contradiction(Arguments& a) {
    std::string error;
    static_cast<void>(choose_safe_mode(a, &error) && output_is_a_file(a, &error) && has_work(a, &error) &&
                      samplers_are_right(a, &error) && crop_is_right(a, &error) && tile_is_right(a, &error) &&
                      outputs_are_apart(a, &error) && can_be_resumed(a, &error));
    return error;
}

/// Whether messages shall be JSON: asked of words that may be wrong otherwise.
bool wants_json(const std::vector<std::string>& words) {
    std::string progress;
    for (size_t i = 0; i < words.size(); ++i) {
        if (words[i].starts_with("--progress=")) progress = words[i].substr(11);
        if (words[i] == "--progress" && i + 1 < words.size()) progress = words[i + 1];
    }
    return progress == "json";
}

/// What --version prints: the version, and which instruction sets this build has vector code for.
std::string version_text() {
    std::string text = std::string("Trapeze ") + kVersion + " (" + revision() + ")\ninstruction sets:";
    const std::vector<std::string_view> compiled = compiled_simd_names();
    for (const std::string_view name : compiled) text += " " + std::string(name);
    if (compiled.size() + 1 < simd_names().size())
        text += compiled.empty() ? " none" : " (of the machine that built it; it runs on no lesser one)";
    return text;
}

/// Reports a usage error as the command line wants its messages, and returns the exit code.
int usage_error(const std::string& text, const std::vector<std::string>& words) {
    const bool json = wants_json(words);
    Terminal({json ? ProgressStyle::Json : ProgressStyle::None, true, false})
        .show({Severity::Error,
               text + (json ? "" : "\nRun with --help for more information."),
               json ? "" : "trapeze",
               {},
               {}});
    return kExitUsage;
}

/// Prints a manual page or completions, or says why not.
int print_page(const CLI::App& app, const std::vector<std::string>& words) {
    std::string problem;
    const std::string page = page_for(words, app, kVersion, &problem);
    if (!problem.empty()) return usage_error(problem, words);
    print_text(page);
    return kExitOk;
}

}  // namespace

bool is_command(std::string_view name) {
    return std::ranges::any_of(kCommands, [&](const CommandRow& row) { return row.name == name; });
}

std::string parse_more_of_compare(const std::vector<std::string>& words, Arguments& arguments) {
    CLI::App app;
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    add_compare_options(app, arguments);
    try {
        app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError& error) {
        return error.what();
    }
    return contradiction(arguments);
}

std::optional<int> parse_arguments(int argc, char** argv, Arguments& arguments) {
    CLI::App app{
        "Trapeze: a Reyes renderer that samples micropolygons by ray tracing.\n"
        "RIB scenes in, EXR pictures out."};
    app.name("trapeze");
    app.footer(
        std::string(kExitCodeHelp) +
        "\n`trapeze help COMMAND` is `trapeze COMMAND --help`. RenderMan programs' spellings are accepted:\n"
        "-progress -Progress -t:N -res W H -crop X0 X1 Y0 Y1 -frames A B -d DRIVER.");
    app.set_version_flag("--version", version_text());
    app.require_subcommand(1);
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    for (const CommandRow& row : kCommands) {
        CLI::App* const command = app.add_subcommand(row.name, row.about);
        command->footer(kExitCodeHelp);
        row.add_options(*command, arguments);
        command->callback([&arguments, &row] { arguments.command = row.command; });
    }

    arguments.words.assign(argv + 1, argv + argc);
    const std::vector<std::string> words = modern_spelling(arguments.words);
    if (asks_for_page(arguments.words)) return print_page(app, arguments.words);
    if (argc > 2 && std::string_view(argv[1]) == "help" && !is_command(argv[2]))
        return usage_error("there is no command \"" + std::string(argv[2]) + "\"", words);
    try {
        app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // backwards, as CLI11 takes them
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0) return usage_error(error.what(), words);
        std::ostringstream text;
        app.exit(error, text, text);
        print_text(text.str());
        return kExitOk;
    }
    if (const std::string error = contradiction(arguments); !error.empty()) return usage_error(error, words);
    return {};
}

}  // namespace trapeze
