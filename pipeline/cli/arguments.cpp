#include "pipeline/cli/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "core/simd_limit.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/compare/sampler_list.h"
#include "pipeline/frame/version.h"
#include "pipeline/study/study.h"
#include "sample/visibility_method.h"

namespace trapeze {
namespace {

const std::vector<std::string> kCommands = {"render", "check", "info",   "cat",       "compare",
                                            "scene",  "study", "shader", "compliance"};

bool is_number(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789.+-eE") == std::string::npos;
}

/// Takes the words after args[i] that belong to it.
std::vector<std::string> take(std::vector<std::string>& args, size_t i, size_t count) {
    count = std::min(count, args.size() - i - 1);
    const auto begin = args.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    std::vector<std::string> taken(begin, begin + static_cast<std::ptrdiff_t>(count));
    args.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
    return taken;
}

/// An option whose text is read by one of parse_values.h's functions.
template <class Value, class Parse>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Value& value, Parse parse,
                        const std::string& help, const std::string& form) {
    return app
        .add_option_function<std::string>(
            name,
            [&value, parse, form](const std::string& text) {
                const auto parsed = parse(text);
                if (!parsed) throw CLI::ValidationError("\"" + text + "\" is not " + form);
                value = *parsed;
            },
            help)
        ->type_name(form);
}

void add_inputs(CLI::App& app, Arguments& a) {
    app.add_option("scenes", a.inputs, "RIB files, read one after another as one stream; - is standard input")
        ->required()
        ->type_name("SCENE.rib");
    app.add_option("--option", a.first_rib,
                   "RIB to execute before the scenes, such as 'PixelSamples 8 8'; may be repeated")
        ->allow_extra_args(false)
        ->type_name("RIB");
    app.add_flag("--allow-programs", a.allow_programs,
                 "runs the programs that scenes name (Procedural \"RunProgram\")");
    app.add_flag("--no-color{false}", a.color, "no colours in messages (also: NO_COLOR in the environment)");
}

/// " name:key=a|b,key=..." for each row of a table.
template <class Row>
std::string listed(const std::vector<Row>& table) {
    std::string text;
    for (const Row& row : table) {
        text += " " + std::string(row.name);
        char separator = ':';
        for (const SpecOption& option : row.options) {
            text += separator + std::string(option.name) + "=";
            for (const std::string_view value : option.values)
                text += (value == option.values.front() ? "" : "|") + std::string(value);
            separator = ',';
        }
    }
    return text;
}

void add_sampler_option(CLI::App& app, Arguments& a) {
    const auto is_method = [](const std::string& text) {
        std::string error;
        choose_sampler(text, "", &error);
        return error;
    };
    app.add_option("--sampler", a.sampler, "visibility method, one of:" + listed(visibility_methods()))
        ->check(is_method)
        ->type_name("METHOD")
        ->capture_default_str();
}

void add_pattern_option(CLI::App& app, Arguments& a) {
    const auto is_pattern = [](const std::string& text) {
        std::string error;
        parse_pattern(text, &error);
        return error;
    };
    app.add_option(
           "--pattern", a.pattern,
           "sample pattern (default: what the method was made for), one of:" + listed(sample_patterns()))
        ->check(is_pattern)
        ->type_name("PATTERN");
}

void add_simd_option(CLI::App& app, Arguments& a) {
    std::string names;
    for (const std::string_view name : simd_names()) names += " " + std::string(name);
    app.add_option("--simd", a.simd, "the best instruction set to use, one of:" + names)
        ->type_name("NAME")
        ->capture_default_str();
}

void add_memory_option(CLI::App& app, Arguments& a, const std::string& what_for) {
    add_parsed(app, "--memory", a.memory_bytes, parse_size, what_for + " (default: 3/4 of the machine's)",
               "SIZE like 4G");
}

/// How the machine is used, and what is said meanwhile.
void add_work_options(CLI::App& app, Arguments& a) {
    add_simd_option(app, a);
    app.add_option("-t,--threads", a.threads, "threads; 0: all, -N: all but N")
        ->check(CLI::Range(-1024, 1024))
        ->type_name("N");
    app.add_option("--progress", a.progress, "how to show progress")
        ->check(CLI::IsMember({"auto", "bar", "lines", "json", "prman", "none"}))
        ->capture_default_str();
    add_memory_option(app, a, "for grids and tree, and as much for a file and its scene");
    app.add_flag("-q,--quiet", a.quiet, "only errors");
}

/// What says how a frame is made, for all commands that make one.
void add_frame_options(CLI::App& app, Arguments& a) {
    add_parsed(app, "-r,--resolution", a.resolution, parse_resolution, "size of the whole picture", "WxH");
    app.add_option("--crop", a.crop, "part of the picture to make, as fractions: x0 x1 y0 y1")
        ->check(CLI::Range(0.0f, 1.0f))
        ->type_name("X0 X1 Y0 Y1");
    app.add_option("--shading-rate", a.shading_rate, "pixel area of a micropolygon, everywhere")
        ->check(CLI::Range(1e-4f, 1e6f))
        ->type_name("AREA");
    add_pattern_option(app, a);
    app.add_option("--seed", a.seed, "of all random numbers")->type_name("N");
    app.add_flag("--strict", a.strict, "warnings count as errors for the exit code");
    add_work_options(app, a);
}

void add_render_options(CLI::App& app, Arguments& a) {
    app.add_option("-o,--output", a.output,
                   "replaces the first Display's name; ####, %04d and <frame> are the frame's number")
        ->type_name("FILE");
    app.add_option("-d,--driver", a.driver, "replaces every Display's driver; null writes nothing")
        ->type_name("DRIVER");
    add_sampler_option(app, a);
    add_parsed(app, "--samples", a.samples, parse_samples, "samples per pixel", "N|NxM");
    add_frame_options(app, a);
    app.add_option("--transfer", a.transfer,
                   "how 8- and 16-bit files stand for light, written and read (default: linear, or the "
                   "scene's Option \"color\" \"transfer\")")
        ->check(CLI::IsMember({"linear", "srgb", "auto"}));
    add_parsed(app, "-f,--frames", a.frames, parse_frames, "frames to render", "LIST like 1-10,20");
    app.add_option("--stats", a.stats_file, "writes statistics as JSON")->type_name("FILE.json");
    app.add_option("--regions", a.regions_at_least, "split the picture into at least so many regions")
        ->check(CLI::Range(1, 100000))
        ->type_name("N");
    // PRMan's -recover: there is nothing to resume yet; accepted so that farm scripts run.
    static_cast<void>(app.add_option("--recover")->group(""));
}

void add_compare_options(CLI::App& app, Arguments& a) {
    CompareArguments& c = a.compare;
    app.add_option("--samplers", c.samplers,
                   "visibility methods, separated by spaces or semicolons (commas are part of a method: "
                   "\"raytrace interval raytrace:tree=paper,bundle=off\"); default: every method as it is by "
                   "default, bruteforce only where the scene is small. There are:" +
                       listed(visibility_methods()))
        ->type_name("LIST");
    add_parsed(app, "--samples", c.samples, parse_samples_list,
               "samples per pixel to compare at (default: the scene's)", "LIST like 1x1,4x4,8x8");
    app.add_option("--reference", c.reference_side, "NxN samples per pixel of the picture that errors are to")
        ->check(CLI::Range(1, 64))
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--repeat", c.rounds, "rounds in which every method takes its turn; medians are reported")
        ->check(CLI::Range(1, 1000))
        ->type_name("R")
        ->capture_default_str();
    app.add_option("--report", c.report, "writes a report with pictures and charts, one file")
        ->type_name("FILE.html");
    app.add_option("--json", c.json, "writes every figure as JSON")->type_name("FILE.json");
    app.add_option("-o,--output", c.folder, "writes pictures and heat maps as OpenEXR into a folder")
        ->type_name("DIR");
    add_frame_options(app, a);
}

void add_scene_options(CLI::App& app, Arguments& a) {
    std::string names;
    std::vector<std::string> known;
    for (const std::string_view name : scene_names()) known.emplace_back(name), names += " " + known.back();
    SceneParameters& p = a.scene.parameters;
    app.add_option("name", a.scene.name, "one of:" + names)
        ->required()
        ->check(CLI::IsMember(known))
        ->type_name("NAME");
    app.add_option("--scale", p.scale, "multiplies the number of micropolygons")
        ->check(CLI::Range(1e-3, 1e3))
        ->type_name("S")
        ->capture_default_str();
    app.add_option("--motion", p.motion, "multiplies the motion; 0: none")
        ->check(CLI::Range(0.0, 1e3))
        ->type_name("M")
        ->capture_default_str();
    app.add_option("--defocus", p.defocus, "multiplies the lens; 0: a pinhole")
        ->check(CLI::Range(0.0, 1e3))
        ->type_name("D")
        ->capture_default_str();
    app.add_option("--shading-factor", p.shading_rate, "multiplies the scene's ShadingRate")
        ->check(CLI::Range(1e-3, 1e3))
        ->type_name("F")
        ->capture_default_str();
    add_parsed(app, "-r,--resolution", a.resolution, parse_resolution, "size of the picture", "WxH");
    app.add_option("-o,--output", a.output, "writes to a file instead of standard output")
        ->type_name("FILE.rib");
}

void add_study_options(CLI::App& app, Arguments& a) {
    StudyArguments& s = a.study;
    std::string names;
    std::vector<std::string> known;
    for (const StudyName& study : study_names()) {
        known.emplace_back(study.name);
        names += "\n  " + known.back() + ": " + std::string(study.about);
    }
    app.add_option("name", s.name, "one of:" + names)
        ->required()
        ->check(CLI::IsMember(known))
        ->type_name("NAME");
    app.add_flag("--quick", s.quick, "a quarter of the pixels and fewer samples: minutes instead of an hour");
    app.add_option("--repeat", s.rounds, "rounds in which every method takes its turn; medians are reported")
        ->check(CLI::Range(1, 1000))
        ->type_name("R")
        ->capture_default_str();
    app.add_option("--report", s.report, "writes a report with tables, plots and checks, one file")
        ->type_name("FILE.html");
    app.add_option("--json", s.json, "writes every figure as JSON")->type_name("FILE.json");
    add_work_options(app, a);
}

void add_cat_options(CLI::App& app, Arguments& a) {
    app.add_option("-o,--output", a.output, "the file to write; - is standard output, the default")
        ->type_name("FILE.rib");
    app.add_flag("-b,--binary", a.cat.binary, "writes the binary encoding");
    app.add_flag("-z,--gzip", a.cat.gzip, "compresses; also when FILE ends with .gz");
    app.add_flag("-q,--quiet", a.quiet, "only errors");
    app.add_flag("--keep-archives", a.cat.keep_archives,
                 "leaves ReadArchive as it is, instead of the archive's requests in its place");
}

void add_shader_options(CLI::App& app, Arguments& a) {
    ShaderArguments& s = a.shader;
    app.add_option("file", s.file, "a shader's source; - is standard input")
        ->required()
        ->type_name("FILE.sl");
    app.add_option("-I,--include", s.include_folders,
                   "a folder to search for included files; may be repeated")
        ->allow_extra_args(false)
        ->type_name("DIR");
    app.add_option("-D,--define", s.defines, "defines a macro, as 1 if no text is given; may be repeated")
        ->allow_extra_args(false)
        ->type_name("NAME[=TEXT]");
    app.add_flag("--params", s.parameters, "prints the parameters: storage, type, name, default");
    app.add_flag("--ir", s.code, "prints the code that the grid machine runs");
    app.add_flag("--strict", a.strict, "warnings count as errors for the exit code");
    app.add_flag("-q,--quiet", a.quiet, "only errors");
    app.add_flag("--no-color{false}", a.color, "no colours in messages (also: NO_COLOR in the environment)");
}

/// Whether the methods and patterns asked for go together; says what is wrong.
bool samplers_are_right(const Arguments& a, std::string* error) {
    if (a.command != Command::Compare) return choose_sampler(a.sampler, a.pattern, error).has_value();
    return a.compare.samplers.empty() || parse_samplers(a.compare.samplers, a.pattern, error);
}

}  // namespace

std::vector<std::string> modern_spelling(std::vector<std::string> args) {
    for (size_t i = 0; i < args.size(); ++i) {
        std::string& arg = args[i];
        if (arg == "-progress") {
            arg = "--progress=auto";
        } else if (arg == "-Progress") {
            arg = "--progress=prman";
        } else if (arg.starts_with("-t:")) {
            arg = "--threads=" + (arg == "-t:all" ? "0" : arg.substr(3));
        } else if (arg == "-res" || arg == "--res") {
            const auto size = take(args, i, 2);
            args[i] = "--resolution=" + (size.size() == 2 ? size[0] + "x" + size[1] : std::string());
        } else if (arg == "-crop") {
            arg = "--crop";
        } else if (arg == "-recover") {
            take(args, i, 1);
            args.erase(args.begin() + static_cast<std::ptrdiff_t>(i--));
        } else if (arg == "-frames" || arg == "-framelist") {
            const bool pair = i + 2 < args.size() && is_number(args[i + 1]) && is_number(args[i + 2]);
            const auto frames = take(args, i, pair ? 2 : 1);
            args[i] = "--frames=" + (frames.empty() ? std::string()
                                     : pair         ? frames[0] + "-" + frames[1]
                                                    : frames[0]);
        }
    }
    const auto is_command = [](const std::string& a) {
        return std::find(kCommands.begin(), kCommands.end(), a) != kCommands.end();
    };
    const bool asks_for_program =
        !args.empty() && (args[0] == "--help" || args[0] == "-h" || args[0] == "--version");
    if (!args.empty() && !is_command(args[0]) && !asks_for_program) args.insert(args.begin(), "render");
    return args;
}

std::optional<int> parse_arguments(int argc, char** argv, Arguments& arguments) {
    CLI::App app{
        "Trapeze: a Reyes renderer that samples micropolygons by ray tracing.\n"
        "RIB scenes in, EXR pictures out."};
    app.name("trapeze");
    app.footer(std::string(kExitCodeHelp) +
               "\nRenderMan programs' spellings are accepted: -progress -Progress -t:N -res W H "
               "-crop X0 X1 Y0 Y1 -frames A B -d DRIVER.");
    app.set_version_flag("--version", std::string("Trapeze ") + kVersion);
    app.require_subcommand(1);

    CLI::App* render = app.add_subcommand("render", "renders scenes");
    CLI::App* check = app.add_subcommand(
        "check", "reads scenes and reports all that is wrong or not supported; renders nothing");
    CLI::App* info = app.add_subcommand("info", "says what is in scenes");
    CLI::App* cat = app.add_subcommand(
        "cat", "writes scenes as one RIB file: ASCII or binary, archives read, conditions resolved");
    CLI::App* compare = app.add_subcommand(
        "compare", "measures visibility methods side by side on a scene: times, counts, errors");
    CLI::App* scene =
        app.add_subcommand("scene", "writes a scene made for measurements, of any size, as RIB");
    CLI::App* study = app.add_subcommand(
        "study", "repeats a table or figure of the micropolygon ray tracing paper on this machine");
    CLI::App* shader = app.add_subcommand("shader", "checks a shader's source, and says what it takes");
    CLI::App* compliance =
        app.add_subcommand("compliance", "writes what of the RenderMan Interface is supported, as Markdown");
    compliance
        ->add_option("--scenes", arguments.scenes_folder,
                     "where tiny and gallery lie, whose RIB files show requests")
        ->capture_default_str()
        ->type_name("DIR");
    for (CLI::App* command : {render, check, info, cat, compare}) {
        add_inputs(*command, arguments);
        command->footer(kExitCodeHelp);
    }
    add_render_options(*render, arguments);
    add_cat_options(*cat, arguments);
    add_compare_options(*compare, arguments);
    add_scene_options(*scene, arguments);
    add_study_options(*study, arguments);
    add_shader_options(*shader, arguments);
    shader->footer(kExitCodeHelp);
    scene->footer(kExitCodeHelp);
    study->footer(kExitCodeHelp);
    for (CLI::App* command : {check, info, cat})
        add_memory_option(*command, arguments, "for a file and for its scene, each");
    check->add_flag("--strict", arguments.strict,
                    "warnings, and what has no effect, count as errors for the exit code");

    std::vector<std::string> words = modern_spelling({argv + 1, argv + argc});
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    try {
        app.parse(words);
    } catch (const CLI::ParseError& error) {
        const int code = app.exit(error, std::cout, std::cerr);
        return code == 0 ? kExitOk : kExitUsage;
    }
    if (check->parsed()) arguments.command = Command::Check;
    if (info->parsed()) arguments.command = Command::Info;
    if (cat->parsed()) arguments.command = Command::Cat;
    if (compare->parsed()) arguments.command = Command::Compare;
    if (scene->parsed()) arguments.command = Command::Scene;
    if (study->parsed()) arguments.command = Command::Study;
    if (compliance->parsed()) arguments.command = Command::Compliance;
    if (shader->parsed()) arguments.command = Command::Shader;
    if (arguments.command == Command::Render && arguments.output == "-") {
        std::cerr
            << "trapeze: error: -o -: pictures are not written to standard output, for they are whole or "
               "not at all; name a file\n";
        return kExitUsage;
    }
    std::string error;
    if (!samplers_are_right(arguments, &error)) {
        std::cerr << "trapeze: error: " << error << "\n";
        return kExitUsage;
    }
    return {};
}

}  // namespace trapeze
