#include "pipeline/cli/support/command_options.h"

#include "core/scene/layer_limit.h"
#include "core/simd/simd_limit.h"
#include "pipeline/cli/support/named_aovs.h"
#include "pipeline/cli/support/option_kinds.h"
#include "pipeline/cli/support/recorded_options.h"
#include "pipeline/study/study_names.h"
#include "sample/load_plugin.h"
#include "sample/sampler_list.h"
#include "sample/visibility.h"

namespace trapeze {
namespace {

CLI::Option* add_file(CLI::App& app, const std::string& name, std::string& file, const std::string& help,
                      const std::string& form) {
    return app.add_option(name, file, help)->check(a_name())->type_name(form);
}

template <class Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, Number& value, Number low, Number high,
                        const std::string& help, const std::string& form) {
    return app.add_option(name, value, help)->check(in_range(low, high))->type_name(form);
}

/// Loads each plugin as soon as its option is read: those after it in the table may name its method. So it is
/// the first of a command's.
void add_plugin_option(CLI::App& app, Arguments& a) {
    const auto load = [&a](const std::vector<std::string>& files) {
        for (const std::string& file : files)
            if (std::string error; !load_plugin(file, &error)) throw CLI::ValidationError("--plugin", error);
        a.plugins = files;
    };
    app.add_option_function<std::vector<std::string>>(
           "--plugin", load,
           "loads a visibility method from a shared object, which is then one of those to choose; may be "
           "repeated")
        ->allow_extra_args(false)
        ->check(a_name())
        ->type_name("FILE.so");
}

void add_color_option(CLI::App& app, Arguments& a) {
    app.add_flag("--no-color{false}", a.color, "no colours in messages (also: NO_COLOR in the environment)");
}

void add_safe_option(CLI::App& app, Arguments& a) {
    app.add_flag(
        "--safe", a.safe,
        "for scenes from strangers: nothing is run, files are read below the scene's and the working "
        "folder and those searched by --option, and written below the working folder or to -o; "
        "memory and time are bounded (also: TRAPEZE_SAFE=1 in the environment)");
}

void add_inputs(CLI::App& app, Arguments& a) {
    app.add_option("scenes", a.inputs, "RIB files, read one after another as one stream; - is standard input")
        ->required()
        ->check(a_name())
        ->type_name("SCENE.rib");
    app.add_option("--option", a.first_rib,
                   "RIB to execute before the scenes, such as 'PixelSamples 8 8'; may be repeated")
        ->allow_extra_args(false)
        ->type_name("RIB");
    app.add_flag("--allow-programs", a.allow_programs,
                 "runs the programs that scenes name (Procedural \"RunProgram\")");
    add_parsed(app, "--program-timeout", a.program_seconds, parse_duration,
               "a program that says nothing for so long is ended (default: 10s)", "TIME like 10s",
               ", more than none (units s, m, h)");
    add_safe_option(app, a);
    add_parsed(app, "--time-limit", a.time_limit, parse_duration,
               "ends the work after so long, with exit code 8 (default under --safe: 10m)",
               "TIME like 90s, 5m, 2h", ", more than none (units s, m, h)");
    add_color_option(app, a);
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

/// For runs that may be broken off.
void add_checkpoint_options(CLI::App& app, Arguments& a) {
    add_parsed(app, "--checkpoint", a.checkpoint, parse_duration,
               "saves what is finished so often, for --resume, in the picture's name with .checkpoint behind",
               "TIME like 30s, 5m", ", more than none (units s, m, h)");
    app.add_flag("--resume", a.resume,
                 "goes on with what a run has saved that was broken off; saves every 5 minutes itself");
}

void add_preview_option(CLI::App& app, Arguments& a) {
    const auto read = [&a](const std::vector<std::string>& texts) {
        a.previews.clear();
        for (const std::string& text : texts) {
            const auto viewer = parse_viewer(text);
            if (!viewer)
                throw CLI::ValidationError("--preview",
                                           "\"" + text + "\" is not tev[:HOST:PORT], tev:PORT or web[:PORT]");
            a.previews.push_back(*viewer);
        }
    };
    app.add_option_function<std::vector<std::string>>(
           "--preview", read,
           "shows pictures while they are made: tev is sent them (to 127.0.0.1:14158), web serves a page "
           "that browsers of this machine can open; may be repeated")
        ->allow_extra_args(false)
        ->type_name("tev[:HOST:PORT]|web[:PORT]");
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
    add_parsed(app, "--memory", a.memory_bytes, parse_size,
               what_for + " (default: 3/4 of the machine's; under --safe at most 4G)", "SIZE like 4G",
               ", of 1 byte to 1e18 (units K, M, G, T)");
}

/// Files for the figures of commands that measure.
void add_figure_options(CLI::App& app, std::string& report, const char* about_report, std::string& json,
                        std::string& csv) {
    add_file(app, "--report", report, about_report, "FILE.html");
    add_file(app, "--json", json, "writes every figure as JSON", "FILE.json");
    add_file(app, "--csv", csv, "writes every figure as a table: comma-separated values", "FILE.csv");
}

/// How the machine is used, and what is said meanwhile.
void add_work_options(CLI::App& app, Arguments& a) {
    add_simd_option(app, a);
    add_number(app, "-t,--threads", a.threads, -1024, 1024, "threads; 0: all, -N: all but N", "N");
    app.add_option("--progress", a.progress, "how to show progress")
        ->check(CLI::IsMember({"auto", "bar", "lines", "json", "prman", "none"}))
        ->capture_default_str();
    add_memory_option(app, a, "for grids and tree, and as much for a file and its scene");
    app.add_flag("-q,--quiet", a.quiet, "only errors");
}

void add_resolution_option(CLI::App& app, Arguments& a, const std::string& help) {
    add_parsed(app, "-r,--resolution", a.resolution, parse_resolution, help, "WxH",
               ", each from 1 to " + std::to_string(kMostPixelsOfSide));
}

/// What says how a frame is made, for all commands that make one.
void add_frame_options(CLI::App& app, Arguments& a) {
    add_resolution_option(app, a, "size of the whole picture");
    app.add_option("--crop", a.crop, "part of the picture to make, as fractions: x0 x1 y0 y1")
        ->check(in_range(0.0f, 1.0f))
        ->type_name("X0 X1 Y0 Y1");
    app.add_option("--shading-rate", a.shading_rate, "pixel area of a micropolygon, everywhere")
        ->check(in_range(1e-4f, 1e6f))
        ->type_name("AREA");
    add_pattern_option(app, a);
    add_number(app, "--seed", a.seed, uint32_t{0}, ~uint32_t{0}, "of all random numbers", "N");
    app.add_flag("--strict", a.strict, "warnings count as errors for the exit code");
    add_work_options(app, a);
}

/// Adds the option of commands that measure methods in turns.
void add_rounds_option(CLI::App& app, int& rounds) {
    add_number(app, "--repeat", rounds, 1, 1000,
               "rounds in which every method takes its turn; medians are reported", "R")
        ->capture_default_str();
}

/// How colours become those of a screen. What is not given is as the scene's Option "ocio" says.
void add_color_options(CLI::App& app, ColorRequest& colors) {
    add_file(app, "--ocio", colors.config,
             "manages colours by a config of OpenColorIO (default: that of the scene's Option \"ocio\" "
             "\"config\", or of $OCIO where a view is asked for, or one with plain sRGB)",
             "FILE.ocio");
    const auto add_name = [&](const char* option, std::string& name, const char* help) {
        app.add_option(option, name, help)->check(a_name())->type_name("NAME");
    };
    add_name("--display", colors.display,
             "the config's display that 8- and 16-bit files are for (default: its first)");
    add_name("--view", colors.view, "the display's view that they show (default: its first)");
    add_name("--look", colors.look, "a look in place of the view's own");
}

/// What a comparison's figures follow from is as it was, and so cannot be given.
void add_replay_option(CLI::App& app, CompareArguments& c) {
    CLI::Option* const replay =
        add_file(app, "--replay", c.replay,
                 "repeats a comparison from its --json, with its scenes and options, and says which figures "
                 "and files are not as they were; times are not compared",
                 "FILE.json");
    for (const std::string_view option : kReplayedOptions)
        replay->excludes(app.get_option("--" + std::string(option)));
    app.get_option("scenes")->required(false);
}

}  // namespace

void add_variance_option(CLI::App& app, Arguments& a, const char* what) {
    app.add_option("--variance", a.variance, what)->check(in_range(1e-12f, 1e6f))->type_name("V");
}

void add_render_options(CLI::App& app, Arguments& a) {
    add_plugin_option(app, a);
    add_inputs(app, a);
    add_file(app, "-o,--output", a.output,
             "replaces the first Display's name; ####, %04d and <frame> are the frame's number, <tile> the "
             "tile's",
             "FILE");
    add_file(app, "-d,--driver", a.driver, "replaces every Display's driver; null writes nothing", "DRIVER");
    app.add_option(
           "--aov", a.aovs,
           "layers for the picture's OpenEXR file: albedo, N, P, z, id, motion, u, v, uv, alpha, crypto_object, "
           "crypto_material, crypto_asset, lightgroups, or variables of shaders, as color foo and float foo")
        ->check([](const std::string& text) {
            std::string error;
            displays_of_aovs(text, &error);
            return error;
        })
        ->type_name("LIST like albedo,N");
    add_sampler_option(app, a);
    add_parsed(app, "--samples", a.samples, parse_sample_rates,
               "samples per pixel; MIN..MAX: as many as --variance asks for", "N|NxM|MIN..MAX",
               ", each from 1 to 64; MAX is twice or four times MIN, as in 4x4..16x16");
    add_variance_option(
        app, a, "adaptive sampling: the variance of linear values that pixels are to have, as 0.0001");
    add_number(app, "--max-layers", a.most_layers, 1, static_cast<int>(kMostLayers),
               "a sample sees the nearest M layers of surfaces, as by Hider \"maxvpdepth\"", "M");
    add_frame_options(app, a);
    add_parsed(app, "--tiles", a.tiles, parse_tiles,
               "divides the picture, or its crop, into N columns and M rows, of which --tile is made",
               "NxM like 4x3", ", each from 1 to " + std::to_string(kMostTilesOfSide));
    add_number(
        app, "--tile", a.tile_number, 1, kMostTilesOfSide * kMostTilesOfSide,
        "the tile to make, from 1, row by row; its files have its number before their endings, or where "
        "names say <tile>",
        "K");
    app.add_option("--transfer", a.transfer,
                   "how 8- and 16-bit files stand for light, written and read (default: linear, or the "
                   "scene's Option \"color\" \"transfer\")")
        ->check(CLI::IsMember({"linear", "srgb", "auto"}));
    add_color_options(app, a.colors);
    add_checkpoint_options(app, a);
    add_preview_option(app, a);
    add_parsed(app, "-f,--frames", a.frames, parse_frames, "frames to render", "LIST like 1-10,20",
               " (ranges upwards, with a step as in 1-9x2)");
    add_file(app, "--stats", a.stats_file, "writes statistics as JSON", "FILE.json");
    add_number(app, "--regions", a.regions_at_least, 1, 100000,
               "split the picture into at least so many regions", "N");
    app.add_option(
           "--cull-hidden", a.cull_hidden,
           "leave what no sample sees unshaded: auto is on where shaders trace rays; the picture is the same")
        ->check(CLI::IsMember({"auto", "on", "off"}))
        ->capture_default_str();
    // PRMan's -recover: there is nothing to resume yet; accepted so that farm scripts run.
    static_cast<void>(app.add_option("--recover")->group(""));
}

void add_merge_options(CLI::App& app, Arguments& a) {
    app.add_option("tiles", a.merge.tiles, "OpenEXR files, each with a part of the picture, in any order")
        ->required()
        ->check(a_name())
        ->type_name("TILE.exr");
    add_file(app, "-o,--output", a.output, "the file to write", "FILE.exr")->required();
    app.add_flag(
        "--allow-missing", a.merge.allow_missing,
        "leaves what is in no tile empty, with a warning; else it is an error, and nothing is written");
    app.add_flag("-q,--quiet", a.quiet, "only errors");
    add_color_option(app, a);
}

void add_farm_options(CLI::App& app, Arguments& a) {
    app.add_option("scene", a.inputs, "scenes that are read one after the other, as by render")
        ->required()
        ->check(a_name())
        ->type_name("SCENE.rib");
    add_parsed(app, "-f,--frames", a.frames, parse_frames, "frames to render", "LIST like 1-10,20",
               " (ranges upwards, with a step as in 1-9x2)")
        ->required();
    add_parsed(app, "--tiles", a.farm.tiles, parse_tiles,
               "divides each frame into N columns and M rows, a task each, and joins them afterwards",
               "NxM like 2x2", ", each from 1 to " + std::to_string(kMostTilesOfSide));
    app.add_option("--for", a.farm.scheduler, "the scheduler that runs the job")
        ->check(CLI::IsMember({"slurm", "parallel", "openjd"}))
        ->required();
    add_file(app, "-o,--output", a.output, "folder of the job and its pictures (default: SCENE.farm)", "DIR");
    app.add_option("--with", a.farm.options,
                   "options for `trapeze render`, as one text: '--samples 8 --memory 8G'")
        ->type_name("OPTIONS");
    add_number(app, "--retries", a.farm.retries, 0, 1000,
               "under Slurm, a task whose process a signal has killed begins again so often", "N")
        ->capture_default_str();
    app.add_flag("-q,--quiet", a.quiet, "only errors");
    add_color_option(app, a);
}

void add_check_options(CLI::App& app, Arguments& a) {
    add_inputs(app, a);
    add_memory_option(app, a, "for a file and for its scene, each");
    app.add_flag("--strict", a.strict, "warnings, and what has no effect, count as errors for the exit code");
}

void add_info_options(CLI::App& app, Arguments& a) {
    add_inputs(app, a);
    add_memory_option(app, a, "for a file and for its scene, each");
}

void add_cat_options(CLI::App& app, Arguments& a) {
    add_inputs(app, a);
    add_file(app, "-o,--output", a.output, "the file to write; - is standard output, the default",
             "FILE.rib");
    app.add_flag("-b,--binary", a.cat.binary, "writes the binary encoding");
    app.add_flag("-z,--gzip", a.cat.gzip, "compresses; also when FILE ends with .gz");
    app.add_flag("-q,--quiet", a.quiet, "only errors");
    app.add_flag("--keep-archives", a.cat.keep_archives,
                 "leaves ReadArchive as it is, instead of the archive's requests in its place");
    add_memory_option(app, a, "for a file and for its scene, each");
}

void add_compare_options(CLI::App& app, Arguments& a) {
    CompareArguments& c = a.compare;
    add_plugin_option(app, a);
    add_inputs(app, a);
    app.add_option("--samplers", c.samplers,
                   "visibility methods, separated by spaces or semicolons (commas are part of a method: "
                   "\"raytrace interval raytrace:tree=paper,bundle=off\"); default: every method as it is by "
                   "default, bruteforce only where the scene is small. There are:" +
                       listed(visibility_methods()))
        ->check(a_name())
        ->type_name("LIST");
    add_parsed(app, "--samples", c.samples, parse_samples_list,
               "samples per pixel to compare at (default: the scene's)", "LIST like 1x1,4x4,8x8",
               ", each from 1 to 64");
    add_variance_option(app, a,
                        "a row of adaptive sampling, too: the variance that pixels are to have, as 0.0001");
    add_number(app, "--reference", c.reference_side, 1, 64,
               "NxN samples per pixel of the picture that errors are to", "N")
        ->capture_default_str();
    add_rounds_option(app, c.rounds);
    add_figure_options(app, c.report, "writes a report with pictures and charts, one file", c.json, c.csv);
    add_file(app, "-o,--output", c.folder, "writes pictures and heat maps as OpenEXR into a folder", "DIR");
    add_frame_options(app, a);
    add_replay_option(app, c);
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
    add_number(app, "--scale", p.scale, 1e-3, 1e3, "multiplies the number of micropolygons", "S")
        ->capture_default_str();
    add_number(app, "--motion", p.motion, 0.0, 1e3, "multiplies the motion; 0: none", "M")
        ->capture_default_str();
    add_number(app, "--defocus", p.defocus, 0.0, 1e3, "multiplies the lens; 0: a pinhole", "D")
        ->capture_default_str();
    add_number(app, "--shading-factor", p.shading_rate, 1e-3, 1e3, "multiplies the scene's ShadingRate", "F")
        ->capture_default_str();
    add_number(app, "--time", p.time, 0.0, 1e3,
               "seconds since the sequence began, of falling, bubbles, crocodile, hand and hair", "T")
        ->capture_default_str();
    add_resolution_option(app, a, "size of the picture");
    add_file(app, "-o,--output", a.output, "writes to a file instead of standard output", "FILE.rib");
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
    app.add_option(
           "--scenes", s.scenes,
           "measures these scenes alone: names or parts of names, separated by commas, of msbvh, mbkd, "
           "dynamic, structures and table5")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(a_name())
        ->type_name("NAME,...");
    add_file(app, "--bart", s.bart,
             "the folder of the Benchmark for Animated Ray Tracing, with kitchen/aff and museum/aff: dynamic "
             "follows them, too",
             "DIR");
    add_rounds_option(app, s.rounds);
    add_figure_options(app, s.report, "writes a report with tables, plots and checks, one file", s.json,
                       s.csv);
    add_work_options(app, a);
}

void add_shader_options(CLI::App& app, Arguments& a) {
    ShaderArguments& s = a.shader;
    app.add_option("file", s.file, "a shader's source; - is standard input")
        ->required()
        ->check(a_name())
        ->type_name("FILE.sl");
    app.add_option("-I,--include", s.include_folders,
                   "a folder to search for included files; may be repeated")
        ->allow_extra_args(false)
        ->check(a_name())
        ->type_name("DIR");
    app.add_option("-D,--define", s.defines, "defines a macro, as 1 if no text is given; may be repeated")
        ->allow_extra_args(false)
        ->check(a_macro())
        ->type_name("NAME[=TEXT]");
    app.add_flag("--params", s.parameters, "prints the parameters: storage, type, name, default");
    app.add_flag("--ir", s.code, "prints the code that the grid machine runs");
    app.add_flag("--strict", a.strict, "warnings count as errors for the exit code");
    app.add_flag("-q,--quiet", a.quiet, "only errors");
    add_safe_option(app, a);
    add_color_option(app, a);
}

void add_compliance_options(CLI::App& app, Arguments& a) {
    add_file(app, "--scenes", a.scenes_folder, "where tiny and gallery lie, whose RIB files show requests",
             "DIR")
        ->capture_default_str();
}

}  // namespace trapeze
